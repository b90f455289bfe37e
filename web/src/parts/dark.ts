// Whether the page is dark: what is drawn on a canvas has to be drawn again when that changes.
import { useEffect, useState } from "preact/hooks";

const query = "(prefers-color-scheme: dark)";

export function useDark(): boolean {
  const [dark, set] = useState(matchMedia(query).matches);
  useEffect(() => {
    const wanted = matchMedia(query);
    const change = (): void => set(wanted.matches);
    wanted.addEventListener("change", change);
    return () => wanted.removeEventListener("change", change);
  }, []);
  return dark;
}
