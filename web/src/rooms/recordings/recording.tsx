// The samples of a recording. Drag over a part to see it closer; a double click shows all of it again.
import { useEffect, useRef, useState } from "preact/hooks";
import { get } from "../../api/client";
import type { Manifest, SampleRanges } from "../../api/schema";
import { Consumers } from "../../parts/consumers";
import { useLoaded } from "../../parts/loaded";
import { duration, number } from "../../parts/numbers";
import { Empty, Loading, Skeleton } from "../../parts/states";
import { kLeft, kRight } from "../../trace/draw";
import { tracesOf } from "../../trace/ranges";
import { TraceTable, TraceView } from "../../trace/trace_view";
import { calibrationWords } from "../../parts/calibration_words";
import { shortfalls, summary } from "./replicate_words";
import { afterKey, type Part, whole, within, zoomed } from "./zoom";

interface At {
  readonly campaign: string;
  readonly folder: string;
  readonly device: string;
  readonly stream: string;
  readonly replicate: number;
}

// The latest answer stays until the next one is there.
function useSamples(at: At, part: Part | null): { ranges: SampleRanges | null; problem: string } {
  const [ranges, show] = useState<SampleRanges | null>(null);
  const [problem, tell] = useState("");
  useEffect(() => {
    let over = false;
    const asked = part ? { from_s: part.from, until_s: part.until } : {};
    get("/v1/samples", {}, { ...at, ...asked, ranges: 1000 })
      .then((answer) => { if (!over) { show(answer); tell(""); } }, (error: Error) => { if (!over) { show(null); tell(error.message); } });
    return () => { over = true; };
  }, [JSON.stringify(at), part?.from, part?.until]);
  return { ranges, problem };
}

function Samples({ at }: { at: At }) {
  const [part, see] = useState<Part | null>(null);
  const { ranges, problem } = useSamples(at, part);
  const [drag, pull] = useState<{ begin: number; end: number } | null>(null);
  const area = useRef<HTMLDivElement>(null);
  if (problem) return <p class="alarm" role="alert">{problem}</p>;
  if (!ranges) return <Skeleton lines={8} />;
  const length = ranges.length_s;
  const seen = part ?? whole(length);
  const timeAt = (event: PointerEvent): number => {
    const box = area.current!.getBoundingClientRect();
    const share = (event.clientX - box.left - kLeft) / Math.max(1, box.width - kLeft - kRight);
    return seen.from + Math.min(1, Math.max(0, share)) * (seen.until - seen.from);
  };
  const drop = (): void => {
    const size = drag ? Math.abs(drag.end - drag.begin) : 0;
    if (drag && size > 0.005 * (seen.until - seen.from))
      see(within({ from: Math.min(drag.begin, drag.end), until: Math.max(drag.begin, drag.end) }, length));
    pull(null);
  };
  const key = (event: KeyboardEvent): void => {
    const next = afterKey(event.key, seen, length);
    if (!next) return;
    event.preventDefault();
    see(next);
  };
  const traces = tracesOf(ranges);
  const words = ranges.samples_each === 1 ? "each sample" : `least and greatest of ${ranges.samples_each} samples each`;
  return (
    <>
      <div class="zoom">
        <span class="soft" role="status">{number(seen.from, 4)} to {number(seen.until, 4)} s of {duration(length)} · {words}{ranges.gaps.length > 0 && <span class="alarm"> · missing in {ranges.gaps.length === 1 ? "one place" : `${ranges.gaps.length} places`}</span>}</span>
        <span class="fill" />
        <button type="button" onClick={() => see(zoomed(seen, 0.5, 0.5 * (seen.from + seen.until), length))}>Closer</button>
        <button type="button" onClick={() => see(zoomed(seen, 2, 0.5 * (seen.from + seen.until), length))}>Farther</button>
        <button type="button" disabled={!part} onClick={() => see(null)}>All</button>
      </div>
      <div class="recorded" ref={area} tabIndex={0} role="group" aria-label="samples; plus and minus zoom, arrow keys move" onKeyDown={key}
        onPointerDown={(event) => { if (event.button === 0) { const at = timeAt(event); pull({ begin: at, end: at }); area.current?.setPointerCapture(event.pointerId); } }}
        onPointerMove={(event) => { if (drag) pull({ ...drag, end: timeAt(event) }); }}
        onPointerUp={drop} onDblClick={() => see(null)}>
        {traces.map((one, place) => <TraceView key={one.channel} trace={one} from={seen.from} until={seen.until} times={place === traces.length - 1} chosen={drag} />)}
      </div>
      <TraceTable traces={traces} />
    </>
  );
}

