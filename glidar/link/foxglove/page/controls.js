// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** The camera that orbits a target, and its control by mouse, touch and keyboard. */
import { add, cross, lookAt, multiply, perspective } from "/vectors.js";

const FOV_RAD = 0.9;
const MAX_PITCH_RAD = Math.PI / 2 - 1e-4;
const CLICK_PIXELS = 4;
const START = { yaw: -2.6, pitch: 0.55, distance: 32 };

export class OrbitCamera {
  target = [0, 0, 0];
  yaw = START.yaw;
  pitch = START.pitch;
  distance = START.distance;

  reset() { Object.assign(this, START); }

  /** From above, x up. */
  lookDown() { Object.assign(this, { yaw: -Math.PI, pitch: MAX_PITCH_RAD }); }

  /** From behind the sensor, along x. */
  lookForward() { Object.assign(this, { yaw: -Math.PI, pitch: 0.35 }); }

  orbit(dx, dy) {
    this.yaw -= dx;
    this.pitch = Math.min(Math.max(this.pitch + dy, -MAX_PITCH_RAD), MAX_PITCH_RAD);
  }

  zoom(factor) { this.distance = Math.min(Math.max(this.distance * factor, 0.1), 5000); }

  /** By shares of the height of the view. */
  pan(dx, dy) {
    const scale = 2 * this.distance * Math.tan(FOV_RAD / 2);
    const back = this.#back();
    const right = cross([0, 0, 1], back);
    const norm = Math.hypot(...right) || 1;
    const up = cross(back, right);
    this.target = add(add(this.target, right, (-dx * scale) / norm), up, (dy * scale) / norm);
  }

  eye() { return add(this.target, this.#back(), this.distance); }

  projection(aspect) {
    const view = lookAt(this.eye(), this.target, [0, 0, 1]);
    return multiply(perspective(FOV_RAD, aspect, Math.max(this.distance / 200, 0.02), this.distance * 20 + 500), view);
  }

  #back() {
    return [Math.cos(this.pitch) * Math.cos(this.yaw), Math.cos(this.pitch) * Math.sin(this.yaw), Math.sin(this.pitch)];
  }
}

/** actions: changed(), panned(), clicked(x, y), and one per key of KEYS. */
export function addControls(canvas, camera, actions) {
  const pointers = new Map();
  let moved = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    moved = pointers.size > 1 ? CLICK_PIXELS + 1 : 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (last === undefined) return;
    const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
    moved += Math.abs(dx) + Math.abs(dy);
    const before = [...pointers.values()].map((place) => [...place]);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (moved <= CLICK_PIXELS) return;
    if (pointers.size === 2) pinch(before, [...pointers.values()]);
    else if ((event.buttons & 6) !== 0 || event.shiftKey) pan(dx, dy);
    else if (pointers.size === 1) camera.orbit(dx / 200, dy / 200);
    actions.changed();
  });
  const end = (event) => {
    if (!pointers.delete(event.pointerId)) return;
    if (event.type === "pointerup" && moved <= CLICK_PIXELS && event.button === 0) actions.clicked(event.offsetX, event.offsetY);
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(Math.min(Math.max(event.deltaY, -200), 200) / 500));
    actions.changed();
  }, { passive: false });

  function pan(dx, dy) {
    camera.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
    actions.panned();
  }

  function pinch([a, b], [c, d]) {
    const spread = (p, q) => Math.max(Math.hypot(p[0] - q[0], p[1] - q[1]), 1);
    camera.zoom(spread(a, b) / spread(c, d));
    pan((c[0] + d[0] - a[0] - b[0]) / 2, (c[1] + d[1] - a[1] - b[1]) / 2);
  }

  addKeys(camera, actions);
}

function addKeys(camera, actions) {
  const keys = {
    ArrowLeft: () => camera.orbit(0.08, 0),
    ArrowRight: () => camera.orbit(-0.08, 0),
    ArrowUp: () => camera.orbit(0, 0.08),
    ArrowDown: () => camera.orbit(0, -0.08),
    "+": () => camera.zoom(0.9),
    "=": () => camera.zoom(0.9),
    "-": () => camera.zoom(1 / 0.9),
    a: () => { camera.pan(0.04, 0); actions.panned(); },
    d: () => { camera.pan(-0.04, 0); actions.panned(); },
    w: () => { camera.pan(0, 0.04); actions.panned(); },
    s: () => { camera.pan(0, -0.04); actions.panned(); },
    r: actions.reset,
    t: actions.top,
    b: actions.behind,
    f: actions.follow,
    " ": actions.play,
    ".": actions.step,
    "[": () => actions.size(-0.5),
    "]": () => actions.size(0.5),
  };
  document.addEventListener("keydown", (event) => {
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    const isInControl = /^(INPUT|SELECT|TEXTAREA|BUTTON)$/.test(event.target.tagName);
    if (action === undefined || isInControl || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    action();
    actions.changed();
  });
}
