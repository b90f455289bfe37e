// What lies over a figure of the service: the cursor, terms that come and go, a hidden table. The figure itself is
// drawn by the service. Works on the SVG's attributes alone (data-term, data-x, data-y, data-sigma).

export interface Place {
  readonly x: number;
  readonly y: number;
  readonly sigma?: number;
}

const value = (element: Element, name: string): number | undefined => {
  const text = element.getAttribute(`data-${name}`);
  return text === null ? undefined : Number(text);
};

/** The measured points of a figure, by x. */
export function places(svg: Element): Place[] {
  const points = [...svg.querySelectorAll('[data-role="measured"] circle.measured')];
  return points.flatMap((point) => {
    const [x, y, sigma] = [value(point, "x"), value(point, "y"), value(point, "sigma")];
    if (x === undefined || y === undefined) return [];
    return [sigma === undefined ? { x, y } : { x, y, sigma }];
  });
}

/** The names of the parts that can be switched off. */
export function terms(svg: Element): string[] {
  const named = [...svg.querySelectorAll('[data-role="term"][data-term]')];
  return [...new Set(named.map((layer) => layer.getAttribute("data-term") ?? ""))];
}

export function showTerm(svg: Element, term: string, shown: boolean): void {
  for (const layer of svg.querySelectorAll(".layer[data-term]"))
    if (layer.getAttribute("data-term") === term) layer.classList.toggle("hidden", !shown);
}

/** Moves the cursor's line to a place; nothing where the figure has none. */
export function pointAt(svg: Element, index: number | null): void {
  const column = index === null ? null : svg.querySelector(`.column[data-index="${index}"]`);
  const guide = svg.querySelector(".guide");
  guide?.classList.toggle("shown", column !== null);
  const at = column?.getAttribute("data-at");
  if (!guide || !at) return;
  guide.setAttribute("x1", at);
  guide.setAttribute("x2", at);
}

/** The place under a pointer's target; null beside all. */
export function indexOf(target: EventTarget | null): number | null {
  const index = target instanceof Element ? target.getAttribute("data-index") : null;
  return index === null ? null : Number(index);
}

/** Titles of the axes: of x, then of y. */
export function axisTitles(svg: Element): [string, string] {
  const titles = [...svg.querySelectorAll(".axis-title")].map((text) => text.textContent ?? "");
  const bottom = [...svg.querySelectorAll('.axis-title[text-anchor="middle"]')].at(-1)?.textContent ?? "x";
  return [bottom, titles.find((title) => title !== bottom) ?? "y"];
}