function Choices({ manifest, campaign, folder }: { manifest: Manifest; campaign: string; folder: string }) {
  const streams = manifest.devices.flatMap((device) => device.streams.map((stream) => ({ device: device.name, stream: stream.name })));
  const replicates = [...new Set(manifest.replicates.map((one) => one.replicate))].sort((a, b) => a - b);
  const [stream, chooseStream] = useState(0);
  const [replicate, chooseReplicate] = useState(replicates[0] ?? 1);
  const one = streams[stream];
  if (!one) return <p class="soft">This recording has no device.</p>;
  return (
    <>
      <div class="zoom">
        <label>device <select value={String(stream)} onChange={(event) => chooseStream(Number(event.currentTarget.value))}>
          {streams.map((each, place) => <option key={place} value={String(place)}>{each.device} / {each.stream}</option>)}
        </select></label>
        {replicates.length > 1 && (
          <label>replicate <select value={String(replicate)} onChange={(event) => chooseReplicate(Number(event.currentTarget.value))}>
            {replicates.map((each) => <option key={each} value={String(each)}>{each}</option>)}
          </select></label>
        )}
      </div>
      <Samples key={`${stream} ${replicate}`} at={{ campaign, folder, ...one, replicate }} />
    </>
  );
}

function NoiseValues({ manifest, campaign, folder }: { manifest: Manifest; campaign: string; folder: string }) {
  const names = manifest.devices.map((one) => one.name);
  const [device, choose] = useState(names[0] ?? "");
  return (
    <details>
      <summary>Noise values for a program</summary>
      {names.length > 1 && (
        <label>device <select value={device} onChange={(event) => choose(event.currentTarget.value)}>{names.map((one) => <option key={one} value={one}>{one}</option>)}</select></label>
      )}
      <Consumers path="/v1/export" fields={{}} asked={{ campaign, folder, device }} />
    </details>
  );
}

export function Recording({ campaign, folder }: { campaign: string; folder: string }) {
  const { answer, problem } = useLoaded(() => get("/v1/recordings/{campaign}/{folder}", { campaign, folder }), `${campaign}/${folder}`);
  const known = useLoaded(() => get("/v1/calibrations", {}, { campaign }), campaign).answer;
  const calibration = known?.calibrations.find((one) => one.folder === folder);
  const back = <p><a href="#/devices">All devices</a></p>;
  if (problem) return <Empty title={`No recording ${folder}`} sentence={problem}>{back}</Empty>;
  if (!answer) return <Loading />;
  return (
    <div class="list">
      {back}
      <h1>{folder}</h1>
      <p class="soft">{campaign} · {answer.closed ? summary(answer.replicates) : "not closed: while it records, its latest samples are on the bench"}</p>
      {shortfalls(answer.replicates).length > 0 && <ul class="alarm">{shortfalls(answer.replicates).map((one) => <li key={one}>{one}</li>)}</ul>}
      {calibration && <p>{calibrationWords(calibration)}</p>}
      {calibration && calibration.fitted > 0 && <NoiseValues manifest={answer} campaign={campaign} folder={folder} />}
      <Choices manifest={answer} campaign={campaign} folder={folder} />
    </div>
  );
}
