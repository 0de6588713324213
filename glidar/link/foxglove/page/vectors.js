// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** 4 x 4 matrices, column by column, and vectors of 3 numbers, as plain arrays. */

export const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

export function multiply(a, b) {
  const result = new Array(16);
  for (let col = 0; col < 4; ++col) {
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + row] * b[4 * col + k];
      result[4 * col + row] = sum;
    }
  }
  return result;
}

/** From a position and a quaternion x y z w, which is normalised. */
export function fromPose(position, rotation) {
  const norm = Math.hypot(...rotation) || 1;
  const [x, y, z, w] = rotation.map((value) => value / norm);
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0,
    2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,
    2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0,
    ...position, 1,
  ];
}

/** The inverse of a rotation and translation. */
export function invertRigid(m) {
  const t = [m[12], m[13], m[14]];
  const rows = [[m[0], m[1], m[2]], [m[4], m[5], m[6]], [m[8], m[9], m[10]]];
  const moved = rows.map((row) => -(row[0] * t[0] + row[1] * t[1] + row[2] * t[2]));
  return [m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0, ...moved, 1];
}

export function transformPoint(m, p) {
  return [0, 1, 2].map((i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i]);
}

export function origin(m) { return [m[12], m[13], m[14]]; }

export function perspective(fovRad, aspect, near, far) {
  const f = 1 / Math.tan(fovRad / 2);
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
}

export function add(a, b, scale = 1) { return a.map((value, i) => value + scale * b[i]); }

export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function normalized(a) {
  const norm = Math.hypot(...a) || 1;
  return a.map((value) => value / norm);
}

/** The camera's view: x right, y up, z backward. */
export function lookAt(eye, target, up) {
  const back = normalized(add(eye, target, -1));
  const right = normalized(cross(up, back));
  const top = cross(back, right);
  return invertRigid([...right, 0, ...top, 0, ...back, 0, ...eye, 1]);
}
