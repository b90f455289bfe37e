import { expect, test } from "vitest";
import type { CataloguedRecording, LiveDevice, LiveReplicate } from "../../api/schema";
import { deviceRows, deviceState, liveOf, minute } from "./device_rows";

const recording = (bench: string, started_ns: string, calibrated: boolean, ...ids: string[]): CataloguedRecording => ({
  bench, folder: "f", campaign: bench, started_ns, closed: true, replicates: 1, samples: "1", bytes: "1", calibrated, trouble: "",
  devices: ids.map((id) => ({ id, name: `${id} in ${bench}`, driver: "d", serial: "s" })),
});

test("a device has one row, named as in its newest recording", () => {
  const rows = deviceRows([recording("old", "1000000", true, "d:2", "d:1"), recording("new", "2000000", false, "d:1")]);
  expect(rows).toEqual([
    { id: "d:1", name: "d:1 in new", campaign: "new", recordings: 2, calibrated: 1, newest: 2 },
    { id: "d:2", name: "d:2 in old", campaign: "old", recordings: 1, calibrated: 1, newest: 1 },
  ]);
});

test("a device is live only in its own campaign", () => {
  const [row] = deviceRows([recording("a", "1", false, "d:1")]);
  const here = { device: "d:1 in a" } as LiveDevice;
  const replicate = { devices: [here] } as unknown as LiveReplicate;
  expect(row && liveOf(row, new Map([["a", replicate]]))).toBe(here);
  expect(row && liveOf(row, new Map([["b", replicate]]))).toBeUndefined();
});

test("a failing disk is told before a warning", () => {
  const warnings = [{ sentence: "gyro_x: stuck" }];
  expect(deviceState({ disk_trouble: "the disk is full", warnings } as unknown as LiveDevice)).toEqual({ words: "the disk is full", alarm: true });
  expect(deviceState({ disk_trouble: "", warnings } as unknown as LiveDevice)).toEqual({ words: "gyro_x: stuck", alarm: true });
  expect(deviceState({ disk_trouble: "", warnings: [] } as unknown as LiveDevice)).toEqual({ words: "recording", alarm: false });
  expect(deviceState(undefined).alarm).toBe(false);
});

test("times are minutes of UTC, and an unknown one is a dash", () => {
  expect(minute(Date.UTC(2026, 2, 1, 6, 0, 59))).toBe("2026-03-01 06:00");
  expect(minute(0)).toBe("–");
});
