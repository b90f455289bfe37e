// A hidden wave is found, previewed, added, taken back and added again.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { browse, folder, open, picture, simulate, violations } from "./programs.mjs";

async function opened(t) {
  const where = folder();
  simulate(where, "--model", "WN(sigma2=2.5e-7) + RW(gamma2=1e-14) + line(f=19.9, amplitude=2e-4)", "--rate", "100", "--samples", "20000",
    "--replicates", "4", "--seed", "4", "--unit", "rad/s", "--channel", "gyro_z", "--out", "g.h5");
  const service = await open(t, where, "g_1.h5", "g_2.h5", "g_3.h5", "g_4.h5");
  const browser = await browse(t);
  await browser.page.goto(service.url);
  return { ...service, ...browser };
}

async function study(page) {
  await page.getByLabel("first model").fill("WN + RW");
  await page.getByRole("button", { name: "Study", exact: true }).click();
  await page.locator(".candidates li").first().waitFor({ timeout: 60_000 });
}

const now = async (page) => parseFloat(await page.locator(".errors .now").first().textContent());

test("the hidden effect is found and the error falls", { timeout: 180_000 }, async (t) => {
  const { page, problems } = await opened(t);
  await page.getByRole("heading", { name: "New study" }).waitFor();
  assert.ok(!page.url().includes("token"), "the token leaves the address");
  assert.deepEqual(await violations(page), []);
  await picture(page, "studies");
  await study(page);
  await page.locator(".figure-canvas svg").waitFor();
  assert.match(await page.locator(".verdict").textContent(), /something is missing.*19\.9 Hz/);
  assert.deepEqual(await violations(page), []);
  await picture(page, "study");
  const before = await now(page);

  await page.getByRole("button", { name: "Preview" }).first().click();
  await page.locator('[data-role="ghost"]').first().waitFor();
  await picture(page, "preview");
  assert.equal(await now(page), before, "a preview changes nothing");

  await page.getByRole("button", { name: "Add", exact: true }).first().click();
  await page.locator(".step").nth(1).waitFor();
  const after = await now(page);
  assert.ok(after < before / 5, `${after} after ${before}`);
  await page.locator(".verdict.good").waitFor({ timeout: 60_000 });
  await picture(page, "added");
  assert.deepEqual(await violations(page), []);

  await page.getByRole("button", { name: "Undo" }).click();
  await page.waitForFunction((error) => parseFloat(document.querySelector(".errors .now")?.textContent) === error, before);
  await page.getByText("Seeking what is missing").waitFor(); // and need not end
  await page.keyboard.press("Control+Shift+Z");
  await page.waitForFunction((error) => parseFloat(document.querySelector(".errors .now")?.textContent) === error, after);
  await page.locator(".verdict.good").waitFor({ timeout: 60_000 });

  await page.getByRole("button", { name: "Branch" }).click();
  await page.getByLabel("copy as").fill("other");
  await page.getByRole("button", { name: "Copy" }).click();
  await page.waitForURL(/studies\/other$/);
  await page.locator(".step").nth(1).waitFor();
  assert.deepEqual(problems, []);
});

test("every view is drawn, and the keyboard alone suffices", { timeout: 180_000 }, async (t) => {
  const { page, problems } = await opened(t);
  await study(page);
  await page.getByRole("tab", { name: "Averaging time" }).focus();
  for (const view of ["Spectrum", "Time", "Distribution", "Witnesses", "Replicates"]) {
    await page.keyboard.press("ArrowRight");
    await page.getByRole("tab", { name: view, selected: true }).waitFor();
    await page.locator(view === "Witnesses" ? ".nothing" : ".figure-canvas svg").waitFor();
    await page.waitForTimeout(200);
    assert.deepEqual(await violations(page), [], view);
    await picture(page, `view_${view.toLowerCase()}`);
  }
  await page.keyboard.press("ArrowRight");
  await page.locator(".figure-canvas .guide").waitFor({ state: "attached" });
  await page.locator(".figure-frame").focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.match(await page.locator(".sentence").textContent(), /0\.02 s|averaging time/);
  assert.ok((await page.locator("table.visually-hidden tbody tr").count()) > 5);
  await page.setViewportSize({ width: 820, height: 1180 });
  await page.waitForTimeout(400);
  await picture(page, "tablet");
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 820, "nothing stands out at the side");
  assert.deepEqual(problems, []);
});

test("a study leaves as figure, report, JSON and noise values", { timeout: 120_000 }, async (t) => {
  const { page, problems } = await opened(t);
  await study(page);
  const saved = async (choice) => {
    const [file] = await Promise.all([page.waitForEvent("download"), page.getByLabel("Export").selectOption(choice)]);
    return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
  };
  const svg = await saved("svg");
  assert.match(svg.bytes.toString(), /^<svg[^]*<\/svg>\s*$/);
  const png = await saved("png");
  assert.deepEqual([...png.bytes.subarray(1, 4)], [...Buffer.from("PNG")]);
  assert.match((await saved("report")).bytes.toString(), /^<!doctype html>/i);
  assert.equal(JSON.parse((await saved("json")).bytes.toString()).channel, "gyro_z");
  await page.getByLabel("Export").selectOption("program");
  await page.getByRole("combobox", { name: /^program/ }).selectOption({ label: "Kalibr" });
  await page.getByRole("button", { name: "Show" }).click();
  await page.getByText(/gyroscope_noise_density: /).waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "export");
  const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save" }).click()]);
  assert.match(file.suggestedFilename(), /^kalibr/);
  assert.deepEqual(problems, []);
});

test("imunoise open ends with its last page", { timeout: 60_000 }, async (t) => {
  const { page, child } = await opened(t);
  await page.getByRole("heading", { name: "New study" }).waitFor();
  const ended = new Promise((go) => child.on("exit", go));
  await page.waitForTimeout(600);
  await page.close();
  assert.equal(await ended, 0);
});

test("the service goes and comes back", { timeout: 60_000 }, async (t) => {
  const { page, child } = await opened(t);
  await page.getByRole("heading", { name: "New study" }).waitFor();
  await page.waitForTimeout(600);
  child.kill("SIGKILL");
  await page.getByText("connection lost").waitFor({ timeout: 10_000 });
  await page.getByRole("button", { name: "Study", exact: true }).click();
  await page.getByText("imunoise does not answer").waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "gone");
});
