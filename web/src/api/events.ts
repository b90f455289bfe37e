// One stream of events for all tabs. The tab that holds the lock reads it and passes it on; when that tab
// closes, the next one gets the lock. EventSource is not used: browsers allow six connections a host.
import type { Event } from "./schema";

export type News = Event | { readonly connected: boolean } | { readonly stranger: true };

const kRetry = 1500; // ms
const kSilence = 40_000; // ms, after which a stream is given up: the service says something each 15 s
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

// Ends when the stream does, or falls silent. The service may have been started again since the page knew it: then it does not know the page.
async function read(): Promise<News> {
  const silence = new AbortController();
  let patience = 0;
  const hear = (): void => {
    clearTimeout(patience);
    patience = setTimeout(() => silence.abort(), kSilence);
  };
  try {
    hear();
    const response = await fetch("/v1/events", { credentials: "same-origin", signal: silence.signal });
    if (response.status === 401) return { stranger: true };
    if (!response.ok || !response.body) throw new Error(`status ${response.status}`);
    tellAll({ connected: true });
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    for (let text = ""; ;) {
      const { value, done } = await reader.read();
      hear();
      if (done) return { connected: false };
      const { blocks, rest } = split(text + value);
      text = rest;
      for (const block of blocks) {
        const event = parse(block);
        if (event) tellAll(event);
      }
    }
  } finally {
    clearTimeout(patience);
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
      tellAll(await read().catch(() => ({ connected: false })));
      await pause(kRetry);
    }
  });
}
