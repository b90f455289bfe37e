// One device while it is recorded: its samples, its Allan deviation, and whether it was recorded long enough.
import { useState } from "preact/hooks";
import type { LiveDevice as Device, LiveStream } from "../../api/schema";
import { FigureView } from "../../figure/figure_view";
import type { Place } from "../../figure/figure";
import { duration, number } from "../../parts/numbers";
import { Empty, Loading, Skeleton } from "../../parts/states";
import { campaigns, live } from "../../state";
import { TraceTable, TraceView } from "../../trace/trace_view";
import { Deviation } from "./deviation";
import { useLiveSamples } from "./live_samples";
import { Parameters } from "./parameters";
import { rateWords } from "./stream_words";

const spans = [["10", "10 s"], ["60", "1 min"], ["600", "10 min"], ["3600", "1 h"], ["36000", "10 h"]] as const;

function Traces({ campaign, device, stream }: { campaign: string; device: string; stream: LiveStream }) {
  const [span, choose] = useState(60);
  const [still, hold] = useState(false);
  const { window, problem } = useLiveSamples({ campaign, device, stream: stream.stream, rate: stream.nominal_hz, span, still });
  const until = window?.traces[0]?.time.at(-1) ?? 0;
  const from = Math.max(0, until - span);
  const words = !window ? "" : window.each === 1 ? "each sample" : `least and greatest of ${window.each} samples each`;
  return (
    <section class="traces" aria-label="Latest samples">
      <header>
        <h2>Latest samples</h2>
        <span class="soft">{words}</span>
        <span class="fill" />
        <label>span <select value={String(span)} onChange={(event) => choose(Number(event.currentTarget.value))}>
          {spans.map(([value, title]) => <option key={value} value={value}>{title}</option>)}
        </select></label>
        <button type="button" aria-pressed={still} onClick={() => hold(!still)}>{still ? "Continue" : "Hold"}</button>
      </header>
      {problem && <p class="alarm" role="alert">{problem}</p>}
      {!window && !problem && <Skeleton lines={6} />}
      {window?.traces.map((one, place) => (
        <TraceView key={one.channel} trace={one} from={from} until={until} times={place === window.traces.length - 1} />
      ))}
      {window && <TraceTable traces={window.traces} />}
    </section>
  );
}

function Facts({ device }: { device: Device }) {
  return (
    <ul class="facts">
      {device.streams.map((one) => (
        <li key={one.stream}>
          <strong>{one.stream}</strong> {rateWords(one)} · {one.missing === "0" ? "nothing missing" : <span class="alarm">{one.missing} missing</span>}
          {one.refused !== "0" && <span class="alarm"> · {one.refused} rejected</span>}
          {one.temperature_k !== undefined && ` · ${number(one.temperature_k - 273.15)} °C`}
        </li>
      ))}
    </ul>
  );
}

function Knowledge({ campaign, device }: { campaign: string; device: Device }) {
  const channels = device.channels;
  const [wanted, choose] = useState("");
  const [at, move] = useState<Place | null>(null);
  const one = channels.find((channel) => `${channel.stream}/${channel.channel}` === wanted) ??
    channels.find((channel) => channel.units === "rad/s") ?? channels[0];
  if (!one) return <section class="knowledge"><p class="soft">No angular rate or acceleration is recorded: there is no Allan deviation to show.</p></section>;
  const asked = { campaign, device: device.device, stream: one.stream, channel: one.channel };
  // Every scale changes slowly: a new figure each ten seconds is enough.
  const version = String(device.elapsed_s < 10 ? Math.floor(device.elapsed_s) : 10 + Math.floor(device.elapsed_s / 10));
  return (
    <section class="knowledge" aria-label="What is known so far">
      <header>
        <h2>Allan deviation so far</h2>
        <span class="fill" />
        <label>channel <select value={`${one.stream}/${one.channel}`} onChange={(event) => choose(event.currentTarget.value)}>
          {channels.map((channel) => {
            const value = `${channel.stream}/${channel.channel}`;
            return <option key={value} value={value}>{channel.channel}</option>;
          })}
        </select></label>
      </header>
      <FigureView path="/v1/live/figure" fields={{}} asked={asked} version={version} onPlace={move} />
      <p class="sentence" aria-live="polite">{at ? `At ${number(at.x)} s: ${number(at.y)}, in the figure's unit.` : device.outlook}</p>
      <Parameters key={`${one.stream}/${one.channel}`} asked={asked} elapsed={device.elapsed_s} />
    </section>
  );
}

export function LiveDevice({ campaign, name }: { campaign: string; name: string }) {
  const back = <p><a href="#/bench">The bench</a></p>;
  if (campaigns.value === null) return <Loading />;
  const device = live.value.get(campaign)?.devices.find((one) => one.device === name);
  if (!device) return <Empty title={`${name} is not recorded now`} sentence="When its campaign records, its samples stand here.">{back}</Empty>;
  const first = device.streams[0];
  return (
    <div class="live-device">
      <header class="live-head">
        {back}
        <h1>{name}</h1>
        <span class="soft">{campaign} · {duration(device.elapsed_s)} recorded</span>
        <Facts device={device} />
        {(device.disk_trouble || device.warnings.length > 0) && (
          <ul class="alarm" role="status">{device.disk_trouble && <li>{device.disk_trouble}</li>}{device.warnings.map((one) => <li key={one.sentence}>{one.sentence}</li>)}</ul>
        )}
      </header>
      {first ? <Traces key={first.stream} campaign={campaign} device={name} stream={first} /> : <Skeleton lines={6} />}
      <Knowledge campaign={campaign} device={device} />
      <Deviation campaign={campaign} device={name} elapsed={device.elapsed_s} />
    </div>
  );
}
