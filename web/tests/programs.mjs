// The programs and the browser that the tests use. What a test starts ends with it.
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const imunoise = process.env.IMUNOISE;
const screenshots = fileURLToPath(new URL("screenshots/", import.meta.url));
const axe = readFileSync(fileURLToPath(import.meta.resolve("axe-core/axe.min.js")), "utf8");
mkdirSync(screenshots, { recursive: true });

// Removed at the very end, when every program that writes there has ended.
export function folder() {
  const path = mkdtempSync(join(tmpdir(), "imunoise_page_"));
  process.on("exit", () => rmSync(path, { recursive: true, force: true }));
  return path;
}

export const simulate = (where, ...options) => execFileSync(imunoise, ["simulate", ...options], { cwd: where });

// Resolves with the first match in what a program prints.
function started(test, program, words, pattern, cwd) {
  const child = spawn(program, words, { cwd });
  const ended = new Promise((go) => child.once("exit", go));
  test.after(() => {
    child.kill("SIGTERM");
    return ended;
  });
  return new Promise((go, fail) => {
    let text = "";
    const hear = (bytes) => {
      text += bytes;
      const found = pattern.exec(text);
      if (found) go({ child, found: found[0] });
    };
    child.stdout.on("data", hear);
    child.stderr.on("data", hear);
    child.on("exit", () => fail(new Error(`${program} ended: ${text}`)));
  });
}

/** `imunoise open`: the address that it prints, and the process. */
export async function open(test, where, ...words) {
  const { child, found } = await started(test, imunoise, ["open", "--no-browser", "--studies", join(where, "studies"), ...words], /http:\S+/, where);
  return { child, url: found };
}

/** Holds a program and those that it runs, or lets them go on. */
export function hold(pid, signal = "SIGSTOP") {
  process.kill(pid, signal);
  const tasks = readdirSync(`/proc/${pid}/task`);
  const children = tasks.flatMap((task) => readFileSync(`/proc/${pid}/task/${task}/children`, "utf8").split(" ").filter(Boolean).map(Number));
  for (const one of children) process.kill(one, signal);
}

export const operator = "o".repeat(32);
export const viewer = "v".repeat(32);

/** Puts a campaign where serve() looks for it. */
export function file(where, name, campaign) {
  mkdirSync(join(where, "campaigns"), { recursive: true });
  writeFileSync(join(where, "campaigns", `${name}.toml`), campaign);
}

/** `imunoised` with emulated sensors. */
export async function serve(test, where, campaign, port) {
  file(where, "array", campaign);
  writeFileSync(join(where, "tokens"), `operator ${operator}\nviewer ${viewer}\n`, { mode: 0o600 });
  const words = ["--listen", `127.0.0.1:${port}`, "--tokens", "tokens", "--studies", "studies", "campaigns"];
  const { child } = await started(test, join(dirname(imunoise), "imunoised"), words, /answers on 127.0.0.1\S+ port \d+/, where);
  return { child, url: `http://127.0.0.1:${port}/` };
}

export async function signIn(page, url, token) {
  await page.goto(url);
  await page.getByLabel("Token").fill(token);
  await page.getByRole("button", { name: "Sign in" }).click();
}

/** A page that fails the test when its scripts do. */
export async function browse(test, viewport = { width: 1366, height: 768 }) {
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
  test.after(() => browser.close());
  const page = await (await browser.newContext({ viewport })).newPage();
  const problems = [];
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => { if (/Content.Security.Policy/.test(message.text())) problems.push(message.text()); });
  return { page, problems };
}

/** In light and in dark. The light ones are those of the guides, where IMUNOISE_PICTURES names their folder. */
export async function picture(page, name) {
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    await page.waitForTimeout(100); // what is on a canvas is drawn again
    await page.screenshot({ path: `${screenshots}${name}_${colorScheme}.png` });
  }
  const guide = process.env.IMUNOISE_PICTURES;
  if (guide && existsSync(join(guide, `${name}.png`))) copyFileSync(`${screenshots}${name}_light.png`, join(guide, `${name}.png`));
}

/** What axe finds wrong in light and in dark, a line each. The script runs beside the page's policy, not by it. */
export async function violations(page) {
  const client = await page.context().newCDPSession(page);
  await client.send("Runtime.evaluate", { expression: axe });
  const found = [];
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    found.push(...(await violationsNow(client)).map((one) => `${colorScheme}: ${one}`));
  }
  await client.detach();
  return found;
}

async function violationsNow(client) {
  const { result } = await client.send("Runtime.evaluate", {
    expression: "axe.run().then((found) => JSON.stringify(found.violations.map((one) => one.id + ': ' + one.nodes.map((node) => node.html.slice(0, 120) + ' ' + (node.any[0]?.message ?? '')).join('; '))))",
    awaitPromise: true,
    returnByValue: true,
  });
  return JSON.parse(result.value);
}
