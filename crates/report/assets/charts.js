"use strict";
// The charts: drawn when they come into view, and all of them before printing.
const gyrocalCharts = (() => {
  const PRINT_WIDTH = 690;
  const drawn = new Map();
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const clear = (colour, part) => `color-mix(in srgb, ${colour} ${100 * part}%, transparent)`;

  // A number with as many digits as the scale tells apart.
  const readable = (value, step) => {
    if (value === null || value === undefined) return "–";
    const digits = Math.max(0, Math.min(8, Math.ceil(-Math.log10(step || Math.abs(value) || 1)) + 1));
    return (Math.abs(value) < 1e-4 && value !== 0 ? value.toExponential(2) : value.toFixed(digits)).replace("-", "−");
  };

  const kinds = {
    solid: () => ({}),
    dashed: () => ({ dash: [6, 4], width: 1.25 }),
    points: () => ({ paths: () => null, points: { show: true, size: 5 } }),
    bars: () => ({ paths: uPlot.paths.bars({ size: [0.7, 60] }), width: 0 }),
  };

  // Horizontal and vertical lines with names, in the frame.
  const guides = (panel) => (u) => {
    const ctx = u.ctx;
    const { left, top, width, height } = u.bbox;
    const scale = devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    ctx.strokeStyle = css("expected");
    ctx.fillStyle = css("faint");
    ctx.lineWidth = 1.25 * scale;
    ctx.setLineDash([5 * scale, 4 * scale]);
    ctx.font = `${11 * scale}px system-ui, sans-serif`;
    const line = (x0, y0, x1, y1) => { ctx.beginPath(); ctx.moveTo(x0, y0); ctx.lineTo(x1, y1); ctx.stroke(); };
    for (const level of panel.levels) {
      const y = u.valToPos(level.value, "y", true);
      line(left, y, left + width, y);
    }
    for (const [row, mark] of panel.marks.entries()) {
      const x = u.valToPos(mark.value, "x", true);
      line(x, top, x, top + height);
      const room = ctx.measureText(mark.label).width + 4 * scale;
      ctx.fillText(mark.label, x + room > left + width ? x - room : x + 4 * scale, top + (12 + 13 * row) * scale);
    }
    ctx.restore();
  };

  const shown = (chart, panel) => {
    const tint = (name) => css(name);
    const number = (u, value) => {
      const [low, high] = [u.scales.y.min, u.scales.y.max];
      return chart.logY ? (value === null ? "–" : value.toPrecision(3)) : readable(value, (high - low) / 200);
    };
    const data = [gyrocalData.column(panel.abscissa)];
    const series = [{ label: panel.abscissaTitle, value: (u, value) => readable(value, (u.scales.x.max - u.scales.x.min) / 500) }];
    const bands = [];
    for (const band of panel.bands) {
      const colour = tint(band.tint);
      const edge = { stroke: clear(colour, 0.55), width: 1, points: { show: false }, value: number };
      series.push({ ...edge, label: `${band.label}, lower` }, { ...edge, label: `${band.label}, upper` });
      data.push(gyrocalData.column(band.lower), gyrocalData.column(band.upper));
      bands.push({ series: [data.length - 1, data.length - 2], fill: clear(colour, 0.16) });
    }
    for (const line of panel.lines) {
      const colour = tint(line.tint);
      series.push({
        label: line.label, stroke: colour, width: line.tint === "measured" ? 3 : 1.4, spanGaps: false, value: number,
        fill: line.kind === "bars" ? colour : undefined, points: { show: false }, ...kinds[line.kind](),
      });
      data.push(gyrocalData.column(line.values));
    }
    return { data, series, bands };
  };

  // Least and largest value of a panel, of the settled part where it has one.
  const range = (panel, low, high) => {
    const columns = [...panel.bands.flatMap((band) => [band.lower, band.upper]), ...panel.lines.map((line) => line.values)];
    const abscissa = gyrocalData.column(panel.abscissa);
    let [least, most] = [Infinity, -Infinity];
    for (const values of columns.map(gyrocalData.column)) {
      for (let row = 0; row < values.length; row++) {
        const x = abscissa[row];
        if (values[row] === null || x < low || x > high) continue;
        least = Math.min(least, values[row]);
        most = Math.max(most, values[row]);
      }
    }
    for (const level of panel.levels) {
      least = Math.min(least, level.value);
      most = Math.max(most, level.value);
    }
    return [least, most];
  };

  const ordinate = (chart, panel) => (u) => {
    const abscissa = gyrocalData.column(panel.abscissa);
    const [first, last] = [abscissa[0], abscissa[abscissa.length - 1]];
    // Before its first drawing a plot has no limits yet.
    const [from, to] = [u.scales.x.min ?? first, u.scales.x.max ?? last];
    if (panel.half !== null && from <= first && to >= last) return [-panel.half, panel.half];
    const settled = panel.scaleFrom !== null && from <= first ? panel.scaleFrom : from;
    const panels = chart.sameScale ? chart.panels : [panel];
    let [least, most] = [Infinity, -Infinity];
    for (const one of panels) {
      // Abscissas of other meaning have no limits in common.
      const [low, high] = one === panel || chart.linked ? range(one, settled, to) : range(one, -Infinity, Infinity);
      least = Math.min(least, low);
      most = Math.max(most, high);
    }
    if (!(least <= most)) return chart.logY ? [0.1, 10] : [-1, 1];
    if (chart.logY) return uPlot.rangeLog(least, most, 10, false);
    const margin = 0.05 * (most - least || Math.abs(most) || 1);
    return [least - margin, most + margin];
  };

  const options = (chart, panel, width, setScale) => {
    const { series, bands } = shown(chart, panel);
    const hasBars = panel.lines.some((line) => line.kind === "bars");
    // Bars of whole numbers stand about their abscissas.
    const margin = hasBars ? 0.5 : 0;
    const axis = (label) => ({
      label, labelSize: 18, labelFont: "12px system-ui, sans-serif", font: "11.5px system-ui, sans-serif", stroke: css("faint"), labelGap: 0,
      grid: { stroke: css("grid"), width: 1 }, ticks: { stroke: css("rule"), width: 1, size: 4 }, gap: 3,
    });
    const unit = panel.unit ? `[${panel.unit}]` : "";
    // As wide as the longest label.
    const room = (u, values) => 12 + 6.6 * Math.max(3, ...(values ?? []).map((value) => `${value ?? ""}`.length));
    const minus = (u, splits) => splits.map((value) => (value === null ? null : `${+value.toPrecision(6)}`.replace("-", "−")));
    return {
      width, height: chart.height, series, bands, pxAlign: 0,
      scales: {
        x: { time: false, distr: chart.logX ? 3 : 1, range: (u, low, high) => [low - margin, high + margin] },
        y: { distr: chart.logY ? 3 : 1, range: ordinate(chart, panel) },
      },
      axes: [
        { ...axis(panel.abscissaTitle), size: 26, ...(hasBars && { incrs: [1, 2, 5, 10, 20, 50] }), ...(!chart.logX && { values: minus }) },
        { ...axis(`${chart.quantity} ${unit}`.trim()), size: room, ...(!chart.logY && { values: minus }) },
      ],
      cursor: { sync: chart.linked ? { key: chart.id, setSeries: false } : undefined, drag: { x: true, y: false }, points: { size: 6 } },
      legend: { show: false },
      hooks: { draw: [guides(panel)], setScale: [setScale], setCursor: [(u) => gyrocalReadout.show(chart, panel, u)] },
    };
  };

  const draw = (chart, width) => {
    const figure = document.getElementById(chart.id);
    const places = [...figure.querySelectorAll(".plot")];
    const before = drawn.get(chart.id);
    before?.plots.forEach((plot) => plot.destroy());
    const state = { plots: [], zoomed: before?.zoomed ?? null, ready: false };
    const reset = figure.querySelector(".reset");
    let following = false;
    const zoom = (limits) => {
      following = true;
      for (const plot of state.plots) plot.setScale("x", { min: limits[0], max: limits[1] });
      following = false;
      const all = state.plots[0] && whole(state.plots[0]);
      state.zoomed = all && limits[0] <= all[0] && limits[1] >= all[1] ? null : limits;
      reset.hidden = state.zoomed === null;
    };
    const follow = (u, key) => {
      if (key !== "x" || following || !state.ready) return;
      if (chart.linked) zoom([u.scales.x.min, u.scales.x.max]);
    };
    chart.panels.forEach((panel, place) => {
      const element = places[place];
      const size = width ?? element.clientWidth;
      element.replaceChildren();
      state.plots.push(new uPlot(options(chart, panel, size, follow), shown(chart, panel).data, element));
    });
    const showAll = () => zoom(whole(state.plots[0]));
    reset.onclick = showAll;
    places.forEach((place) => { place.onkeydown = (event) => event.key === "Escape" && showAll(); });
    // Plots set their scales in a microtask of their own.
    setTimeout(() => {
      state.ready = true;
      if (state.zoomed) zoom(state.zoomed);
    });
    drawn.set(chart.id, state);
  };

  const whole = (plot) => {
    const abscissa = plot.data[0];
    return [abscissa[0], abscissa[abscissa.length - 1]];
  };

  // Columns of panels on paper are as on the screen.
  const printWidth = (chart) => {
    const columns = Number(getComputedStyle(document.getElementById(chart.id).querySelector(".panels")).getPropertyValue("--columns"));
    return Math.floor((PRINT_WIDTH - 16 * (columns - 1)) / columns);
  };

  const start = () => {
    const byId = new Map(gyrocalData.charts.map((chart) => [chart.id, chart]));
    const seen = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        if (entry.isIntersecting && !drawn.has(entry.target.id)) draw(byId.get(entry.target.id));
      }
    }, { rootMargin: "400px" });
    for (const id of byId.keys()) seen.observe(document.getElementById(id));
    const again = () => { for (const id of [...drawn.keys()]) draw(byId.get(id)); };
    let waiting = 0;
    addEventListener("resize", () => { clearTimeout(waiting); waiting = setTimeout(again, 120); });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    addEventListener("beforeprint", () => { for (const chart of byId.values()) draw(chart, printWidth(chart)); });
    addEventListener("afterprint", again);
  };
  return { start, drawn };
})();
