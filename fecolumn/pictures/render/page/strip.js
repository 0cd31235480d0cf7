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

const LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"];
const DASHES = [[], [5, 3], [1.5, 2], [7, 2, 1.5, 2]];

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
