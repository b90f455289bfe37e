// Round numbers on an axis.

/** At most `most` multiples of 1, 2 or 5 · 10ᵏ from low to high; the one value where these are equal. */
export function ticks(low: number, high: number, most: number): number[] {
  if (!(high > low)) return Number.isFinite(low) ? [low] : [];
  const rough = (high - low) / Math.max(1, most);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5, 10].find((one) => one * power >= rough * (1 - 1e-9)) ?? 10);
  const out: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9) + 0; k * step <= high + step * 1e-9; ++k) out.push(k * step);
  return out;
}

/** As many decimals as tell neighbours apart; powers of ten where numbers are far from one. */
export function tickLabels(values: readonly number[]): string[] {
  const largest = Math.max(...values.map(Math.abs), 0);
  const step = values.length > 1 ? Math.abs((values[1] ?? 0) - (values[0] ?? 0)) : largest;
  if (largest === 0) return values.map(() => "0");
  if (largest < 1e-3 || largest >= 1e5) {
    const power = Math.floor(Math.log10(largest) + 1e-9);
    const digits = Math.min(4, Math.max(0, power - Math.floor(Math.log10(step) + 1e-9)));
    const sign = power < 0 ? "⁻" : "";
    const raised = [...String(Math.abs(power))].map((digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(digit)]).join("");
    return values.map((one) => (one === 0 ? "0" : `${(one / 10 ** power).toFixed(digits)}·10${sign}${raised}`.replace("-", "−")));
  }
  const digits = Math.min(6, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  return values.map((one) => (Math.abs(one) < step * 1e-6 ? 0 : one).toFixed(digits).replace("-", "−"));
}

/** "12:30" or "1:02:30" of seconds since a beginning; below ten seconds apart with decimals. */
export function timeLabel(seconds: number, step: number): string {
  if (step < 1) return `${seconds.toFixed(Math.min(4, Math.ceil(-Math.log10(step) - 1e-9)))} s`;
  const whole = Math.round(seconds);
  if (whole < 120 && step < 60) return `${whole} s`;
  const two = (value: number): string => String(value).padStart(2, "0");
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  return hours ? `${hours}:${two(minutes)}:${two(whole % 60)}` : `${minutes}:${two(whole % 60)}`;
}

const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600, 43200, 86400];

/** Ticks of times in seconds: round in the clock's sense. */
export function timeTicks(low: number, high: number, most: number): { at: number[]; step: number } {
  const rough = (high - low) / Math.max(1, most);
  if (!(rough > 0)) return { at: [low], step: 1 };
  const found = rough <= 0.5 ? undefined : steps.find((one) => one >= rough);
  if (found === undefined) {
    const at = ticks(low, high, most);
    return { at, step: at.length > 1 ? (at[1] ?? 0) - (at[0] ?? 0) : 1 };
  }
  const at: number[] = [];
  for (let k = Math.ceil(low / found); k * found <= high; ++k) at.push(k * found);
  return { at, step: found };
}
