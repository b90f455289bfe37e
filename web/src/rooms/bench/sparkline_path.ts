// A channel's least and greatest of each stretch as one outline, in a box of so many units.

export interface Box {
  readonly width: number;
  readonly height: number;
}

/** An SVG path around all ranges; "" where there are none. A channel that never changes is a thin line in the middle. */
export function outline(lower: readonly number[], upper: readonly number[], box: Box): string {
  if (lower.length === 0) return "";
  const [low, high] = [Math.min(...lower), Math.max(...upper)];
  const thin = 0.5; // a range of one value is seen
  const y = (value: number): number =>
    high > low ? thin + ((high - value) / (high - low)) * (box.height - 2 * thin) : box.height / 2;
  const step = box.width / lower.length;
  const corners = (values: readonly number[], by: number): string[] =>
    values.flatMap((value, k) => [`${(k * step).toFixed(1)} ${(y(value) + by).toFixed(1)}`, `${((k + 1) * step).toFixed(1)} ${(y(value) + by).toFixed(1)}`]);
  return `M${[...corners(upper, -thin), ...corners(lower, thin).reverse()].join("L")}Z`;
}
