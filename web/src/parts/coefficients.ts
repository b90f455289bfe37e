// Coefficients in the units of data sheets, SI where none is customary.
import type { Coefficient } from "../api/schema";
import { number } from "./numbers";

/** "0.172 (0.171 … 0.173) °/√h"; of what is not seen, its upper bound alone. */
export function coefficientText(one: Coefficient, seen: boolean): string {
  const sheet = one.datasheet_unit !== "";
  const unit = sheet ? one.datasheet_unit : one.unit;
  const [value, lower, upper] = sheet
    ? [one.datasheet_value, one.datasheet_lower, one.datasheet_upper]
    : [one.value, one.lower, one.upper];
  if (!seen) return upper === undefined ? "–" : `at most ${number(upper)} ${unit}`;
  const interval = lower === undefined || upper === undefined ? "" : ` (${number(lower)} … ${number(upper)})`;
  return `${number(value)}${interval} ${unit}`;
}
