// Figures as SVG and PNG, and the study as JSON.
import { getText } from "../../api/client";
import type { Study } from "../../api/schema";
import type { View } from "./views";

function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

async function png(svg: Blob): Promise<Blob> {
  const picture = new Image();
  const address = URL.createObjectURL(svg);
  picture.src = address;
  await picture.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [2 * picture.naturalWidth, 2 * picture.naturalHeight];
  canvas.getContext("2d")?.drawImage(picture, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(address);
  return new Promise((go, fail) => canvas.toBlob((blob) => (blob ? go(blob) : fail(new Error("no picture"))), "image/png"));
}

export function Export({ study, name, view, variance }: { study: Study; name: string; view: View; variance: boolean }) {
  const choose = async (event: { currentTarget: HTMLSelectElement }): Promise<void> => {
    const kind = event.currentTarget.value;
    event.currentTarget.value = "";
    if (kind === "json") return save(new Blob([JSON.stringify(study, null, 1)], { type: "application/json" }), `${name}.json`);
    const text = await getText("/v1/studies/{study}/figure", { study: name }, { view, variance, standalone: true });
    const svg = new Blob([text], { type: "image/svg+xml" });
    save(kind === "svg" ? svg : await png(svg), `${name}_${view}.${kind}`);
  };
  return (
    <select aria-label="Export" value="" onChange={(event) => void choose(event)}>
      <option value="" disabled>Export</option>
      <option value="svg">this figure, SVG</option>
      <option value="png">this figure, PNG</option>
      <option value="json">the study, JSON</option>
    </select>
  );
}
