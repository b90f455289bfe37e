// How the replicates of a recording ended.
import type { MissingDevice, ReplicateNote } from "../../api/schema";

const states: Record<ReplicateNote["state"], string> = { replicate_state_unspecified: "", open: "open", complete: "complete", interrupted: "interrupted" };

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
  return notes.filter((one) => one.state !== "complete" || one.missing.length > 0).map((one) => {
    const state = one.state === "complete" ? [] : [one.reason ? `${states[one.state]}: ${one.reason}` : states[one.state]];
    return `replicate ${one.replicate}: ${[...state, ...one.missing.map(lacks)].filter(Boolean).join("; ")}`;
  });
}
