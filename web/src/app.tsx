// The frame around the rooms, and the states in which there is no room yet.
import { duration } from "./parts/numbers";
import { Empty, Loading } from "./parts/states";
import { SignIn } from "./parts/sign_in";
import { ArrayRoom } from "./rooms/arrays/array_room";
import { Arrays } from "./rooms/arrays/arrays";
import { Bench } from "./rooms/bench/bench";
import { LiveDevice } from "./rooms/bench/live_device";
import { Devices } from "./rooms/devices/devices";
import { History } from "./rooms/devices/history";
import { Fleet } from "./rooms/fleet/fleet";
import { Recording as RecordingRoom } from "./rooms/recordings/recording";
import { Studies } from "./rooms/study/studies";
import { StudyRoom } from "./rooms/study/study_room";
import { campaigns, connected, knownHere, mayChange, place, session, trouble } from "./state";

const rooms = [
  { word: "bench", title: "Bench", ifBench: true },
  { word: "studies", title: "Studies", ifBench: false },
  { word: "devices", title: "Devices", ifBench: true },
  { word: "fleet", title: "Fleet", ifBench: true },
  { word: "arrays", title: "Arrays", ifBench: true },
];

const here = (): string => place.value[0] ?? (session.value?.bench ? "bench" : "studies");

// Rooms of a service that records; null: none of them.
function BenchRoom() {
  const [room, name = "", second = "", third = ""] = [here(), ...place.value.slice(1)];
  switch (room) {
    case "bench": return name && second ? <LiveDevice key={`${name}/${second}`} campaign={name} name={second} /> : <Bench />;
    case "devices": return name ? <History key={name} device={name} /> : <Devices />;
    case "fleet": return <Fleet key={name} type={name} />;
    case "arrays": return name ? <ArrayRoom key={`${name}/${second}/${third}`} campaign={name} folder={second} place={Number(third)} /> : <Arrays />;
    case "recordings": return <RecordingRoom key={`${name}/${second}`} campaign={name} folder={second} />;
    default: return <Empty title="There is no such page" sentence="Choose a room at the top." />;
  }
}

function Room() {
  if (trouble.value) return <Empty title="imunoise does not answer" sentence={trouble.value} />;
  if (!session.value) return <Loading />;
  if (!knownHere.value) return <SignIn />;
  const name = place.value[1];
  if (here() === "studies") return name ? <StudyRoom key={name} name={name} /> : <Studies />;
  if (session.value.bench) return <BenchRoom />;
  return <Empty title="There is no such page" sentence="Choose a room at the top." />;
}

function Recording() {
  if (!knownHere.value) return null;
  const now = [...(campaigns.value?.values() ?? [])].find((one) => one.recording);
  if (!now) return null;
  const left = now.left_s === undefined ? "" : ` · ${duration(now.left_s)} left`;
  return <span class="recording"><span class="dot" aria-hidden="true" />{now.campaign?.name} · {now.recording}{left}</span>;
}

export function App() {
  return (
    <>
      <header class="bar">
        <a class="name" href="#/">imunoise</a>
        <nav aria-label="Rooms">
          {rooms.filter((one) => !one.ifBench || session.value?.bench).map((one) => (
            <a key={one.word} href={`#/${one.word}`} aria-current={here() === one.word ? "page" : undefined}>{one.title}</a>
          ))}
        </nav>
        <span class="fill" />
        <Recording />
        {knownHere.value && !mayChange.value && <span class="badge">read only</span>}
        {!connected.value && <span class="badge alarm" role="status">connection lost; trying again</span>}
      </header>
      <main><Room /></main>
    </>
  );
}
