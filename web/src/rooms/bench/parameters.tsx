// Each parameter of a channel so far, and how much longer to record for it.
import { useEffect, useState } from "preact/hooks";
import { get } from "../../api/client";
import type { LiveParameter, LiveParameters } from "../../api/schema";
import { coefficientText } from "../../parts/coefficients";
import { Skeleton } from "../../parts/states";

const precisions = [["0.3", "±30 %"], ["0.1", "±10 %"], ["0.03", "±3 %"], ["0.01", "±1 %"]] as const;
const kAgain = 15; // s of recording

function Row({ one }: { one: LiveParameter }) {
  const coefficient = one.coefficient;
  if (!coefficient) return null;
  const enough = one.enough_in_s === 0;
  return (
    <tr>
      <th scope="row">{coefficient.symbol} <span class="soft">{coefficient.title}</span></th>
      <td>{coefficientText(coefficient, one.observability === "observed")}</td>
      <td class="words"><span class={`badge ${enough ? "good" : one.observability === "observed" ? "doubt" : "plain"}`}>{enough ? "long enough" : "record longer"}</span> {one.sentence}</td>
    </tr>
  );
}

export function Parameters({ asked, elapsed }: { asked: { campaign: string; device: string; stream: string; channel: string }; elapsed: number }) {
  const [precision, choose] = useState("0.1");
  const [known, learn] = useState<LiveParameters | null>(null);
  const [problem, tell] = useState("");
  useEffect(() => {
    let over = false;
    get("/v1/live/parameters", {}, { ...asked, precision })
      .then((answer) => { if (!over) { learn(answer); tell(""); } }, (error: Error) => { if (!over) tell(error.message); });
    return () => { over = true; };
  }, [asked.campaign, asked.device, asked.stream, asked.channel, precision, Math.floor(elapsed / kAgain)]);
  return (
    <div class="parameters">
      <header>
        <h2>Long enough?</h2>
        <span class="fill" />
        <label>wanted <select value={precision} onChange={(event) => choose(event.currentTarget.value)}>
          {precisions.map(([value, title]) => <option key={value} value={value}>{title}</option>)}
        </select></label>
      </header>
      {problem && <p class="soft">{problem}</p>}
      {!known && !problem && <Skeleton lines={3} />}
      {known?.trouble && <p class="soft">{known.trouble}</p>}
      {known && !known.trouble && (
        <div class="scroll" tabIndex={0} role="group" aria-label="parameters">
          <table class="rows">
            <caption>By the model {known.model}, with 95 % intervals</caption>
            <thead><tr>{["parameter", "so far", "long enough?"].map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>
            <tbody>{known.parameters.map((one) => <Row key={`${one.term} ${one.coefficient?.symbol ?? ""}`} one={one} />)}</tbody>
          </table>
        </div>
      )}
    </div>
  );
}
