// Requests to the service. A refusal's sentence is what people read.
import type { Gets, Job, Posts } from "./schema";

export class Refused extends Error {
  constructor(readonly status: number, sentence: string) {
    super(sentence);
  }
}

export type Fields = Readonly<Record<string, string | number | boolean | undefined>>;

// "/v1/studies/{study}/add" with its fields put in.
const place = (path: string, fields: Fields): string =>
  path.replace(/\{(\w+)\}/g, (_, name: string) => String(fields[name]).split("/").map(encodeURIComponent).join("/"));

async function send(path: string, how: RequestInit = {}): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, { credentials: "same-origin", ...how });
  } catch {
    throw new Refused(0, "imunoise does not answer. Start it again; this page goes on by itself.");
  }
  if (response.ok) return response;
  const body = (await response.json().catch(() => ({}))) as { error?: string };
  throw new Refused(response.status, body.error ?? `imunoise answered with status ${response.status}.`);
}

const query = (fields: Fields): string => {
  const known = Object.entries(fields).filter(([, value]) => value !== undefined && value !== "");
  return known.length ? "?" + new URLSearchParams(known.map(([name, value]) => [name, String(value)])) : "";
};

export const get = async <Path extends keyof Gets>(path: Path, fields: Fields = {}, asked: Fields = {}): Promise<Gets[Path]> =>
  (await send(place(path, fields) + query(asked))).json() as Promise<Gets[Path]>;

export const getText = async (path: string, fields: Fields, asked: Fields, signal?: AbortSignal): Promise<string> =>
  (await send(place(path, fields) + query(asked), signal ? { signal } : {})).text();

export const post = async <Path extends keyof Posts>(
  path: Path, fields: Fields, body: Posts[Path]["body"] = {} as Posts[Path]["body"],
): Promise<Posts[Path]["reply"]> =>
  (await send(place(path, fields), {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  })).json() as Promise<Posts[Path]["reply"]>;

export const over = (job: Job): boolean => job.state === "done" || job.state === "failed" || job.state === "cancelled";
