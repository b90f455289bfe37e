// The live Allan deviations of a device, with their narrowing intervals, and whether it was recorded long enough. Asked for while they
// are looked at: events do not bring them.
import { useEffect, useState } from "preact/hooks";
import { get } from "../../api/client";
import type { LiveChannel } from "../../api/schema";
import { duration, number } from "../../parts/numbers";

const kAgain = 10; // s of recording

function Channel({ channel }: { channel: LiveChannel }) {
  const missing = channel.scales.find((one) => one.enough_in_s > 0);
  return (
    <tr>
      <th scope="row">{channel.channel}</th>
      {channel.scales.map((one) => (
        <td key={one.tau_s} class={one.enough_in_s > 0 ? "soft" : ""} title={`${number(one.lower)} … ${number(one.upper)} ${channel.units}, wavelet deviation`}>
          {number(one.deviation, 2)}<small> {number(one.lower, 2)} … {number(one.upper, 2)}</small>
        </td>
      ))}
      <td>{missing ? `${number(missing.tau_s, 2)} s: ${duration(missing.enough_in_s)} more` : "long enough"}</td>
    </tr>
  );
}

function Table({ all }: { all: readonly LiveChannel[] }) {
  const channels = all.filter((one) => one.scales.length > 0);
  const longest = channels.reduce<LiveChannel | undefined>((best, one) => (best && best.scales.length >= one.scales.length ? best : one), undefined);
  if (!longest) return <p class="soft">Too few samples yet.</p>;
  return (
    <div class="scroll" tabIndex={0} role="group" aria-label="all averaging times">
      <table class="deviation">
        <caption>Wavelet deviation over averaging time, with 95 % intervals</caption>
        <thead><tr><th scope="col">channel</th>{longest.scales.map((one) => <th scope="col" key={one.tau_s}>{number(one.tau_s, 2)} s</th>)}<th scope="col">long enough?</th></tr></thead>
        <tbody>{channels.map((one) => <Channel key={`${one.stream} ${one.channel}`} channel={one} />)}</tbody>
      </table>
    </div>
  );
}

export function Deviation({ campaign, device, elapsed }: { campaign: string; device: string; elapsed: number }) {
  const [open, look] = useState(false);
  const [all, learn] = useState<readonly LiveChannel[] | null>(null);
  useEffect(() => {
    let over = false;
    if (open) {
      void get("/v1/live", {}, { campaign, device })
        .then((answer) => { if (!over) learn(answer.replicates[0]?.devices[0]?.channels ?? []); }, () => undefined);
    }
    return () => { over = true; };
  }, [campaign, device, open, Math.floor(elapsed / kAgain)]);
  return (
    <details class="scales" onToggle={(event) => look(event.currentTarget.open)}>
      <summary>All averaging times of all channels</summary>
      {open && all && <Table all={all} />}
    </details>
  );
}
