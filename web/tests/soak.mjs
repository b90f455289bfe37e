// IMUNOISE=../build/dev/imunoise node --test tests/soak.mjs: 64 emulated devices and a page that shows them, for ten minutes. The memory of
// both may grow by a twentieth from the fourth minute to the tenth.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { browse, folder, operator, serve, signIn } from "./programs.mjs";

const kMinutes = 10;
const kWarm = 4; // minutes, until rings and caches are full
const kMost = 1.05;

const device = (number) => `[[device]]
name = "imu${number}"
driver = "emulated"
options.device = "adis16405"
options.serial = "AB${100 + number}"
options.seed = ${number}
`;

const resident = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1000; // MB
const seconds = (pid) => {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100; // of a core
};

test("64 devices for ten minutes", { timeout: (kMinutes + 3) * 60_000 }, async (t) => {
  const all = Array.from({ length: 64 }, (_, k) => device(k + 1)).join("\n");
  const { url, child } = await serve(t, folder(), `name = "wall"\nfolder = "recordings"\nreplicates = 1\nlength = "30 min"\n\n${all}`, 8482);
  const { page, problems } = await browse(t);
  await signIn(page, url, operator);
  await page.locator(".devices tbody tr").nth(63).waitFor({ timeout: 120_000 });
  const client = await page.context().newCDPSession(page);
  await client.send("Performance.enable");
  await client.send("HeapProfiler.enable");
  const metric = async (name) => (await client.send("Performance.getMetrics")).metrics.find((one) => one.name === name).value;
  const marks = [];
  for (let minute = 1; minute <= kMinutes; ++minute) {
    const [before, busy] = [seconds(child.pid), await metric("TaskDuration")];
    await page.waitForTimeout(60_000);
    await client.send("HeapProfiler.collectGarbage");
    const mark = { daemon: resident(child.pid), heap: (await metric("JSHeapUsedSize")) / 1e6, nodes: await metric("Nodes") };
    marks.push(mark);
    console.log(`${minute} min: imunoised ${mark.daemon.toFixed(0)} MB, ${((seconds(child.pid) - before) / 0.6).toFixed(0)} % of a core; page ${mark.heap.toFixed(1)} MB, ` +
      `${mark.nodes} nodes, ${(((await metric("TaskDuration")) - busy) / 0.6).toFixed(0)} % of a core`);
  }
  const [warm, last] = [marks[kWarm - 1], marks.at(-1)];
  for (const what of ["daemon", "heap", "nodes"]) assert.ok(last[what] < kMost * warm[what], `${what}: ${warm[what]} MB, then ${last[what]} MB`);
  assert.deepEqual(problems, []);
});
