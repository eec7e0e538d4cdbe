"use strict";
// The values below the cursor, beside the name of the panel.
const gyrocalReadout = (() => {
  const notes = new WeakMap();
  const show = (chart, panel, u) => {
    const note = u.root.closest(".panel").querySelector(".panel-head span");
    if (!notes.has(note)) notes.set(note, note.textContent);
    const row = u.cursor.idx;
    if (row === null || row === undefined) {
      note.textContent = notes.get(note);
      return;
    }
    const parts = u.series.slice(1).map((series, place) => {
      const value = u.data[place + 1][row];
      const of = 1 + 2 * panel.bands.length;
      return place + 1 < of || value === null ? null : `${series.label} ${series.value(u, value)}`;
    });
    const at = u.series[0].value(u, u.data[0][row]);
    note.textContent = `${at}: ${parts.filter((part) => part !== null).join(", ")} ${panel.unit}`;
  };
  return { show };
})();

(() => {
  const announce = (text) => { document.getElementById("announce").textContent = text; };

  const copy = async (text, button) => {
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      const area = document.createElement("textarea");
      area.value = text;
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    const before = button.textContent;
    button.textContent = "Copied";
    announce("Copied");
    setTimeout(() => { button.textContent = before; }, 1200);
  };

  for (const button of document.querySelectorAll(".copy-command")) {
    button.onclick = () => copy(button.previousElementSibling.textContent, button);
  }

  // The number at the start of a cell, or none.
  const number = (text) => {
    const plain = text.replaceAll("−", "-").replace(/\((\S+) ± \S+\)/u, "$1").replace(/·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/u, (_, raised) =>
      `e${[...raised].map((letter) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(letter)).map((place) => (place ? place - 1 : "-")).join("")}`);
    const found = /^[<>≈ ]*([+-]?\d[\d.]*(?:e[+-]?\d+)?)/.exec(plain.trim());
    return found ? Number(found[1]) : null;
  };

  const sort = (table, place, head) => {
    const down = head.getAttribute("aria-sort") === "ascending";
    const rows = [...table.tBodies[0].rows];
    const key = (row) => row.cells[place].textContent;
    const order = (a, b) => {
      const [x, y] = [number(key(a)), number(key(b))];
      if (x !== null && y !== null) return x - y;
      if (x !== null || y !== null) return x === null ? 1 : -1;
      return key(a).localeCompare(key(b), "en");
    };
    rows.sort((a, b) => (down ? -order(a, b) : order(a, b)));
    table.tBodies[0].append(...rows);
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
  };

  const asText = (table) => [...table.rows]
    .map((row) => [...row.cells].map((cell) => cell.innerText.replace(/\s+/gu, " ").trim()).join("\t"))
    .join("\n");

  for (const table of document.querySelectorAll("table.sortable")) {
    [...table.tHead.rows[0].cells].forEach((head, place) => {
      if (head.classList.contains("fixed")) return;
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sort";
      button.append(...head.childNodes);
      button.onclick = () => sort(table, place, head);
      head.append(button);
    });
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "Copy";
    button.title = "Copy this table, to be pasted into a spreadsheet";
    button.onclick = () => copy(asText(table), button);
    table.caption?.append(button);
  }

  gyrocalCharts.start();
})();
