// Emulated sensors are recorded; a viewer looks on.
import assert from "node:assert/strict";
import { test } from "node:test";
import { browse, folder, operator, picture, serve, signIn, viewer, violations } from "./programs.mjs";

const campaign = `name = "array"
folder = "recordings"
replicates = 1
length = "60 s"

[[device]]
name = "left"
driver = "emulated"
options.device = "xsens"
options.seed = 1
`;

// The samples of a device as they come, its Allan deviation, and how much longer.
async function look(page) {
  await page.getByRole("link", { name: "left" }).click();
  await page.getByRole("heading", { name: "left" }).waitFor();
  const trace = page.getByRole("img", { name: /^gyro_x: from/ });
  await trace.waitFor({ timeout: 30_000 });
  const before = await trace.getAttribute("aria-label");
  await page.waitForFunction((label) => document.querySelector(".trace canvas")?.getAttribute("aria-label") !== label, before);
  await page.locator(".knowledge .figure-canvas circle.measured").nth(3).waitFor({ timeout: 30_000 });
  await page.getByText("By the model WN + FN + RW").waitFor({ timeout: 30_000 });
  assert.equal(await page.locator(".parameters tbody tr").count(), 3);
  assert.match(await page.locator(".parameters tbody tr").first().textContent(), /angle random walk.*°\/√h.*(long enough|more for ±10 %|not seen)/);
  assert.ok((await page.locator(".traces table.visually-hidden tbody tr").count()) >= 6);
  assert.deepEqual(await violations(page), []);
  await page.getByText(/· 1\d s recorded/).waitFor({ timeout: 30_000 });
  await page.waitForTimeout(1500);
  await picture(page, "live");
  await page.getByRole("button", { name: "Hold" }).click();
  await page.waitForTimeout(700);
  const held = await trace.getAttribute("aria-label");
  await page.waitForTimeout(1500);
  assert.equal(await trace.getAttribute("aria-label"), held, "nothing moves while it is held");
  await page.getByRole("button", { name: "Continue" }).click();
  await page.getByLabel("span").selectOption("600");
  await page.getByText(/least and greatest of \d+ samples each/).waitFor();
  await page.getByLabel("channel").selectOption({ label: "gyro_z" });
  await page.locator(".knowledge .figure-frame").focus();
  await page.keyboard.press("ArrowRight");
  await page.getByText(/^At 0\.0\d+ s: /).waitFor();
}

test("a campaign records, is stopped knowingly and started again", { timeout: 90_000 }, async (t) => {
  const { url } = await serve(t, folder(), campaign, 8471);
  const { page, problems } = await browse(t);
  await page.goto(url);
  await page.getByLabel("Token").fill("x".repeat(32));
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByText("unknown token").waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, "sign_in");
  await signIn(page, url, operator);
  await page.locator(".devices tbody tr").first().waitFor({ timeout: 30_000 });
  assert.deepEqual(await violations(page), []);
  await look(page);
  await page.getByRole("link", { name: "The bench" }).click();
  await page.locator(".devices tbody tr path").first().waitFor({ state: "attached" });
  await picture(page, "bench");
  await page.getByRole("button", { name: "Stop", exact: true }).click();
  await page.getByText("This ends recording").waitFor();
  await picture(page, "stop");
  await page.getByRole("button", { name: "Stop it" }).click();
  await page.getByRole("button", { name: "Start" }).click({ timeout: 30_000 });
  await page.getByRole("button", { name: "Stop", exact: true }).waitFor({ timeout: 30_000 });
  assert.deepEqual(problems, []);
});

test("a viewer sees everything and changes nothing", { timeout: 60_000 }, async (t) => {
  const { url } = await serve(t, folder(), campaign, 8472);
  const { page } = await browse(t);
  await signIn(page, url, viewer);
  await page.getByText("read only").waitFor();
  assert.ok(await page.getByRole("button", { name: "Stop", exact: true }).isDisabled());
  const refused = await page.evaluate(async () => {
    const response = await fetch("/v1/campaigns/array/stop", { method: "POST", headers: { "Content-Type": "application/json" }, body: "{}" });
    return [response.status, (await response.json()).error];
  });
  assert.deepEqual(refused, [403, "this needs an operator token"]);
});
