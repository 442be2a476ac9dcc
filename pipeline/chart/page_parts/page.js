// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const state = { selected: null, sort: "steady_frame_ms", down: false };
const element = (id) => document.getElementById(id);
const STYLES = {
  march: { color: "#c0504d", symbol: "square" },
  gauss: { color: "#2f6db5", symbol: "circle" },
  field: { color: "#2e8b57", symbol: "diamond" },
  path: { color: "#8064a2", symbol: "triangle-up" },
};
const STATISTICS = {
  p95: "95 of 100 pixels", p99: "99 of 100 pixels", median: "median", max: "largest",
  relative_rmse: "relative RMSE", bias: "bias of the mean", flip: "FLIP",
};
const CONFIG = {
  responsive: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d"],
  displayModeBar: matchMedia("(max-width: 600px)").matches ? false : "hover",
};
const NOTICEABLE = 0.02;  // of an error: what a row must gain to be on the front
// Up to so many decades these digits of each are named.
const NAMED = [[1, [1, 2, 3, 5, 7]], [3, [1, 2, 5]], [Infinity, [1]]];

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);

// A logarithmic axis for these values, whose ticks are plain numbers.
function logAxis(text, values) {
  const exponents = values.filter((value) => value > 0).map(Math.log10);
  const decades = Math.max(...exponents) - Math.min(...exponents);
  const digitsOf = NAMED.find(([most]) => !(decades > most))[1];
  const ticks = [];
  for (let exponent = -8; exponent <= 12; exponent += 1) {
    ticks.push(...digitsOf.map((digit) => Number(`${digit}e${exponent}`)));
  }
  return {
    type: "log", title: { text }, tickvals: ticks, ticktext: ticks.map((value) => plain(value)),
    gridcolor: colour("grid"), linecolor: colour("line"), zeroline: false,
    automargin: true,
  };
}

const plain = (value) => (value >= 1e6 ? `${value / 1e6} M` : `${value}`);

function layoutOf(more) {
  return {
    paper_bgcolor: colour("paper"), plot_bgcolor: colour("paper"),
    font: { color: colour("ink"), family: "system-ui, sans-serif", size: 13 },
    hovermode: "closest", legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0, itemsizing: "constant" },
    margin: { l: 60, r: 16, t: 10, b: 50 },
    ...more,
  };
}

const kind = () => document.querySelector("input[name=kind]:checked").value;
const digits = (value) => (Math.abs(value) >= 100 ? value.toFixed(0) : value.toPrecision(2));
const percent = (share) => (share == null ? "" : `${digits(100 * share)} %`);
const milliseconds = (ms) => (ms == null ? "" : ms < 1000 ? `${ms.toPrecision(3)} ms`
  : `${(ms / 1000).toPrecision(3)} s`);
const megabytes = (bytes) => (bytes == null ? "" : `${(bytes / 1e6).toFixed(1)} MB`);

function errorColumn(statistic = element("statistic").value) {
  return statistic === "flip" ? `${kind()}_flip` : `${kind()}_${element("place").value}_${statistic}`;
}

const error = (row) => (row[errorColumn()] == null ? null : Math.abs(row[errorColumn()]));
const cost = (row) => (element("cost").value === "with_bake_ms"
  ? (row.bake_ms || 0) + row.steady_frame_ms : row[element("cost").value]);
const shotRows = () => data.rows.filter((row) => row.shot === element("shot").value);

function shownRows() {
  const shown = new Set([...document.querySelectorAll("#methods input:checked")].map((i) => i.value));
  return shotRows().filter((row) => shown.has(row.method) && error(row) != null && row.rounds);
}

// The rows that no other beats in both time and error, by rising time; as in plot.py.
function front(rows) {
  const best = [];
  for (const row of [...rows].sort((a, b) => cost(a) - cost(b) || error(a) - error(b))) {
    if (!best.length || error(row) < (1 - NOTICEABLE) * error(best[best.length - 1])) best.push(row);
  }
  return best;
}

