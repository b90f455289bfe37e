// Facts of a stream in a few words.
import type { LiveDevice, LiveStream } from "../../api/schema";
import { number } from "../../parts/numbers";

/** "102.4 of 102.4 Hz"; the rate is that of the last ten seconds. */
export function rateWords(stream: LiveStream): string {
  const nominal = stream.nominal_hz > 0 ? `${number(stream.nominal_hz, 4)} Hz` : "";
  if (stream.rate_hz === undefined) return nominal || "–";
  // As many digits each time: text that changes its width jumps.
  return nominal ? `${stream.rate_hz === 0 ? "0" : stream.rate_hz.toPrecision(4)} of ${nominal}` : `${number(stream.rate_hz, 4)} Hz`;
}

/** A rate that is more than a fiftieth off. */
export const offRate = (stream: LiveStream): boolean =>
  stream.rate_hz !== undefined && stream.nominal_hz > 0 && Math.abs(stream.rate_hz / stream.nominal_hz - 1) > 0.02;

export interface DeviceFacts {
  readonly rate: string; // of the fastest stream
  readonly rateOff: boolean;
  readonly missing: string;
  readonly temperature: string;
}

/** A device's streams in one row. */
export function deviceFacts(device: LiveDevice | undefined): DeviceFacts {
  const fastest = device?.streams.reduce<LiveStream | undefined>((best, one) => (best && best.nominal_hz >= one.nominal_hz ? best : one), undefined);
  if (!device || !fastest) return { rate: "–", rateOff: false, missing: "–", temperature: "–" };
  const missing = device.streams.reduce((sum, one) => sum + Number(one.missing), 0);
  const warm = device.streams.find((one) => one.temperature_k !== undefined)?.temperature_k;
  return {
    rate: rateWords(fastest),
    rateOff: device.streams.some(offRate),
    missing: String(missing),
    temperature: warm === undefined ? "–" : `${(warm - 273.15).toFixed(1)} °C`,
  };
}

/** What is wrong with a device now, else what was wrong last and when. */
export function lastError(device: LiveDevice): string {
  const now = device.disk_trouble || device.warnings[0]?.sentence;
  if (now) return now;
  const past = device.past_warning;
  return past ? `${clock(past.since_ns)} UTC: ${past.sentence}` : "none";
}

// "06:12:33" of nanoseconds since 1970.
const clock = (ns: string): string => new Date(Number(ns) / 1e6).toISOString().slice(11, 19);
