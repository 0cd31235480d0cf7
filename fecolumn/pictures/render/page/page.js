"use strict";

/** Numbers that the page holds as base64, in single precision. */
function unpacked(text) {
  return new Float32Array(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
}

/** A new element with attributes, text and children, the last of `parent`. */
function made(parent, name, attributes = {}, text = "") {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  parent.append(element);
  return element;
}

/** A number as the page writes it, with a true minus. */
function written(value, digits = 3) {
  return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

const hex = (colour) => "#" + colour.toString(16).padStart(6, "0");
const LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];
const DASHES = [[], [5, 3], [1.5, 2], [7, 2, 1.5, 2]];
// Viridis from light to dark, by the share of the largest force
const SCALE = [[0xfd, 0xe7, 0x25], [0x35, 0xb7, 0x79], [0x31, 0x68, 0x8e], [0x44, 0x01, 0x54]];

function scaled(share) {
  const at = Math.min(Math.max(share, 0), 1) * (SCALE.length - 1), k = Math.min(Math.floor(at), SCALE.length - 2);
  return SCALE[k].map((low, n) => (low + (at - k) * (SCALE[k + 1][n] - low)) / 255);
}

/** Three numbers of an array between its columns k and k + 1. */
function between(values, k, share) {
  return [0, 1, 2].map((n) => values[3 * k + n] + share * ((values[3 * k + 3 + n] ?? values[3 * k + n]) - values[3 * k + n]));
}

/** Product of quaternions x, y, z, w. */
function times(a, b) {
  return [
    a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
    a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
    a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
    a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
  ];
}

/** The turn by `factor` times the angle of a quaternion, about its axis. */
function powered(turn, factor) {
  const sign = turn[3] < 0 ? -1 : 1, sine = Math.hypot(turn[0], turn[1], turn[2]);
  if (sine < 1e-12) return [0, 0, 0, 1];
  const half = factor * Math.atan2(sine, sign * turn[3]);
  return [...turn.slice(0, 3).map((one) => (sign * one / sine) * Math.sin(half)), Math.cos(half)];
}

/** A vector turned by a quaternion. */
function turned(turn, v) {
  return times(times(turn, [...v, 0]), [-turn[0], -turn[1], -turn[2], turn[3]]).slice(0, 3);
}

/** Quaternion that turns z into the direction of a vector. */
function towards(v) {
  const long = Math.hypot(...v), z = v[2] / long;
  if (z < -0.999999) return [1, 0, 0, 0];
  const turn = [-v[1] / long, v[0] / long, 0, 1 + z], norm = Math.hypot(...turn);
  return turn.map((one) => one / norm);
}

/** What an analysis says over time, with the line of the time shown. */
class Strip {
  constructor(parent, told, go) {
    Object.assign(this, { unit: told.unit, time: unpacked(told.time) });
    this.lines = told.lines.map((line) => ({ name: line.name, values: unpacked(line.values) }));
    const box = made(parent, "div", { class: "strip" });
    this.head = made(box, "p");
    made(this.head, "b", {}, told.title + (this.unit ? ` [${this.unit}]` : ""));
    this.readings = this.lines.map((line, k) => {
      const reading = made(this.head, "span");
      reading.style.color = LINES[k];
      return reading;
    });
    this.canvas = made(box, "canvas", { role: "img", "aria-label": `${told.title} over time` });
    this.canvas.addEventListener("pointerdown", (event) => go(this.timeAt(event.offsetX)));
    this.canvas.addEventListener("pointermove", (event) => event.buttons && go(this.timeAt(event.offsetX)));
    const every = this.lines.flatMap((line) => [Math.min(...line.values), Math.max(...line.values)]);
    const [low, high] = [Math.min(0, ...every), Math.max(0, ...every)], room = 0.06 * (high - low || 1);
    Object.assign(this, { low: low - room, high: high + room });
  }

  x(time) { return 44 + ((time - this.time[0]) / (this.time.at(-1) - this.time[0])) * (this.wide - 52); }
  y(value) { return 4 + ((this.high - value) / (this.high - this.low)) * (this.tall - 24); }
  timeAt(x) { return this.time[0] + ((x - 44) / (this.wide - 52)) * (this.time.at(-1) - this.time[0]); }

  /** Draw all but the line of the time. */
  draw() {
    const fine = window.devicePixelRatio || 1;
    [this.wide, this.tall] = [this.canvas.clientWidth, this.canvas.clientHeight];
    [this.canvas.width, this.canvas.height] = [this.wide * fine, this.tall * fine];
    this.still = document.createElement("canvas");
    [this.still.width, this.still.height] = [this.canvas.width, this.canvas.height];
    this.pen = this.canvas.getContext("2d");
    const pen = this.still.getContext("2d");
    this.pen.scale(fine, fine);
    pen.scale(fine, fine);
    pen.font = "11px system-ui, sans-serif";
    this.#axes(pen);
    this.lines.forEach((line, k) => {
      pen.beginPath();
      line.values.forEach((value, n) => pen.lineTo(this.x(this.time[n]), this.y(value)));
      pen.strokeStyle = LINES[k];
      pen.lineWidth = 1.2;
      pen.setLineDash(DASHES[k]);
      pen.stroke();
    });
  }

  #axes(pen) {
    const ticks = (low, high, wanted) => {
      const power = 10 ** Math.floor(Math.log10((high - low) / wanted));
      const step = power * [1, 2, 5, 10].find((one) => one * power * wanted >= high - low), found = [];
      for (let n = Math.ceil(low / step); n * step <= high; n++) found.push(Number((n * step).toPrecision(9)));
      return found;
    };
    pen.strokeStyle = "#ddd";
    pen.fillStyle = "#444";
    pen.textAlign = "right";
    for (const value of ticks(this.low, this.high, 4)) {
      pen.strokeRect(44, this.y(value), this.wide - 52, 0);
      pen.fillText(written(value), 40, this.y(value) + 4);
    }
    pen.textAlign = "center";
    const last = this.time.at(-1);
    for (const value of ticks(this.time[0], last, 5)) {
      if (this.x(value) < this.wide - 30) pen.fillText(written(value), this.x(value), this.tall - 6);
    }
    pen.textAlign = "right";
    pen.fillText("t [s]", this.wide - 2, this.tall - 6);
    pen.strokeStyle = "#888";
    pen.strokeRect(44, 4, this.wide - 52, this.tall - 24);
  }

  show(time) {
    this.pen.clearRect(0, 0, this.wide, this.tall);
    this.pen.drawImage(this.still, 0, 0, this.wide, this.tall);
    this.pen.fillStyle = "#000";
    this.pen.fillRect(this.x(time) - 0.75, 4, 1.5, this.tall - 24);
    let k = this.time.findIndex((one) => one >= time);
    if (k < 0) k = this.time.length - 1;
    this.lines.forEach((line, n) => (this.readings[n].textContent = `${line.name} ${written(Math.abs(line.values[k]) < 1e-3 * this.high ? 0 : line.values[k])}`));
  }
}

