// All studies, and a new one of what was recorded or opened.
import { useEffect, useState } from "preact/hooks";
import { get, over, post } from "../../api/client";
import type { Preflight, RecordingList } from "../../api/schema";
import { Files } from "../../parts/files";
import { Loading, Progress, Trouble } from "../../parts/states";
import { go, inputs, jobs, listStudies, mayChange, session, studies } from "../../state";
import { freeName } from "./free_name";

interface Source {
  readonly title: string;
  readonly what: { input: string } | { campaign: string; folder: string };
  readonly channels: readonly string[];
  readonly preflight: readonly Preflight[];
}

// A recording's manifest names its channels.
function useChannels(source: Source): readonly string[] {
  const [channels, set] = useState(source.channels);
  useEffect(() => {
    if ("input" in source.what) return;
    void get("/v1/recordings/{campaign}/{folder}", source.what)
      .then((manifest) => set(manifest.devices.flatMap((device) =>
        device.streams.flatMap((stream) => stream.channels.map((one) => `${device.name}/${stream.name}/${one.name}`)))))
      .catch(() => undefined);
  }, []);
  return channels;
}

function New({ source }: { source: Source }) {
  const channels = useChannels(source);
  const [chosen, choose] = useState("");
  const channel = chosen || (channels[0] ?? "");
  const [model, type] = useState("");
  const [id, follow] = useState("");
  const [busy, work] = useState(false);
  const [problem, tell] = useState("");
  const job = jobs.value.get(id);
  const begin = async (event: Event): Promise<void> => {
    event.preventDefault();
    tell("");
    work(true);
    const study = freeName(channel, (studies.value ?? []).map((one) => one.study));
    try {
      let now = await post("/v1/studies", {}, { study, ...source.what, channel, model });
      follow(now.job);
      while (!over(now)) {
        await new Promise((next) => setTimeout(next, 300));
        now = await get("/v1/jobs/{job}", { job: now.job });
        jobs.value = new Map(jobs.value).set(now.job, now);
      }
      if (now.state === "failed") return tell(now.error);
      await listStudies();
      if (now.state === "done") go("studies", study);
    } catch (error) {
      tell((error as Error).message);
    } finally {
      work(false);
    }
  };
  return (
    <form class="new" onSubmit={(event) => void begin(event)}>
      <h2 title={source.title}>{source.title}</h2>
      <label>channel <select value={channel} onChange={(event) => choose(event.currentTarget.value)}>
        {channels.map((one) => <option key={one}>{one}</option>)}
      </select></label>
      <label>first model <input value={model} placeholder="chosen by cross-validation" onInput={(event) => type(event.currentTarget.value)} /></label>
      <button type="submit" class="main" disabled={!mayChange.value || busy}>Study</button>
      <Files of={source.preflight} />
      {job && !over(job) && <Progress job={job} />}
      {problem && <Trouble sentence={problem} onClose={() => tell("")} />}
    </form>
  );
}

function useRecordings(): RecordingList["recordings"] {
  const [all, set] = useState<RecordingList["recordings"]>([]);
  useEffect(() => {
    if (session.value?.bench) void get("/v1/recordings").then((list) => set(list.recordings)).catch(() => undefined);
  }, []);
  return all;
}

export function Studies() {
  const recordings = useRecordings();
  if (studies.value === null) return <Loading />;
  const sources: Source[] = [
    ...inputs.value.map((one) => ({
      title: one.input && one.input.files.length > 1 ? `${one.name} and ${one.input.files.length - 1} more` : one.name,
      what: { input: one.name }, channels: one.channels, preflight: one.preflight,
    })),
    ...[...recordings].reverse().slice(0, 20).map((one) => ({
      title: `${one.bench} · ${one.folder}`,
      what: { campaign: one.bench, folder: one.folder },
      channels: [], preflight: [],
    })),
  ];
  return (
    <div class="studies">
      <section aria-labelledby="new-title">
        <h1 id="new-title">New study</h1>
        {sources.length > 0 && <p class="soft">Choose a channel. imunoise fits a model, shows where it fails, and seeks the effects that it lacks.</p>}
        {sources.length === 0 && <p class="soft">Nothing is recorded yet. {session.value?.bench ? "Start a campaign on the bench." : "Run imunoise open FILES."}</p>}
        {sources.map((one) => <New key={one.title} source={one} />)}
      </section>
      <section aria-labelledby="all-title">
        <h1 id="all-title">Studies</h1>
        {studies.value.length === 0 && <p class="soft">There is no study yet.</p>}
        <ul class="cards">
          {studies.value.map((one) => (
            <li key={one.study}>
              <a href={`#/studies/${encodeURIComponent(one.study)}`}>
                <strong>{one.study}</strong>
                <span class="soft">{one.trouble || `${one.channel} · ${one.attempts === 1 ? "one model" : `${one.attempts} models`}`}</span>
                <span class="mono">{one.model}</span>
              </a>
            </li>
          ))}
        </ul>
      </section>
    </div>
  );
}
