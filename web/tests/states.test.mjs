// States that must look good: nothing there yet, much too much, slow, broken, gone and back, enlarged, on paper.
import assert from "node:assert/strict";
import { rmSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { browse, file, folder, open, operator, picture, serve, signIn, simulate, violations } from "./programs.mjs";
import { proxy } from "./proxy.mjs";

const device = (name, more = "") => `
[[device]]
name = "${name}"
driver = "emulated"
options.device = "adis16405"
${more}`;

const campaign = (name, more = "") => `name = "${name}"
folder = "recordings"
replicates = 1
length = "10 min"
${more}`;

const long = `gyro_${"x".repeat(75)}`; // 80 characters

const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

// How much of what was seen has jumped, as Chromium counts it.
const watchJumps = (page) => page.addInitScript(() => {
  globalThis.jumped = 0;
  new PerformanceObserver((list) => {
    for (const one of list.getEntries()) if (!one.hadRecentInput) globalThis.jumped += one.value;
  }).observe({ type: "layout-shift", buffered: true });
});

test("where there is nothing yet, each room says what to do", { timeout: 90_000 }, async (t) => {
  const where = folder();
  const { url, child } = await serve(t, where, campaign("array", "settling = \"1 h\"\n" + device("left")), 8478);
  const { page, problems } = await browse(t);
  await signIn(page, url, operator);
  await page.getByText("waits until the sensors are still").waitFor({ timeout: 30_000 });
  assert.deepEqual(await violations(page), []);
  await picture(page, "bench_settling");
  for (const [room, words] of [["Studies", "Nothing is recorded yet"], ["Devices", "No device was recorded yet"], ["Fleet", "There is no fleet"], ["Arrays", "No array was calibrated yet"]]) {
    await page.getByRole("link", { name: room }).click();
    await page.getByText(words).waitFor();
    assert.deepEqual(await violations(page), [], room);
    await picture(page, `nothing_${room.toLowerCase()}`);
  }
  rmSync(join(where, "campaigns", "array.toml"));
  file(where, "other", "name = 'x'");
  child.kill("SIGHUP");
  await page.waitForTimeout(1000);
  await page.getByRole("link", { name: "Bench" }).click();
  await page.getByText("is not used").waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "rejected");
  assert.deepEqual(problems, []);
});

test("a connection that is slow, breaks, falls silent", { timeout: 150_000 }, async (t) => {
  const { url } = await serve(t, folder(), campaign("array", device("left")), 8479);
  const between = await proxy(t, url);
  const { page, problems } = await browse(t);
  await watchJumps(page);
  await signIn(page, between.url, operator);
  await page.locator(".devices tbody tr").first().waitFor({ timeout: 30_000 });

  const client = await page.context().newCDPSession(page);
  await client.send("Network.enable");
  const network = (latency, downloadThroughput) =>
    client.send("Network.emulateNetworkConditions", { offline: false, latency, downloadThroughput, uploadThroughput: downloadThroughput });
  await network(1500, 30_000);
  await page.reload();
  await page.getByRole("status", { name: "loading" }).waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "loading");
  await page.locator(".devices tbody tr").first().waitFor({ timeout: 30_000 });
  const jumped = await page.evaluate(() => globalThis.jumped);
  assert.ok(jumped < 0.1, `the page jumps while it loads: ${jumped}`);
  await network(0, -1);

  const elapsed = () => page.locator(".devices tbody td").nth(5).textContent();
  between.break_();
  await page.getByText("connection lost").waitFor({ timeout: 10_000 });
  assert.deepEqual(await violations(page), []);
  await picture(page, "lost");
  await page.getByRole("button", { name: "Stop", exact: true }).click();
  await page.getByRole("button", { name: "Stop it" }).click();
  await page.getByText("imunoise does not answer").waitFor();
  between.mend();
  await page.getByText("connection lost").waitFor({ state: "detached", timeout: 10_000 });
  const before = await elapsed();
  await page.waitForFunction((text) => document.querySelectorAll(".devices tbody td")[5].textContent !== text, before, { timeout: 10_000 });

  between.silence();
  await page.getByText("connection lost").waitFor({ timeout: 60_000 });
  between.mend();
  await page.getByText("connection lost").waitFor({ state: "detached", timeout: 10_000 });
  assert.deepEqual(problems, []);
});

