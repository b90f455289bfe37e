// The live Allan deviations of a device, with their narrowing intervals, and whether it was recorded long enough.
import type { LiveChannel, LiveDevice } from "../../api/schema";
import { duration, number } from "../../parts/numbers";

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

export function Deviation({ device }: { device: LiveDevice }) {
  const channels = device.channels.filter((one) => one.scales.length > 0);
  const longest = channels.reduce<LiveChannel | undefined>((best, one) => (best && best.scales.length >= one.scales.length ? best : one), undefined);
  if (!longest) return <p class="soft">Too few samples yet.</p>;
  return (
    <div class="scroll">
      <table class="deviation">
        <caption>Wavelet deviation over averaging time, with 95 % intervals</caption>
        <thead><tr><th scope="col">channel</th>{longest.scales.map((one) => <th scope="col" key={one.tau_s}>{number(one.tau_s, 2)} s</th>)}<th scope="col">long enough?</th></tr></thead>
        <tbody>{channels.map((one) => <Channel key={`${one.stream} ${one.channel}`} channel={one} />)}</tbody>
      </table>
    </div>
  );
}
