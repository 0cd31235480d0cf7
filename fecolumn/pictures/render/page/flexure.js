// Deformation of bodies, and pressure on faces.
"use strict";

// YlOrRd, from the least pressure to the largest
const PRESSURES = [[0xff, 0xff, 0xb2], [0xfe, 0xb2, 0x4c], [0xf0, 0x3b, 0x20], [0x80, 0x00, 0x26]];

/** A face whose elements are coloured by their pressure. */
class PressedFace {
  constructor(told, known) {
    Object.assign(this, { part: told.part, corners: told.corners, drawn: known(told.id) });
    this.levels = Uint8Array.from(atob(told.levels), (one) => one.charCodeAt(0));
    const { geometry, material } = this.drawn, position = geometry.attributes.position;
    this.rest = position.array.slice();
    this.count = position.count / this.corners;
    geometry.setAttribute("color", new position.constructor(new Float32Array(3 * position.count).fill(1), 3));
    Object.assign(material, { vertexColors: true, needsUpdate: true });
    material.color.setRGB(1, 1, 1);
    material.emissive?.setRGB(0, 0, 0);
  }

  /** Colour the elements at an instant, hide those without pressure; whether any has some. */
  colour(instant) {
    const { position, color } = this.drawn.geometry.attributes, wide = 3 * this.corners;
    let some = false;
    for (let k = 0; k < this.count; k++) {
      const level = this.levels[instant * this.count + k], tint = scaled((level - 1) / 254, PRESSURES);
      some ||= level > 0;
      for (let n = 0; n < wide; n++) {
        position.array[k * wide + n] = this.rest[k * wide + (level > 0 ? n : n % 3)];
        color.array[k * wide + n] = tint[n % 3];
      }
    }
    position.needsUpdate = color.needsUpdate = true;
    return some;
  }
}

/** What fields or states add to the motion: `told` is what `document.py` tells, `parts` those of the page. */
class Flexure {
  constructor(told, parts, known) {
    this.times = told.times ? unpacked(told.times) : new Float32Array(0);
    this.faces = told.faces.map((face) => new PressedFace(face, known));
    this.parts = told.parts.map((one, k) => one && this.#prepared(one, parts[k])).filter((one) => one);
    this.bends = this.parts.length > 0;
    this.at = 0;
  }

  /** Shapes of a part, and of what is drawn of it the place at rest and the points that move it. */
  #prepared(told, part) {
    const bytes = (text) => Uint8Array.from(atob(text), (one) => one.charCodeAt(0)).buffer;
    const shapes = new Int16Array(bytes(told.shapes)), long = shapes.length / told.count;
    const ends = [null, ...told.ends.map((one) => new Uint32Array(bytes(one)))];
    const drawn = part.drawn.map((one, k) => ({ position: one.geometry.attributes.position, points: ends[k] }));
    for (const one of drawn) one.rest = one.position.array.slice();
    return { ...told, shapes, long, drawn, shares: unpacked(told.shares) };
  }

  /** Bend all parts as at a time [s], `factor` times. */
  bend(time, factor) {
    const { times } = this;
    if (times.length === 0) return;
    let k = 0;
    while (k < times.length - 2 && times[k + 1] <= time) k++;
    const share = Math.min(Math.max((time - times[k]) / (times[k + 1] - times[k]), 0), 1);
    this.at = share < 0.5 ? k : k + 1;
    for (const { count, shapes, shares, unit, long, drawn } of this.parts) {
      const moved = new Float32Array(long);
      for (let r = 0; r < count; r++) {
        const one = shares[k * count + r], amount = factor * unit * (one + share * (shares[(k + 1) * count + r] - one));
        for (let n = 0; n < long; n++) moved[n] += amount * shapes[r * long + n];
      }
      for (const { position, points, rest } of drawn) {
        for (let n = 0; n < position.count; n++)
          for (let axis = 0; axis < 3; axis++) position.array[3 * n + axis] = rest[3 * n + axis] + moved[3 * (points ? points[n] : n) + axis];
        position.needsUpdate = true;
      }
    }
  }
}
