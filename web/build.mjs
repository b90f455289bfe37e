// node build.mjs OPENAPI.json FOLDER: checks the page's types, and writes it as compressed files. Fails
// beyond 80 kB.
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const most = 80_000; // bytes, compressed
const folder = fileURLToPath(new URL(".", import.meta.url));
const [, , document, out] = process.argv;

for (const words of [[join(folder, "types.mjs"), document], [join(folder, "node_modules/typescript/bin/tsc"), "--noEmit"]])
  execFileSync(process.execPath, words, { cwd: folder, stdio: "inherit" });

const bundled = await build({
  absWorkingDir: folder,
  entryPoints: { app: "src/main.tsx" },
  bundle: true,
  minify: true,
  write: false,
  outdir: out,
  target: "es2022",
  jsx: "automatic",
  jsxImportSource: "preact",
  legalComments: "none",
});
const files = bundled.outputFiles.map((file) => [file.path.split("/").at(-1), file.text]);
for (const name of ["index.html", "icon.svg"]) files.push([name, readFileSync(join(folder, "src", name), "utf8")]);

mkdirSync(out, { recursive: true });
let total = 0;
for (const [name, text] of files) {
  const bytes = gzipSync(text, { level: 9 });
  total += bytes.length;
  writeFileSync(join(out, `${name}.gz`), bytes);
}
console.log(`the page: ${total} bytes compressed, at most ${most}`);
if (total > most) process.exit(1);