test("imunoised is killed and comes back", { timeout: 90_000 }, async (t) => {
  const where = folder();
  const first = await serve(t, where, campaign("array", device("left")), 8480);
  const { page, problems } = await browse(t);
  await signIn(page, first.url, operator);
  await page.locator(".devices tbody tr").first().waitFor({ timeout: 30_000 });
  first.child.kill("SIGKILL");
  await page.getByText("connection lost").waitFor({ timeout: 10_000 });
  await serve(t, where, campaign("array", device("left")), 8480);
  await page.getByText("imunoised was started again").waitFor({ timeout: 10_000 });
  assert.deepEqual(await violations(page), []);
  await picture(page, "again");
  await page.getByLabel("Token").fill(operator);
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.locator(".devices tbody tr").first().waitFor({ timeout: 30_000 });
  await page.getByText(/replicate 2 of 1|replicate 1 of 1|replicate 2/).first().waitFor();
  await picture(page, "back");
  assert.deepEqual(problems, []);
});

test("64 devices", { timeout: 300_000 }, async (t) => {
  const names = Array.from({ length: 64 }, (_, k) => `imu${String(k + 1).padStart(2, "0")}`);
  const all = names.map((name, k) => device(name, `options.serial = "AB${100 + k}"\noptions.seed = ${k + 1}\n`)).join("");
  const { url } = await serve(t, folder(), campaign("wall", all), 8481);
  const { page, problems } = await browse(t);
  await watchJumps(page);
  await signIn(page, url, operator);
  await page.locator(".devices tbody tr").nth(63).waitFor({ timeout: 60_000 });
  await page.locator(".sparkline path").nth(63).waitFor({ state: "attached", timeout: 60_000 });
  await page.waitForTimeout(12_000);
  assert.deepEqual(await violations(page), []);
  await picture(page, "bench_64");
  const before = await page.evaluate(() => globalThis.jumped);
  await page.waitForTimeout(5000);
  assert.equal(await page.evaluate(() => globalThis.jumped), before, "nothing jumps while samples come");
  assert.ok((await overflow(page)) <= 0);
  await page.getByRole("link", { name: "imu64" }).click();
  await page.locator(".knowledge .figure-canvas circle.measured").nth(3).waitFor({ timeout: 30_000 });
  await page.getByText("All averaging times of all channels").click();
  await page.locator(".deviation tbody tr").nth(5).waitFor();
  assert.deepEqual(await violations(page), []);
  await page.getByText("All averaging times of all channels").scrollIntoViewIfNeeded();
  await picture(page, "live_64");
  assert.deepEqual(problems, []);
});

test("200 replicates under a name of 80 characters; enlarged, and on paper", { timeout: 480_000 }, async (t) => {
  const where = folder();
  simulate(where, "--model", "WN(sigma2=2.5e-7) + line(f=19.9, amplitude=2e-4)", "--rate", "100", "--samples", "1000",
    "--replicates", "200", "--seed", "4", "--unit", "rad/s", "--channel", long, "--out", "g.h5");
  const files = Array.from({ length: 200 }, (_, k) => `g_${k + 1}.h5`);
  const { url } = await open(t, where, ...files);
  const { page, problems } = await browse(t);
  await page.goto(url);
  await page.getByLabel("first model").fill("WN");
  assert.deepEqual(await violations(page), []);
  await picture(page, "studies_200");
  const inside = await page.locator(".new select").evaluate((one) => one.getBoundingClientRect().right <= one.form.getBoundingClientRect().right);
  assert.ok(inside, "a long name stays in its card");
  await page.getByRole("button", { name: "Study", exact: true }).click();
  await page.locator(".candidates li").first().waitFor({ timeout: 400_000 });
  await page.getByText("200 replicates").first().waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "study_200");
  await page.getByRole("tab", { name: "Replicates" }).click();
  await page.locator(".figure-canvas svg").waitFor();
  await page.waitForTimeout(500);
  await picture(page, "replicates_200");
  await page.getByRole("tab", { name: "Averaging time" }).click();
  // 200 % on a laptop is half as many pixels; then a tablet.
  for (const [width, height, name] of [[683, 384, "zoom_200"], [820, 1180, "tablet_200"]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(500);
    assert.ok((await overflow(page)) <= 0, `nothing stands out at the side at ${width} px`);
    assert.deepEqual(await violations(page), [], name);
    await picture(page, name);
  }
  await page.setViewportSize({ width: 1000, height: 1400 });
  await page.emulateMedia({ media: "print" });
  assert.ok(await page.locator(".bar").isHidden());
  for (const kept of [".candidates .title", ".ladder .step"]) assert.ok(await page.locator(kept).first().isVisible(), `${kept} is printed`);
  await picture(page, "print");
  await page.emulateMedia({ media: "screen" });
  assert.deepEqual(problems, []);
});
