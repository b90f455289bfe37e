// One channel's samples over time, with a sentence for those who cannot see them.
import { useEffect, useRef } from "preact/hooks";
import { useSize } from "../figure/size";
import { number } from "../parts/numbers";
import { useDark } from "../parts/dark";
import { draw } from "./draw";
import { type Extent, extentOf, latestOf, steadyAxis, type Trace } from "./ranges";

const unitOf = (trace: Trace): string => (trace.unit ? ` ${trace.unit}` : "");

/** "gyro_x: from −0.3 to 0.41 °/s; the latest is 0.02 °/s; samples are missing in 2 places" */
export function sentence(trace: Trace): string {
  const extent = extentOf(trace);
  if (!extent) return `${trace.channel}: no samples yet`;
  const missing = trace.gaps.length ? `; samples are missing in ${trace.gaps.length === 1 ? "one place" : `${trace.gaps.length} places`}` : "";
  return `${trace.channel}: from ${number(extent.low)} to ${number(extent.high)}${unitOf(trace)}; the latest is ${number(latestOf(trace))}${unitOf(trace)}${missing}`;
}

interface Props {
  readonly trace: Trace;
  readonly from: number; // s
  readonly until: number; // s
  readonly times: boolean; // with labels of the times
  readonly chosen?: { readonly begin: number; readonly end: number } | null; // a part that is being chosen, s
}

const kHeight = 58; // px

export function TraceView({ trace, from, until, times, chosen = null }: Props) {
  const frame = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const axis = useRef<Extent | null>(null);
  const width = useSize(frame)?.width;
  const dark = useDark();
  const tall = kHeight + (times ? 16 : 0);
  useEffect(() => {
    if (!canvas.current || !width || !(until > from)) return;
    const begin = trace.time.findIndex((time) => time >= from);
    const extent = begin < 0 ? null : extentOf(trace, begin);
    if (extent) axis.current = steadyAxis(axis.current, extent);
    draw(canvas.current, trace, { width, height: tall, from, until, axis: axis.current ?? { low: -1, high: 1 }, times, chosen });
  }, [trace, from, until, times, width, tall, dark, chosen]);
  const latest = latestOf(trace);
  return (
    <figure class="trace">
      <figcaption><strong>{trace.channel}</strong> <span class="soft">{number(latest)}{unitOf(trace)}</span></figcaption>
      <div class="trace-frame" ref={frame}>
        <canvas class={times ? "with-times" : ""} ref={canvas} role="img" aria-label={sentence(trace)} />
      </div>
    </figure>
  );
}

/** Everything that the traces show, as a table. */
export const TraceTable = ({ traces }: { traces: readonly Trace[] }) => (
  <table class="visually-hidden">
    <caption>The samples that are shown</caption>
    <thead><tr>{["channel", "least", "greatest", "latest", "unit"].map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>
    <tbody>
      {traces.map((one) => {
        const extent = extentOf(one);
        return <tr key={one.channel}><th scope="row">{one.channel}</th><td>{number(extent?.low)}</td><td>{number(extent?.high)}</td><td>{number(latestOf(one))}</td><td>{one.unit}</td></tr>;
      })}
    </tbody>
  </table>
);
