// The sentence that explains a place of a figure.
import type { Misfit, Study } from "../../api/schema";
import type { Place } from "../../figure/figure";
import { number } from "../../parts/numbers";
import type { View } from "./views";

const kinds: Partial<Record<View, readonly string[]>> = {
  averaging_times: ["scale"],
  spectrum: ["frequency"],
  time: ["time"],
  distribution: ["kurtosis"],
  witnesses: ["sensors"],
  replicates: ["replicate"],
};

const units: Partial<Record<View, string>> = { averaging_times: "s", spectrum: "Hz", distribution: "s" };

const about: Record<View, string> = {
  averaging_times: "Circles: measured, with 95 % intervals. Filled ones lie beyond two standard deviations, as one in 20 does by chance.",
  spectrum: "Circles: measured, with 95 % intervals. Thin line: the strongest single frequency. Marks: waves that were tested.",
  time: "Variance of the whitened noise in stretches of each replicate: orange is more than in the whole of it, blue is less.",
  distribution: "Excess kurtosis of the whitened noise. Grey: where 19 of 20 values lie if it is normal.",
  witnesses: "What the channel shares with witnesses beyond what the model explains.",
  replicates: "Each replicate against the model, in standard deviations: orange is more, blue is less.",
};

// Allan deviations stand at half of the averaging time of a wavelet.
function said(one: Misfit, view: View, variance: boolean): string {
  if (view !== "averaging_times" || variance || one.from === undefined || one.to === undefined) return one.sentence;
  const [from, to] = [number(one.from / 2), number(one.to / 2)];
  return `${one.sentence} In Allan deviation: at ${from === to ? from : `${from} to ${to}`} s.`;
}

/** Under the cursor the failure there, else how the point deviates; without a cursor the worst of the view. */
export function placeSentence(study: Study, view: View, at: Place | null, variance: boolean): string {
  const here = (study.diagnosis?.misfits ?? []).filter((one) => kinds[view]?.includes(one.kind))
    .sort((one, other) => Math.abs(other.sigma) - Math.abs(one.sigma));
  if (!at) return here[0] ? said(here[0], view, variance) : about[view];
  const x = view === "averaging_times" && !variance ? 2 * at.x : at.x;
  const failure = here.find((one) => one.from !== undefined && one.to !== undefined && one.from <= x * 1.001 && x <= one.to * 1.001);
  if (failure) return said(failure, view, variance);
  const deviation = at.sigma === undefined ? "" : `, ${number(at.sigma, 2)} standard deviations from the model`;
  return `At ${number(at.x)} ${units[view] ?? ""}: ${number(at.y)}${deviation}.`;
}
