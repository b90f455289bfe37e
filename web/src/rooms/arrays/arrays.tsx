// The arrays of sensors that were calibrated.
import { get } from "../../api/client";
import { useLoaded } from "../../parts/loaded";
import { Empty, Loading } from "../../parts/states";
import { minute } from "../devices/device_rows";
import { arrayTitle, placesOf } from "./array_rows";

export function Arrays() {
  const { answer, problem } = useLoaded(() => get("/v1/arrays"), "");
  if (problem) return <Empty title="The arrays cannot be listed" sentence={problem} />;
  if (!answer) return <Loading />;
  if (answer.arrays.length === 0)
    return <Empty title="No array was calibrated yet" sentence="Record a device with several angular rates or accelerations, or several devices at once, and let the campaign calibrate with array = true." />;
  return (
    <div class="list">
      <h1>Arrays</h1>
      <div class="scroll" tabIndex={0} role="group" aria-label="arrays">
        <table class="rows">
          <thead><tr>{["array", "campaign", "recorded (UTC)", "sensors"].map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>
          <tbody>
            {placesOf(answer.arrays).reverse().map(({ array, place }) => (
              <tr key={`${array.bench} ${array.folder} ${place}`}>
                <th scope="row"><a href={`#/arrays/${[array.bench, array.folder, String(place)].map(encodeURIComponent).join("/")}`}>{arrayTitle(array)}</a></th>
                <td>{array.bench}</td>
                <td>{minute(Number(array.started_ns) / 1e6)}</td>
                <td>{array.channels.length}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </div>
  );
}
