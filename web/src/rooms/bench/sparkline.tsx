// The last minute of a device's first channel, beside its numbers. No axes: it shows what stands out.
import type { RangeChannel } from "../../api/schema";
import { number } from "../../parts/numbers";
import { shownAs } from "../../trace/units";
import { type Box, outline } from "./sparkline_path";

const box: Box = { width: 120, height: 22 };

/** "gyro_x: from −0.3 to 0.41 °/s in the last minute" */
function sentence(channel: RangeChannel): string {
  const { unit, factor, offset } = shownAs(channel.units);
  const told = (value: number): string => number(offset + factor * value);
  return `${channel.channel}: from ${told(Math.min(...channel.lower))} to ${told(Math.max(...channel.upper))}${unit && ` ${unit}`} in the last minute`;
}

export function Sparkline({ channel }: { channel: RangeChannel | undefined }) {
  const known = channel !== undefined && channel.lower.length > 0;
  return (
    <svg class="sparkline" width={box.width} height={box.height} viewBox={`0 0 ${box.width} ${box.height}`} role="img"
      aria-label={known ? sentence(channel) : "no samples yet"}>
      {known && <path d={outline(channel.lower, channel.upper, box)}><title>{sentence(channel)}</title></path>}
    </svg>
  );
}
