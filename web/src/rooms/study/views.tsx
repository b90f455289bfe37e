import type { ComponentChildren } from "preact";

export const views = {
  averaging_times: "Averaging time",
  spectrum: "Spectrum",
  time: "Time",
  distribution: "Distribution",
  witnesses: "Witnesses",
  replicates: "Replicates",
} as const;
export type View = keyof typeof views;
const names = Object.keys(views) as View[];

export function Views({ current, onChoose, children }: { current: View; onChoose: (view: View) => void; children: ComponentChildren }) {
  const step = (event: KeyboardEvent): void => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    const next = names[(names.indexOf(current) + by + names.length) % names.length] ?? current;
    onChoose(next);
    document.getElementById(`tab-${next}`)?.focus();
  };
  return (
    <div class="views">
      <div role="tablist" aria-label="Views" onKeyDown={step}>
        {names.map((name) => (
          <button type="button" key={name} id={`tab-${name}`} role="tab" aria-selected={name === current} aria-controls="view"
            tabIndex={name === current ? 0 : -1} onClick={() => onChoose(name)}>{views[name]}</button>
        ))}
      </div>
      <span class="fill" />
      {children}
    </div>
  );
}
