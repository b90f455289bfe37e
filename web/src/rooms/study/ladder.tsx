// Every model on the way to the current one, and what was tried beside it.
import type { IntegratedError, Study } from "../../api/schema";
import { number, withUnit } from "../../parts/numbers";
import { brief, currentRung, errorOf, longestDrift, path, type Step } from "./model";
import type { StudyStore } from "./study_store";

const degrees = 180 / Math.PI;
const inDegrees = (drift: IntegratedError, value: number): string =>
  drift.unit === "rad" ? withUnit(value * degrees, "°") : withUnit(value, drift.unit);

function name(step: Step): string {
  const rung = step.attempt.rung;
  if (!rung?.added) return step.index === 0 ? "start" : rung?.model ?? "";
  return `+ ${brief(rung.added)}`;
}

// On a logarithmic scale from the floor to the worst: errors fall by factors.
const height = (error: number | undefined, worst: number): number =>
  error === undefined || worst <= 1 ? 0.05 : Math.max(0.05, Math.min(1, Math.log(Math.max(1, error)) / Math.log(worst)));

export function Ladder({ study, store, still }: { study: Study; store: StudyStore; still: boolean }) {
  const steps = path(study);
  const undone = study.attempts.flatMap((attempt, index) => (attempt.undone && attempt.parent === study.current ? [{ index, attempt }] : []));
  const worst = Math.max(1.01, ...[...steps, ...undone].map((one) => errorOf(one.attempt.rung) ?? 1));
  const drift = longestDrift(currentRung(study));
  // What the first model lacks is known once it was compared with the effects.
  const waiting = study.attempts.length === 1 && !study.diagnosis;
  return (
    <section class="ladder" aria-label="Ladder">
      <h2>Ladder</h2>
      <span class="soft">error, as a multiple of<br />what chance alone leaves</span>
      <ol>
        {steps.map((step, place) => {
          const error = errorOf(step.attempt.rung);
          const now = step.index === study.current;
          const back = steps.length - 1 - place;
          return (
            <li key={step.index}>
              <button type="button" class="step" aria-current={now ? "step" : undefined} disabled={now || still}
                title={`${step.attempt.rung?.model ?? ""}\n${step.attempt.rung?.why ?? ""}`} onClick={() => void store.back(back)}>
                <span class="step-bar" aria-hidden="true"><span style={{ transform: `scaleY(${height(error, worst)})` }} /></span>
                <span class="step-text"><strong>{waiting ? "…" : number(error, 2)}</strong><span>{name(step)}</span></span>
              </button>
            </li>
          );
        })}
        {undone.map((step) => (
          <li key={step.index} class="undone">
            <span class="step-text"><strong>{number(errorOf(step.attempt.rung), 2)}</strong><span>{name(step)} (undone)</span></span>
          </li>
        ))}
      </ol>
      <span class="fill" />
      {drift && (
        <p class="soft" title="How far the integral of the channel runs off after its bias was averaged for as long">integrated error after {number(drift.seconds)} s: <strong>{inDegrees(drift, drift.measured)}</strong> measured, {inDegrees(drift, drift.predicted)} by the model</p>
      )}
    </section>
  );
}
