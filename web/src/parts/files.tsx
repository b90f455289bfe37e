// What was recognised in files, and every fault that was found.
import type { Preflight } from "../api/schema";
import { sameWords } from "./same_words";

const many = 4;

const nameOf = (file: Preflight): string => file.file.split("/").pop() ?? file.file;

const sum = (of: readonly Preflight[], one: (file: Preflight) => string): number => of.reduce((total, file) => total + Number(one(file)), 0);

function One({ file }: { file: Preflight }) {
  return (
    <details class="file" open={file.findings.length > 0}>
      <summary>{nameOf(file)}: {file.findings.length === 0 ? "no faults found" : `${file.findings.length} ${file.findings.length === 1 ? "finding" : "findings"}`},{" "}
        {file.used} of {file.samples} samples used</summary>
      <ul>
        {file.findings.map((one) => <li key={one.text}><span aria-hidden="true">{one.left_out ? "✂" : "?"}</span> {one.text}</li>)}
        {file.recognised.map((one) => <li key={one} class="soft">{one}</li>)}
      </ul>
    </details>
  );
}

/** What holds for many files is said once. */
function Together({ of }: { of: readonly Preflight[] }) {
  return (
    <details class="file">
      <summary>{of.length} files: no faults found, {sum(of, (one) => one.used)} of {sum(of, (one) => one.samples)} samples used</summary>
      <ul>
        {sameWords(of.map((one) => ({ name: nameOf(one), sentences: one.recognised }))).map((one) => <li key={one} class="soft">{one}</li>)}
      </ul>
    </details>
  );
}

export function Files({ of }: { of: readonly Preflight[] }) {
  const sound = of.filter((one) => one.findings.length === 0);
  const alone = sound.length >= many ? of.filter((one) => one.findings.length > 0) : of;
  return (
    <>
      {alone.map((one) => <One key={one.file} file={one} />)}
      {sound.length >= many && <Together of={sound} />}
    </>
  );
}
