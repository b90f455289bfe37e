// A channel's least and greatest of each stretch as one outline, in a box of so many units.

export interface Box {
  readonly width: number;
  readonly height: number;
}

/** An SVG path around all ranges; "" where there are fewer than two. A channel that never changes is a line in the middle. */
export function outline(lower: readonly number[], upper: readonly number[], box: Box): string {
  if (lower.length < 2) return "";
  const [low, high] = [Math.min(...lower), Math.max(...upper)];
  const room = 1.5; // for the line's width
  const y = (value: number): number => (high > low ? room + ((high - value) / (high - low)) * (box.height - 2 * room) : box.height / 2);
  const step = box.width / (lower.length - 1);
  const corners = (values: readonly number[]): string[] => values.map((value, k) => `${(k * step).toFixed(1)} ${y(value).toFixed(1)}`);
  return `M${[...corners(upper), ...corners(lower).reverse()].join("L")}Z`;
}