function hover(row) {
  return [
    `<b>${row.setting}</b>`, `model: ${row.model}`,
    `frame ${milliseconds(row.steady_frame_ms)} (spread ${milliseconds(row.spread_ms)}), ` +
      `${row.ratio_to_surface.toPrecision(3)} surface frames`,
    `bake ${milliseconds(row.bake_ms)}, ${megabytes(row.memory_bytes)}`,
    `${kind()}: median ${percent(row[errorColumn("median")])}, ` +
      `p95 ${percent(row[errorColumn("p95")])}, p99 ${percent(row[errorColumn("p99")])}`,
    `bias ${percent(row[errorColumn("bias")])}, FLIP ${(row[`${kind()}_flip`] || 0).toPrecision(2)}`,
  ].join("<br>");
}

function methodTraces(rows) {
  return Object.entries(STYLES).map(([method, style]) => {
    const own = rows.filter((row) => row.method === method);
    return {
      name: method, mode: "markers", x: own.map(cost), y: own.map((row) => 100 * error(row)),
      customdata: own.map((row) => row.id), text: own.map(hover), hoverinfo: "text",
      marker: {
        ...style, opacity: 0.9, size: own.map((row) => (row.id === state.selected ? 18 : 10)),
        line: { width: own.map((row) => (row.id === state.selected ? 3 : 0)), color: colour("ink") },
      },
    };
  }).filter((trace) => trace.x.length);
}

// The paper states times alone: each takes the error that we measure at as many steps.
function paperTrace(rows) {
  const known = Object.entries(data.paper.framesPerSecond)
    .map(([steps, rate]) => ({
      steps, ms: 1000 / rate,
      row: rows.find((row) => row.setting === `march ${steps}, steps outside`),
    })).filter((entry) => entry.row);
  if (!known.length || element("cost").value === "ratio_to_surface") return [];
  known.sort((a, b) => a.ms - b.ms);
  return [{
    name: "the paper's Table 1, our errors", mode: "lines+markers",
    x: known.map((entry) => entry.ms), y: known.map((entry) => 100 * error(entry.row)),
    text: known.map((entry) => `<b>the paper, ${entry.steps} steps</b><br>` +
      `${entry.ms.toPrecision(3)} ms<br>${data.paper.source}<br>` +
      `its error: ours at as many steps, ${percent(error(entry.row))}`),
    hoverinfo: "text", line: { dash: "dot", color: "#b8860b" },
    marker: { symbol: "x", color: "#b8860b", size: 9 },
  }];
}

function drawPlot() {
  const rows = shownRows();
  const best = front(rows);
  const surface = shotRows().find((row) => row.method === "surface");
  const x = element("cost").value === "ratio_to_surface" ? 1 : surface.steady_frame_ms;
  const traces = [
    { name: "front", mode: "lines", x: best.map(cost), y: best.map((row) => 100 * error(row)),
      hoverinfo: "skip", line: { color: colour("front"), width: 1.5, shape: "hv" } },
    ...methodTraces(rows), ...paperTrace(shotRows()),
  ];
  const statistic = STATISTICS[element("statistic").value];
  const unit = element("statistic").value === "flip" ? "x 100" : "%";
  const layout = layoutOf({
    xaxis: logAxis(element("cost").selectedOptions[0].text, [x, ...traces.flatMap((t) => t.x)]),
    yaxis: logAxis(`${kind()} error, ${unit}: ${statistic}`, traces.flatMap((t) => t.y)),
    shapes: [{ type: "line", x0: x, x1: x, yref: "paper", y0: 0, y1: 1,
      line: { dash: "dash", color: colour("front") } }],
    annotations: [{ x: Math.log10(x), yref: "paper", y: 0.02, text: "surface frame", xanchor: "left",
      showarrow: false, font: { color: colour("quiet") } }],
  });
  Plotly.react("plot", traces, layout, CONFIG);
  element("explained").textContent = kind() === "numerical"
    ? "Numerical: against the same model, converged." : `Total: against ${data.richest}.`;
}

