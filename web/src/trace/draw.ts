// A trace on a canvas. The colours are those of the figures.
import { type Extent, stretchesOf, type Trace } from "./ranges";
import { tickLabels, ticks, timeLabel, timeTicks } from "./ticks";

export interface Frame {
  readonly width: number; // px, of the page
  readonly height: number;
  readonly from: number; // s
  readonly until: number; // s
  readonly axis: Extent;
  readonly times: boolean; // with labels of the times
  readonly chosen: { readonly begin: number; readonly end: number } | null; // a part that is being chosen, s
}

export const kLeft = 62; // px, room for labels
export const kRight = 8;
const kTop = 6;
const kLine = 16;

const colour = (of: Element, name: string): string => getComputedStyle(of).getPropertyValue(name).trim() || "#888";

/** Draws what lies between frame.from and frame.until. */
export function draw(canvas: HTMLCanvasElement, trace: Trace, frame: Frame): void {
  const scale = window.devicePixelRatio || 1;
  const [width, height] = [Math.round(frame.width * scale), Math.round(frame.height * scale)];
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const to = canvas.getContext("2d");
  if (!to) return;
  to.setTransform(scale, 0, 0, scale, 0, 0);
  to.clearRect(0, 0, frame.width, frame.height);
  const bottom = frame.height - (frame.times ? kLine + 2 : 4);
  const right = frame.width - kRight;
  const x = (time: number): number => kLeft + ((time - frame.from) / (frame.until - frame.from)) * (right - kLeft);
  const y = (value: number): number => bottom - ((value - frame.axis.low) / (frame.axis.high - frame.axis.low)) * (bottom - kTop);

  if (frame.chosen) {
    to.fillStyle = colour(canvas, "--band");
    const [begin, end] = [x(frame.chosen.begin), x(frame.chosen.end)];
    to.fillRect(Math.min(begin, end), kTop, Math.abs(end - begin), bottom - kTop);
  }
  to.font = '11px system-ui, "Liberation Sans", "DejaVu Sans", sans-serif';
  to.lineWidth = 1;
  to.textBaseline = "middle";
  to.textAlign = "right";
  const values = ticks(frame.axis.low, frame.axis.high, Math.max(2, Math.floor((bottom - kTop) / 15)));
  const labels = tickLabels(values);
  values.forEach((value, place) => {
    to.strokeStyle = colour(canvas, "--grid");
    to.beginPath();
    to.moveTo(kLeft, Math.round(y(value)) + 0.5);
    to.lineTo(right, Math.round(y(value)) + 0.5);
    to.stroke();
    to.fillStyle = colour(canvas, "--soft");
    to.fillText(labels[place] ?? "", kLeft - 6, y(value));
  });
  const { at, step } = timeTicks(frame.from, frame.until, Math.max(1, Math.floor((right - kLeft) / 90)));
  to.textAlign = "center";
  for (const time of at) {
    to.strokeStyle = colour(canvas, "--grid");
    to.beginPath();
    to.moveTo(Math.round(x(time)) + 0.5, kTop);
    to.lineTo(Math.round(x(time)) + 0.5, bottom);
    to.stroke();
    to.fillStyle = colour(canvas, "--soft");
    if (frame.times) to.fillText(timeLabel(time, step), Math.min(x(time), right - 14), bottom + kLine / 2 + 2);
  }

  to.save();
  to.beginPath();
  to.rect(kLeft, 0, right - kLeft, frame.height);
  to.clip();
  to.strokeStyle = colour(canvas, "--alarm");
  for (const gap of trace.gaps) {
    const place = Math.round(x(trace.time[gap] ?? frame.from)) + 0.5;
    to.beginPath();
    to.moveTo(place, kTop);
    to.lineTo(place, bottom);
    to.stroke();
  }
  const places = trace.time.map(x);
  const beyond = places.findIndex((place) => place > right);
  const last = beyond < 0 ? places.length : beyond + 1;
  const first = Math.max(0, places.findIndex((place) => place >= kLeft) - 1);
  to.strokeStyle = to.fillStyle = colour(canvas, "--model");
  to.lineWidth = 1.2;
  to.lineJoin = to.lineCap = "round";
  // Stretches without a gap: what lies between the least and the greatest of each range.
  for (const [from, until] of stretchesOf(trace)) {
    const [begin, end] = [Math.max(from, first), Math.min(until, last)];
    if (begin >= end) continue;
    to.beginPath();
    for (let k = begin; k < end; ++k) to.lineTo(places[k]!, y(trace.upper[k]!));
    if (end === begin + 1) to.lineTo(places[begin]!, y(trace.lower[begin]!)); // a range between two gaps
    to.stroke();
    for (let k = end - 1; k >= begin; --k) to.lineTo(places[k]!, y(trace.lower[k]!));
    to.closePath();
    to.globalAlpha = 0.7;
    to.fill();
    to.globalAlpha = 1;
    to.beginPath();
    for (let k = begin; k < end; ++k) to.lineTo(places[k]!, y(trace.lower[k]!));
    to.stroke();
  }
  to.restore();
}
