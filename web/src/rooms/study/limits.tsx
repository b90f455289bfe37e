// What was not seen, and how strong it would have to be to be seen.
import type { Study } from "../../api/schema";
import { number } from "../../parts/numbers";

export function Limits({ study }: { study: Study }) {
  const all = study.diagnosis?.limits ?? [];
  if (all.length === 0) return null;
  return (
    <details class="limits">
      <summary>What these data could have shown</summary>
      <table class="rows">
        <caption>An effect of this size is seen nine times in ten</caption>
        <thead><tr>{["effect", "size"].map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>
        <tbody>
          {all.map((one) => (
            <tr key={`${one.effect} ${one.witness} ${one.term} ${one.parameter}`}>
              <th scope="row">{one.effect.replaceAll("_", " ")}{one.witness && ` of ${one.witness}`}</th>
              <td>{one.parameter.replaceAll("_", " ")} {number(one.value)}{one.unit && one.unit !== "1" && ` ${one.unit}`}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </details>
  );
}
