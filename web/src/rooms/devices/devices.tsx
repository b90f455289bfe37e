// Every device of the bench: how often it was recorded and calibrated, and what it does now.
import { get } from "../../api/client";
import { useLoaded } from "../../parts/loaded";
import { Empty, Loading } from "../../parts/states";
import { campaigns, live } from "../../state";
import { deviceFacts } from "../bench/stream_words";
import { type DeviceRow, deviceRows, deviceState, liveOf, minute } from "./device_rows";

const titles = ["device", "name", "recordings", "calibrated", "newest (UTC)", "rate", "missing", "temperature", "now"];

function Row({ row }: { row: DeviceRow }) {
  const now = liveOf(row, live.value);
  const state = deviceState(now);
  const facts = deviceFacts(now);
  return (
    <tr>
      <th scope="row"><a href={`#/devices/${encodeURIComponent(row.id)}`}>{row.id}</a></th>
      <td>{row.name}</td>
      <td>{row.recordings}</td>
      <td>{row.calibrated}</td>
      <td>{minute(row.newest)}</td>
      <td class={facts.rateOff ? "alarm" : ""}>{facts.rate}</td>
      <td class={facts.missing !== "0" && facts.missing !== "–" ? "alarm" : ""}>{facts.missing}</td>
      <td>{facts.temperature}</td>
      <td class={state.alarm ? "alarm" : "soft"}>{state.words}</td>
    </tr>
  );
}

export function Devices() {
  const recordings = [...(campaigns.value?.values() ?? [])].map((one) => one.recording).join(" ");
  const { answer, problem } = useLoaded(() => get("/v1/recordings"), recordings);
  if (problem) return <Empty title="The devices cannot be listed" sentence={problem} />;
  if (!answer) return <Loading />;
  const rows = deviceRows(answer.recordings);
  if (rows.length === 0) return <Empty title="No device was recorded yet" sentence="Start a campaign on the bench; its devices then stand here." />;
  return (
    <div class="list">
      <h1>Devices</h1>
      <div class="scroll" tabIndex={0} role="group" aria-label="devices">
        <table class="rows">
          <thead><tr>{titles.map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>
          <tbody>{rows.map((one) => <Row key={one.id} row={one} />)}</tbody>
        </table>
      </div>
    </div>
  );
}
