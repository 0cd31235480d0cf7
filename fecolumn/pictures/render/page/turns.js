// Places and turns between the instants that the page holds.
"use strict";

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
