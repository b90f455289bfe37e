// How the replicates of a recording ended.
import type { MissingDevice, ReplicateNote } from "../../api/schema";

// "imu0 is missing (the port disappeared)"
const lacks = (one: MissingDevice): string => `${one.device} ${Number(one.joined_ns) > 0 ? "came late" : "is missing"} (${one.reason})`;

/** "2 of 3 replicates are complete" */
export function summary(notes: readonly ReplicateNote[]): string {
  const complete = notes.filter((one) => one.state === "complete").length;
  if (notes.length === 1) return complete ? "its replicate is complete" : "its replicate is not complete";
  return complete === notes.length ? `all ${complete} replicates are complete` : `${complete} of ${notes.length} replicates ${complete === 1 ? "is" : "are"} complete`;
}

/** "replicate 1: interrupted: the disk reserve was reached; imu0 is missing (no port)" of each that was not recorded as planned. */
export function shortfalls(notes: readonly ReplicateNote[]): string[] {
  return notes.filter((one) => one.state === "interrupted" || one.missing.length > 0).map((one) => {
    const ended = one.state === "interrupted" ? [one.reason ? `interrupted: ${one.reason}` : "interrupted"] : [];
    return `replicate ${one.replicate}: ${[...ended, ...one.missing.map(lacks)].join("; ")}`;
  });
}
