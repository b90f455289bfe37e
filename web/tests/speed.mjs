// IMUNOISE=../build/release/imunoise node tests/speed.mjs: how long a user waits, in Chromium, for 6 · 10⁶ samples. Prints medians; asserts
// nothing, for machines differ.
import { test } from "node:test";
import { browse, folder, open, operator, serve, simulate } from "./programs.mjs";

const times = Number(process.env.TIMES ?? 20);
const median = (all) => [...all].sort((a, b) => a - b)[Math.floor(all.length / 2)];
const tell = (what, all, unit) => console.log(`${what}: median ${median(all).toFixed(0)} ${unit} of ${all.length}, largest ${Math.max(...all).toFixed(0)} ${unit}`);

// From here until `until` holds in the page, ms by the page's own clock.
async function timed(page, act, until) {
  const begin = await page.evaluate(() => performance.now());
  await act();
  return page.waitForFunction(until, null, { polling: "raf" }).then(() => page.evaluate((since) => performance.now() - since, begin));
}

async function begin(page, url) {
  await page.goto(url);
  await page.getByLabel("first model").fill("WN + RW");
  await page.getByRole("button", { name: "Study", exact: true }).click();
  await page.locator(".candidates li").nth(1).waitFor({ timeout: 300_000 });
}

test("a study of six million samples", { timeout: 1_200_000 }, async (t) => {
  const where = folder();
  simulate(where, "--model", "WN(sigma2=2.5e-7) + RW(gamma2=1e-14) + line(f=19.9, amplitude=2e-5) + line(f=7.3, amplitude=2e-5)", "--rate", "100",
    "--samples", "1000000", "--replicates", "6", "--seed", "4", "--unit", "rad/s", "--channel", "gyro_z", "--out", "g.h5");
  const { url } = await open(t, where, ...[1, 2, 3, 4, 5, 6].map((k) => `g_${k}.h5`));
  const { page } = await browse(t);
  await begin(page, url);
  const here = page.url();

  const previews = [];
  for (let k = 0; k < times; ++k) {
    const which = page.locator(".candidates li").nth(k % 2).getByRole("button", { name: "Preview" });
    const before = await page.evaluate(() => document.querySelector('[data-role="ghost"] path')?.getAttribute("d") ?? "");
    await page.evaluate((path) => { window.before = path; }, before);
    previews.push(await timed(page, () => which.click(), () => {
      const path = document.querySelector('[data-role="ghost"] path')?.getAttribute("d") ?? "";
      return path !== "" && path !== window.before;
    }));
  }
  tell("Preview, until the dotted line is drawn", previews, "ms");

  const pictures = [];
  for (let k = 0; k < times; ++k) {
    await page.goto("about:blank");
    const since = Date.now();
    await page.goto(here);
    await page.locator(".figure-canvas svg").waitFor();
    pictures.push(Date.now() - since);
  }
  tell("First picture, from the address on", pictures, "ms");

  const adds = [];
  for (let k = 0; k < Math.min(times, 5); ++k) {
    if (k > 0) {
      await page.goto(here.replace(/#.*/, "#/studies"));
      await page.getByRole("heading", { name: "New study" }).waitFor();
      await page.getByLabel("first model").fill("WN + RW");
      await page.getByRole("button", { name: "Study", exact: true }).click();
      await page.locator(".candidates li").nth(1).waitFor({ timeout: 300_000 });
    }
    adds.push(await timed(page, () => page.getByRole("button", { name: "Add", exact: true }).first().click(),
      () => document.querySelectorAll(".step").length === 2 && document.querySelector(".figure-canvas svg") !== null));
    await page.locator(".verdict:not(:empty)").waitFor();
  }
  tell("Add, until fit, errors and ladder are new", adds, "ms");
});

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
  await page.goto(url);
  await page.getByLabel("Token").fill(operator);
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByRole("link", { name: "imu1" }).click();
  await page.getByRole("img", { name: /^gyro_x: from/ }).waitFor({ timeout: 30_000 });
  await page.waitForTimeout(10_000);
  const client = await page.context().newCDPSession(page);
  await client.send("Performance.enable");
  const busy = async () => (await client.send("Performance.getMetrics")).metrics.find((one) => one.name === "TaskDuration").value;
  const shares = [];
  for (let k = 0; k < 6; ++k) {
    const before = await busy();
    await page.waitForTimeout(5000);
    shares.push((100 * ((await busy()) - before)) / 5);
  }
  tell("A live page's share of a core (its main thread)", shares, "%");
});
