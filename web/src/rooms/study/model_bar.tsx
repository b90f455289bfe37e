// The model's terms with their values; terms by hand, under the names that people know.
import { useState } from "preact/hooks";
import type { Coefficient, FittedEffect, Rung, Term } from "../../api/schema";
import { focus } from "../../parts/focus";
import { withUnit } from "../../parts/numbers";
import { brief, split, without } from "./model";
import type { StudyStore } from "./study_store";

const byHand = [
  { term: "WN", words: "white noise (angle random walk N)" },
  { term: "QN", words: "quantisation noise (Q)" },
  { term: "AR1", words: "first-order correlated noise (Gauss–Markov)" },
  { term: "RW", words: "random walk (rate random walk K)" },
  { term: "DR", words: "rate ramp (R)" },
  { term: "flicker", words: "flicker noise (bias instability B)" },
  { term: "RES", words: "resonance" },
  { term: "ramp", words: "linear trend in time" },
  { term: "warm_up(tau=600)", words: "warm-up, time constant tau in s" },
  { term: "line(f=50)", words: "sine wave, frequency f in Hz" },
  { term: "outliers(above=6)", words: "outliers" },
];

function value(coefficient: Coefficient, datasheet: boolean): string {
  const sheet = datasheet && coefficient.datasheet_unit !== "";
  if (coefficient.value === 0) return `${coefficient.symbol} not seen`;
  return `${coefficient.symbol} ${sheet ? withUnit(coefficient.datasheet_value, coefficient.datasheet_unit) : withUnit(coefficient.value, coefficient.unit)}`;
}

// The size of an effect: the first number that its term does not name.
function size(effect: FittedEffect | undefined): string {
  const one = effect?.parameters.find((parameter) => /amplitude|coefficient|height|sigma|power/.test(parameter.name));
  return one ? `${one.name.replaceAll("_", " ")} ${withUnit(one.value, one.unit)}` : "";
}

function Chip({ text, term, effect, datasheet, still, onRemove }: {
  text: string; term: Term | undefined; effect: FittedEffect | undefined; datasheet: boolean; still: boolean; onRemove: (() => void) | null;
}) {
  return (
    <li class="chip" title={term?.meaning ?? ""}>
      <span class="chip-name">{brief(text)}</span>
      {term && <span class="chip-value">{term.coefficients.map((one) => value(one, datasheet)).join(", ") || term.title}</span>}
      {effect && <span class="chip-value">{size(effect)}</span>}
      {onRemove && <button type="button" disabled={still} aria-label={`remove ${text}`} onClick={onRemove}>×</button>}
    </li>
  );
}

function AddTerm({ store, still }: { store: StudyStore; still: boolean }) {
  const [open, show] = useState(false);
  const [term, type] = useState("");
  const [used, use] = useState(false); // the button takes the focus back
  const add = (event: Event): void => {
    event.preventDefault();
    void store.add(term.trim()).then((done) => {
      if (!done) return; // what is wrong with it can be mended
      show(false);
      type("");
    });
  };
  const cancel = (): void => {
    show(false);
    store.preview.value = "";
  };
  if (!open) return <button type="button" ref={used ? focus : null} disabled={still} onClick={() => { use(true); show(true); }}>+ add a term</button>;
  return (
    <form class="inline" onSubmit={add} onKeyDown={(event) => { if (event.key === "Escape") cancel(); }}>
      <label>term <input ref={focus} value={term} list="terms" required placeholder="line(f=7.12)" onInput={(event) => type(event.currentTarget.value)} /></label>
      <datalist id="terms">{byHand.map((one) => <option key={one.term} value={one.term}>{one.words}</option>)}</datalist>
      <button type="button" disabled={still || !term.trim()} onClick={() => void store.foresee(term.trim())}>Preview</button>
      <button type="submit" class="main" disabled={still}>Add</button>
      <button type="button" onClick={cancel}>Cancel</button>
    </form>
  );
}

export function ModelBar({ store, rung, datasheet, still }: { store: StudyStore; rung: Rung; datasheet: boolean; still: boolean }) {
  const texts = split(rung.model);
  // "2*AR1" is one text, and two terms.
  const terms = rung.picture?.terms ?? [];
  let next = 0;
  const chips = texts.flatMap((text, place) => {
    const count = Number(/^(\d+)\*/.exec(text)?.[1] ?? 1);
    const name = text.replace(/^\d+\*/, "");
    return Array.from({ length: count }, (_, k) => {
      const term = terms[next] && name.startsWith(terms[next]?.name ?? "") ? terms[next++] : undefined;
      const remove = texts.length > 1 || count > 1 ? () => void store.tryModel(without(rung.model, place)) : null;
      return <Chip key={`${text} ${k}`} text={name} term={term} effect={rung.effects.find((one) => one.term === name)} datasheet={datasheet} still={still} onRemove={remove} />;
    });
  });
  return (
    <section class="model" aria-label="Model">
      <h2>Model</h2>
      <ul>{chips}</ul>
      <AddTerm store={store} still={still} />
    </section>
  );
}
