import { expect, test } from "vitest";
import type { SampleRanges } from "../api/schema";
import { extend, extentOf, latestOf, rangeSize, steadyAxis, stretchesOf, tracesOf } from "./ranges";

const news = (from: number, count: number, more: Partial<SampleRanges> = {}): SampleRanges => ({
  stream: "imu", begin_ns: "0", replicate: 1, samples_each: 4, length_s: 0,
  time_s: Array.from({ length: count }, (_, k) => (from + k) * 0.04), gaps: [], next: String(from + count),
  channels: [{ channel: "gyro_x", units: "rad/s", lower: Array.from({ length: count }, (_, k) => -(from + k)), upper: Array.from({ length: count }, (_, k) => from + k) }],
  ...more,
});

test("what came is appended, and the oldest dropped with its gaps", () => {
  const first = extend(null, news(0, 6, { gaps: [1, 5] }), 8);
  const both = extend(first, news(6, 4, { gaps: [2] }), 8);
  expect(both.next).toBe(10);
  const [trace] = both.traces;
  expect(trace?.time.length).toBe(8);
  expect(trace?.time[0]).toBeCloseTo(0.08);
  expect(trace?.gaps).toEqual([3, 6]);
  expect(trace?.upper.at(-1)).toBeCloseTo((9 * 180) / Math.PI);
  expect(trace?.unit).toBe("°/s");
});

test("what does not follow replaces what there was", () => {
  const first = extend(null, news(0, 6), 8);
  expect(extend(first, news(9, 2), 8).traces[0]?.time.length).toBe(2); // ranges between them were lost
  expect(extend(first, news(0, 3, { replicate: 2 }), 8).traces[0]?.time.length).toBe(3);
  expect(extend(first, news(6, 2, { samples_each: 16 }), 8).traces[0]?.time.length).toBe(2);
  expect(extend(first, news(6, 0), 8).traces[0]?.time.length).toBe(6);
});

test("the newest value of a range of many samples is its middle", () => {
  const [trace] = tracesOf(news(0, 6, { channels: [{ channel: "t", units: "K", lower: [1, 2, 3, 4, 5, 6], upper: [2, 3, 4, 5, 6, 8] }] }));
  expect(latestOf(trace!)).toBeCloseTo(7 - 273.15);
  expect(latestOf({ ...trace!, time: [], lower: [], upper: [] })).toBeUndefined();
});

test("nothing is drawn over a gap, even if it lies within a range", () => {
  const [trace] = tracesOf(news(0, 6));
  expect(stretchesOf(trace!)).toEqual([[0, 6]]);
  expect(stretchesOf({ ...trace!, gaps: [2] })).toEqual([[0, 2], [2, 6]]);
  expect(stretchesOf({ ...trace!, time: [0, 0.04, 0.08, 13.8, 13.84, 13.88], gaps: [2] })).toEqual([[0, 2], [2, 3], [3, 6]]);
  expect(stretchesOf({ ...trace!, time: [] })).toEqual([]);
});

test("ranges are as large as the screen needs", () => {
  expect(rangeSize(10, 100, 1000)).toBe(1);
  expect(rangeSize(60, 100, 1000)).toBe(16);
  expect(rangeSize(1e9, 100, 1000)).toBe(4096);
});

test("an axis grows at once, shrinks late, and has room where all is one value", () => {
  const [trace] = tracesOf(news(0, 0));
  expect(extentOf(trace!)).toBeNull();
  const axis = steadyAxis(null, { low: 0, high: 1 });
  expect(axis.high).toBeCloseTo(1.1);
  expect(steadyAxis(axis, { low: 0.1, high: 0.9 })).toBe(axis);
  expect(steadyAxis(axis, { low: 0, high: 2 }).high).toBeCloseTo(2.2);
  expect(steadyAxis(axis, { low: 0.4, high: 0.6 }).high).toBeCloseTo(0.62);
  const flat = steadyAxis(null, { low: 1e-14, high: 1e-14 });
  expect(flat.high).toBeGreaterThan(flat.low);
});
