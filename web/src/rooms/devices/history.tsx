// A device's parameters over its recordings, and whether the newest calibration fits the earlier ones.
import { get } from "../../api/client";
import type { History as Answer, HistoryPoint, ParameterHistory } from "../../api/schema";
import { Picture } from "../../figure/picture";
import { calibrationWords } from "../../parts/calibration_words";
import { useLoaded } from "../../parts/loaded";
import { Empty, Loading } from "../../parts/states";
import { minute, recordingsOf } from "./device_rows";
import { parameterRow, pointRows } from "./parameter_rows";

const moods = { changed: "alarm", drift: "alarm", compatible: "good", "not compared": "plain" } as const;

function Overview({ history }: { history: Answer }) {
  return (
    <div class="scroll" tabIndex={0} role="group" aria-label="newest calibration">
      <table class="rows">
        <caption>The newest calibration against the earlier ones, with 95 % intervals</caption>
        <thead><tr>{["parameter", "newest", "expected", "unit", "change", "verdict"].map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>
        <tbody>
          {history.parameters.map(parameterRow).map((one) => (
            <tr key={one.name}>
              <th scope="row">{one.name}</th><td>{one.newest}</td><td>{one.expected}</td><td>{one.unit}</td><td>{one.change}</td>
              <td><span class={`badge ${moods[one.verdict]}`}>{one.verdict}</span></td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

const Points = ({ device, one }: { device: string; one: ParameterHistory }) => (
  <details>
    <summary>{one.channel}: {one.title || one.parameter}, {one.points.length === 1 ? "one calibration" : `${one.points.length} calibrations`}</summary>
    {one.points.length > 1 && (
      <Picture path="/v1/history/figure" version={one.points.at(-1)?.started_ns ?? ""}
        asked={{ device, stream: one.stream, channel: one.channel, term: one.term, parameter: one.parameter }} />
    )}
    <table class="rows">
      <thead><tr>{["recorded (UTC)", `value, ${parameterRow(one).unit}`, "model"].map((title) => <th scope="col" key={title}>{title}</th>)}</tr></thead>
      <tbody>
        {pointRows(one).map((point) => (
          <tr key={point.started}><th scope="row">{minute(point.started)}</th><td>{point.value}</td><td class="mono">{point.model}</td></tr>
        ))}
      </tbody>
    </table>
  </details>
);

// Whether its models fit.
function Newest({ points }: { points: readonly HistoryPoint[] }) {
  const newest = points.at(-1);
  const { answer } = useLoaded(() => get("/v1/calibrations", {}, { campaign: newest?.bench ?? "" }), `${newest?.bench} ${newest?.folder}`);
  const one = answer?.calibrations.find((each) => each.folder === newest?.folder);
  return one ? <p>{calibrationWords(one)}</p> : null;
}

function Recordings({ device }: { device: string }) {
  const { answer } = useLoaded(() => get("/v1/recordings"), device);
  const all = recordingsOf(answer?.recordings ?? [], device);
  if (all.length === 0) return null;
  return (
    <details>
      <summary>{all.length === 1 ? "One recording" : `${all.length} recordings`}</summary>
      <ul class="plain-list">
        {all.map((one) => <li key={`${one.bench} ${one.folder}`}><a href={`#/recordings/${encodeURIComponent(one.bench)}/${encodeURIComponent(one.folder)}`}>Samples of {one.folder}</a> <span class="soft">{one.bench}{one.calibrated ? ", calibrated" : ""}</span></li>)}
      </ul>
    </details>
  );
}

export function History({ device }: { device: string }) {
  const { answer, problem } = useLoaded(() => get("/v1/history", {}, { device }), device);
  const back = <p><a href="#/devices">All devices</a></p>;
  if (problem) return <Empty title={`No history of ${device}`} sentence={problem}>{back}<Recordings device={device} /></Empty>;
  if (!answer) return <Loading />;
  return (
    <div class="list">
      {back}
      <h1>{answer.device?.id ?? device}</h1>
      <p class={answer.alarm ? "alarm" : ""} role="status">{answer.summary}</p>
      <Newest points={answer.parameters[0]?.points ?? []} />
      <Overview history={answer} />
      {answer.notes.map((one) => <p class="soft" key={one}>{one}</p>)}
      <Recordings device={answer.device?.id ?? device} />
      <h2>Calibrations</h2>
      {answer.parameters.map((one) => <Points key={`${one.stream} ${one.channel} ${one.term} ${one.parameter}`} device={device} one={one} />)}
    </div>
  );
}
