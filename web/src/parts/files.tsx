// What was recognised in files, and every fault that was found.
import type { Preflight } from "../api/schema";

export function Files({ of }: { of: readonly Preflight[] }) {
  return (
    <>
      {of.map((file) => (
        <details key={file.file} class="file" open={file.findings.length > 0}>
          <summary>{file.file.split("/").pop()}: {file.findings.length === 0 ? "no faults found" : `${file.findings.length} ${file.findings.length === 1 ? "finding" : "findings"}`},{" "}
            {file.used} of {file.samples} samples used</summary>
          <ul>
            {file.findings.map((one) => <li key={one.text}><span aria-hidden="true">{one.left_out ? "✂" : "?"}</span> {one.text}</li>)}
            {file.recognised.map((one) => <li key={one} class="soft">{one}</li>)}
          </ul>
        </details>
      ))}
    </>
  );
}
