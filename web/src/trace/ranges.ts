// Ranges of samples as the service gives them: the latest are appended, the oldest dropped.
import type { SampleRanges } from "../api/schema";
import { rank, shownAs } from "./units";

export interface Trace {
  readonly channel: string;
  readonly unit: string;
  readonly time: readonly number[]; // s since the replicate's first sample
  readonly lower: readonly number[];
  readonly upper: readonly number[];
  readonly gaps: readonly number[]; // places in time
}

export interface Window {
  readonly replicate: number;
  readonly next: number; // number of the range that comes next
  readonly each: number; // samples of a range
  readonly traces: readonly Trace[];
}

const shown = (values: readonly number[], units: string): number[] => {
  const { factor, offset } = shownAs(units);
  return values.map((one) => offset + factor * one);
};

export const tracesOf = (ranges: SampleRanges): Trace[] =>
  [...ranges.channels].sort((a, b) => rank(a.units) - rank(b.units)).map((one) => ({
    channel: one.channel,
    unit: shownAs(one.units).unit,
    time: ranges.time_s,
    lower: shown(one.lower, one.units),
    upper: shown(one.upper, one.units),
    gaps: ranges.gaps,
  }));

/** What is shown once `news` came, which were asked for from `before.next` on: the latest `most` ranges. */
export function extend(before: Window | null, news: SampleRanges, most: number): Window {
  const next = Number(news.next);
  const fresh = { replicate: news.replicate, next, each: news.samples_each, traces: tracesOf(news) };
  const goesOn = before !== null && before.replicate === news.replicate && before.each === news.samples_each &&
    next - news.time_s.length === before.next && before.traces.length === fresh.traces.length;
  if (!goesOn) return fresh;
  const held = before.traces[0]?.time.length ?? 0;
  const drop = Math.max(0, held + news.time_s.length - most);
  const joined = (a: readonly number[], b: readonly number[]): number[] => [...a.slice(drop), ...b];
  return {
    ...fresh,
    traces: fresh.traces.map((one, place) => {
      const old = before.traces[place]!;
      return {
        ...one,
        time: joined(old.time, one.time),
        lower: joined(old.lower, one.lower),
        upper: joined(old.upper, one.upper),
        gaps: [...old.gaps.map((gap) => gap - drop).filter((gap) => gap >= 0), ...one.gaps.map((gap) => gap + held - drop)],
      };
    }),
  };
}

/** Samples of a range so that at most `most` ranges fill this time: 1, 4, 16 … 4096. */
export function rangeSize(seconds: number, rate: number, most: number): number {
  let each = 1;
  while (each < 4096 && seconds * rate > each * most) each *= 4;
  return each;
}

/** The newest value: where a range has many samples, the middle between its least and its greatest. */
export function latestOf(trace: Trace): number | undefined {
  const last = trace.time.length - 1;
  return last < 0 ? undefined : (trace.lower[last]! + trace.upper[last]!) / 2;
}

/** Where nothing is missing between ranges: the first place of each stretch, and that after its last. */
export function stretchesOf(trace: Trace): [number, number][] {
  const { time } = trace;
  const steps = time.slice(1).map((one, k) => one - time[k]!);
  const usual = [...steps].sort((a, b) => a - b)[steps.length >> 1] ?? 0;
  const gaps = new Set(trace.gaps);
  const out: [number, number][] = [];
  let begin = 0;
  for (let k = 1; k <= time.length; ++k) {
    // A range that a gap lies in is longer than others.
    if (k < time.length && !gaps.has(k) && steps[k - 1]! <= 2.5 * usual) continue;
    out.push([begin, k]);
    begin = k;
  }
  return time.length > 0 ? out : [];
}

export interface Extent {
  readonly low: number;
  readonly high: number;
}

/** Least and greatest of a trace from place `begin` on; null where there is none. */
export function extentOf(trace: Trace, begin = 0): Extent | null {
  let [low, high] = [Infinity, -Infinity];
  for (let k = begin; k < trace.time.length; ++k) {
    low = Math.min(low, trace.lower[k]!);
    high = Math.max(high, trace.upper[k]!);
  }
  return low <= high ? { low, high } : null;
}

/** The axis of a trace that changes: it grows at once, shrinks when half of it is empty, and has room where all is one value. */
export function steadyAxis(before: Extent | null, now: Extent): Extent {
  const height = now.high - now.low || Math.max(Math.abs(now.high) * 1e-3, 1e-12);
  const wanted = { low: now.low - 0.1 * height, high: now.high + 0.1 * height };
  if (!before || now.low < before.low || now.high > before.high) return wanted;
  return height < 0.5 * (before.high - before.low) ? wanted : before;
}
