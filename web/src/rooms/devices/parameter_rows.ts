// The histories of a device's parameters, turned into rows in the units of data sheets.
import type { HistoryPoint, ParameterHistory } from "../../api/schema";
import { number } from "../../parts/numbers";

export interface ParameterRow {
  readonly name: string; // "gyro_x N of WN"
  readonly unit: string;
  readonly newest: string;
  readonly expected: string;
  readonly change: string;
  readonly verdict: "changed" | "drift" | "compatible" | "not compared";
}

const shown = (one: ParameterHistory): { unit: string; factor: number } =>
  one.datasheet_unit && one.to_datasheet > 0 ? { unit: one.datasheet_unit, factor: one.to_datasheet } : { unit: one.unit, factor: 1 };

/** "1.2 (1.1 … 1.3)"; a point without a lower end is an upper bound. */
export function pointText(point: HistoryPoint, factor: number): string {
  const { value, lower, upper } = point;
  if (upper === undefined) return number(value * factor);
  if (!lower || lower <= 0) return `at most ${number(upper * factor)}`;
  return `${number(value * factor)} (${number(lower * factor)} … ${number(upper * factor)})`;
}

/** A change as a fraction: "+12 %", "3.5 times" */
export const changeText = (fraction: number): string =>
  Math.abs(fraction) >= 10 ? `${number(1 + fraction)} times` : `${fraction < 0 ? "" : "+"}${number(100 * fraction, 2)} %`;

const verdictOf = (drift: ParameterHistory["drift"]): ParameterRow["verdict"] => {
  if (!drift) return "not compared";
  return drift.newest_alarm ? "changed" : drift.trend_alarm ? "drift" : "compatible";
};

export function parameterRow(one: ParameterHistory): ParameterRow {
  const { unit, factor } = shown(one);
  const newest = one.points.at(-1);
  const drift = one.drift;
  return {
    name: `${one.channel} ${one.parameter} of ${one.term}`,
    unit,
    newest: newest ? pointText(newest, factor) : "–",
    expected: drift ? `${number(drift.expected_lower * factor)} … ${number(drift.expected_upper * factor)}` : "–",
    change: drift ? changeText(drift.change) : "–",
    verdict: verdictOf(drift),
  };
}

/** The calibrations of a parameter, newest first. */
export const pointRows = (one: ParameterHistory): { started: number; value: string; model: string }[] =>
  [...one.points].reverse().map((point) => ({
    started: Number(point.started_ns) / 1e6, value: pointText(point, shown(one).factor), model: point.model,
  }));
