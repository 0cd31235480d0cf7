"use strict";

const hex = (colour) => "#" + colour.toString(16).padStart(6, "0");
// Viridis from light to dark, by the share of the largest force
const SCALE = [[0xfd, 0xe7, 0x25], [0x35, 0xb7, 0x79], [0x31, 0x68, 0x8e], [0x44, 0x01, 0x54]];

function scaled(share, scale = SCALE) {
  const at = Math.min(Math.max(share, 0), 1) * (scale.length - 1), k = Math.min(Math.floor(at), scale.length - 2);
  return scale[k].map((low, n) => (low + (at - k) * (scale[k + 1][n] - low)) / 255);
}

/** The page of a motion: `K3D` draws what stands in it, `told` is what `document.py` tells. */
class MotionPage {
  constructor(K3D, told) {
    Object.assign(this, { K3D, told, time: told.start, end: told.start + told.step * (told.count - 1), magnified: 1 });
    const known = (id) => K3D.getObjectById(id);
    this.parts = told.parts.map((part) => ({ ...part, drawn: part.ids.map(known), place: unpacked(part.place), turn: unpacked(part.turn) }));
    this.rods = told.rods.map((rod) => ({ ...rod, drawn: known(rod.id), tension: rod.tension && unpacked(rod.tension) }));
    const { ids, tips, forces } = told.arrows;
    this.arrows = ids.map((id) => ({ drawn: known(id) }));
    if (ids.length) [this.tips, this.forces] = [unpacked(tips), unpacked(forces)];
    this.flexure = new Flexure(told.flexure, this.parts, known);
    this.bent = 1;
    this.still = told.still.map(known);
    this.ground = unpacked(told.ground);
    this.shown = { ground: told.groundMoves && told.groundRests, forces: true, pressure: true };
    for (const one of [...this.parts.flatMap((part) => part.drawn), ...this.rods.map((rod) => rod.drawn), ...this.arrows.map((one) => one.drawn), ...this.flexure.faces.map((one) => one.drawn), ...this.still]) this.#prepare(one);
    // forces, links and pressure are seen through bodies
    for (const { drawn } of [...this.flexure.faces, ...this.rods.filter((rod) => rod.tension), ...this.arrows]) {
      Object.assign(drawn.material, { depthTest: false, transparent: true });
      drawn.renderOrder = 10;
    }
    for (const { drawn } of this.flexure.faces) drawn.renderOrder = 9;
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
    this.flexure.bend(this.time, this.bent);
    for (const face of this.flexure.faces) {
      const { place, turn } = now[face.part];
      this.#put(face.drawn, place, turn, this.shown.pressure && face.colour(this.flexure.at) ? 1 : 0);
    }
    for (const drawn of this.still) this.#put(drawn, shift, [0, 0, 0, 1]);
    const end = (part, arm) => (part < 0 ? arm : turned(now[part].turn, arm)).map((one, n) => one + (part < 0 ? shift : now[part].place)[n]);
    for (const rod of this.rods) {
      const [from, to] = rod.parts.map((part, n) => end(part, rod.arms[n])), along = to.map((one, n) => one - from[n]);
      const tension = rod.tension?.[k];
      this.#put(rod.drawn, from, towards(along), Number.isNaN(tension) ? 0 : Math.hypot(...along));
      if (rod.tension) rod.drawn.material.color.setRGB(...scaled((Math.abs(tension) - told.tension.low) / (told.tension.high - told.tension.low || 1)), "srgb");
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
    // words stand above and below
    const far = Math.max(1.12 * tall, (wide * box.height) / Math.max(box.width, 1)) / slope + 0.6 * Math.max(wide, tall);
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
    const bent = !this.flexure.bends ? "" : this.bent === 0 ? ", bodies rigid" : `, deformation ${this.bent === 1 ? "true (\u00d71)" : `\u00d7${this.bent}`}, at most ${this.told.flexure.largest}`;
    this.said.textContent = factor + bent + ground;
  }

  build(style) {
    const { told } = this;
    made(document.head, "style", {}, style);
    const page = made(document.body, "main", { id: "page" }), head = made(page, "header");
    made(head, "h1", {}, told.title);
    made(head, "p", {}, `t = ${written(told.start)} to ${written(this.end, 4)} s, engine ${told.engine}. ${this.flexure.bends ? "" : "Bodies are drawn rigid. "}Turn: drag; zoom: wheel or two fingers.`);
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
    if (this.flexure.bends) {
      const factors = [...new Set([0, 1, 10, 100, 1000, told.flexure.seen])].sort((a, b) => a - b);
      chosen("bent", "deformation", factors.map((one) => [one, one ? `\u00d7${one}` : "none"]), 1, (value) => this.#change(() => (this.bent = value)));
    }
    const box = (id, name) => {
      const tick = document.createElement("input");
      Object.assign(tick, { id, type: "checkbox", checked: this.shown[id] });
      made(bar, "label", {}, name).prepend(tick);
      tick.addEventListener("change", () => this.#change(() => (this.shown[id] = tick.checked)));
    };
    if (told.groundMoves) box("ground", "ground moves");
    if (this.arrows.length) box("forces", "contact forces");
    if (this.flexure.faces.length) box("pressure", "pressure");
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
    if (this.rods.some((rod) => rod.tension)) line({ class: "scale" }, `force of links: ${told.tension.written}`);
    if (this.flexure.faces.length) line({ class: "pressure" }, told.flexure.pressure);
    if (told.still.length) line({ class: "line" }, "feet at rest");
  }
}

/** Build the page. */
function showMotion(K3D, told, style) {
  const page = new MotionPage(K3D, told);
  page.build(style);
  window.motionPage = page;
}
