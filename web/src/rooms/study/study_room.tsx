// The heart: look at a model, learn what it lacks, add it, watch the error fall, take it back.
import { useEffect, useMemo, useState } from "preact/hooks";
import type { Place } from "../../figure/figure";
import { FigureView } from "../../figure/figure_view";
import { Files } from "../../parts/files";
import { number } from "../../parts/numbers";
import { Loading, Progress, Trouble } from "../../parts/states";
import { go, mayChange } from "../../state";
import { Candidates } from "./candidates";
import { ErrorPanel } from "./error_panel";
import { Export } from "./export";
import { Ladder } from "./ladder";
import { Limits } from "./limits";
import { currentRung, mayRedo, verdict } from "./model";
import { ModelBar } from "./model_bar";
import { StudyStore } from "./study_store";
import { View, views, Views } from "./views";
import { placeSentence } from "./places";

function Branch({ store }: { store: StudyStore }) {
  const [open, show] = useState(false);
  const [name, type] = useState(`${store.name}-2`);
  const copy = async (event: Event): Promise<void> => {
    event.preventDefault();
    if (await store.branch(name)) go("studies", name);
    show(false);
  };
  if (!open) return <button type="button" disabled={!mayChange.value} onClick={() => show(true)}>Branch</button>;
  return (
    <form class="inline" onSubmit={(event) => void copy(event)}>
      <label>copy as <input value={name} pattern="[A-Za-z0-9_\-][A-Za-z0-9_.\-]*" maxLength={64} required
        onInput={(event) => type(event.currentTarget.value)} /></label>
      <button type="submit" class="main">Copy</button>
      <button type="button" onClick={() => show(false)}>Cancel</button>
    </form>
  );
}

export function StudyRoom({ name }: { name: string }) {
  const store = useMemo(() => new StudyStore(name), [name]);
  const [view, look] = useState<View>("averaging_times");
  const [variance, setVariance] = useState(false);
  const [datasheet, setDatasheet] = useState(true);
  const [at, move] = useState<Place | null>(null);
  useEffect(() => { void store.load(); return () => store.close(); }, [store]);
  useEffect(() => {
    const keys = (event: KeyboardEvent): void => {
      if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || event.target instanceof HTMLInputElement) return;
      event.preventDefault();
      if (store.busy.value || !mayChange.value) return;
      void (event.shiftKey ? store.redo() : store.undo());
    };
    addEventListener("keydown", keys);
    return () => removeEventListener("keydown", keys);
  }, [store]);

  const study = store.study.value;
  const rung = study ? currentRung(study) : undefined;
  if (!study || !rung) {
    return store.problem.value
      ? <Trouble sentence={store.problem.value} onClose={() => go("studies")} />
      : <Loading />;
  }
  const judged = verdict(study);
  const still = store.busy.value || !mayChange.value;
  return (
    <div class="study">
      <header class="study-head">
        <h1>{study.channel}</h1>
        <span class="soft">{study.replicates > 0 && `${study.replicates === 1 ? "one replicate" : `${study.replicates} replicates`} · `}{number(study.rate_hz)} Hz</span>
        <strong class={`verdict ${judged.mood}`} role="status"><span aria-hidden="true">{judged.sign}</span> {judged.words}</strong>
        <span class="fill" />
        <button type="button" disabled={still || study.current === 0} onClick={() => void store.undo()} title="Ctrl-Z">Undo</button>
        <button type="button" disabled={still || !mayRedo(study)} onClick={() => void store.redo()} title="Ctrl-Shift-Z">Redo</button>
        <Branch store={store} />
        <Export study={study} name={name} view={view} variance={variance} onProblem={(problem) => { store.problem.value = problem; }} />
      </header>
      <ModelBar store={store} rung={rung} datasheet={datasheet} still={still} />
      {store.problem.value && <Trouble sentence={store.problem.value} onClose={() => { store.problem.value = ""; }} />}
      <section class="picture" aria-label="Model and data">
        <Views current={view} onChoose={look}>
          <label>units <select value={datasheet ? "datasheet" : "si"} onChange={(event) => setDatasheet(event.currentTarget.value === "datasheet")}>
            <option value="datasheet">data sheet</option><option value="si">SI</option>
          </select></label>
          {view === "averaging_times" && (
            <label>as <select value={variance ? "variance" : "allan"} onChange={(event) => setVariance(event.currentTarget.value === "variance")}>
              <option value="allan">Allan deviation</option><option value="variance">wavelet variance</option>
            </select></label>
          )}
        </Views>
        <div id="view" role="tabpanel" aria-label={views[view]}>
          <FigureView onPlace={move} path="/v1/studies/{study}/figure" fields={{ study: name }}
            asked={{ view, variance, si: !datasheet, ghost: view === "averaging_times" || view === "spectrum" ? store.preview.value : "" }}
            version={`${study.current} ${study.attempts.length} ${study.diagnosis ? 1 : 0}`} />
        </div>
        <p class="sentence" aria-live="polite">{placeSentence(study, view, at, variance)}</p>
      </section>
      <aside class="side">
        <ErrorPanel study={study} preview={store.preview.value} />
        {store.working.value && <Progress job={store.working.value} />}
        <Candidates store={store} study={study} still={still} />
        <Limits study={study} />
        <Files of={study.preflight} />
      </aside>
      <Ladder study={study} store={store} still={still} />
    </div>
  );
}
