// How far the model is from the data in each view: before, now, with a preview, and the floor.
import type { Rung, Study } from "../../api/schema";
import { number } from "../../parts/numbers";
import { currentRung } from "./model";

interface Row {
  readonly name: string;
  readonly unit: string;
  readonly before: number | undefined;
  readonly now: number | undefined;
  readonly then: number | undefined;
  readonly floor: number | undefined;
  readonly limit: number; // a true model seldom exceeds it
  readonly sentence: string;
}

const titles: Record<string, string> = {
  averaging_times: "averaging times", spectrum: "spectrum", single_waves: "single waves", noise_over_time: "noise over time",
  distribution: "distribution", witnesses: "witnesses", replicates: "replicates",
};

function viewRows(first: Rung, now: Rung, next: Rung | undefined): Row[] {
  const of = (rung: Rung | undefined, view: string): number | undefined => rung?.views.find((one) => one.view === view)?.value;
  return now.views.map((one) => ({
    name: titles[one.view] ?? one.view, unit: one.unit === "1" ? "" : one.unit, before: of(first, one.view), now: one.value,
    then: of(next, one.view), floor: one.floor, limit: one.chance_limit, sentence: one.sentence,
  }));
}

// What a study knew before there were views.
function errorRows(first: Rung, now: Rung, next: Rung | undefined): Row[] {
  const row = (name: string, sentence: string, value: (rung: Rung) => number | undefined): Row => ({
    name, unit: "", before: value(first), now: value(now), then: next && value(next), floor: 1, limit: 1, sentence,
  });
  return [
    row("held-out error", "On replicates that the model was not fitted to.", (rung) => rung.heldout_error),
    row("training error", "On the replicates that the model was fitted to.", (rung) => rung.training_error),
  ].filter((one) => one.now !== undefined);
}

const text = (value: number | undefined, unit: string): string =>
  value === undefined ? "–" : `${number(value, value < 10 ? 2 : 3)}${unit && ` ${unit}`}`;

// What is beyond chance, as part of what was there at first.
const share = (value: number | undefined, row: Row): number => {
  const floor = row.floor ?? 0;
  const most = Math.max(row.before ?? 0, row.now ?? 0) - floor;
  return value === undefined || value <= row.limit ? 0 : Math.min(1, (value - floor) / most);
};

function Bar({ row }: { row: Row }) {
  const then = row.then === undefined ? null : share(row.then, row);
  return (
    <span class="meter" aria-hidden="true">
      <span class="meter-now" style={{ transform: `scaleX(${share(row.now, row)})` }} />
      {then !== null && <span class="meter-then" style={{ transform: `scaleX(${then})` }} />}
    </span>
  );
}

export function ErrorPanel({ study, preview }: { study: Study; preview: string }) {
  const first = study.attempts[0]?.rung;
  const now = currentRung(study);
  if (!first || !now) return null;
  const next = preview ? study.diagnosis?.candidates.find((one) => one.term === preview)?.next : undefined;
  const rows = now.views.length > 0 ? viewRows(first, now, next) : errorRows(first, now, next);
  return (
    <section class="errors" aria-labelledby="errors-title">
      <h2 id="errors-title">Error</h2>
      <table>
        <thead>
          <tr><th scope="col"><span class="visually-hidden">view</span></th><th scope="col">before</th><th scope="col">now</th>
            {next && <th scope="col" class="then">preview</th>}<th scope="col">floor</th><th scope="col"><span class="visually-hidden">bar</span></th></tr>
        </thead>
        <tbody>
          {rows.map((row) => (
            <tr key={row.name} title={row.sentence}>
              <th scope="row">{row.name}</th>
              <td>{text(row.before, row.unit)}</td>
              <td class="now">{text(row.now, row.unit)}</td>
              {next && <td class="then">{text(row.then, row.unit)}</td>}
              <td class="soft">{text(row.floor, row.unit)}</td>
              <td><Bar row={row} /></td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}
