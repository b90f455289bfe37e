import { expect, test } from "vitest";
import type { FleetParameter } from "../../api/schema";
import { fleetRows, quartiles, titleOf, worstFirst } from "./fleet_rows";

const parameter = (more: Partial<FleetParameter> = {}): FleetParameter => ({
  stream: "imu", channel: "gyro_x", term: "WN", parameter: "N", title: "angle random walk", unit: "rad/s/√Hz",
  datasheet_unit: "°/√h", to_datasheet: 1000, seen: 2, median: 2e-4, lower_quartile: 1e-4, upper_quartile: 3e-4,
  devices: [
    { device: { id: "adis:7", name: "imu", driver: "adis", serial: "7" }, calibrations: 2, robust_z: 4.21, outlier: true,
      newest: { bench: "b", folder: "f", started_ns: "1", value: 2e-4, lower: 1.9e-4, upper: 2.1e-4, model: "WN", compared: false } },
    { device: { id: "imu2", name: "imu2", driver: "adis", serial: "" }, calibrations: 1, outlier: false,
      newest: { bench: "b", folder: "f", started_ns: "1", value: 2e-4, upper: 3e-4, model: "WN", compared: false } },
  ],
  ...more,
});

test("a device is a row: its serial number, its value in data sheets' units, how far it is off", () => {
  const [first, second] = fleetRows(parameter());
  expect(first).toEqual({ id: "adis:7", name: "7", value: "0.2 (0.19 … 0.21)", deviation: "+4.2", outlier: true, calibrations: 2 });
  expect(second?.name).toBe("imu2");
  expect(second?.value).toBe("at most 0.3");
  expect(second?.deviation).toBe("–");
});

test("quartiles are told with their unit, or why there are none", () => {
  expect(quartiles(parameter())).toBe("quartiles 0.1 … 0.3, median 0.2 °/√h, of 2 devices");
  const { median: _, ...without } = parameter();
  expect(quartiles(without)).toMatch(/no quartiles/);
});

test("what stands out comes first", () => {
  const quiet = parameter({ channel: "gyro_y", devices: [] });
  expect(worstFirst([quiet, parameter()]).map((one) => one.channel)).toEqual(["gyro_x", "gyro_y"]);
  expect(titleOf(parameter())).toBe("gyro_x: angle random walk of WN");
  expect(titleOf(parameter({ title: "correlation time of AR1" }))).toBe("gyro_x: correlation time of AR1");
});
