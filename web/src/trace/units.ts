// The units that people read samples in.

export interface Shown {
  readonly unit: string;
  readonly factor: number;
  readonly offset: number;
}

const known: Readonly<Record<string, Shown>> = {
  "rad/s": { unit: "°/s", factor: 180 / Math.PI, offset: 0 },
  K: { unit: "°C", factor: 1, offset: -273.15 },
  "m/s^2": { unit: "m/s²", factor: 1, offset: 0 },
  T: { unit: "µT", factor: 1e6, offset: 0 },
};

/** Angular rates first, then accelerations, then what is beside them. */
export const rank = (units: string): number => {
  const place = ["rad/s", "m/s^2"].indexOf(units);
  return place < 0 ? 2 : place;
};

/** Shown value = offset + factor · SI value. */
export const shownAs = (units: string): Shown => known[units] ?? { unit: units === "1" ? "" : units, factor: 1, offset: 0 };