/** The page of a motion: `K3D` draws what stands in it, `told` is what `document.py` tells. */
class MotionPage {
  constructor(K3D, told) {
    Object.assign(this, { K3D, told, time: told.start, end: told.start + told.step * (told.count - 1), magnified: 1 });
    const known = (id) => K3D.getObjectById(id);
    this.parts = told.parts.map((part) => ({ ...part, drawn: part.ids.map(known), place: unpacked(part.place), turn: unpacked(part.turn) }));
    this.bars = told.bars.map((bar) => ({ ...bar, drawn: known(bar.id), tension: bar.tension && unpacked(bar.tension) }));
    const { ids, tips, forces } = told.arrows;
    this.arrows = ids.map((id) => ({ drawn: known(id) }));
    if (ids.length) [this.tips, this.forces] = [unpacked(tips), unpacked(forces)];
    this.still = told.still.map(known);
    this.ground = unpacked(told.ground);
    this.shown = { ground: told.groundMoves && told.groundRests, forces: true };
    for (const one of [...this.parts.flatMap((part) => part.drawn), ...this.bars.map((bar) => bar.drawn), ...this.arrows.map((one) => one.drawn), ...this.still]) this.#prepare(one);
    // forces and links are seen through bodies
    for (const { drawn } of [...this.bars.filter((bar) => bar.tension), ...this.arrows]) {
      Object.assign(drawn.material, { depthTest: false, transparent: true });
      drawn.renderOrder = 10;
    }
  }

  /** Lines lie before the faces on which they are. */
  #prepare(drawn) {
    drawn.frustumCulled = false;
    if (drawn.isMesh) Object.assign(drawn.material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  }

