import { expect, test } from "vitest";
import type { ReplicateNote } from "../../api/schema";
import { shortfalls, summary } from "./replicate_words";

const note = (replicate: number, state: ReplicateNote["state"], more: Partial<ReplicateNote> = {}): ReplicateNote => ({
  replicate, state, started_ns: "0", ended_ns: "0", reason: "", missing: [], disturbances: [], clocks: [], streams: [], settled: true, boot_id: "", started_since_boot_ns: "0", clock_steps: [], ...more,
});

test("a recording with interrupted replicates is not called complete", () => {
  const notes = [note(1, "interrupted", { reason: "it was away for a while" }), note(2, "complete")];
  expect(summary(notes)).toBe("1 of 2 replicates is complete");
  expect(summary([note(1, "complete"), note(2, "complete")])).toBe("all 2 replicates are complete");
  expect(summary([note(1, "open")])).toBe("its replicate is not complete");
  expect(shortfalls(notes)).toEqual(["replicate 1: interrupted: it was away for a while"]);
  expect(shortfalls([note(2, "open")])).toEqual([]);
});

test("a device that is missing is named, in complete replicates, too", () => {
  const notes = [note(3, "complete", { missing: [{ device: "imu0", reason: "the port disappeared", joined_ns: "0" }] })];
  expect(shortfalls(notes)).toEqual(["replicate 3: imu0 is missing (the port disappeared)"]);
});
