// What may be missing: evidence, rivals, what to record to be sure.
import { useState } from "preact/hooks";
import type { EffectCandidate, Study } from "../../api/schema";
import { number, withUnit } from "../../parts/numbers";
import { beyondChance, currentRung, errorOf, surety, withNumber } from "./model";
import type { StudyStore } from "./study_store";

const percent = (p: number): string => (p < 1e-4 ? "less than 0.01 %" : `${number(100 * p, 2)} %`);

const ended = (sentence: string): string => (/[.!?]$/.test(sentence) ? sentence : `${sentence}.`);

function Falls({ study, candidate }: { study: Study; candidate: EffectCandidate }) {
  const before = errorOf(currentRung(study));
  const after = errorOf(candidate.next) ?? candidate.heldout_error_after;
  if (before === undefined || after === undefined) return null;
  return <span class="falls">error {number(before, 2)} → <strong>{number(after, 2)}</strong></span>;
}

function Details({ candidate }: { candidate: EffectCandidate }) {
  return (
    <div class="details">
      <p>{candidate.cause}</p>
      {candidate.confused_with.length > 0 && <p><b>Or:</b> {candidate.confused_with.map((id) => id.replaceAll("_", " ")).join(", ")}.</p>}
      {candidate.record_next && <p><b>To be sure:</b> {ended(candidate.record_next)}</p>}
      {candidate.parameters.length > 0 && (
        <dl>
          {candidate.parameters.map((one) => (
            <div key={one.name}>
              <dt>{one.name.replace(/_(hz|s)$/, "").replaceAll("_", " ")}</dt>
              <dd>{withUnit(one.value, one.unit)}{one.lower !== undefined && one.upper !== undefined && ` (${number(one.lower)} … ${number(one.upper)})`}</dd>
            </div>
          ))}
        </dl>
      )}
      <p class="soft">explains {number(candidate.likelihood_gain_nats)} nats; noise alone looks this good in {percent(candidate.familywise_p)} of searches</p>
    </div>
  );
}

export function Candidates({ store, study, still }: { store: StudyStore; study: Study; still: boolean }) {
  const nothing = study.diagnosis?.verdict === "none";
  const [shownHere, show] = useState<number | null>(null);
  const open = shownHere ?? (nothing ? -1 : 0);
  const all = (study.diagnosis?.candidates ?? []).filter(beyondChance);
  const preview = store.preview.value;
  if (!study.diagnosis) {
    return store.busy.value || store.working.value ? null : (
      <section class="candidates">
        <h2>What may be missing</h2>
        <p class="soft">This model has not been compared with the known effects.</p>
        <button type="button" class="main" disabled={still} onClick={() => void store.seek()}>Compare</button>
      </section>
    );
  }
  return (
    <section class="candidates" aria-labelledby="candidates-title">
      <h2 id="candidates-title">What may be missing</h2>
      {nothing && <p class="soft">{study.diagnosis.summary}</p>}
      <ol>
        {all.map((one, i) => {
          const sure = surety(one, all[0]);
          const shown = preview !== "" && preview === one.term;
          return (
            <li key={`${one.effect} ${one.term}`} class={shown ? "shown" : ""}>
              <div class="candidate-head">
                <button type="button" class="title" aria-expanded={open === i} onClick={() => show(open === i ? -1 : i)}>{withNumber(one)}</button>
                <span class={`badge ${sure.mood}`}>{sure.words}</span>
              </div>
              <div class="candidate-act">
                <Falls study={study} candidate={one} />
                <span class="fill" />
                {one.term && <>
                  <button type="button" aria-pressed={shown} disabled={still && !one.next} onClick={() => void store.foresee(shown ? "" : one.term)}>Preview</button>
                  <button type="button" class="main" disabled={still} onClick={() => void store.add(one.term)}>Add</button>
                </>}
              </div>
              {open === i && <Details candidate={one} />}
            </li>
          );
        })}
      </ol>
      {all.length === 0 && !nothing && <p class="soft">{study.diagnosis.summary}</p>}
    </section>
  );
}