  /** Put a drawn thing at a place, turned and stretched along its z. */
  #put(drawn, place, turn, long = 1) {
    drawn.visible = long > 0;
    drawn.position.set(...place);
    drawn.quaternion.set(...turn);
    drawn.scale.set(1, 1, long || 1);
    drawn.updateMatrix();
    drawn.updateMatrixWorld(true);
  }

  /** Show the instant `time` [s]. */
  show(time) {
    const { told, magnified } = this;
    this.time = Math.min(Math.max(time, told.start), this.end);
    const at = (this.time - told.start) / told.step, k = Math.min(Math.floor(at + 1e-6), told.count - 2), share = at - k;
    const shift = this.shown.ground ? between(this.ground, k, share) : [0, 0, 0];
    const now = this.parts.map((part) => {
      const place = between(part.place, k, share), [a, b] = [k, k + 1].map((n) => [...part.turn.subarray(4 * n, 4 * n + 4)]);
      const step = times(b, [-a[0], -a[1], -a[2], a[3]]);
      const turn = powered(times(powered(step, share), a), magnified);
      const moved = place.map((one, n) => part.rest[n] + magnified * (one - part.rest[n]) + shift[n]);
      for (const drawn of part.drawn) this.#put(drawn, moved, turn);
      return { place: moved, turn };
    });
    for (const drawn of this.still) this.#put(drawn, shift, [0, 0, 0, 1]);
    const end = (part, arm) => (part < 0 ? arm : turned(now[part].turn, arm)).map((one, n) => one + (part < 0 ? shift : now[part].place)[n]);
    for (const bar of this.bars) {
      const [from, to] = bar.parts.map((part, n) => end(part, bar.arms[n])), along = to.map((one, n) => one - from[n]);
      const tension = bar.tension?.[k];
      this.#put(bar.drawn, from, towards(along), Number.isNaN(tension) ? 0 : Math.hypot(...along));
      if (bar.tension) bar.drawn.material.color.setRGB(...scaled(Math.abs(tension) / (told.tension.largest || 1)), "srgb");
    }
    this.arrows.forEach(({ drawn }, n) => {
      const column = n * told.count + k, part = told.arrows.parts[n];
      const force = [0, 1, 2].map((axis) => this.forces[3 * column + axis]);
      const tip = end(part, [0, 1, 2].map((axis) => this.tips[3 * column + axis]));
      this.#put(drawn, tip, Math.hypot(...force) ? towards(force) : [0, 0, 0, 1], this.shown.forces ? Math.hypot(...force) : 0);
    });
    this.clock.textContent = `t = ${this.time.toFixed(3)} s`;
    this.slider.value = this.time;
    this.slider.setAttribute("aria-valuetext", this.clock.textContent);
    for (const strip of this.strips) strip.show(this.time);
    this.K3D.render();
  }

  /** Look at all that moves, however wide the scene is. */
  look() {
    const { focus, toward, up, half, shift, slope } = this.told, box = this.scene.getBoundingClientRect();
    const [wide, tall] = half.map((one, n) => one + (this.shown.ground ? shift[n] : 0));
    const far = Math.max(tall, (wide * box.height) / Math.max(box.width, 1)) / slope + 0.6 * Math.max(wide, tall);
    const lens = this.K3D.getWorld().camera;
    Object.assign(lens, { near: 0.01 * far, far: 4 * far });
    lens.updateProjectionMatrix();
    this.K3D.setCamera([...focus.map((one, n) => one + far * toward[n]), ...focus, ...up]);
  }

  play(on = !this.playing) {
    this.playing = on;
    this.button.textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (this.time >= this.end - 1e-9) this.time = this.told.start;
    let last = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      this.show(this.time + ((now - last) / 1000) * Number(this.speed.value));
      last = now;
      if (this.time >= this.end) this.play(false);
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /** What is drawn is told below the scene. */
  say() {
    const factor = this.magnified === 1 ? "displacements true (\u00d71)" : `displacements \u00d7${this.magnified}: bodies may overlap`;
    const ground = !this.told.groundMoves ? "" : this.shown.ground ? `, ground moves by up to ${this.told.groundLargest}, true` : ", seen from the ground";
    this.said.textContent = factor + ground;
  }

  build(style) {
    const { told } = this;
    made(document.head, "style", {}, style);
    const page = made(document.body, "main", { id: "page" }), head = made(page, "header");
    made(head, "h1", {}, told.title);
    made(head, "p", {}, `t = ${written(told.start)} to ${written(this.end, 4)} s, engine ${told.engine}. Bodies are drawn rigid. Turn: drag; zoom: wheel or two fingers.`);
    this.scene = made(page, "div", { id: "scene" });
    this.scene.append(document.getElementById("canvasTarget"));
    this.clock = made(this.scene, "div", { id: "clock" });
    this.said = made(this.scene, "div", { id: "said" });
    this.#buildBar(made(page, "div", { id: "bar" }));
    const side = made(page, "aside", { id: "side" });
    this.#buildLegend(made(side, "ul", { id: "legend" }));
    this.strips = told.strips.map((strip) => new Strip(side, strip, (time) => this.show(time)));
    new ResizeObserver(() => {
      this.K3D.resizeHelper();
      for (const strip of this.strips) strip.draw();
      this.look();
      this.show(this.time);
    }).observe(this.scene);
    for (const strip of this.strips) strip.draw();
    this.say();
    this.look();
    this.show(told.start);
    document.documentElement.dataset.ready = "true";
  }

  #buildBar(bar) {
    const { told } = this;
    this.button = made(bar, "button", { id: "play", type: "button" }, "Play");
    this.button.addEventListener("click", () => this.play());
    const range = { id: "time", type: "range", min: told.start, max: this.end, step: "any", "aria-label": "time [s]" };
    this.slider = made(bar, "input", range);
    this.slider.addEventListener("input", () => this.show(Number(this.slider.value)));
    const chosen = (id, name, values, at, changed) => {
      const select = made(made(bar, "label", {}, name), "select", { id });
      for (const [value, text] of values) made(select, "option", { value, ...(value === at ? { selected: "" } : {}) }, text);
      select.addEventListener("change", () => changed(Number(select.value)));
      return select;
    };
    const speeds = [...new Set([0.05, 0.1, 0.25, 0.5, 1, 2, told.speed])].sort((a, b) => a - b);
    this.speed = chosen("speed", "speed", speeds.map((one) => [one, `\u00d7${one}`]), told.speed, () => {});
    chosen("magnified", "displacements", [1, 2, 5, 10, 20, 50].map((one) => [one, `\u00d7${one}`]), 1, (value) => this.#change(() => (this.magnified = value)));
    const box = (id, name) => {
      const tick = document.createElement("input");
      Object.assign(tick, { id, type: "checkbox", checked: this.shown[id] });
      made(bar, "label", {}, name).prepend(tick);
      tick.addEventListener("change", () => this.#change(() => (this.shown[id] = tick.checked)));
    };
    if (told.groundMoves) box("ground", "ground moves");
    if (this.arrows.length) box("forces", "contact forces");
    made(bar, "button", { id: "reset", type: "button" }, "Reset view").addEventListener("click", () => this.#change(() => this.look()));
    document.addEventListener("keydown", (event) => {
      if (event.target.closest?.("select, button, input[type=checkbox]")) return;
      if (event.key === " ") this.play();
      else if (event.target !== this.slider && event.key === "ArrowRight") this.show(this.time + told.step);
      else if (event.target !== this.slider && event.key === "ArrowLeft") this.show(this.time - told.step);
      else return;
      event.preventDefault();
    });
  }

  #change(act) {
    act();
    this.say();
    this.show(this.time);
  }

  #buildLegend(legend) {
    const { told } = this, line = (mark, text) => {
      const item = made(legend, "li"), sign = made(item, "i", mark.class ? { class: mark.class } : {});
      if (mark.colour !== undefined) sign.style.background = hex(mark.colour);
      made(item, "span", {}, text);
    };
    for (const [kind, colour] of Object.entries(told.colours)) line({ colour }, kind);
    if (this.arrows.length) line({ class: "arrow" }, told.arrows.said);
    if (this.bars.some((bar) => bar.tension)) line({ class: "scale" }, `tendons and links: 0 to ${told.tension.written}`);
    if (told.still.length) line({ class: "line" }, "feet at rest");
  }
}

/** Build the page. */
function showMotion(K3D, told, style) {
  const page = new MotionPage(K3D, told);
  page.build(style);
  window.motionPage = page;
}
