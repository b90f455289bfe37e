// Emulated sensors are recorded; a viewer looks on.
import assert from "node:assert/strict";
import { test } from "node:test";
import { browse, folder, operator, picture, serve, viewer, violations } from "./programs.mjs";

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

async function signIn(page, url, token) {
  await page.goto(url);
  await page.getByLabel("Token").fill(token);
  await page.getByRole("button", { name: "Sign in" }).click();
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
  await page.getByRole("button", { name: "left" }).click();
  await page.locator(".deviation td").first().waitFor({ timeout: 30_000 });
  assert.deepEqual(await violations(page), []);
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
