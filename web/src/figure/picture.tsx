// A figure of the service that stands beside a table of its points, which is why nothing lies over it.
import { useEffect, useRef, useState } from "preact/hooks";
import { type Fields, getText, type Refused } from "../api/client";
import { useSize } from "./size";

/** `version` changes when the figure may have changed. */
export function Picture({ path, asked, version }: { path: string; asked: Fields; version: string }) {
  const frame = useRef<HTMLDivElement>(null);
  const width = useSize(frame)?.width;
  const [svg, draw] = useState("");
  const [problem, tell] = useState("");
  const words = JSON.stringify(asked);
  useEffect(() => {
    if (!width) return;
    const stop = new AbortController();
    getText(path, {}, { ...asked, width }, stop.signal)
      .then((text) => { draw(text); tell(""); })
      .catch((error: Refused) => { if (!stop.signal.aborted) { draw(""); tell(error.message); } });
    return () => stop.abort();
  }, [path, words, version, width]);
  return (
    <div class="picture-frame" ref={frame}>
      {problem ? <p class="soft">{problem}</p> : <div dangerouslySetInnerHTML={{ __html: svg }} />}
    </div>
  );
}
