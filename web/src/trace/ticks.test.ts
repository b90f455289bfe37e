import { expect, test } from "vitest";
import { tickLabels, ticks, timeLabel, timeTicks } from "./ticks";

test("ticks are round numbers", () => {
  expect(ticks(0, 1, 5)).toEqual([0, 0.2, 0.4, 0.6000000000000001, 0.8, 1]);
  expect(ticks(-3, 7, 3)).toEqual([0, 5]);
  expect(ticks(2, 2, 3)).toEqual([2]);
  expect(ticks(NaN, NaN, 3)).toEqual([]);
});

test("labels tell neighbours apart, however small the numbers are", () => {
  expect(tickLabels([0, 0.2, 0.4])).toEqual(["0.0", "0.2", "0.4"]);
  expect(tickLabels([-5, 0, 5])).toEqual(["−5", "0", "5"]);
  expect(tickLabels([0, 1e-14, 2e-14])).toEqual(["0", "1·10⁻¹⁴", "2·10⁻¹⁴"]);
  expect(tickLabels([9.79, 9.8, 9.81])).toEqual(["9.79", "9.80", "9.81"]);
  expect(tickLabels([0])).toEqual(["0"]);
});

test("times are round as on a clock", () => {
  expect(timeTicks(0, 60, 4)).toEqual({ at: [0, 15, 30, 45, 60], step: 15 });
  expect(timeTicks(3599, 7205, 4)).toEqual({ at: [3600, 5400, 7200], step: 1800 });
  expect(timeTicks(0, 0.01, 4).step).toBeCloseTo(0.005);
  expect(timeLabel(30, 15)).toBe("30 s");
  expect(timeLabel(4500, 900)).toBe("1:15:00");
  expect(timeLabel(150, 30)).toBe("2:30");
  expect(timeLabel(1.25, 0.05)).toBe("1.25 s");
});
