// An array's report as rows.
import type { ArrayReport, CataloguedArray, SensorPair, VirtualSensor } from "../../api/schema";
import { number } from "../../parts/numbers";

/** "left: gyro_x, gyro_y, gyro_z" */
export const arrayTitle = (one: { readonly device: string; readonly channels: readonly string[] }): string =>
  `${one.device || "across devices"}: ${one.channels.join(", ")}`;

/** Arrays of one recording are counted from 0, in the order of the list. */
export function placesOf(all: readonly CataloguedArray[]): { readonly array: CataloguedArray; readonly place: number }[] {
  const count = new Map<string, number>();
  return all.map((array) => {
    const key = `${array.bench}/${array.folder}`;
    const place = count.get(key) ?? 0;
    count.set(key, place + 1);
    return { array, place };
  });
}

export const pairVerdict = (pair: SensorPair): string =>
  pair.withheld ? "not judged: the model does not fit" : pair.dependent ? "share noise" : "none shown";

export interface GainRow {
  readonly tau: string;
  readonly predicted: string;
  readonly measured: string;
}

export const gainRows = (sensor: VirtualSensor): GainRow[] =>
  sensor.scale_gains.map((one) => ({ tau: number(one.tau_s), predicted: number(one.predicted), measured: number(one.measured) }));

export const weightRows = (sensor: VirtualSensor): { sensor: string; weight: string }[] =>
  sensor.weights.map((one) => ({
    sensor: one.sensor,
    weight: number(one.weight) + (one.standard_error === undefined ? "" : ` ± ${number(one.standard_error, 2)}`),
  }));

/** What is gained at the averaging time that the virtual sensor was made for, and at the ends. */
export function gainSentence(sensor: VirtualSensor): string {
  const [first, last] = [sensor.scale_gains[0], sensor.scale_gains.at(-1)];
  if (!first || !last) return "";
  const words = (gain: number): string => (gain < 0.995 ? `${number(100 * (1 - gain), 2)} % less` : gain > 1.005 ? `${number(100 * (gain - 1), 2)} % more` : "as much");
  return `Compared with the mean of the sensors it has ${words(first.predicted)} noise power at ${number(first.tau_s)} s, and ${words(last.predicted)} at ${number(last.tau_s)} s.`;
}

export const shareTerms = (report: ArrayReport): string[] => report.budgets[0]?.terms.map((one) => one.term) ?? [];
