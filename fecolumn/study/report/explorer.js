"use strict";

(() => {
  const study = JSON.parse(document.getElementById("explorer-data").textContent);
  const part = (name) => document.getElementById(`explorer-${name}`);
  const STEPS = 200; // of the sliders over the axis of peaks
  const AXIS = 1.08; // the axis ends here, in units of end_mm: what was lost lies beyond every peak, in a strip of its own
  const FALLEN = AXIS * Math.max(study.end_mm, study.critical_mm ?? 0); // farther than this a fall is not followed [mm]: it would dwarf all else
  // settings: places of the settings drawn; range: of peaks [mm]; motion: place of the one chosen, or null
  const state = { settings: [...study.start], range: [0, AXIS * study.end_mm], motion: null, quantity: 0 };
  let cdf = null; // the chart of the distributions

  // ---- the study ---------------------------------------------------------------------------------------------------

  /** Settings that are drawn, as many as there are looks. */
  const shown = () => state.settings.slice(0, study.looks.length).map((place, i) => ({ ...study.settings[place], look: study.looks[i] }));

  /** Peak of a motion [mm], of what was lost in the strip beyond every peak; undefined where there is no analysis. */
  const peak = (setting, motion) => (setting.ends[motion] === null ? undefined : setting.ends[motion] ? 1.04 * study.end_mm : setting.peaks[motion]);

  const within = (value) => value !== undefined && value >= state.range[0] && value <= state.range[1];

  /** A peak for a reader. */
  function peakText(setting, motion) {
    const end = setting.ends[motion];
    return end === null ? "\u2014" : end ? study.ends[end].word : setting.peaks[motion].toPrecision(3);
  }

  /**
   * time [s], ux, uy [mm], size [mm] and tilt [degrees] of a history, or null; of what was lost up to FALLEN.
   * The bytes are those of explorer.py, packed.
   */
  function history(setting, motion) {
    const text = setting.histories[motion];
    if (!text) return null;
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const [time, u, tilt] = new Float32Array(bytes.buffer, 0, 3), n = (bytes.length - 12) / 8;
    const times = new Uint16Array(bytes.buffer, 12, n), signed = new Int16Array(bytes.buffer, 12 + 2 * n);
    const column = (place, scale) => Array.from(signed.subarray(place * n, (place + 1) * n), (number) => (number / 32767) * scale);
    const [ux, uy] = [column(0, 1e3 * u), column(1, 1e3 * u)];
    const size = ux.map((value, i) => Math.hypot(value, uy[i]));
    const whole = { time: Array.from(times, (number) => (number / 65535) * time), ux, uy, size, tilt: column(2, (tilt * 180) / Math.PI) };
    const fallen = setting.ends[motion] ? size.findIndex((value) => value > FALLEN) : -1;
    return fallen < 0 ? whole : Object.fromEntries(Object.entries(whole).map(([name, values]) => [name, values.slice(0, fallen + 1)]));
  }

  // ---- settings ----------------------------------------------------------------------------------------------------

  /** Boxes for each level of each axis, or where an axis has too many, for each setting. */
  function drawSettings() {
    const groups = study.axes.length ? study.axes : study.settings.length > 1 ? [{ name: "setting", levels: study.settings.map((one) => one.words) }] : [];
    groups.forEach((group, axis) => {
      const field = document.createElement("fieldset");
      field.append(Object.assign(document.createElement("legend"), { textContent: group.name }));
      const box = field.appendChild(Object.assign(document.createElement("div"), { className: "levels" }));
      group.levels.forEach((words, level) => {
        const input = Object.assign(document.createElement("input"), { type: "checkbox" });
        Object.assign(input.dataset, { axis, level });
        input.checked = state.settings.some((place) => (study.axes.length ? study.settings[place].levels[axis] === level : place === level));
        input.addEventListener("change", chooseSettings);
        const label = box.appendChild(document.createElement("label"));
        label.append(input, ` ${words}`);
      });
      part("settings").append(field);
    });
  }

  /** Take the settings all of whose levels are ticked. */
  function chooseSettings() {
    const ticked = (axis, level) => part("settings").querySelector(`[data-axis="${axis}"][data-level="${level}"]`).checked;
    const places = [...study.settings.keys()];
    state.settings = study.axes.length
      ? places.filter((place) => study.settings[place].levels.every((level, axis) => ticked(axis, level)))
      : places.filter((place) => places.length === 1 || ticked(0, place));
    draw();
  }

  function drawLegend() {
    const all = state.settings.length, settings = shown();
    part("note").textContent = !all ? "No setting chosen." : all > settings.length ? `${all} settings chosen; the first ${settings.length} are drawn.` : "";
    part("legend").replaceChildren(...settings.map((setting) => {
      const item = document.createElement("li");
      const sample = drawn(item, "svg", { width: 34, height: 10, "aria-hidden": "true" });
      drawn(sample, "line", { x1: 1, x2: 33, y1: 5, y2: 5, stroke: setting.look.colour, "stroke-dasharray": setting.look.dash, "stroke-width": 2 });
      const ends = setting.ends.filter((end) => end !== null), lost = ends.filter(Boolean).length;
      item.append(` ${setting.words}: ${lost} of ${ends.length} ${study.lost}`);
      return item;
    }));
  }

  // ---- distribution and range --------------------------------------------------------------------------------------

  function drawDistribution() {
    const end = AXIS * study.end_mm, svg = part("cdf");
    cdf = new Chart(svg, { x: [0, end], y: [0, 1], xLabel: "largest top displacement u_max [mm]", yLabel: "share of motions that stay below [-]",
      width: svg.parentElement.clientWidth, height: 300, lastTick: study.end_mm });
    cdf.shade(study.end_mm, end, "lost");
    cdf.shade(...state.range, "brush");
    for (const setting of shown()) {
      const n = setting.ends.filter((one) => one !== null).length, x = [0], y = [0];
      setting.peaks.filter((value) => value !== null).sort((a, b) => a - b).forEach((value, i) => { x.push(value, value); y.push(i / n, (i + 1) / n); });
      cdf.line([...x, study.end_mm], [...y, y.at(-1)], setting.look);
    }
    const middle = [cdf.toX(1.04 * study.end_mm), cdf.box.y + cdf.box.height / 2];
    if (shown().some((setting) => setting.ends.some(Boolean)))
      drawn(svg, "text", { transform: `translate(${middle[0] + 4} ${middle[1]}) rotate(-90)`, "text-anchor": "middle" }, study.lost);
    svg.setAttribute("aria-label", `Distribution of the largest top displacement in ${shown().length} settings; range marked: ${rangeText()}`);
  }

  const edgeText = (value) => (value > study.end_mm ? study.lost : `${written(value)} mm`);
  const rangeText = () => `${edgeText(state.range[0])} to ${edgeText(state.range[1])}`;

  function drawRange() {
    ["from", "to"].forEach((name, i) => {
      const slider = part(name);
      slider.value = Math.round((STEPS * state.range[i]) / (AXIS * study.end_mm));
      slider.setAttribute("aria-valuetext", edgeText(state.range[i]));
      part(`${name}-text`).textContent = edgeText(state.range[i]);
    });
  }

  function setRange(low, high) {
    state.range = [Math.min(low, high), Math.max(low, high)];
    drawRange();
    drawDistribution();
    drawList();
  }

  /** A slider was moved, by keys or pointer; it takes the other one along. */
  function slid(name) {
    const value = (part(name).value / STEPS) * AXIS * study.end_mm;
    setRange(...(name === "from" ? [value, Math.max(value, state.range[1])] : [Math.min(value, state.range[0]), value]));
  }

  /** Marking with the pointer; a click without a drag marks all again. */
  function brush() {
    let start = null;
    const svg = part("cdf");
    svg.addEventListener("pointerdown", (event) => { start = cdf.fromWindow(event.clientX); svg.setPointerCapture(event.pointerId); });
    svg.addEventListener("pointermove", (event) => { if (start !== null) setRange(start, cdf.fromWindow(event.clientX)); });
    svg.addEventListener("pointercancel", () => { start = null; });
    svg.addEventListener("pointerup", (event) => {
      if (Math.abs(cdf.toX(cdf.fromWindow(event.clientX)) - cdf.toX(start)) < 3) setRange(0, AXIS * study.end_mm);
      start = null;
    });
  }

  // ---- motions -----------------------------------------------------------------------------------------------------

  /** Motions with a peak in the range in any setting, those of the first setting first. */
  function drawList() {
    const settings = shown(), inRange = (motion) => settings.some((setting) => within(peak(setting, motion)));
    const motions = [...study.motions.keys()].filter(inRange);
    if (settings.length) motions.sort((a, b) => (peak(settings[0], a) ?? Infinity) - (peak(settings[0], b) ?? Infinity));
    part("count").textContent = `${motions.length} of ${study.motions.length} motions have a peak from ${rangeText()} in ${settings.length === 1 ? "this setting" : "one of these settings at least"}.`;
    const focused = document.activeElement?.dataset?.motion;
    const table = document.createElement("table");
    const head = table.createTHead().insertRow();
    head.append(Object.assign(document.createElement("th"), { textContent: "motion", className: "text", scope: "col" }));
    for (const setting of settings) {
      const cell = head.appendChild(Object.assign(document.createElement("th"), { scope: "col", title: setting.words }));
      const sample = drawn(cell, "svg", { width: 34, height: 10, role: "img", "aria-label": setting.words });
      drawn(sample, "line", { x1: 1, x2: 33, y1: 5, y2: 5, stroke: setting.look.colour, "stroke-dasharray": setting.look.dash, "stroke-width": 2 });
      cell.append(" [mm]");
    }
    const body = table.createTBody();
    for (const motion of motions) {
      const row = body.insertRow(), button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: study.motions[motion], tabIndex: -1 });
      button.dataset.motion = motion;
      button.setAttribute("aria-pressed", motion === state.motion);
      button.addEventListener("click", () => choose(motion));
      const name = row.appendChild(Object.assign(document.createElement("th"), { className: "text", scope: "row" }));
      name.append(button);
      for (const setting of settings) row.append(Object.assign(document.createElement("td"), { textContent: peakText(setting, motion), className: within(peak(setting, motion)) ? "in" : "" }));
    }
    part("list").replaceChildren(table);
    const buttons = [...body.querySelectorAll("button")];
    const first = buttons.find((button) => Number(button.dataset.motion) === state.motion) ?? buttons[0];
    if (first) first.tabIndex = 0; // one stop of the Tab key; arrow keys go on from there
    if (focused !== undefined) (buttons.find((button) => button.dataset.motion === focused) ?? first)?.focus();
  }

  /** Arrow keys, Home and End go through the list. */
  function moveInList(event) {
    const buttons = [...part("list").querySelectorAll("button")], here = buttons.indexOf(document.activeElement);
    const place = { ArrowDown: here + 1, ArrowUp: here - 1, Home: 0, End: buttons.length - 1 }[event.key];
    if (here < 0 || place === undefined) return;
    event.preventDefault();
    const next = buttons[Math.min(Math.max(place, 0), buttons.length - 1)];
    buttons[here].tabIndex = -1;
    next.tabIndex = 0;
    next.focus();
  }

  function choose(motion) {
    state.motion = motion;
    for (const button of part("list").querySelectorAll("button")) button.setAttribute("aria-pressed", Number(button.dataset.motion) === motion);
    drawHistories();
  }

  // ---- histories ---------------------------------------------------------------------------------------------------

  function drawHistories() {
    const motion = state.motion;
    part("histories").classList.toggle("empty", motion === null);
    if (motion === null) return;
    part("motion").textContent = `${study.motions[motion]}.`;
    const found = shown().map((setting) => ({ setting, history: history(setting, motion), end: setting.ends[motion] }));
    const missing = found.filter((one) => !one.history).map((one) => one.setting.words);
    part("missing").textContent = missing.length ? `No history in this page of: ${missing.join("; ")}.` : "";
    const there = found.filter((one) => one.history);
    const quantity = ["size", "ux", "uy"][state.quantity];
    const label = ["top displacement |u_| [mm]", "top displacement u_x [mm]", "top displacement u_y [mm]"][state.quantity];
    against(part("top"), there, quantity, label, state.quantity === 0);
    against(part("tilt"), there, "tilt", "tilt of the axis [\u00b0]", true);
    plan(part("plan"), there);
  }

  /** Ends of an axis for values of all histories, displacements up to FALLEN. */
  function reach(there, name, fromZero) {
    const largest = Math.max(1e-6, ...there.map((one) => one.history[name].reduce((most, value) => Math.max(most, Math.abs(value)), 0)));
    const most = 1.05 * (name === "tilt" ? largest : Math.min(largest, FALLEN));
    return [fromZero ? 0 : -most, most];
  }

  function against(svg, there, name, label, fromZero) {
    const end = Math.max(0.001, ...there.map((one) => one.history.time.at(-1)));
    const chart = new Chart(svg, { x: [0, end], y: reach(there, name, fromZero), xLabel: "time t_ [s]", yLabel: label, width: svg.parentElement.clientWidth, height: 220 });
    for (const { setting, history: one, end: word } of there) {
      chart.line(one.time, one[name], setting.look);
      if (word) chart.cross(one.time.at(-1), one[name].at(-1), setting.look.colour);
    }
    svg.setAttribute("aria-label", `${label.replace(/_/g, "")} of ${study.motions[state.motion]} against time, ${there.length} settings`);
  }

  /** Path of the top in plan on axes of one scale, with the foot and the critical displacement where these are not far off. */
  function plan(svg, there) {
    const most = reach(there, "size", true)[1], width = Math.min(svg.parentElement.clientWidth, 460);
    const half = study.critical_mm && study.critical_mm < 3 * most ? Math.max(most, 1.05 * study.critical_mm) : most;
    const chart = new Chart(svg, { x: [-half, half], y: [-half, half], xLabel: "u_x [mm]", yLabel: "u_y [mm]", width, height: Chart.square(width) });
    const black = { colour: "#000000", width: 1 };
    if (study.foot) chart.line(study.foot.map((point) => point[0]), study.foot.map((point) => point[1]), black);
    const marks = [study.foot && "foot: full line", study.critical_mm && `critical displacement, ${written(study.critical_mm)} mm: dashed`];
    part("marks").textContent = marks.filter(Boolean).length ? `In black, ${marks.filter(Boolean).join("; ")}. ` : "";
    if (there.some((one) => one.end)) part("marks").textContent += `A cross: ${study.lost}, followed up to ${written(FALLEN)} mm at most.`;
    if (study.critical_mm) {
      const angles = Array.from({ length: 181 }, (_, i) => (i * Math.PI) / 90);
      chart.line(angles.map((a) => study.critical_mm * Math.cos(a)), angles.map((a) => study.critical_mm * Math.sin(a)), { ...black, dash: "4 3" });
    }
    for (const { setting, history: one, end } of there) {
      chart.line(one.ux, one.uy, { ...setting.look, width: 1.2 });
      if (end) chart.cross(one.ux.at(-1), one.uy.at(-1), setting.look.colour);
    }
    svg.setAttribute("aria-label", `Path of the top of ${study.motions[state.motion]} in plan, ${there.length} settings`);
  }

  // ---- the whole ---------------------------------------------------------------------------------------------------

  function draw() {
    drawLegend();
    drawRange();
    drawDistribution();
    drawList();
    drawHistories();
  }

  part("panel").hidden = false;
  drawSettings();
  draw();
  brush();
  for (const name of ["from", "to"]) part(name).addEventListener("input", () => slid(name));
  part("all").addEventListener("click", () => setRange(0, AXIS * study.end_mm));
  part("list").addEventListener("keydown", moveInList);
  part("quantity").addEventListener("change", (event) => { state.quantity = Number(event.target.value); drawHistories(); });
  let width = part("panel").clientWidth;
  new ResizeObserver(([entry]) => {
    const now = Math.round(entry.contentRect.width);
    if (now && now !== width) { width = now; draw(); } // 0: not shown, as in print
  }).observe(part("panel"));
})();
