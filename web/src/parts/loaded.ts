// What a room asks the service for once: nothing yet, an answer, or a sentence that says why there is none.
import { useEffect, useState } from "preact/hooks";

export interface Loaded<Answer> {
  readonly answer?: Answer;
  readonly problem?: string;
}

/** Asks again when `of` changes; a late answer to an earlier question is dropped. */
export function useLoaded<Answer>(ask: () => Promise<Answer>, of: string): Loaded<Answer> {
  const [loaded, set] = useState<Loaded<Answer>>({});
  useEffect(() => {
    let asked = true;
    set({});
    ask().then(
      (answer) => { if (asked) set({ answer }); },
      (error: Error) => { if (asked) set({ problem: error.message }); },
    );
    return () => { asked = false; };
  }, [of]);
  return loaded;
}
