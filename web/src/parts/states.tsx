// What stands where there is nothing to show yet, or no more.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import { post } from "../api/client";
import type { Job } from "../api/schema";

export const Empty = ({ title, sentence, children }: { title: string; sentence: string; children?: ComponentChildren }) => (
  <section class="empty">
    <h1>{title}</h1>
    <p>{sentence}</p>
    {children}
  </section>
);

export const Skeleton = ({ lines }: { lines: number }) => (
  <div class="skeleton" role="status" aria-label="loading">
    {Array.from({ length: lines }, (_, line) => <span key={line} />)}
  </div>
);

/** A room whose data have not arrived yet. */
export const Loading = () => (
  <>
    <h1 class="visually-hidden">Loading</h1>
    <Skeleton lines={8} />
  </>
);

const words: Record<string, string> = {
  open: "Fitting the first model", candidates: "Seeking what is missing", preview: "Previewing", add: "Adding the term",
  undo: "Going back", redo: "Going forward", try: "Trying the model", branch: "Copying the study",
};

export function Progress({ job }: { job: Job }) {
  const [asked, ask] = useState(false);
  const left = job.left_s === undefined || job.left_s < 1 ? "" : `, ${Math.ceil(job.left_s)} s left`;
  return (
    <div class="job" role="status">
      <span>{words[job.operation] ?? job.operation}{job.state === "queued" ? " (waits)" : left}</span>
      <progress max={1} value={job.progress} aria-label={words[job.operation] ?? job.operation} />
      <button type="button" disabled={asked}
        onClick={() => { ask(true); void post("/v1/jobs/{job}/cancel", { job: job.job }).catch(() => ask(false)); }}>
        Cancel
      </button>
    </div>
  );
}

/** What follows the first line points at a place in what was asked. */
export function Trouble({ sentence, onClose }: { sentence: string; onClose: () => void }) {
  const [said, ...place] = sentence.split("\n");
  return (
    <div class="trouble" role="alert">
      <span>{said}{place.length > 0 && <pre class="mono">{place.join("\n")}</pre>}</span>
      <button type="button" onClick={onClose}>Close</button>
    </div>
  );
}
