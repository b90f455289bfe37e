// Figures as SVG and PNG, the report, the study as JSON, and noise values for other programs.
import { useState } from "preact/hooks";
import { getText } from "../../api/client";
import type { Study } from "../../api/schema";
import { Consumers } from "../../parts/consumers";
import { png, save, saveText } from "../../parts/save";
import type { View } from "./views";

interface Props {
  readonly study: Study;
  readonly name: string;
  readonly view: View;
  readonly variance: boolean;
  readonly onProblem: (problem: string) => void;
}

export function Export({ study, name, view, variance, onProblem }: Props) {
  const [open, show] = useState(false);
  const figure = (): Promise<string> => getText("/v1/studies/{study}/figure", { study: name }, { view, variance, standalone: true });
  const makers: Record<string, () => Promise<void>> = {
    svg: async () => saveText(await figure(), "image/svg+xml", `${name}_${view}.svg`),
    png: async () => save(await png(new Blob([await figure()], { type: "image/svg+xml" })), `${name}_${view}.png`),
    report: async () => saveText(await getText("/v1/studies/{study}/report", { study: name }, {}), "text/html", `${name}.html`),
    json: async () => saveText(JSON.stringify(study, null, 1), "application/json", `${name}.json`),
  };
  const choose = (event: { currentTarget: HTMLSelectElement }): void => {
    const kind = event.currentTarget.value;
    event.currentTarget.value = "";
    if (kind === "program") show(true);
    else makers[kind]?.().catch((error: Error) => onProblem(error.message));
  };
  return (
    <>
      <select aria-label="Export" value="" onChange={choose}>
        <option value="" disabled>Export</option>
        <option value="svg">this figure, SVG</option>
        <option value="png">this figure, PNG</option>
        <option value="report">the report, HTML</option>
        <option value="json">the study, JSON</option>
        <option value="program">noise values for a program …</option>
      </select>
      {open && (
        <div class="export-panel" role="group" aria-label="Noise values for a program"
          onKeyDown={(event) => { if (event.key === "Escape") show(false); }}>
          <Consumers path="/v1/studies/{study}/export" fields={{ study: name }} asked={{}} />
          <button type="button" onClick={() => show(false)}>Close</button>
        </div>
      )}
    </>
  );
}
