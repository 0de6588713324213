// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Connects the parts of the page. */
import { Connection } from "/connection.js";
import { OrbitCamera, addControls } from "/controls.js";
import { ImagePanel } from "/images.js";
import { ColourBar, ColourChoice, FrameLabels, TopicList, formatCount } from "/panels.js";
import { PointPanel, findPoint } from "/picking.js";
import { Playback } from "/playback.js";
import { PLAYBACK_SCHEMA, decodeMessage, isShown } from "/ros_messages.js";
import { Scene } from "/scene.js";
import { origin } from "/vectors.js";
import { View } from "/view.js";

const element = (id) => document.getElementById(id);
const canvas = element("view");
const scene = new Scene();
const camera = new OrbitCamera();
const points = new PointPanel();
const labels = new FrameLabels();
const bar = new ColourBar();
const choice = new ColourChoice(requestDraw);
const topics = new TopicList(toggle);
const images = new ImagePanel(element("images"), (topic, problem) => topics.report(topic, problem));
const playback = new Playback(showBanner);
const switchedOff = new Set();
let isDrawRequested = false;
let shownPoints = 0;
let drawTimes = [];

function showBanner(text) {
  element("banner").textContent = text;
  element("banner").hidden = text === "";
}

function requestDraw() {
  if (isDrawRequested) return;
  isDrawRequested = true;
  requestAnimationFrame(draw);
}

function settings() {
  return {
    key: choice.key,
    map: choice.map,
    interval: choice.interval,
    size: Number(element("point-size").value),
    showGrid: element("show-grid").checked,
    showFrames: element("show-frames").checked,
    showTrails: element("show-trails").checked,
  };
}

function followSensor() {
  const cloud = [...scene.clouds.values()].at(-1);
  const model = cloud === undefined ? undefined : scene.modelOf(cloud);
  if (element("follow").checked && model !== undefined) camera.target = origin(model);
}

function draw() {
  isDrawRequested = false;
  followSensor();
  let shown;
  try {
    shown = view.draw(scene, camera, settings());
  } catch (error) {
    showBanner(`The view cannot be drawn: ${error.message}`);
    return;
  }
  shownPoints = shown.points;
  bar.show(choice, shown);
  labels.show(scene, camera, canvas, element("show-frames").checked);
  points.place(camera, canvas);
  element("empty").hidden = scene.clouds.size > 0;
  drawTimes.push(performance.now());
  document.body.dataset.draws = String(Number(document.body.dataset.draws ?? 0) + 1);
  document.body.dataset.points = String(shownPoints);
  document.body.dataset.boxes = String(shown.boxes);
}

/** One handler per kind of message. */
const HANDLERS = {
  "sensor_msgs/msg/PointCloud2": (topic, message) => {
    scene.addCloud(topic, message);
    choice.offer([...scene.clouds.values()].map((cloud) => cloud.message));
  },
  "sensor_msgs/msg/Image": (topic, message) => images.show(topic, message),
  "sensor_msgs/msg/CompressedImage": (topic, message) => images.show(topic, message),
  "tf2_msgs/msg/TFMessage": (topic, message) => scene.addTransforms(message),
  "visualization_msgs/msg/MarkerArray": (topic, message) => scene.addBoxes(topic, message),
  "nav_msgs/msg/Odometry": (topic, message) => scene.addOdometry(topic, message),
  [PLAYBACK_SCHEMA]: (topic, message) => playback.show(message),
};

function onMessage(channel, timeNs, bytes) {
  topics.count(channel.topic);
  try {
    HANDLERS[channel.schemaName](channel.topic, decodeMessage(channel, bytes));
    if (!channel.schemaName.endsWith("Image")) topics.report(channel.topic, "");
  } catch (error) {
    topics.report(channel.topic, `invalid message: ${error.message}`);
  }
  requestDraw();
}

function onChannels(channels) {
  for (const channel of channels) {
    const isInternal = channel.schemaName === PLAYBACK_SCHEMA;
    const isOn = isInternal || topics.add(channel, isShown(channel), !switchedOff.has(channel.topic));
    if (isOn && isShown(channel)) connection.subscribe(channel);
  }
}

function toggle(channel, isOn) {
  if (isOn) {
    switchedOff.delete(channel.topic);
    connection.subscribe(channel);
  } else {
    switchedOff.add(channel.topic);
    connection.unsubscribe(channel);
    view.release(scene.clouds.get(channel.topic));
    scene.removeCloud(channel.topic);
    scene.removeBoxes(channel.topic);
    images.remove(channel.topic);
  }
  requestDraw();
}

function setStatus(text, kind) {
  element("status").textContent = text;
  element("status").className = `badge ${kind}`;
  document.body.dataset.state = kind;
}

function updateRates() {
  topics.update();
  const clouds = [...scene.clouds.keys()].map((topic) => topics.rate(topic));
  drawTimes = drawTimes.filter((time) => time > performance.now() - 2000);
  element("rates").textContent = `${Math.max(0, ...clouds).toFixed(1)} Hz · ${formatCount(shownPoints)} points · ${(drawTimes.length / 2).toFixed(0)} fps`;
}

function addButtons(actions) {
  for (const [id, action] of [["view-reset", actions.reset], ["view-top", actions.top], ["view-front", actions.behind]]) {
    element(id).addEventListener("click", () => { action(); requestDraw(); });
  }
  for (const id of ["follow", "show-frames", "show-trails", "show-grid", "point-size"]) element(id).addEventListener("input", requestDraw);
  element("toggle-panel").addEventListener("click", () => {
    const isHidden = document.body.classList.toggle("no-panel");
    element("toggle-panel").setAttribute("aria-expanded", String(!isHidden));
  });
}

const actions = {
  changed: requestDraw,
  panned: () => { element("follow").checked = false; },
  clicked: (x, y) => {
    points.show(findPoint(scene, camera, canvas, x, y));
    requestDraw();
  },
  reset: () => {
    camera.reset();
    element("follow").checked = true;
  },
  top: () => camera.lookDown(),
  behind: () => camera.lookForward(),
  follow: () => { element("follow").checked = !element("follow").checked; },
  play: () => playback.toggle(),
  step: () => playback.step(),
  size: (change) => { element("point-size").valueAsNumber += change; },
};

let view;
let connection;
try {
  view = new View(canvas);
  addControls(canvas, camera, actions);
  addButtons(actions);
  connection = new Connection({
    onOpen: () => { setStatus("live", "live"); showBanner(""); },
    onLost: (seconds) => {
      setStatus("connection lost", "lost");
      showBanner(`The connection to GLIDAR is lost. The page connects again in ${seconds} s.`);
      topics.clear();
    },
    onInfo: (info) => {
      scene.transforms.clear();
      scene.trails.clear();
      playback.offer(info.metadata?.["glidar.playback"] === "true");
      points.canExplain = info.metadata?.["glidar.pick"] === "true";
    },
    onChannels,
    onMessage,
    onTime: (timeNs) => { element("time").textContent = `${(Number(timeNs / 1000000n) / 1000).toFixed(3)} s`; },
    onStatus: (level, text) => { if (level > 0) showBanner(`The server reports: ${text}`); },
  });
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => { view.restore(scene); requestDraw(); });
  new ResizeObserver(requestDraw).observe(canvas);
  setInterval(updateRates, 500);
} catch (error) {
  showBanner(error.message);
}
