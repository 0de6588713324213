// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** The list of topics, the choices of colour, the colour bar and the labels of frames. */
import { colourings } from "/cloud.js";
import { CATEGORY_MAP, MAPS } from "/colours.js";
import { toCanvas } from "/picking.js";
import { origin } from "/vectors.js";

const RATE_WINDOW_MS = 3000;

export function formatCount(count) { return count.toLocaleString("en-GB"); }

export class TopicList {
  #list = document.getElementById("topics");
  #rows = new Map();
  #onToggle;

  constructor(onToggle) { this.#onToggle = onToggle; }

  clear() {
    this.#list.replaceChildren();
    this.#rows.clear();
  }

  /** Returns whether the topic is switched on. */
  add(channel, isShown, wasOn) {
    const item = document.createElement("li");
    const label = document.createElement("label");
    const box = document.createElement("input");
    const name = document.createElement("span");
    const detail = document.createElement("span");
    label.className = "check";
    name.className = "name";
    detail.className = "detail";
    box.type = "checkbox";
    box.disabled = !isShown;
    box.checked = isShown && wasOn;
    name.textContent = channel.topic;
    const kind = channel.schemaName.replace(/^.*[/.]/, "");
    detail.textContent = isShown ? kind : `${kind}; not shown by this page`;
    label.append(box, name);
    item.append(label, detail);
    this.#list.append(item);
    box.addEventListener("change", () => this.#onToggle(channel, box.checked));
    this.#rows.set(channel.topic, { kind, detail, times: [], problem: "", isOn: () => box.checked });
    return box.checked;
  }

  count(topic) { this.#rows.get(topic)?.times.push(performance.now()); }

  report(topic, problem) {
    const row = this.#rows.get(topic);
    if (row !== undefined) row.problem = problem;
  }

  /** Messages per second of a topic. */
  rate(topic) {
    const row = this.#rows.get(topic);
    if (row === undefined) return 0;
    row.times = row.times.filter((time) => time > performance.now() - RATE_WINDOW_MS);
    return row.times.length < 2 ? 0 : (row.times.length - 1) / ((row.times.at(-1) - row.times[0]) / 1000);
  }

  update() {
    for (const [topic, row] of this.#rows) {
      const rate = this.rate(topic);
      if (row.times.length === 0 && row.problem === "") continue;
      row.detail.textContent = row.problem === "" ? `${row.kind} · ${rate.toFixed(1)} Hz` : row.problem;
      row.detail.classList.toggle("problem", row.problem !== "");
    }
  }
}

export class ColourChoice {
  #by = document.getElementById("colour-by");
  #map = document.getElementById("colour-map");
  #min = document.getElementById("range-min");
  #max = document.getElementById("range-max");
  #known = "";
  #otherMap = "";  // to return to from the map of errors

  constructor(onChange) {
    this.#map.replaceChildren(...[...MAPS.keys()].map((name) => new Option(name, name)));
    this.#by.replaceChildren(new Option("height", "height"));
    this.#by.addEventListener("change", () => {
      this.#min.value = "";
      this.#max.value = "";
      this.#chooseMap();
      onChange();
    });
    for (const input of [this.#map, this.#min, this.#max]) input.addEventListener("input", onChange);
  }

  get key() { return this.#by.value; }
  get map() { return this.#map.value; }
  get name() { return this.#by.selectedOptions[0]?.textContent ?? ""; }
  get interval() { return [this.#min, this.#max].map((input) => (input.value === "" ? undefined : Number(input.value))); }

  /** Errors have two signs, so their map has two ends. */
  #chooseMap() {
    const isError = this.key === "error";
    if (isError) this.#otherMap = this.map;
    if (isError || this.#otherMap !== "") this.#map.value = isError ? "blue to red" : this.#otherMap;
    if (!isError) this.#otherMap = "";
  }

  /** Offers what the points of these clouds have. */
  offer(clouds) {
    const options = new Map(clouds.flatMap((cloud) => colourings(cloud)).map(({ key, name }) => [key, name]));
    const known = [...options.keys()].join("\n");
    if (known === this.#known || options.size === 0) return;
    this.#known = known;
    const chosen = this.key;
    this.#by.replaceChildren(...[...options].map(([key, name]) => new Option(name, key)));
    this.#by.value = options.has(chosen) ? chosen : "height";
  }
}

export class ColourBar {
  #box = document.getElementById("bar");
  #canvas = document.getElementById("bar-colours");
  #drawn = "";

  show(choice, shown) {
    this.#box.hidden = shown.points === 0;
    const unit = ["height", "range", "error"].includes(choice.key) ? ", m" : "";
    const text = (value) => Number(value.toPrecision(4)).toString();
    document.getElementById("bar-title").textContent = choice.name + unit;
    document.getElementById("bar-min").textContent = shown.isCategory ? "one colour per value" : text(shown.interval[0]);
    document.getElementById("bar-max").textContent = shown.isCategory ? "" : text(shown.interval[1]);
    const name = shown.isCategory ? "category" : choice.map;
    if (this.#drawn === name) return;
    this.#drawn = name;
    const table = shown.isCategory ? CATEGORY_MAP : MAPS.get(name);
    const picture = new ImageData(256, 12);
    for (let y = 0; y < 12; ++y) picture.data.set(table, y * table.length);
    this.#canvas.getContext("2d").putImageData(picture, 0, 0);
  }
}

export class FrameLabels {
  #box = document.getElementById("labels");
  #labels = new Map();

  show(scene, camera, canvas, isShown) {
    const frames = isShown ? scene.transforms.frames() : [];
    for (const [name, label] of this.#labels) {
      if (frames.includes(name)) continue;
      label.remove();
      this.#labels.delete(name);
    }
    for (const name of frames) {
      const model = scene.transforms.lookup(scene.fixedFrame(), name);
      const at = model === undefined ? undefined : toCanvas(camera, canvas, origin(model));
      const label = this.#labels.get(name) ?? this.#create(name);
      label.hidden = at === undefined;
      if (at !== undefined) label.style.transform = `translate(${Math.round(at[0]) + 6}px, ${Math.round(at[1]) + 4}px)`;
    }
  }

  #create(name) {
    const label = document.createElement("span");
    label.textContent = name;
    this.#box.append(label);
    this.#labels.set(name, label);
    return label;
  }
}
