// Noise values for other programs: the service knows which.
import { useState } from "preact/hooks";
import { type Fields, get, getText } from "../api/client";
import type { ExportConsumer } from "../api/schema";
import { useLoaded } from "./loaded";
import { saveText } from "./save";
import { Trouble } from "./states";

/** "kalibr_imu.yaml": the program's customary name without its folders, or the program's own. */
export function fileName(consumer: ExportConsumer): string {
  const last = consumer.file.split("/").at(-1) ?? "";
  return /^[\w.-]+\.\w+$/.test(last) ? `${consumer.name}_${last}`.replace(/^(\w+)_\1/, "$1") : `${consumer.name}.txt`;
}

/** A form: which program, and whether its values shall bound what it cannot express. */
export function Consumers({ path, fields, asked }: { path: string; fields: Fields; asked: Fields }) {
  const { answer, problem } = useLoaded(() => get("/v1/consumers"), "");
  const [name, choose] = useState("");
  const [conservative, bound] = useState(false);
  const [text, show] = useState("");
  const [trouble, tell] = useState("");
  const all = answer?.consumers ?? [];
  const one = all.find((each) => each.name === name) ?? all[0];
  if (problem) return <p class="soft">{problem}</p>;
  if (!one) return null;
  const ask = (then: (text: string) => void) => (): void => {
    getText(path, fields, { ...asked, consumer: one.name, conservative })
      .then((words) => { then(words); tell(""); }, (error: Error) => { show(""); tell(error.message); });
  };
  return (
    <div class="consumers">
      <div class="zoom">
        <label>program <select value={one.name} onChange={(event) => { choose(event.currentTarget.value); show(""); }}>
          {all.map((each) => <option key={each.name} value={each.name}>{each.title}</option>)}
        </select></label>
        <label><input type="checkbox" checked={conservative} onChange={(event) => { bound(event.currentTarget.checked); show(""); }} /> bound what it cannot express (conservative)</label>
        <button type="button" onClick={ask(show)}>Show</button>
        <button type="button" class="main" onClick={ask((words) => saveText(words, "text/plain", fileName(one)))}>Save</button>
      </div>
      <p class="soft">{one.title} holds {one.holds}.{one.remark && ` ${one.remark}`}</p>
      {trouble && <Trouble sentence={trouble} onClose={() => tell("")} />}
      {text && <pre class="mono values" tabIndex={0} aria-label={`values for ${one.title}`}>{text}</pre>}
    </div>
  );
}
