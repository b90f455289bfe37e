// A figure of the service in the page: fetched in the size that it has here.
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { type Fields, getText, type Refused } from "../api/client";
import { Skeleton } from "../parts/states";
import { number } from "../parts/numbers";
import { useSize } from "./size";
import { axisTitles, indexOf, type Place, places, pointAt, showTerm, terms } from "./figure";

interface Props {
  readonly path: string; // of the method that draws it
  readonly fields: Fields; // in the path
  readonly asked: Fields;
  readonly version: string; // changes when the figure may have changed
  readonly onPlace: (place: Place | null) => void;
}

const Table = ({ all, titles }: { all: readonly Place[]; titles: readonly [string, string] }) => (
  <table class="visually-hidden">
    <caption>The measured points of the figure</caption>
    <thead><tr><th scope="col">{titles[0]}</th><th scope="col">{titles[1]}</th><th scope="col">residual, σ</th></tr></thead>
    <tbody>
      {all.map((one) => <tr key={one.x}><td>{number(one.x)}</td><td>{number(one.y)}</td><td>{number(one.sigma)}</td></tr>)}
    </tbody>
  </table>
);

export function FigureView({ path, fields, asked, version, onPlace }: Props) {
  const frame = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLDivElement>(null);
  const size = useSize(frame);
  const [svg, draw] = useState("");
  const [problem, tell] = useState("");
  const [all, setAll] = useState<readonly Place[]>([]);
  const [titles, setTitles] = useState<readonly [string, string]>(["", ""]);
  const [names, setNames] = useState<readonly string[]>([]);
  const [hidden, hide] = useState<ReadonlySet<string>>(new Set());
  const [at, move] = useState<number | null>(null);

  const words = JSON.stringify([fields, asked]);
  useEffect(() => {
    if (!size) return;
    const stop = new AbortController();
    getText(path, fields, { ...asked, width: size.width, height: size.height }, stop.signal)
      .then((text) => { draw(text); tell(""); })
      .catch((error: Refused) => { if (!stop.signal.aborted) { draw(""); tell(error.message); } });
    return () => stop.abort();
  }, [path, words, version, size?.width, size?.height]);

  useLayoutEffect(() => {
    const drawn = canvas.current?.querySelector("svg");
    setAll(drawn ? places(drawn) : []);
    setNames(drawn ? terms(drawn) : []);
    if (drawn) setTitles(axisTitles(drawn));
  }, [svg]);
  useLayoutEffect(() => move(null), [words]);
  useLayoutEffect(() => {
    const drawn = canvas.current?.querySelector("svg");
    if (!drawn) return;
    for (const name of names) showTerm(drawn, name, !hidden.has(name));
    pointAt(drawn, at);
  }, [svg, names, hidden, at]);
  useEffect(() => onPlace(at === null ? null : all[at] ?? null), [at, all]);

  const step = (event: KeyboardEvent): void => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by || all.length === 0) return;
    event.preventDefault();
    move(Math.min(all.length - 1, Math.max(0, (at ?? (by > 0 ? -1 : all.length)) + by)));
  };
  const toggle = (name: string): void => {
    const next = new Set(hidden);
    if (!next.delete(name)) next.add(name);
    hide(next);
  };
  return (
    <div class="figure-view">
      <div class="figure-frame" ref={frame} tabIndex={0} role="group" aria-label="figure; arrow keys move the cursor" onKeyDown={step}
        onPointerMove={(event) => { const index = indexOf(event.target); if (index !== null) move(index); }}
        onPointerLeave={() => move(null)}>
        {svg && <div class="figure-canvas" ref={canvas} dangerouslySetInnerHTML={{ __html: svg }} />}
        {!svg && !problem && <Skeleton lines={6} />}
        {problem && <p class="nothing">{problem}</p>}
      </div>
      {all.length > 0 && <Table all={all} titles={titles} />}
      {names.length > 1 && (
        <div class="legend" role="group" aria-label="Terms in the figure">
          {names.map((name) => (
            <button type="button" key={name} aria-pressed={!hidden.has(name)} onClick={() => toggle(name)}>{name}</button>
          ))}
        </div>
      )}
    </div>
  );
}
