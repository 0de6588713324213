// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Draws the scene with WebGL 2. */
import { isCategory } from "/cloud.js";
import { CATEGORY_MAP, MAPS } from "/colours.js";
import { prepareCloud } from "/scene.js";
import { lineProgram, pointProgram } from "/shaders.js";
import { IDENTITY, multiply } from "/vectors.js";

const GRID_STEP_M = 5;
const GRID_CELLS = 20;
const AXES = [[1, 0, 0, [0.94, 0.33, 0.31, 1]], [0, 1, 0, [0.4, 0.78, 0.36, 1]], [0, 0, 1, [0.36, 0.58, 0.97, 1]]];
const TRAIL_COLOUR = [1, 0.78, 0.3, 1];
const GRID_COLOUR = [0.17, 0.21, 0.25, 1];

export class View {
  #canvas;
  #gl;
  #points;
  #lines;
  #map;
  #mapName;
  #grid;
  #axes;
  #cube;

  constructor(canvas) {
    this.#canvas = canvas;
    this.#gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: false });
    if (this.#gl === null) throw new Error("this browser offers no WebGL 2, which the view needs");
    this.#create();
  }

  /** Makes all objects; again after the context was lost. */
  #create() {
    const gl = this.#gl;
    this.#points = pointProgram(gl);
    this.#lines = lineProgram(gl);
    this.#map = gl.createTexture();
    this.#mapName = undefined;
    this.#grid = this.#makeLines(gridLines());
    this.#axes = AXES.map(([x, y, z]) => this.#makeLines([0, 0, 0, x, y, z]));
    this.#cube = this.#makeLines(cubeEdges());
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0.055, 0.07, 0.086, 1);
  }

  restore(scene) {
    for (const cloud of scene.clouds.values()) cloud.buffers = undefined;
    for (const trail of scene.trails.values()) trail.buffers = undefined;
    this.#create();
  }

  /** settings: key, map, interval (or undefined), size, showGrid, showFrames, showTrails. Returns what the
   * colour bar shows, and the number of boxes: {interval, isCategory, points, boxes}. */
  draw(scene, camera, settings) {
    const gl = this.#gl;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.#canvas.clientWidth, this.#canvas.clientHeight].map((size) => Math.max(1, Math.round(size * ratio)));
    if (this.#canvas.width !== width || this.#canvas.height !== height) Object.assign(this.#canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const projection = camera.projection(width / height);
    const shown = this.#drawClouds(scene, projection, settings, ratio);
    gl.useProgram(this.#lines.program);
    gl.uniformMatrix4fv(this.#lines.at.projection, false, projection);
    if (settings.showGrid) this.#drawGrid(camera);
    if (settings.showTrails) this.#drawTrails(scene);
    if (settings.showFrames) this.#drawFrames(scene, camera);
    return { ...shown, boxes: this.#drawBoxes(scene) };
  }

  #drawClouds(scene, projection, settings, ratio) {
    const gl = this.#gl;
    const category = isCategory(settings.key);
    this.#useMap(category ? "category" : settings.map);
    gl.useProgram(this.#points.program);
    gl.uniformMatrix4fv(this.#points.at.projection, false, projection);
    gl.uniform1f(this.#points.at.size, settings.size * ratio);
    let points = 0;
    const ready = [];
    for (const cloud of scene.clouds.values()) {
      const model = scene.modelOf(cloud);
      if (model === undefined) continue;
      if (cloud.xyz === undefined) scene.extendTrail(cloud, model);
      if (prepareCloud(cloud, settings.key, model)) this.#upload(cloud);
      ready.push({ cloud, model });
      points += cloud.xyz.length / 3;
    }
    const interval = mergedInterval(ready, settings.interval);
    gl.uniform2fv(this.#points.at.interval, interval);
    for (const { cloud, model } of ready) {
      gl.uniformMatrix4fv(this.#points.at.model, false, model);
      gl.uniform1i(this.#points.at.mode, cloud.hasValues ? (category ? 2 : 0) : 1);
      gl.bindVertexArray(cloud.buffers.array);
      gl.drawArrays(gl.POINTS, 0, cloud.xyz.length / 3);
    }
    return { interval, isCategory: category, points };
  }

  #upload(cloud) {
    const gl = this.#gl;
    if (cloud.buffers === undefined) {
      cloud.buffers = { array: gl.createVertexArray(), xyz: gl.createBuffer(), values: gl.createBuffer() };
      gl.bindVertexArray(cloud.buffers.array);
      [[cloud.buffers.xyz, 3], [cloud.buffers.values, 1]].forEach(([buffer, size], place) => {
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.enableVertexAttribArray(place);
        gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
      });
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, cloud.buffers.xyz);
    gl.bufferData(gl.ARRAY_BUFFER, cloud.xyz, gl.STREAM_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, cloud.buffers.values);
    gl.bufferData(gl.ARRAY_BUFFER, cloud.values, gl.STREAM_DRAW);
  }

  /** Frees the buffers of a cloud that is no longer shown. */
  release(cloud) {
    if (cloud?.buffers === undefined) return;
    this.#gl.deleteVertexArray(cloud.buffers.array);
    this.#gl.deleteBuffer(cloud.buffers.xyz);
    this.#gl.deleteBuffer(cloud.buffers.values);
    cloud.buffers = undefined;
  }

  #useMap(name) {
    const gl = this.#gl;
    gl.bindTexture(gl.TEXTURE_2D, this.#map);
    if (this.#mapName === name) return;
    this.#mapName = name;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, name === "category" ? CATEGORY_MAP : MAPS.get(name));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  #makeLines(xyz) {
    const gl = this.#gl;
    const lines = { array: gl.createVertexArray(), buffer: gl.createBuffer(), count: 0 };
    gl.bindVertexArray(lines.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, lines.buffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    this.#fill(lines, xyz);
    return lines;
  }

  #fill(lines, xyz) {
    const gl = this.#gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, lines.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(xyz), gl.DYNAMIC_DRAW);
    lines.count = xyz.length / 3;
  }

  #drawLines(lines, model, colour, mode) {
    const gl = this.#gl;
    gl.uniformMatrix4fv(this.#lines.at.model, false, model);
    gl.uniform4fv(this.#lines.at.colour, colour);
    gl.bindVertexArray(lines.array);
    gl.drawArrays(mode, 0, lines.count);
  }

  #drawGrid(camera) {
    const model = [...IDENTITY];
    for (const i of [0, 1]) model[12 + i] = GRID_STEP_M * Math.round(camera.target[i] / GRID_STEP_M);
    this.#drawLines(this.#grid, model, GRID_COLOUR, this.#gl.LINES);
  }

  #drawTrails(scene) {
    for (const trail of scene.trails.values()) {
      const model = scene.transforms.lookup(scene.fixedFrame(), trail.frame);
      if (model === undefined) continue;
      trail.buffers ??= this.#makeLines([]);
      if (trail.drawn !== trail.version || trail.buffers.count === 0) this.#fill(trail.buffers, trail.points);
      trail.drawn = trail.version;
      this.#drawLines(trail.buffers, model, TRAIL_COLOUR, this.#gl.LINE_STRIP);
    }
  }

  #drawBoxes(scene) {
    let drawn = 0;
    for (const box of [...scene.boxes.values()].flat()) {
      const model = scene.modelOfBox(box);
      if (model === undefined) continue;
      this.#drawLines(this.#cube, model, box.colour, this.#gl.LINES);
      ++drawn;
    }
    return drawn;
  }

  #drawFrames(scene, camera) {
    const size = Math.min(Math.max(camera.distance / 20, 0.1), 3);
    const scale = [size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, 0, 0, 0, 0, 1];
    for (const frame of scene.transforms.frames()) {
      const model = scene.transforms.lookup(scene.fixedFrame(), frame);
      if (model === undefined) continue;
      this.#axes.forEach((lines, i) => this.#drawLines(lines, multiply(model, scale), AXES[i][3], this.#gl.LINES));
    }
  }
}

/** The edges of a cube of edge length 1 around the origin. */
function cubeEdges() {
  const xyz = [];
  for (const [axis, u, v] of [[0, 1, 2], [1, 2, 0], [2, 0, 1]]) {
    for (const [a, b] of [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]]) {
      for (const end of [-0.5, 0.5]) {
        const corner = [0, 0, 0];
        [corner[axis], corner[u], corner[v]] = [end, a, b];
        xyz.push(...corner);
      }
    }
  }
  return xyz;
}

function gridLines() {
  const end = GRID_STEP_M * GRID_CELLS;
  const xyz = [];
  for (let i = -GRID_CELLS; i <= GRID_CELLS; ++i) {
    const at = i * GRID_STEP_M;
    xyz.push(at, -end, 0, at, end, 0, -end, at, 0, end, at, 0);
  }
  return xyz;
}

/** Of all clouds; `wanted` replaces one or both ends. */
function mergedInterval(ready, wanted) {
  let min = Math.min(...ready.map(({ cloud }) => cloud.interval[0]));
  let max = Math.max(...ready.map(({ cloud }) => cloud.interval[1]));
  if (ready.length === 0) [min, max] = [0, 1];
  min = wanted[0] ?? min;
  max = wanted[1] ?? max;
  return max > min ? [min, max] : [min, min + 1e-6 + Math.abs(min) * 1e-6];
}
