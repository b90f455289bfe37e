// From an emulated sensor with a hidden effect to a model that holds it, with nothing but the page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { browse, folder, operator, picture, serve, violations } from "./programs.mjs";

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

test("record, study, find, add", { timeout: 240_000 }, async (t) => {
  const { url } = await serve(t, folder(), campaign, 8473);
  const { page, problems } = await browse(t);
  await page.goto(url);
  await page.getByLabel("Token").fill(operator);
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByText("finished").first().waitFor({ timeout: 90_000 });
  assert.deepEqual(await violations(page), []);
  await picture(page, "bench_finished");

  await page.getByRole("link", { name: "Studies" }).click();
  await page.getByRole("option", { name: "imu/imu/gyro_x" }).first().waitFor({ state: "attached", timeout: 20_000 });
  await page.getByLabel("channel").first().selectOption("imu/imu/gyro_x");
  await page.getByLabel("first model").first().fill("WN");
  await page.getByRole("button", { name: "Study", exact: true }).first().click();
  await page.locator(".candidates li").first().waitFor({ timeout: 120_000 });
  assert.match(await page.locator(".verdict").textContent(), /something is missing/);
  await picture(page, "journey_missing");
  const error = async () => parseFloat(await page.locator(".errors .now").first().textContent());
  const before = await error();
  await page.getByRole("button", { name: "Add", exact: true }).first().click();
  await page.locator(".step").nth(1).waitFor({ timeout: 60_000 });
  assert.ok((await error()) < before / 2);
  await picture(page, "journey_added");
  assert.deepEqual(problems, []);
});
