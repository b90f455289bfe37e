// A model's text and a study's attempts, as the room needs them.
import type { EffectCandidate, IntegratedError, Rung, Study, StudyAttempt } from "../../api/schema";

/** "WN + RW + line(f=7)": its terms. A + within brackets separates nothing. */
export function split(model: string): string[] {
  const out: string[] = [];
  let depth = 0;
  let term = "";
  for (const letter of model) {
    if (letter === "(" || letter === "[") ++depth;
    if (letter === ")" || letter === "]") --depth;
    if (letter === "+" && depth === 0) {
      out.push(term.trim());
      term = "";
    } else term += letter;
  }
  return [...out, term.trim()].filter(Boolean);
}

/** A term with its numbers to four digits: "line(f=19.9)". */
export const brief = (term: string): string =>
  term.replace(/\d+\.\d+(e[-+]?\d+)?/g, (text) => String(Number(Number(text).toPrecision(4))));

/** The model without one of its terms. "2*AR1" loses one of the two. */
export function without(model: string, place: number): string {
  return split(model).flatMap((term, i) => {
    if (i !== place) return [term];
    const [, count, name] = /^(\d+)\*(.*)$/.exec(term) ?? [];
    if (!count || !name) return [];
    return [Number(count) > 2 ? `${Number(count) - 1}*${name}` : name];
  }).join(" + ");
}

export interface Step {
  readonly index: number;
  readonly attempt: StudyAttempt;
}

/** From the first model to the current one. */
export function path(study: Study): Step[] {
  const out: Step[] = [];
  for (let index: number | undefined = study.current; index !== undefined;) {
    const attempt: StudyAttempt | undefined = study.attempts[index];
    if (!attempt) break;
    out.unshift({ index, attempt });
    index = attempt.parent;
  }
  return out;
}

export const currentRung = (study: Study): Rung | undefined => study.attempts[study.current]?.rung;

export const mayRedo = (study: Study): boolean =>
  study.attempts.some((one) => one.undone && one.parent === study.current);

/** What a step of the ladder is measured by: 1 is the floor. */
export const errorOf = (rung: Rung | undefined): number | undefined =>
  rung?.unexplained ?? rung?.heldout_error ?? rung?.training_error;

export interface VerdictWords {
  readonly mood: "good" | "alarm" | "doubt" | "plain";
  readonly sign: string;
  readonly words: string;
}

export function verdict(study: Study): VerdictWords {
  const found = study.diagnosis;
  const best = found?.candidates.find(beyondChance);
  const name = best ? withNumber(best) : "";
  switch (found?.verdict) {
    case "found": return { mood: "alarm", sign: "✗", words: `something is missing: ${name}` };
    case "one_of": return { mood: "doubt", sign: "?", words: `something is missing: ${name}, or a rival` };
    case "unknown": return { mood: "alarm", sign: "✗", words: best ? `something is missing; best guess: ${name}` : "something is missing that no known effect explains" };
    case "several": return { mood: "alarm", sign: "✗", words: `something is missing: ${name}, and more` };
    case "none": return { mood: "good", sign: "✓", words: "nothing is missing that these data could show" };
    default: return { mood: "plain", sign: "", words: "not yet compared with the known effects" };
  }
}

/** "resonance at 19.9 Hz" */
export function withNumber(candidate: EffectCandidate): string {
  const frequency = candidate.parameters.find((one) => one.name === "frequency_hz");
  return frequency ? `${candidate.title} at ${Number(frequency.value.toPrecision(4))} Hz` : candidate.title;
}

/** Whether noise alone makes a search look this good less often than once in twenty. Others are not listed. */
export const beyondChance = (candidate: EffectCandidate): boolean => candidate.familywise_p < 0.05;

export interface Surety {
  readonly words: string;
  readonly mood: "good" | "doubt" | "plain";
}

/** What it gains on replicates that it was not fitted to, where both were asked, else on those that it was fitted to. */
const gains = (one: EffectCandidate, other: EffectCandidate): [number, number] =>
  one.heldout_gain_nats !== undefined && other.heldout_gain_nats !== undefined
    ? [one.heldout_gain_nats, other.heldout_gain_nats]
    : [one.likelihood_gain_nats, other.likelihood_gain_nats];

/** How sure a candidate is: by its rivals, by how much less it explains than the best one, and by the chance that noise alone looks this good. */
export function surety(candidate: EffectCandidate, best: EffectCandidate | undefined): Surety {
  if (candidate.confused_with.length > 0) return { words: "or a rival", mood: "doubt" };
  const clearly = 5; // nats
  if (best && best !== candidate) {
    const [most, here] = gains(best, candidate);
    if (most > here + clearly) return { words: "explains less", mood: "plain" };
  }
  return { words: candidate.familywise_p < 1e-3 ? "sure" : "likely", mood: "good" };
}

/** How far an integral runs off, over the longest time that the data tell: beyond it, few stretches make the measured value a matter of chance. */
export function longestDrift(rung: Rung | undefined): IntegratedError | undefined {
  const fewest = 10; // stretches
  const told = rung?.drift.filter((one) => one.seconds <= 100 && Number(one.stretches) >= fewest) ?? [];
  return told.at(-1);
}
