// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Selecting a point and showing why it was measured so. */
import { describePoint } from "/cloud.js";
import { multiply, transformPoint } from "/vectors.js";

const MAX_PIXELS = 10;

/** The point that is nearest to a place of the canvas, in front of those beside it; undefined if there is
 * none within 10 pixels. */
export function findPoint(scene, camera, canvas, x, y) {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const projection = camera.projection(width / height);
  let best;
  let bestRank = Infinity;
  for (const cloud of scene.clouds.values()) {
    const model = scene.modelOf(cloud);
    if (model === undefined || cloud.xyz === undefined) continue;
    const m = multiply(projection, model);
    for (let i = 0; i < cloud.xyz.length / 3; ++i) {
      const [px, py, pz] = cloud.xyz.subarray(3 * i, 3 * i + 3);
      const w = m[3] * px + m[7] * py + m[11] * pz + m[15];
      if (!(w > 0 && w < 1e6)) continue;
      const dx = ((m[0] * px + m[4] * py + m[8] * pz + m[12]) / w + 1) * width / 2 - x;
      const dy = (1 - (m[1] * px + m[5] * py + m[9] * pz + m[13]) / w) * height / 2 - y;
      const pixels = Math.hypot(dx, dy);
      const rank = pixels + 20 * Math.log(w);
      if (pixels <= MAX_PIXELS && rank < bestRank) {
        bestRank = rank;
        best = { cloud, index: i, place: transformPoint(model, [px, py, pz]) };
      }
    }
  }
  return best;
}

async function requestExplanation(cloud, index) {
  const response = await fetch("/api/pick", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ topic: cloud.topic, time_ns: String(cloud.message.header.timeNs), index }),
  });
  if (!(response.headers.get("Content-Type") ?? "").startsWith("application/json")) throw new Error(await response.text());
  const answer = await response.json();
  if (answer.error !== undefined) throw new Error(answer.error);
  return answer.text;
}

export class PointPanel {
  #section = document.getElementById("picked");
  #fields = document.getElementById("picked-fields");
  #text = document.getElementById("explanation");
  #marker = document.getElementById("marker");
  #picked;
  canExplain = false;

  async show(picked) {
    this.#picked = picked;
    this.#section.hidden = picked === undefined;
    if (picked === undefined) return;
    const rows = [["topic", picked.cloud.topic], ["index", String(picked.index)], ...describePoint(picked.cloud.message, picked.index)];
    this.#fields.replaceChildren(...rows.flatMap(([name, value]) => {
      const term = document.createElement("dt");
      const detail = document.createElement("dd");
      term.textContent = name;
      detail.textContent = value;
      return [term, detail];
    }));
    this.#section.scrollIntoView({ block: "nearest" });
    this.#text.textContent = "";
    if (!this.canExplain) return;
    this.#text.textContent = "Explaining this point ...";
    const text = await requestExplanation(picked.cloud, picked.index).catch((error) => `No explanation: ${error.message}`);
    if (this.#picked === picked) this.#text.textContent = text;
  }

  /** Moves the marker to the point's place on the canvas. */
  place(camera, canvas) {
    if (this.#picked === undefined) {
      this.#marker.hidden = true;
      return;
    }
    const at = toCanvas(camera, canvas, this.#picked.place);
    this.#marker.hidden = at === undefined;
    if (at !== undefined) this.#marker.style.transform = `translate(${at[0]}px, ${at[1]}px)`;
  }
}

/** Where a point of the fixed frame is on the canvas; undefined: behind the camera. */
export function toCanvas(camera, canvas, point) {
  const m = camera.projection(canvas.clientWidth / canvas.clientHeight);
  const w = m[3] * point[0] + m[7] * point[1] + m[11] * point[2] + m[15];
  if (!(w > 0)) return undefined;
  const [x, y] = transformPoint(m, point);
  return [((x / w + 1) * canvas.clientWidth) / 2, ((1 - y / w) * canvas.clientHeight) / 2];
}
