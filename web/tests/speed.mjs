// IMUNOISE=../build/release/imunoise node --test tests/speed.mjs: what the page costs, in Chromium. Prints medians; asserts nothing, for
// machines differ.
import { test } from "node:test";
import { browse, folder, open, operator, serve, signIn, simulate } from "./programs.mjs";

const kTimes = 20;
const sorted = (all) => [...all].sort((a, b) => a - b);
const median = (all) => sorted(all)[Math.floor(all.length / 2)];
const tell = (what, all, unit) => console.log(`${what}: median ${median(all).toPrecision(3)} ${unit} of ${all.length}, largest ${Math.max(...all).toPrecision(3)} ${unit}`);

const device = (number) => `[[device]]
name = "imu${number}"
driver = "emulated"
options.device = "adis16405"
options.rate = 819.2
options.seed = ${number}
`;

test("a live page", { timeout: 120_000 }, async (t) => {
  const { url } = await serve(t, folder(), `name = "bench"\nfolder = "recordings"\nreplicates = 1\nlength = "600 s"\n\n${device(1)}\n${device(2)}`, 8476);
  const { page } = await browse(t);
  await signIn(page, url, operator);
  await page.locator(".devices tbody tr").first().waitFor({ timeout: 30_000 });
  const client = await page.context().newCDPSession(page);
  await client.send("Performance.enable");
  const busy = async () => (await client.send("Performance.getMetrics")).metrics.find((one) => one.name === "TaskDuration").value;
  const shares = async (what) => {
    await page.waitForTimeout(10_000);
    const all = [];
    for (let k = 0; k < 6; ++k) {
      const before = await busy();
      await page.waitForTimeout(3000);
      all.push((100 * ((await busy()) - before)) / 3);
    }
    tell(`${what}: share of a core of its main thread`, all, "%");
  };
  await shares("The bench");
  await page.getByRole("link", { name: "imu1" }).click();
  await page.getByRole("img", { name: /^gyro_x: from/ }).waitFor({ timeout: 30_000 });
  await shares("A live device");
});

test("a study of 6,000,000 samples", { timeout: 1_800_000 }, async (t) => {
  const where = folder();
  simulate(where, "--model", "WN(sigma2=2.5e-7) + RW(gamma2=1e-14) + line(f=19.9, amplitude=2e-5)", "--rate", "100", "--samples", "1000000",
    "--replicates", "6", "--seed", "4", "--unit", "rad/s", "--channel", "gyro_z", "--out", "g.h5");
  const { url } = await open(t, where, ...[1, 2, 3, 4, 5, 6].map((k) => `g_${k}.h5`));
  const { page } = await browse(t);
  await page.goto(url);
  await page.getByLabel("first model").fill("WN + RW");
  await page.getByRole("button", { name: "Study", exact: true }).click();
  await page.locator(".candidates li").first().waitFor({ timeout: 300_000 });

  // From the request of the address to the figure on the screen.
  const first = [];
  for (let k = 0; k < kTimes; ++k) {
    await page.reload();
    first.push(await page.evaluate(() => new Promise((go) => {
      const look = () => (document.querySelector(".figure-canvas svg .measured") ? requestAnimationFrame(() => go(performance.now())) : requestAnimationFrame(look));
      look();
    })));
  }
  tell("First picture", first, "ms");

  // From a click to the frame after `there` holds.
  const timed = (click, there) => page.evaluate(`new Promise((go) => {
    const begin = performance.now();
    ${click};
    const look = () => (${there} ? requestAnimationFrame(() => go(performance.now() - begin)) : requestAnimationFrame(look));
    look();
  })`);

  await page.locator(".candidates li").first().waitFor({ timeout: 60_000 });
  const button = (words) => `[...document.querySelectorAll("button")].find((one) => one.textContent === "${words}" && !one.disabled)`;
  const preview = [];
  for (let k = 0; k < kTimes; ++k) {
    preview.push(await timed(`${button("Preview")}.click()`, `document.querySelector('[data-role="ghost"]') !== null`));
    await timed(`${button("Preview")}.click()`, `document.querySelector('[data-role="ghost"]') === null`);
  }
  tell("Preview of a candidate", preview, "ms");

  // Each time a term that was not tried before: nothing of its fit is in the cache.
  const add = [];
  for (let k = 0; k < kTimes; ++k) {
    await page.getByRole("button", { name: "+ add a term" }).click();
    await page.getByLabel("term", { exact: true }).fill(`line(f=${(3.1 + 0.7 * k).toFixed(1)})`);
    await page.evaluate(() => document.querySelector(".figure-canvas svg").classList.add("before"));
    add.push(await timed(`document.querySelector(".model button.main").click()`,
      `document.querySelectorAll(".step").length === 2 && document.querySelector(".figure-canvas svg:not(.before)") !== null`));
    await page.waitForFunction(() => document.querySelector(".job") === null && ![...document.querySelectorAll("button")].find((one) => one.textContent === "Undo").disabled, null, { timeout: 120_000 });
    await page.getByRole("button", { name: "Undo" }).click();
    await page.waitForFunction(() => document.querySelectorAll(".step").length === 1, null, { timeout: 60_000 });
    await page.waitForFunction(() => document.querySelector(".job") === null && ![...document.querySelectorAll("button")].find((one) => one.textContent === "+ add a term").disabled, null, { timeout: 120_000 });
  }
  tell("Add, until fit, residuals, errors and ladder are on the screen", add, "ms");
});
