// IMUNOISE=../build/release/imunoise node tests/speed.mjs: what a live page costs, in Chromium. Prints medians; asserts nothing, for machines
// differ.
import { test } from "node:test";
import { browse, folder, operator, serve } from "./programs.mjs";

const median = (all) => [...all].sort((a, b) => a - b)[Math.floor(all.length / 2)];
const tell = (what, all, unit) => console.log(`${what}: median ${median(all).toFixed(0)} ${unit} of ${all.length}, largest ${Math.max(...all).toFixed(0)} ${unit}`);

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
