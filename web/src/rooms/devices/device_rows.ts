// Recordings, turned into one row a device.
import type { CataloguedRecording, LiveDevice, LiveReplicate } from "../../api/schema";

export interface DeviceRow {
  readonly id: string; // driver:serial
  readonly name: string; // in its newest recording
  readonly campaign: string; // of its newest recording
  readonly recordings: number;
  readonly calibrated: number; // recordings with a calibration
  readonly newest: number; // ms since 1970-01-01 UTC; 0: unknown
}

const milliseconds = (nanoseconds: string): number => Number(nanoseconds) / 1e6;

/** By identity. `recordings` are oldest first. */
export function deviceRows(recordings: readonly CataloguedRecording[]): DeviceRow[] {
  const rows = new Map<string, DeviceRow>();
  for (const one of recordings) {
    for (const device of one.devices) {
      const before = rows.get(device.id);
      rows.set(device.id, {
        id: device.id,
        name: device.name,
        campaign: one.bench,
        recordings: (before?.recordings ?? 0) + 1,
        calibrated: (before?.calibrated ?? 0) + (one.calibrated ? 1 : 0),
        newest: milliseconds(one.started_ns),
      });
    }
  }
  return [...rows.values()].sort((a, b) => a.id.localeCompare(b.id));
}

/** Those of one device, newest first. */
export const recordingsOf = (recordings: readonly CataloguedRecording[], device: string): CataloguedRecording[] =>
  recordings.filter((one) => one.devices.some((each) => each.id === device)).reverse();

/** The device while its campaign records it. */
export function liveOf(row: DeviceRow, live: ReadonlyMap<string, LiveReplicate>): LiveDevice | undefined {
  return live.get(row.campaign)?.devices.find((one) => one.device === row.name);
}

/** What a device does now, in a few words; `alarm` where it needs a look. */
export function deviceState(now: LiveDevice | undefined): { words: string; alarm: boolean } {
  if (!now) return { words: "not recorded now", alarm: false };
  if (now.disk_trouble) return { words: now.disk_trouble, alarm: true };
  if (now.warnings[0]) return { words: now.warnings[0].sentence, alarm: true };
  return { words: "recording", alarm: false };
}

/** "2026-03-01 06:00" in UTC. */
export const minute = (time: number): string => (time > 0 ? new Date(time).toISOString().slice(0, 16).replace("T", " ") : "–");
