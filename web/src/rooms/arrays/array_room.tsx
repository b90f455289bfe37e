// One array: which sensors share noise, and the quietest virtual sensor.
import { useState } from "preact/hooks";
import { get } from "../../api/client";
import type { ArrayReport, SensorBudget, VirtualSensor } from "../../api/schema";
import { Picture } from "../../figure/picture";
import { useLoaded } from "../../parts/loaded";
import { number } from "../../parts/numbers";
import { Empty, Loading } from "../../parts/states";
import { arrayTitle, gainRows, gainSentence, pairVerdict, shareTerms, weightRows } from "./array_rows";

interface At {
  readonly campaign: string;
  readonly folder: string;
  readonly array: number;
}

const Head = ({ titles }: { titles: readonly string[] }) => <thead><tr>{titles.map((one) => <th scope="col" key={one}>{one}</th>)}</tr></thead>;

function Emphasis({ report, value, onChoose }: { report: ArrayReport; value: number; onChoose: (value: number) => void }) {
  const chosen = report.trade_offs[value];
  const words = chosen ? `quiet at averaging times about ${chosen.scales}` : `as calibrated: quiet at ${report.virtual_sensor?.scales === "all" ? "all" : report.virtual_sensor?.scales} averaging times`;
  if (report.trade_offs.length === 0) return <p class="soft">{words}. Calibrate again to choose between short and long averaging times.</p>;
  return (
    <label class="slider">short averaging times
      <input type="range" min={-1} max={report.trade_offs.length - 1} step={1} value={value} aria-label="averaging times to be quiet at" aria-valuetext={words}
        onInput={(event) => onChoose(Number(event.currentTarget.value))} />
      long <strong>{words}</strong>
    </label>
  );
}

function Virtual({ report, at }: { report: ArrayReport; at: At }) {
  const [emphasis, choose] = useState(-1);
  const sensor: VirtualSensor | undefined = report.trade_offs[emphasis] ?? report.virtual_sensor;
  if (!sensor) return null;
  const asked = { ...at, ...(emphasis >= 0 ? { emphasis } : {}) };
  return (
    <section aria-label="Virtual sensor">
      <h2>Virtual sensor</h2>
      <Emphasis report={report} value={emphasis} onChoose={choose} />
      <p role="status">{gainSentence(sensor)}{sensor.plain_mean && " On held-out replicates the best weights were noisier than equal ones: equal weights are given."}</p>
      <div class="pair">
        <Picture path="/v1/array/figure" asked={{ ...asked, view: "gain" }} version={report.summary} />
        <Picture path="/v1/array/figure" asked={{ ...asked, view: "weights" }} version={report.summary} />
      </div>
      <details>
        <summary>Weights and gains as numbers</summary>
        <div class="pair">
          <table class="rows"><caption>Weights</caption><Head titles={["sensor", "weight ± standard error"]} />
            <tbody>{weightRows(sensor).map((one) => <tr key={one.sensor}><th scope="row">{one.sensor}</th><td>{one.weight}</td></tr>)}</tbody></table>
          <table class="rows"><caption>Wavelet variance over that of the mean</caption><Head titles={["averaging time, s", "by the model", "held-out replicates"]} />
            <tbody>{gainRows(sensor).map((one) => <tr key={one.tau}><th scope="row">{one.tau}</th><td>{one.predicted}</td><td>{one.measured}</td></tr>)}</tbody></table>
        </div>
      </details>
    </section>
  );
}

function Shared({ report, at }: { report: ArrayReport; at: At }) {
  const correlated = report.parameters.filter((one) => one.correlation !== undefined);
  return (
    <section aria-label="Shared noise">
      <h2>Shared noise</h2>
      <Picture path="/v1/array/figure" asked={{ ...at, view: "covariances" }} version={report.summary} />
      <div class="scroll" tabIndex={0} role="group" aria-label="pairs">
        <table class="rows">
          <caption>Which sensors share noise</caption>
          <Head titles={["sensors", "strongest at, s", "correlation there", "p", "verdict"]} />
          <tbody>
            {report.pairs.map((one) => (
              <tr key={`${one.first} ${one.second}`}>
                <th scope="row">{one.first}, {one.second}</th>
                <td>{number(one.strongest_tau_s)}</td><td>{number(one.correlation, 2)}</td><td>{one.adjusted_p_value < 1e-4 ? "< 0.0001" : number(one.adjusted_p_value, 2)}</td>
                <td><span class={`badge ${one.dependent ? "doubt" : "plain"}`}>{pairVerdict(one)}</span></td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      {correlated.length > 0 && (
        <>
          <h2>Correlation of each process</h2>
          <Picture path="/v1/array/figure" asked={{ ...at, view: "correlations" }} version={report.summary} />
          <table class="visually-hidden"><caption>Correlation of each process</caption><Head titles={["term", "sensors", "correlation", "interval"]} />
            <tbody>{correlated.map((one) => <tr key={`${one.term} ${one.sensors.join()}`}><th scope="row">{one.term}</th><td>{one.sensors.join(", ")}</td><td>{number(one.correlation)}</td><td>{number(one.correlation_lower)} … {number(one.correlation_upper)}</td></tr>)}</tbody></table>
        </>
      )}
    </section>
  );
}

const Shares = ({ budgets, terms }: { budgets: readonly SensorBudget[]; terms: readonly string[] }) => (
  <div class="scroll" tabIndex={0} role="group" aria-label="shares">
    <table class="rows">
      <caption>What explains each sensor's noise, over all averaging times</caption>
      <Head titles={["sensor", ...terms]} />
      <tbody>{budgets.map((one) => <tr key={one.sensor}><th scope="row">{one.sensor}</th>{one.terms.map((term) => <td key={term.term}>{number(100 * term.share, 2)} %</td>)}</tr>)}</tbody>
    </table>
  </div>
);

export function ArrayRoom({ campaign, folder, place }: { campaign: string; folder: string; place: number }) {
  const { answer, problem } = useLoaded(() => get("/v1/arrays/{campaign}/{folder}", { campaign, folder }), `${campaign}/${folder}`);
  const back = <p><a href="#/arrays">All arrays</a></p>;
  if (problem) return <Empty title="This array cannot be shown" sentence={problem}>{back}</Empty>;
  if (!answer) return <Loading />;
  const one = answer.arrays[place];
  if (!one) return <Empty title="There is no such array" sentence="Choose one of the list.">{back}</Empty>;
  const troubles = one.troubles.map((trouble) => <p class="alarm" key={trouble.message}>{trouble.step}: {trouble.message}</p>);
  const report = one.report;
  const at = { campaign, folder, array: place };
  const misfits = report?.sensor_fits.filter((fit) => !fit.fits).map((fit) => fit.sensor) ?? [];
  return (
    <div class="list array">
      {back}
      <h1>{arrayTitle(one)}</h1>
      <p class="soft">{campaign} · {folder}{report && ` · ${report.model} · ${number(report.rate_hz, 4)} Hz · ${report.replicates} replicates`}</p>
      {troubles}
      {report && report.sensors.length > 0 && (
        <>
          <p role="status" class={misfits.length ? "alarm" : ""}>{report.summary}</p>
          <Virtual report={report} at={at} />
          <Shared report={report} at={at} />
          <Shares budgets={report.budgets} terms={shareTerms(report)} />
          {report.notes.map((note) => <p class="soft" key={note}>{note}</p>)}
        </>
      )}
    </div>
  );
}