function picturesOf(row) {
  const shot = data.pictures[row.shot];
  return { ...shot.rows[row.id], truth: shot.truths[kind() === "total" ? data.richestName : row.model],
    truthName: kind() === "total" ? data.richestName : `${row.model}, converged` };
}

function drawViewer() {
  const row = data.rows.find((each) => each.id === state.selected);
  if (!row) return;
  const pictures = picturesOf(row);
  element("chosen").textContent = row.setting;
  element("options").textContent = row.options;
  element("image").src = pictures.image;
  element("truth").src = pictures.truth;
  element("map").src = pictures[kind()];
  element("truth-name").textContent = pictures.truthName;
  element("map-kind").textContent = kind();
  const lines = [
    ["steady frame", milliseconds(row.steady_frame_ms)],
    ["spread of its rounds", milliseconds(row.spread_ms)],
    ["surface frames", row.ratio_to_surface.toPrecision(3)],
    ["bake", milliseconds(row.bake_ms)], ["memory", megabytes(row.memory_bytes)],
    ...Object.entries(STATISTICS).map(([name, text]) =>
      [text, name === "flip" ? (row[errorColumn(name)] || 0).toPrecision(3)
        : percent(row[errorColumn(name)])]),
  ];
  element("numbers").replaceChildren(...lines.map(([name, text]) => {
    const entry = document.createElement("div");
    entry.append(Object.assign(document.createElement("dt"), { textContent: name }),
      Object.assign(document.createElement("dd"), { textContent: text }));
    return entry;
  }));
}

const COLUMNS = [
  ["setting", "setting", (v) => v], ["model", "model", (v) => v],
  ["steady_frame_ms", "frame", milliseconds], ["ratio_to_surface", "to surface", digits],
  ["bake_ms", "bake", milliseconds], ["memory_bytes", "memory", megabytes],
  ...["bias", "median", "p95", "p99", "max", "relative_rmse"].map((s) => [s, s === "relative_rmse" ? "RMSE" : s, percent]),
  ["flip", "FLIP", (v) => v.toPrecision(2)],
];

const cell = (row, name) => (name in STATISTICS ? row[errorColumn(name)] : row[name]);

function drawTable() {
  const button = (text, action) => {
    const made = Object.assign(document.createElement("button"), { textContent: text, type: "button" });
    made.addEventListener("click", action);
    return made;
  };
  const rows = shotRows().filter((row) => row.method !== "surface");
  const sign = state.down ? -1 : 1;
  rows.sort((a, b) => {
    const [x, y] = [cell(a, state.sort), cell(b, state.sort)];
    if (x == null || y == null) return (x == null) - (y == null);
    return sign * (typeof x === "string" ? x.localeCompare(y) : x - y);
  });
  const best = new Set(front(shownRows()).map((row) => row.id));
  const head = document.createElement("tr");
  for (const [name, text] of COLUMNS) {
    const th = document.createElement("th");
    th.scope = "col";
    if (name === state.sort) th.ariaSort = state.down ? "descending" : "ascending";
    th.append(button(text + (name === state.sort ? (state.down ? " ▼" : " ▲") : ""), () => {
      state.down = state.sort === name && !state.down;
      state.sort = name;
      drawTable();
      [...element("table").tHead.querySelectorAll("button")][COLUMNS.findIndex((c) => c[0] === name)]
        .focus();
    }));
    head.append(th);
  }
  element("table").tHead.replaceChildren(head);
  element("table").tBodies[0].replaceChildren(...rows.map((row) => {
    const tr = document.createElement("tr");
    tr.dataset.id = row.id;
    tr.classList.toggle("chosen", row.id === state.selected);
    tr.classList.toggle("front", best.has(row.id));
    for (const [name, , format] of COLUMNS) {
      const td = document.createElement("td");
      const value = cell(row, name);
      if (name === "setting" && !row.failure) td.append(button(value, () => select(row.id, true)));
      else td.textContent = name === "model" && row.failure ? row.failure : value == null ? "" : format(value);
      tr.append(td);
    }
    return tr;
  }));
}

