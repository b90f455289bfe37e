// All serials of a type on one chart.
import { useState } from "preact/hooks";
import { get } from "../../api/client";
import type { FleetParameter } from "../../api/schema";
import { Picture } from "../../figure/picture";
import { useLoaded } from "../../parts/loaded";
import { Empty, Loading } from "../../parts/states";
import { go } from "../../state";
import { fleetRows, keyOf, quartiles, titleOf, unitOf, worstFirst } from "./fleet_rows";

const outliers = (one: FleetParameter): number => one.devices.filter((device) => device.outlier).length;

function Parameter({ type, one }: { type: string; one: FleetParameter }) {
  return (
    <>
      <p class="soft">{quartiles(one)}</p>
      <Picture path="/v1/fleet/figure" version={`${one.devices.length} ${one.median ?? ""}`}
        asked={{ type, stream: one.stream, channel: one.channel, term: one.term, parameter: one.parameter }} />
      <div class="scroll" tabIndex={0} role="group" aria-label="devices">
        <table class="rows">
          <caption>The newest calibration of each device, with its 95 % interval</caption>
          <thead><tr>{["device", unitOf(one), "from the median, σ", "calibrations", "verdict"].map((title) => <th scope="col" key={title}>{title}</th>)}</tr></thead>
          <tbody>
            {fleetRows(one).map((row) => (
              <tr key={row.id}>
                <th scope="row"><a href={`#/devices/${encodeURIComponent(row.id)}`}>{row.name}</a></th>
                <td>{row.value}</td><td>{row.deviation}</td><td>{row.calibrations}</td>
                <td>{row.outlier ? <span class="badge alarm">stands out</span> : ""}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

export function Fleet({ type }: { type: string }) {
  const { answer, problem } = useLoaded(() => get("/v1/fleet", {}, { type }), type);
  const [wanted, choose] = useState("");
  if (problem) return <Empty title="There is no fleet to show" sentence={problem} />;
  if (!answer) return <Loading />;
  const all = worstFirst(answer.parameters);
  const one = all.find((parameter) => keyOf(parameter) === wanted) ?? all[0];
  return (
    <div class="list">
      <header class="list-head">
        <h1>Fleet</h1>
        <span class="fill" />
        <label>type <select value={answer.type} onChange={(event) => go("fleet", event.currentTarget.value)}>
          {answer.types.map((name) => <option key={name} value={name}>{name}</option>)}
        </select></label>
        <label>parameter <select value={one ? keyOf(one) : ""} onChange={(event) => choose(event.currentTarget.value)}>
          {all.map((parameter) => (
            <option key={keyOf(parameter)} value={keyOf(parameter)}>{titleOf(parameter)}{outliers(parameter) ? ` (${outliers(parameter)} out)` : ""}</option>
          ))}
        </select></label>
      </header>
      <p class={all.some(outliers) ? "alarm" : ""} role="status">{answer.summary}</p>
      {answer.notes.map((note) => <p class="soft" key={note}>{note}</p>)}
      {one && <Parameter key={keyOf(one)} type={answer.type} one={one} />}
    </div>
  );
}
