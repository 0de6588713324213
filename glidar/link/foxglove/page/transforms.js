// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** The coordinate frames of /tf and /tf_static as a tree with a short history. */
import { IDENTITY, fromPose, invertRigid, multiply } from "/vectors.js";

const MAX_HISTORY = 200;
const MAX_FRAMES = 1000;
const MAX_DEPTH = 64;

export class TransformTree {
  /** Child frame -> parent, history of {timeNs, matrix} ordered by time. */
  #links = new Map();

  add(transform) {
    const { header, childFrameId, position, rotation } = transform;
    const parent = header.frameId.replace(/^\//, "");
    const child = childFrameId.replace(/^\//, "");
    if (![...position, ...rotation].every(Number.isFinite)) throw new Error(`transform of ${child} is not finite`);
    let link = this.#links.get(child);
    if (link === undefined || link.parent !== parent) {
      if (this.#links.size >= MAX_FRAMES) throw new Error(`more than ${MAX_FRAMES} frames`);
      link = { parent, history: [] };
      this.#links.set(child, link);
    }
    const entry = { timeNs: header.timeNs, matrix: fromPose(position, rotation) };
    const last = link.history.at(-1);
    if (last !== undefined && entry.timeNs <= last.timeNs) link.history = link.history.filter((other) => other.timeNs < entry.timeNs);
    link.history.push(entry);
    if (link.history.length > MAX_HISTORY) link.history.shift();
  }

  clear() { this.#links.clear(); }

  frames() {
    const names = new Set(this.#links.keys());
    for (const link of this.#links.values()) names.add(link.parent);
    return [...names];
  }

  /** The frame that all others hang from. */
  root(frame) {
    let name = frame;
    for (let depth = 0; depth < MAX_DEPTH && this.#links.has(name); ++depth) name = this.#links.get(name).parent;
    return name;
  }

  /** Matrix that takes points of the frame to its root; of the nearest time, or the newest. */
  rootFrom(frame, timeNs) {
    let matrix = IDENTITY;
    let name = frame;
    for (let depth = 0; depth < MAX_DEPTH && this.#links.has(name); ++depth) {
      const link = this.#links.get(name);
      matrix = multiply(nearest(link.history, timeNs).matrix, matrix);
      name = link.parent;
    }
    return matrix;
  }

  /** undefined if the frames are not connected. */
  lookup(target, source, timeNs) {
    if (target === source) return IDENTITY;
    if (this.root(target) !== this.root(source)) return undefined;
    return multiply(invertRigid(this.rootFrom(target, timeNs)), this.rootFrom(source, timeNs));
  }
}

function nearest(history, timeNs) {
  let best = history.at(-1);
  if (timeNs === undefined) return best;
  const distance = (entry) => (entry.timeNs > timeNs ? entry.timeNs - timeNs : timeNs - entry.timeNs);
  for (let i = history.length - 2; i >= 0 && distance(history[i]) <= distance(best); --i) best = history[i];
  return best;
}
