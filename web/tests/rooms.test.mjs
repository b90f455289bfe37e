// Six devices of one type, calibrated alone and as arrays: fleet, arrays, and the samples of a recording.
import assert from "node:assert/strict";
import { test } from "node:test";
import { browse, folder, operator, picture, serve, signIn, violations } from "./programs.mjs";

// The sixth has three times the noise of the others, which differ by a few percent.
const device = (number) => `
[[device]]
name = "imu${number}"
driver = "emulated"
options.device = "adis16405"
options.speed = 0
options.length = 20
options.serial = "AB10${number}"
options.seed = ${number}
options.model = ["gyro: WN(sigma2=${number === 6 ? 8.1e-5 : 9e-6 * (1 + 0.02 * number)})"]
`;

const campaign = `name = "shelf"
folder = "recordings"
replicates = 3
length = "20 s"

[calibration]
models = ["WN"]
diagnose = false
array = true
array_model = "WN"
${[1, 2, 3, 4, 5, 6].map(device).join("")}`;

async function fleet(page) {
  await page.getByRole("link", { name: "Fleet" }).click();
  await page.locator(".rows tbody tr").nth(5).waitFor();
  const out = page.locator(".rows tbody tr", { hasText: "stands out" });
  assert.deepEqual(await out.locator("th").allTextContents(), ["AB106"]);
  assert.match(await page.locator("p.alarm").textContent(), /AB106/);
  assert.match(await page.getByText(/^quartiles/).textContent(), /°\/√h, of 6 devices/);
  await page.locator(".picture-frame svg circle").nth(5).waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "fleet");
  const before = await page.getByText(/^quartiles/).textContent();
  await page.getByLabel("parameter").selectOption({ label: "gyro_y: angle random walk of WN (1 out)" });
  await page.waitForFunction((text) => ![...document.querySelectorAll("p")].some((one) => one.textContent === text), before);
  assert.deepEqual(await out.locator("th").allTextContents(), ["AB106"]);
  await page.getByRole("link", { name: "AB103" }).click();
  await page.getByRole("heading", { name: /AB103/ }).waitFor();
}

async function samples(page) {
  await page.getByText("One recording").click();
  await page.getByRole("link", { name: /^Samples of/ }).click();
  const told = page.locator(".zoom [role=status]");
  await told.getByText("0 to 20 s of 20 s").waitFor();
  await page.getByRole("img", { name: /^gyro_x: from/ }).waitFor();
  assert.match(await told.textContent(), /least and greatest of \d+ samples each/);
  assert.deepEqual(await violations(page), []);
  await picture(page, "recording");
  // With the pointer: drag over a part of the first trace, then all of it again.
  const box = await page.locator(".trace canvas").first().boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 20, { steps: 4 });
  await picture(page, "recording_drag");
  await page.mouse.up();
  await page.waitForFunction(() => !document.querySelector(".zoom [role=status]").textContent.startsWith("0 to 20"));
  const [from, until] = /([\d.]+) to ([\d.]+) s/.exec(await told.textContent()).slice(1).map(Number);
  assert.ok(until - from > 3 && until - from < 5, `a fifth of 20 s: ${from} to ${until}`);
  await page.getByRole("button", { name: "All" }).click();
  await told.getByText("0 to 20 s of 20 s").waitFor();
  // With the keyboard: so close that each sample is seen.
  await page.getByRole("group", { name: /^samples/ }).focus();
  for (let k = 0; k < 4; ++k) await page.keyboard.press("+");
  await told.getByText("each sample").waitFor();
  const before = await told.textContent();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction((text) => document.querySelector(".zoom [role=status]").textContent !== text, before);
  await picture(page, "recording_close");
  await page.getByText("Noise values for a program").click();
  await page.getByRole("button", { name: "Show" }).click();
  await page.locator("pre.values").waitFor();
  assert.deepEqual(await violations(page), []);
}

async function arrays(page) {
  await page.getByRole("link", { name: "Arrays" }).click();
  const row = page.locator(".rows tbody tr", { hasText: "across devices" }).filter({ hasText: "gyro_x" }).first();
  await row.waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "arrays");
  await row.getByRole("link").click();
  const told = page.getByRole("region", { name: "Virtual sensor" }).locator("[role=status]");
  await told.getByText("Compared with the mean of the sensors").waitFor();
  await page.locator(".array .picture-frame svg").nth(2).waitFor();
  assert.match(await told.textContent(), /% less noise power/, "the sixth has nine times the variance");
  assert.deepEqual(await violations(page), []);
  await picture(page, "array");
  const slider = page.getByRole("slider");
  const before = await slider.getAttribute("aria-valuetext");
  await slider.focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction((text) => document.querySelector("[type=range]").getAttribute("aria-valuetext") !== text, before);
  await page.getByText("Weights and gains as numbers").click();
  const weights = await page.locator("details table").first().locator("tbody td").allTextContents();
  assert.equal(weights.length, 6);
  assert.ok(parseFloat(weights[5]) < 0.3 * parseFloat(weights[0]), `the noisy one counts least: ${weights}`);
}

test("all devices of a type, what was recorded, and arrays", { timeout: 480_000 }, async (t) => {
  const { url } = await serve(t, folder(), campaign, 8477);
  const { page, problems } = await browse(t);
  await signIn(page, url, operator);
  await page.getByText("finished").first().waitFor({ timeout: 400_000 });
  // The catalogue knows a calibration a moment after the campaign has finished.
  const known = () => page.evaluate(async () => (await (await fetch("/v1/fleet")).json()).parameters?.length ?? 0);
  while ((await known()) < 3) await page.waitForTimeout(300);
  await fleet(page);
  await samples(page);
  await arrays(page);
  assert.deepEqual(problems, []);
});
