// From an emulated sensor with a hidden effect to a model that holds it, with nothing but the page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { browse, file, folder, hold, operator, picture, serve, signIn, viewer, violations } from "./programs.mjs";

const campaign = `name = "bench"
folder = "recordings"
replicates = 3
length = "300 s"

[calibration]
enabled = false

[[device]]
name = "imu"
driver = "emulated"
options.device = "adis16405"
options.speed = 0
options.length = 300
options.seed = 5
options.model = ["gyro: WN(sigma2=9e-6)"]
options.effect = ["fan(frequency=23, amplitude=3e-3, channel=gyro_x)"]
`;

const waiting = campaign.replace('"bench"', '"other"').replace('"recordings"', '"elsewhere"').replace("[calib", 'settling = "1 h"\n[calib');

// Someone else looks on: every button is there, none works, and a request is refused with a sentence.
async function lookOn(t, url, address) {
  const { page } = await browse(t);
  await signIn(page, url, viewer);
  await page.getByText("read only").waitFor();
  await page.goto(address);
  await page.locator(".candidates li").first().waitFor({ timeout: 60_000 });
  for (const name of ["Undo", "Redo", "Branch", "+ add a term"]) assert.ok(await page.getByRole("button", { name }).isDisabled(), name);
  assert.ok(await page.getByRole("button", { name: "Add", exact: true }).first().isDisabled());
  await page.keyboard.press("Control+z");
  const refused = await page.evaluate(async () => {
    const response = await fetch(`/v1/studies/${location.hash.split("/")[2]}/add`, { method: "POST", headers: { "Content-Type": "application/json" }, body: '{"term": "RW"}' });
    return [response.status, (await response.json()).error];
  });
  assert.deepEqual(refused, [403, "this needs an operator token"]);
  assert.deepEqual(await violations(page), []);
  await picture(page, "journey_viewer");
}

test("from an empty bench to a model that holds the hidden effect", { timeout: 480_000 }, async (t) => {
  const where = folder();
  const { url, child } = await serve(t, where, waiting, 8473);
  const { page, problems } = await browse(t);
  await signIn(page, url, operator);
  await page.getByText("waits until the sensors are still").waitFor({ timeout: 30_000 });
  await page.getByRole("link", { name: "Studies" }).click();
  await page.getByText("Nothing is recorded yet").waitFor();
  await page.getByRole("link", { name: "Bench" }).click();
  file(where, "bench", campaign);
  child.kill("SIGHUP");
  await page.getByText("finished").first().waitFor({ timeout: 90_000 });
  assert.deepEqual(await violations(page), []);
  await picture(page, "bench_finished");

  await page.getByRole("link", { name: "Studies" }).click();
  await page.getByRole("option", { name: "imu/imu/gyro_x" }).first().waitFor({ state: "attached", timeout: 20_000 });
  await page.getByLabel("channel").first().selectOption("imu/imu/gyro_x");
  await page.route("**/v1/studies", async (route) => {
    const response = await route.fetch();
    hold(child.pid); // else the fit may end before it is cancelled
    await route.fulfill({ response });
  }, { times: 1 });
  await page.getByRole("button", { name: "Study", exact: true }).first().click();
  await page.getByRole("status").getByText("Fitting the first model").waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "job");
  await page.getByRole("button", { name: "Cancel" }).click();
  child.kill("SIGCONT"); // the fit itself is ended
  await page.getByText("Fitting the first model").waitFor({ state: "detached", timeout: 10_000 });
  await page.getByText("There is no study yet").waitFor();
  await page.getByLabel("first model").first().fill("WN");
  await page.getByRole("button", { name: "Study", exact: true }).first().click();
  await page.locator(".candidates li").first().waitFor({ timeout: 240_000 });
  assert.match(await page.locator(".verdict").textContent(), /something is missing/);
  await picture(page, "journey_missing");
  await lookOn(t, url, page.url());
  await page.getByRole("button", { name: "+ add a term" }).click();
  await page.getByLabel("term", { exact: true }).fill("lime(f=7)");
  await page.locator(".model").getByRole("button", { name: "Add", exact: true }).click();
  await page.getByRole("alert").getByText(/line/).waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "journey_error");
  await page.getByRole("button", { name: "Close" }).click();
  assert.equal(await page.getByLabel("term", { exact: true }).inputValue(), "lime(f=7)");
  await page.getByRole("button", { name: "Cancel", exact: true }).click();
  const error = async () => parseFloat(await page.locator(".errors .now").first().textContent());
  const before = await error();
  await page.getByRole("button", { name: "Add", exact: true }).first().click();
  await page.locator(".step").nth(1).waitFor({ timeout: 60_000 });
  assert.ok((await error()) < before / 2);
  await picture(page, "journey_added");
  await page.getByRole("link", { name: "Bench" }).click();
  await page.getByRole("button", { name: "Record again" }).click();
  await page.getByRole("region", { name: "bench" }).getByText(/replicate \d of 3/).waitFor({ timeout: 30_000 });
  assert.deepEqual(problems, []);
});
