import { expect, test } from "vitest";
import type { HistoryPoint, ParameterHistory } from "../../api/schema";
import { changeText, parameterRow, pointRows, pointText } from "./parameter_rows";

const point = (started_ns: string, value: number, lower?: number, upper?: number): HistoryPoint =>
  ({ bench: "b", folder: "f", started_ns, value, model: "WN", compared: true, ...(lower === undefined ? {} : { lower }), ...(upper === undefined ? {} : { upper }) });
const history: ParameterHistory = {
  stream: "imu", channel: "gyro_x", term: "WN", parameter: "N", title: "angle random walk", unit: "rad/√s", datasheet_unit: "°/√h", to_datasheet: 10,
  points: [point("1000000", 1, 0.9, 1.1), point("2000000", 2, 1.9, 2.1)],
  drift: { earlier: 1, change: 1, p_value: 1e-9, expected_lower: 0.8, expected_upper: 1.2, alarm: true, newest_alarm: true, trend_alarm: false },
};

test("an interval without a lower end is an upper bound", () => {
  expect(pointText(point("0", 2, 1, 3), 10)).toBe("20 (10 … 30)");
  expect(pointText(point("0", 2, 0, 3), 1)).toBe("at most 3");
  expect(pointText(point("0", 2, undefined, 3), 1)).toBe("at most 3");
  expect(pointText(point("0", 2), 1)).toBe("2");
});

test("a change has its sign, and a large one is a factor", () => {
  expect(changeText(0.12)).toBe("+12 %");
  expect(changeText(-0.5)).toBe("−50 %");
  expect(changeText(11)).toBe("12 times");
});

test("a row is in the data sheet's unit, and says the verdict", () => {
  expect(parameterRow(history)).toEqual({
    name: "gyro_x N of WN", unit: "°/√h", newest: "20 (19 … 21)", expected: "8 … 12", change: "+100 %", verdict: "changed",
  });
  const { drift, ...alone } = history;
  expect(parameterRow({ ...history, drift: drift && { ...drift, newest_alarm: false, trend_alarm: true } }).verdict).toBe("drift");
  expect(drift?.alarm).toBe(true);
  expect(parameterRow({ ...alone, datasheet_unit: "" })).toMatchObject({ unit: "rad/√s", newest: "2 (1.9 … 2.1)", expected: "–", verdict: "not compared" });
});

test("the newest calibration is the first row", () => {
  expect(pointRows(history).map((one) => one.started)).toEqual([2, 1]);
});
