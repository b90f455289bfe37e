// Every device of the bench, and the history of one.
import assert from "node:assert/strict";
import { test } from "node:test";
import { browse, folder, operator, picture, serve, signIn, violations } from "./programs.mjs";

const campaign = `name = "bench"
folder = "recordings"
replicates = 2
length = "4 s"

[schedule]
every = "10 s"

[calibration]
models = ["WN"]
diagnose = false

[[device]]
name = "imu"
driver = "emulated"
options.device = "adis16405"
options.speed = 0
options.length = 4
options.seed = 5
options.model = ["gyro: WN(sigma2=9e-6)"]
`;

test("a device is listed, and its history is a click away", { timeout: 150_000 }, async (t) => {
  const { url } = await serve(t, folder(), campaign, 8474);
  const { page, problems } = await browse(t);
  await signIn(page, url, operator);
  const calibrated = async (count) => {
    const known = () => page.evaluate(async () => (await (await fetch("/v1/recordings")).json()).recordings.filter((one) => one.calibrated).length);
    while ((await known()) < count) await page.waitForTimeout(300);
  };
  await page.getByRole("link", { name: "Devices" }).waitFor();
  await page.getByRole("region", { name: "bench" }).waitFor();
  await calibrated(2);

  await page.getByRole("link", { name: "Devices" }).click();
  const row = page.locator(".rows tbody tr").first();
  await row.waitFor();
  const [name, recordings, fitted] = await row.locator("td").allTextContents();
  assert.equal(name, "imu");
  assert.ok(Number(recordings) >= 2 && Number(fitted) >= 2, `${recordings} recordings, ${fitted} calibrated`);
  assert.deepEqual(await violations(page), []);
  await picture(page, "devices");

  await row.getByRole("link").click();
  await page.getByText("The newest calibration against").waitFor();
  await page.getByText(/^Calibration: \d+ of \d+ channels have a model/).waitFor();
  assert.match(await page.locator(".rows tbody tr").first().textContent(), /N of WN.*not compared/);
  await page.locator("summary", { hasText: "calibrations" }).first().click();
  await page.locator("details .picture-frame circle.measured").nth(1).waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "history");

  await page.goto(`${url}#/devices/nobody`);
  await page.getByRole("heading", { name: "No history of nobody" }).waitFor();
  assert.deepEqual(await violations(page), []);
  await page.getByRole("link", { name: "All devices" }).click();
  await page.getByRole("heading", { name: "Devices" }).waitFor();
  assert.deepEqual(problems, []);
});
