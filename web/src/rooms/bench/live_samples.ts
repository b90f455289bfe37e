// The latest samples of a device, asked for again and again while the page is seen.
import { useEffect, useState } from "preact/hooks";
import { get } from "../../api/client";
import { extend, rangeSize, type Window } from "../../trace/ranges";

const kMost = 1000; // ranges on the screen
const kPause = 500; // ms

export interface Asked {
  readonly campaign: string;
  readonly device: string;
  readonly stream: string;
  readonly rate: number; // Hz
  readonly span: number; // s
  readonly still: boolean; // nothing new is asked for
}

export function useLiveSamples(asked: Asked): { window: Window | null; problem: string } {
  const [window, show] = useState<Window | null>(null);
  const [problem, tell] = useState("");
  const { campaign, device, stream, span, rate, still } = asked;
  const each = rangeSize(span, rate, kMost);
  useEffect(() => {
    if (still) return;
    let over = false;
    let timer = 0;
    let now: Window | null = null;
    const ask = async (): Promise<void> => {
      if (document.visibilityState === "visible") {
        try {
          const news = await get("/v1/live/samples", {}, { campaign, device, stream, samples_each: each, from: now?.next ?? 0 });
          if (over) return;
          // A new replicate counts from zero: what was asked for is not there yet.
          const anew = now !== null && (news.replicate !== now.replicate || Number(news.next) < now.next);
          now = anew ? null : extend(now, news, kMost);
          show(now);
          tell("");
        } catch (error) {
          if (over) return;
          tell((error as Error).message);
        }
      }
      // A range of many samples takes its time.
      const pause = Math.min(10_000, Math.max(kPause, (250 * each) / Math.max(1, rate)));
      if (!over) timer = setTimeout(() => void ask(), pause);
    };
    void ask();
    return () => { over = true; clearTimeout(timer); };
  }, [campaign, device, stream, each, still]);
  return { window, problem };
}
