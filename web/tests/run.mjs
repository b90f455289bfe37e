// IMUNOISE=build/dev/imunoise node run.mjs: all browser tests. Status 77: skipped, and why.
import { spawnSync } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { fileURLToPath } from "node:url";

const folder = fileURLToPath(new URL(".", import.meta.url));
const skip = (why) => { console.log(`SKIPPED: ${why}`); process.exit(77); };

if (!existsSync("/usr/bin/chromium")) skip("the browser tests need Chromium: apt-get install chromium");
if (!existsSync(`${folder}../node_modules/playwright-core`)) skip("the browser tests need the page's tools: run npm ci in web/");
if (!process.env.IMUNOISE) skip("set IMUNOISE to the program, such as build/dev/imunoise");

const tests = readdirSync(folder).filter((name) => name.endsWith(".test.mjs")).map((name) => folder + name);
process.exit(spawnSync(process.execPath, ["--test", "--test-concurrency=1", ...tests], { stdio: "inherit" }).status ?? 1);
