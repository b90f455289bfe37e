// node types.mjs OPENAPI.json: writes its messages as TypeScript types, src/api/schema.ts.
import { readFileSync, writeFileSync } from "node:fs";

const folder = new URL(".", import.meta.url);
const document = JSON.parse(readFileSync(process.argv[2], "utf8"));

const named = (name) => name.replaceAll(".", "");

function type(schema) {
  if (schema.$ref) return named(schema.$ref.split("/").at(-1));
  if (schema.allOf) return type(schema.allOf[0]);
  if (schema.enum) return schema.enum.map((word) => JSON.stringify(word)).join(" | ");
  if (schema.type === "array") return `readonly (${type(schema.items)})[]`;
  if (schema.additionalProperties) return `Readonly<Record<string, ${type(schema.additionalProperties)}>>`;
  if (schema.type === "object") return object(schema);
  return { integer: "number", number: "number", boolean: "boolean" }[schema.type] ?? "string";
}

function object(schema) {
  const required = new Set(schema.required ?? []);
  const fields = Object.entries(schema.properties ?? {}).map(
    ([name, field]) => `  readonly ${name}${required.has(name) ? "" : "?"}: ${type(field)};`);
  return `{\n${fields.join("\n")}\n}`;
}

const messages = Object.entries(document.components.schemas).map(
  ([name, schema]) => `export type ${named(name)} = ${object(schema)};`);

const requests = [];
for (const [path, verbs] of Object.entries(document.paths)) {
  for (const [verb, method] of Object.entries(verbs)) {
    if (verb !== "post") continue;
    const body = method.requestBody.content["application/json"].schema;
    const reply = method.responses["200"].content["application/json"].schema;
    requests.push(`  ${JSON.stringify(path)}: { body: ${type(body)}; reply: ${type(reply)} };`);
  }
}

const gets = [];
for (const [path, verbs] of Object.entries(document.paths)) {
  const content = verbs.get?.responses["200"].content["application/json"];
  if (content?.schema.$ref) gets.push(`  ${JSON.stringify(path)}: ${type(content.schema)};`);
}

writeFileSync(new URL("src/api/schema.ts", folder), [
  "// Made by types.mjs.",
  ...messages,
  `export interface Gets {\n${gets.join("\n")}\n}`,
  `export interface Posts {\n${requests.join("\n")}\n}`,
  "",
].join("\n\n"));
