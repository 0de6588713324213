// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** What the 3D view shows: the newest cloud of every topic, frames, trajectories. */
import { checkLayout, positions, scalars, typicalInterval } from "/cloud.js";
import { TransformTree } from "/transforms.js";
import { fromPose, multiply, origin, transformPoint } from "/vectors.js";

const MAX_TRAIL = 20000;
const MIN_STEP_M = 0.02;
/** Type of a visualization_msgs/Marker. */
const CUBE = 1;
const JUMP_BACK_NS = 1000000000n;
/** Positions and values of points that are not drawn or have no colour; see shaders.js. */
const HIDDEN = 1e30;
const NO_VALUE = -1e38;

export class Scene {
  transforms = new TransformTree();
  clouds = new Map();
  trails = new Map();
  boxes = new Map();
  #newestNs = 0n;

  addCloud(topic, message) {
    checkLayout(message);
    const old = this.clouds.get(topic);
    const frame = message.header.frameId.replace(/^\//, "");
    this.#noteTime(message.header.timeNs);
    this.clouds.set(topic, { topic, message, frame, buffers: old?.buffers, isVisible: true, version: (old?.version ?? 0) + 1 });
  }

  removeCloud(topic) { this.clouds.delete(topic); }

  /** The cubes of a message, which replace those of the topic. */
  addBoxes(topic, message) {
    const boxes = message.markers.filter(({ type, action }) => type === CUBE && action === 0).map((marker) => {
      if (![...marker.position, ...marker.rotation, ...marker.scale].every(Number.isFinite)) throw new Error("a box is not finite");
      const [x, y, z] = marker.scale;
      return {
        frame: marker.header.frameId.replace(/^\//, ""),
        timeNs: marker.header.timeNs,
        colour: [...marker.colour.slice(0, 3), 1],
        frameFromUnit: multiply(fromPose(marker.position, marker.rotation), [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1]),
      };
    });
    this.boxes.set(topic, boxes);
  }

  removeBoxes(topic) { this.boxes.delete(topic); }

  /** Pose and scale of a box of edge length 1; undefined: its frame is not connected to the fixed one. */
  modelOfBox(box) {
    const model = this.transforms.lookup(this.fixedFrame(), box.frame, box.timeNs);
    return model === undefined ? undefined : multiply(model, box.frameFromUnit);
  }

  addTransforms(message) {
    for (const transform of message.transforms) this.transforms.add(transform);
  }

  addOdometry(topic, message) {
    if (!message.position.every(Number.isFinite)) throw new Error("the position is not finite");
    this.#noteTime(message.header.timeNs);
    this.#extend(topic, message.header.frameId.replace(/^\//, ""), message.position);
  }

  /** The frame in which everything is drawn. */
  fixedFrame() {
    const cloud = [...this.clouds.values()].at(-1);
    if (cloud !== undefined) return this.transforms.root(cloud.frame);
    const frames = this.transforms.frames();
    return frames.length > 0 ? this.transforms.root(frames[0]) : "";
  }

  /** Pose of a cloud when it was measured; undefined: its frame is not connected to the fixed one. */
  modelOf(cloud) {
    return this.transforms.lookup(this.fixedFrame(), cloud.frame, cloud.message.header.timeNs);
  }

  /** Adds the sensor's position to its trajectory, when a cloud is drawn for the first time. */
  extendTrail(cloud, model) {
    if (this.transforms.root(cloud.frame) !== cloud.frame) this.#extend(cloud.frame, this.fixedFrame(), origin(model));
  }

  #extend(name, frame, position) {
    let trail = this.trails.get(name);
    if (trail === undefined || trail.frame !== frame) {
      trail = { frame, points: [], version: 0 };
      this.trails.set(name, trail);
    }
    const last = trail.points.slice(-3);
    if (last.length === 3 && Math.hypot(...position.map((value, i) => value - last[i])) < MIN_STEP_M) return;
    trail.points.push(...position);
    ++trail.version;
    if (trail.points.length > 3 * MAX_TRAIL) trail.points.splice(0, 3 * MAX_TRAIL / 2);
  }

  /** A replay that begins again has another past. */
  #noteTime(timeNs) {
    if (timeNs + JUMP_BACK_NS < this.#newestNs) {
      this.trails.clear();
      this.#newestNs = timeNs;
    }
    if (timeNs > this.#newestNs) this.#newestNs = timeNs;
  }
}

/** Fills xyz, values and interval of a cloud for this colouring, unless that is done. */
export function prepareCloud(cloud, key, model) {
  if (cloud.xyz === undefined) cloud.xyz = hideInvalid(positions(cloud.message));
  if (cloud.key === key) return false;
  cloud.key = key;
  const values = scalars(cloud.message, key, cloud.xyz);
  cloud.interval = typicalInterval(values ?? heights(cloud, model));
  if (key === "error") cloud.interval = symmetric(cloud.interval);
  cloud.hasValues = values !== undefined;
  cloud.values = replaceInvalid(values ?? new Float32Array(cloud.xyz.length / 3));
  return true;
}

function replaceInvalid(values) {
  for (let i = 0; i < values.length; ++i) {
    if (!Number.isFinite(values[i])) values[i] = NO_VALUE;
  }
  return values;
}

/** An error of zero has the colour in the middle. */
function symmetric([min, max]) {
  const end = Math.max(Math.abs(min), Math.abs(max));
  return [-end, end];
}

function hideInvalid(xyz) {
  for (let i = 0; i < xyz.length; i += 3) {
    if (!(Math.abs(xyz[i]) + Math.abs(xyz[i + 1]) + Math.abs(xyz[i + 2]) < HIDDEN)) xyz.fill(HIDDEN, i, i + 3);
  }
  return xyz;
}

/** Of a sample of the points, for the colour bar. */
function heights(cloud, model) {
  const list = [];
  const step = 3 * Math.max(1, Math.floor(cloud.xyz.length / 15000));
  for (let i = 0; i + 2 < cloud.xyz.length; i += step) {
    if (cloud.xyz[i] < HIDDEN / 2) list.push(transformPoint(model, cloud.xyz.subarray(i, i + 3))[2]);
  }
  return list;
}