function select(id, scroll) {
  state.selected = id;
  draw();
  if (scroll) element("viewer").scrollIntoView({ block: "start" });
}

function step(direction) {
  const rows = shownRows().sort((a, b) => cost(a) - cost(b));
  if (!rows.length) return;
  const at = rows.findIndex((row) => row.id === state.selected);
  select(rows[Math.min(Math.max(at + direction, 0), rows.length - 1)].id, false);
}

function drawNeeds() {
  const text = data.needs[element("shot").value];
  element("needs-section").hidden = !text;
  element("needs").innerHTML = text || "";
}

function drawGrowth() {
  const of = element("growth-of").value;
  const series = (data.growth || {})[of];
  element("growth-section").hidden = !series;
  if (!series) return;
  const column = element("growth-cost").value;
  const traces = Object.entries(series).map(([setting, points]) => ({
    name: setting, mode: "lines+markers", x: points.map((p) => p.x), y: points.map((p) => p[column]),
    text: points.map((p) => `${setting}<br>${p.scene}, ${p.size}<br>${of}: ${p.x}<br>` +
      `frame ${milliseconds(p.steady_frame_ms)}, bake ${milliseconds(p.bake_ms)}, ` +
      `${megabytes(p.memory_bytes)}`),
    hoverinfo: "text",
  }));
  Plotly.react("growth", traces, layoutOf({
    xaxis: logAxis(of, traces.flatMap((trace) => trace.x)),
    yaxis: logAxis(element("growth-cost").selectedOptions[0].text, traces.flatMap((t) => t.y)),
  }), CONFIG);
}

function draw() {
  drawPlot();
  drawViewer();
  drawTable();
}

function chooseFirst() {
  const rows = shownRows();
  state.selected = (front(rows).at(-1) || rows[0] || {}).id ?? null;
}

function fill(select, entries) {
  select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
}

function start() {
  element("about").textContent = data.about;
  fill(element("shot"), Object.keys(data.pictures).map((shot) => [shot, shot]));
  fill(element("statistic"), Object.entries(STATISTICS));
  fill(element("growth-of"), Object.keys(data.growth || {}).map((of) => [of, of]));
  element("scale").style.background = `linear-gradient(to right, ${data.scale.colours.join(",")})`;
  element("scale").replaceChildren(...data.scale.marks.map(([text, at]) => {
    const span = Object.assign(document.createElement("span"), { textContent: text });
    span.style.left = `${at}%`;
    return span;
  }));
  for (const method of new Set(data.rows.map((row) => row.method))) {
    if (method === "surface") continue;
    const label = document.createElement("label");
    const box = Object.assign(document.createElement("input"),
      { type: "checkbox", value: method, checked: true });
    box.addEventListener("change", draw);
    label.append(box, ` ${method}`);
    element("methods").append(label);
  }
  chooseFirst();
  draw();
  drawNeeds();
  drawGrowth();
  element("plot").on("plotly_click", (event) => {
    const id = event.points[0].customdata;
    if (id !== undefined) select(id, false);
  });
  element("plot").addEventListener("keydown", (event) => {
    const direction = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (direction) { event.preventDefault(); step(direction); }
  });
  element("slider").addEventListener("input", () => {
    const at = element("slider").value;
    element("image").style.clipPath = `inset(0 ${100 - at}% 0 0)`;
    element("divider").style.left = `${at}%`;
  });
  element("shot").addEventListener("change", () => { chooseFirst(); draw(); drawNeeds(); });
  for (const input of document.querySelectorAll("#place, #statistic, #cost, input[name=kind]")) {
    input.addEventListener("change", draw);
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { draw(); drawGrowth(); });
  for (const id of ["growth-of", "growth-cost"]) element(id).addEventListener("change", drawGrowth);
}

start();
