// Everything shown on hover stands in the page's own table of scales: this only picks rows.
for (const section of document.querySelectorAll("section")) {
  const plot = section.querySelector(".plot");
  const table = section.querySelector(".scales");
  const readout = section.querySelector(".readout");
  if (!plot || !table) continue;
  const heads = [...table.tHead.rows[0].cells].map((cell) => cell.textContent);
  const rows = [...table.tBodies[0].rows];
  let current = -1;

  const read = (scale) => {
    if (scale === current || !rows[scale]) return;
    rows[current]?.classList.remove("at");
    current = scale;
    rows[scale].classList.add("at");
    readout.replaceChildren(...heads.map((head, i) => {
      const pair = document.createElement("div");
      pair.append(document.createElement("span"), document.createElement("strong"));
      pair.firstChild.textContent = head;
      pair.lastChild.textContent = rows[scale].cells[i].textContent;
      return pair;
    }));
    for (const svg of plot.querySelectorAll("svg")) {
      const x = svg.querySelector(`.column[data-index="${scale}"]`).dataset.at;
      const guide = svg.querySelector(".guide");
      guide.setAttribute("x1", x);
      guide.setAttribute("x2", x);
    }
    plot.classList.add("reading");
  };

  plot.addEventListener("pointermove", (event) => {
    const scale = event.target.dataset?.index;
    if (scale !== undefined) read(Number(scale));
  });
  plot.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    read(Math.min(rows.length - 1, Math.max(0, current + step)));
  });

  for (const button of section.querySelectorAll(".legend button")) {
    button.addEventListener("click", () => {
      const shown = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", shown);
      for (const layer of plot.querySelectorAll(".layer")) {
        if (layer.dataset.term === button.dataset.term) layer.classList.toggle("hidden", !shown);
      }
    });
  }

  section.querySelector(".copy")?.addEventListener("click", async (event) => {
    const text = section.querySelector("pre");
    try {
      await navigator.clipboard.writeText(text.textContent);
      event.target.textContent = "copied";
    } catch {
      getSelection().selectAllChildren(text);  // no permission: one key press is left to the reader
    }
  });
}
