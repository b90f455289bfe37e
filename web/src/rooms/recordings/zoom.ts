// Which part of a replicate is seen, in seconds since its first sample.

export interface Part {
  readonly from: number;
  readonly until: number;
}

const kShortest = 1e-3; // s

/** A part within the whole, no shorter than a millisecond. */
export function within(part: Part, length: number): Part {
  const size = Math.min(Math.max(part.until - part.from, kShortest), Math.max(length, kShortest));
  const from = Math.min(Math.max(0, part.from), Math.max(0, length - size));
  return { from, until: from + size };
}

/** As much larger (factor > 1) or smaller around a place, which stays where it is. */
export const zoomed = (part: Part, factor: number, at: number, length: number): Part =>
  within({ from: at + (part.from - at) * factor, until: at + (part.until - at) * factor }, length);

/** Moved by a share of what is seen. */
export const moved = (part: Part, share: number, length: number): Part => {
  const by = share * (part.until - part.from);
  return within({ from: part.from + by, until: part.until + by }, length);
};

export const whole = (length: number): Part => ({ from: 0, until: Math.max(length, kShortest) });

/** What a key does to the part that is seen; null: nothing. */
export function afterKey(key: string, part: Part, length: number): Part | null {
  const middle = 0.5 * (part.from + part.until);
  switch (key) {
    case "+": case "=": return zoomed(part, 0.5, middle, length);
    case "-": return zoomed(part, 2, middle, length);
    case "ArrowLeft": return moved(part, -0.25, length);
    case "ArrowRight": return moved(part, 0.25, length);
    case "Home": case "0": return whole(length);
    default: return null;
  }
}
