"use strict";

/** A number as the page writes it: a true minus, no more digits than tell it. */
function written(value, digits = 3) {
  return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

/** Ticks from low to high at 1, 2 or 5 times a power of ten, about `wanted` of them. */
function ticks(low, high, wanted) {
  const rough = (high - low) / Math.max(wanted, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= 0.999 * rough);
  const found = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n++) found.push(Number((n * step).toPrecision(12)));
  return found;
}

/** A new SVG element with attributes and text, the last of `parent`. */
function drawn(parent, name, attributes = {}, text = "") {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  parent.append(element);
  return element;
}

/** A label; "u_max" in it is the letter in italics with its index below, "t_" the letter alone. */
function labelled(parent, attributes, text) {
  const label = drawn(parent, "text", attributes);
  let lowered = 0;
  for (const piece of text.split(/([a-z]_[a-z]*)/)) {
    const [symbol, index] = piece.includes("_") ? piece.split("_") : [];
    drawn(label, "tspan", { dy: -lowered, "font-style": symbol ? "italic" : "normal" }, symbol ?? piece);
    lowered = index ? 4 : 0;
    if (index) drawn(label, "tspan", { dy: lowered, "font-size": "10px" }, index);
  }
}

/**
 * A pair of axes in an SVG element.
 *
 * x, y: [low, high] of the axes; xLabel, yLabel: with their units; width, height: of the whole [pixels]; lastTick: of x.
 * What is drawn is given in the units of the axes and cut at their edges.
 */
class Chart {
  static margin = { left: 54, right: 14, top: 12, bottom: 44 };

  constructor(svg, { x, y, xLabel, yLabel, width, height, lastTick = x[1] }) {
    Object.assign(this, { svg, x, y, width, height });
    svg.replaceChildren();
    for (const [key, value] of Object.entries({ width, height, viewBox: `0 0 ${width} ${height}` })) svg.setAttribute(key, value);
    const { left, right, top, bottom } = Chart.margin;
    this.box = { x: left, y: top, width: width - left - right, height: height - top - bottom };
    this.#axes(xLabel, yLabel, lastTick);
    const clip = drawn(svg, "clipPath", { id: `${svg.id}-clip` });
    drawn(clip, "rect", this.box);
    this.inside = drawn(svg, "g", { "clip-path": `url(#${svg.id}-clip)` });
  }

  /** Height of a chart of a given width whose axes have the same scale. */
  static square(width) {
    const { left, right, top, bottom } = Chart.margin;
    return width - left - right + top + bottom;
  }

  toX(value) {
    return this.box.x + (this.box.width * (value - this.x[0])) / (this.x[1] - this.x[0]);
  }

  toY(value) {
    return this.box.y + this.box.height * (1 - (value - this.y[0]) / (this.y[1] - this.y[0]));
  }

  /** The value of x at a pixel of the window, kept within the axis. */
  fromWindow(pixel) {
    const share = (pixel - this.svg.getBoundingClientRect().left - this.box.x) / this.box.width;
    return this.x[0] + (this.x[1] - this.x[0]) * Math.min(Math.max(share, 0), 1);
  }

  #axes(xLabel, yLabel, lastTick) {
    const { x: left, y: top, width, height } = this.box;
    for (const value of ticks(this.x[0], lastTick, width / 55)) {
      const at = this.toX(value);
      drawn(this.svg, "line", { class: "grid", x1: at, x2: at, y1: top, y2: top + height });
      drawn(this.svg, "text", { x: at, y: top + height + 16, "text-anchor": "middle" }, written(value, 6));
    }
    for (const value of ticks(...this.y, height / 40)) {
      const at = this.toY(value);
      drawn(this.svg, "line", { class: "grid", x1: left, x2: left + width, y1: at, y2: at });
      drawn(this.svg, "text", { x: left - 6, y: at + 4, "text-anchor": "end" }, written(value, 6));
    }
    drawn(this.svg, "rect", { class: "frame", x: left, y: top, width, height });
    labelled(this.svg, { x: left + width / 2, y: top + height + 36, "text-anchor": "middle" }, xLabel);
    labelled(this.svg, { transform: `translate(13 ${top + height / 2}) rotate(-90)`, "text-anchor": "middle" }, yLabel);
  }

  /** A line through the points (x[i], y[i]); look: colour and dash. */
  line(x, y, { colour, dash = "", width = 1.5 }) {
    const points = Array.from(x, (value, i) => `${this.toX(value).toFixed(1)},${this.toY(y[i]).toFixed(1)}`).join(" ");
    drawn(this.inside, "polyline", { points, fill: "none", stroke: colour, "stroke-dasharray": dash, "stroke-width": width, "stroke-linejoin": "round" });
  }

  /** A shade from x = low to high over the whole height. */
  shade(low, high, name) {
    const { y, height } = this.box;
    drawn(this.inside, "rect", { class: name, x: this.toX(low), y, width: Math.max(this.toX(high) - this.toX(low), 1), height });
  }

  /** A cross where an analysis stopped, kept within the axes. */
  cross(x, y, colour) {
    const at = { x: Math.min(Math.max(x, this.x[0]), this.x[1]), y: Math.min(Math.max(y, this.y[0]), this.y[1]) };
    const path = "M-4,-4L4,4M-4,4L4,-4";
    drawn(this.svg, "path", { d: path, transform: `translate(${this.toX(at.x)} ${this.toY(at.y)})`, stroke: colour, "stroke-width": 2.4, class: "end" });
  }
}
