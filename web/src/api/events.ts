// One stream of events for all tabs. The tab that holds the lock reads it and passes it on; when that tab
// closes, the next one gets the lock. EventSource is not used: browsers allow six connections a host.
import type { Event } from "./schema";

export type News = Event | { readonly connected: boolean };

const kRetry = 1500; // ms
const channel = new BroadcastChannel("imunoise-events");
const listeners = new Set<(news: News) => void>();

// The blocks of a text/event-stream, and the beginning of one that is not complete.
export function split(text: string): { blocks: string[]; rest: string } {
  const blocks = text.split("\n\n");
  const rest = blocks.pop() ?? "";
  return { blocks, rest };
}

/** An event's name is that of the field which its data are. */
export function parse(block: string): Event | null {
  const field = (name: string): string =>
    block.split("\n").filter((line) => line.startsWith(`${name}: `)).map((line) => line.slice(name.length + 2)).join("\n");
  const data = field("data");
  return data ? ({ [field("event")]: JSON.parse(data) } as Event) : null;
}

function tell(news: News): void {
  for (const one of listeners) one(news);
}

function tellAll(news: News): void {
  tell(news);
  channel.postMessage(news);
}

async function read(): Promise<void> {
  const response = await fetch("/v1/events", { credentials: "same-origin" });
  if (!response.ok || !response.body) throw new Error(`status ${response.status}`);
  tellAll({ connected: true });
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  for (let text = ""; ;) {
    const { value, done } = await reader.read();
    if (done) return;
    const { blocks, rest } = split(text + value);
    text = rest;
    for (const block of blocks) {
      const event = parse(block);
      if (event) tellAll(event);
    }
  }
}

const pause = (time: number): Promise<void> => new Promise((go) => setTimeout(go, time));

export function watch(listener: (news: News) => void): void {
  const first = listeners.size === 0;
  listeners.add(listener);
  if (!first) return;
  channel.onmessage = (message: MessageEvent<News>) => tell(message.data);
  void navigator.locks.request("imunoise-events", async () => {
    for (;;) {
      await read().catch(() => undefined);
      tellAll({ connected: false });
      await pause(kRetry);
    }
  });
}
