// What is happening: campaigns, their devices, what is wrong, how long still.
import { useEffect, useState } from "preact/hooks";
import { post } from "../../api/client";
import type { CampaignState, LiveDevice, LiveReplicate } from "../../api/schema";
import { focus } from "../../parts/focus";
import { duration } from "../../parts/numbers";
import { Empty, Loading, Trouble } from "../../parts/states";
import { campaigns, listCampaigns, live, mayChange, rejected } from "../../state";
import { Sparkline } from "./sparkline";
import { deviceFacts, lastError } from "./stream_words";

const phases: Record<string, string> = {
  settling: "waits until the sensors are still", recording: "records", pausing: "pauses", calibrating: "calibrates",
  publishing: "publishes", waiting: "waits for the next recording", held_up: "held up", finished: "finished",
};

function Stop({ state, replicate, onDone }: { state: CampaignState; replicate: LiveReplicate | undefined; onDone: (problem: string) => void }) {
  const [asking, ask] = useState(false);
  const [asked, note] = useState(false); // the button takes the focus back
  const name = state.campaign?.name ?? "";
  const stop = (): void => {
    ask(false);
    post("/v1/campaigns/{campaign}/stop", { campaign: name }, { recording: state.recording })
      .then(() => onDone(""), (error: Error) => onDone(error.message));
  };
  const begin = (): void => {
    note(true);
    ask(true);
  };
  if (!asking) return <button type="button" ref={asked ? focus : null} disabled={!mayChange.value} onClick={() => (state.recording ? begin() : stop())}>Stop</button>;
  const elapsed = Math.max(0, ...(replicate?.devices.map((one) => one.elapsed_s) ?? []));
  return (
    <div class="ask" role="alertdialog" aria-label="Stop the recording?" onKeyDown={(event) => { if (event.key === "Escape") ask(false); }}>
      <span>This ends recording {state.recording}. Replicate {replicate?.replicate ?? state.status?.replicate} is cut after {duration(elapsed)}; replicates before it stay.</span>
      <button type="button" class="main" onClick={stop}>Stop it</button>
      <button type="button" ref={focus} onClick={() => ask(false)}>Go on</button>
    </div>
  );
}

function Row({ campaign, device }: { campaign: string; device: LiveDevice }) {
  const facts = deviceFacts(device);
  return (
    <tr class={device.warnings.length > 0 || device.disk_trouble ? "doubt" : ""}>
      <th scope="row"><a href={`#/bench/${encodeURIComponent(campaign)}/${encodeURIComponent(device.device)}`}>{device.device}</a></th>
      <td><Sparkline channel={device.last_minute} /></td>
      <td class={facts.rateOff ? "alarm" : ""}>{facts.rate}</td>
      <td class={facts.missing !== "0" ? "alarm" : ""}>{facts.missing}</td>
      <td class={device.refused !== "0" ? "alarm" : ""}>{device.refused}</td>
      <td>{facts.temperature}</td>
      <td>{duration(device.elapsed_s)}</td>
      <td class={device.disk_trouble || device.warnings.length > 0 ? "alarm" : "soft"}>{lastError(device)}</td>
    </tr>
  );
}

function Devices({ replicate }: { replicate: LiveReplicate }) {
  return (
    <div class="scroll" tabIndex={0} role="group" aria-label={`devices of ${replicate.campaign}`}>
      <table class="devices">
        <thead><tr>{["device", "last minute", "rate", "missing", "rejected", "temperature", "recorded", "last error"].map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>
        <tbody>
          {replicate.devices.map((one) => <Row key={one.device} campaign={replicate.campaign} device={one} />)}
        </tbody>
      </table>
    </div>
  );
}

function Campaign({ state }: { state: CampaignState }) {
  const [problem, tell] = useState("");
  const name = state.campaign?.name ?? "";
  const replicate = live.value.get(name);
  const told = state.status?.phase ?? "";
  const finished = told === "finished" && state.status?.reason !== "stopped"; // its schedule asks for no more
  const start = (): void => {
    post("/v1/campaigns/{campaign}/start", { campaign: name }, { once: finished }).then(() => tell(""), (error: Error) => tell(error.message));
  };
  const phase = state.running || finished ? phases[told] ?? "starts" : "stopped";
  return (
    <section class="campaign" aria-label={name}>
      <header>
        <h2 title={name}>{name}</h2>
        <span class={`badge ${state.trouble ? "alarm" : state.recording ? "good" : "plain"}`}>{phase}</span>
        {state.recording && <span class="soft">{state.recording} · replicate {state.status?.replicate} of {state.status?.replicates}</span>}
        <span class="fill" />
        {state.left_s !== undefined && <span>{duration(state.left_s)} left</span>}
        {state.running
          ? <Stop state={state} replicate={replicate} onDone={tell} />
          : <button type="button" class="main" disabled={!mayChange.value} onClick={start}>{finished ? "Record again" : "Start"}</button>}
      </header>
      {state.progress !== undefined && <progress max={1} value={state.progress} aria-label={`progress of ${name}`} />}
      {state.trouble && <p class="alarm" role="alert">{state.trouble}</p>}
      {state.status?.reason && !state.trouble && <p class="soft">{state.status.reason}</p>}
      {problem && <Trouble sentence={problem} onClose={() => tell("")} />}
      {replicate
        ? <Devices replicate={replicate} />
        : <p class="soft">{(state.campaign?.devices ?? []).map((one) => one.name).join(", ")}: {state.campaign?.replicates} {state.campaign?.replicates === 1 ? "replicate" : "replicates"} of {duration(state.campaign?.length_s ?? 0)}.</p>}
    </section>
  );
}

// Campaign files that imunoised does not take: what is wrong, and where.
const Rejected = () => (
  <section class="trouble" role="alert" aria-label="Campaign files that are not used">
    <ul>
      {rejected.value.map((one) => (
        <li key={one.file}>
          <strong>{one.file}</strong> is not used. Mend it, then send SIGHUP to imunoised:
          <ul>{one.problems.map((problem) => <li key={problem}>{problem.replace(`${one.file}:`, "line ")}</li>)}</ul>
        </li>
      ))}
    </ul>
  </section>
);

export function Bench() {
  const wrong = rejected.value.length > 0; // that they were mended is no event
  useEffect(() => {
    const look = (): void => void listCampaigns().catch(() => undefined);
    look();
    const again = wrong ? setInterval(look, 5000) : undefined;
    return () => clearInterval(again);
  }, [wrong]);
  if (campaigns.value === null) return <Loading />;
  const all = [...campaigns.value.values()];
  return (
    <div class="bench">
      {all.length > 0 && <h1 class="visually-hidden">Bench</h1>}
      {wrong && <Rejected />}
      {all.length === 0 && <Empty title="The bench is empty" sentence="Put a campaign file, such as config/emulated.toml, into the folder that imunoised was started with, then send SIGHUP to imunoised." />}
      {all.map((one) => <Campaign key={one.campaign?.name} state={one} />)}
    </div>
  );
}
