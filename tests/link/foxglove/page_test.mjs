// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The page in Chromium without a display: what it shows, its controls, and its recovery. With GLIDAR_SCREENSHOTS, a
// folder, it also stores pictures there.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { loadPackages, skip, startFeed, waitUntil } from "./node_support.mjs";

const CHROMIUM = "/usr/bin/chromium";
const [{ chromium }] = loadPackages("playwright-core");
if (!existsSync(CHROMIUM)) skip(`no ${CHROMIUM}; ./dev test installs it`);

const profile = mkdtempSync(join(tmpdir(), "glidar-page-"));
const feed = await startFeed(process.argv[2] ?? "VLP-16");
const context = await chromium.launchPersistentContext(profile, {
  executablePath: CHROMIUM,
  timeout: 0,
  viewport: { width: 1200, height: 720 },
  args: ["--no-sandbox", "--disable-gpu", "--disable-gpu-compositing", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
context.setDefaultTimeout(0);
const page = context.pages()[0] ?? await context.newPage();
const problems = [];
page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
page.on("pageerror", (error) => problems.push(error.message));
page.on("request", (request) => { if (new URL(request.url()).host !== new URL(feed.url).host) problems.push(`request of ${request.url()}`); });

const data = (name) => page.evaluate((key) => document.body.dataset[key], name);
const until = (expression, what) => waitUntil(() => page.evaluate(expression), what);
const post = (command) => page.evaluate((text) => fetch("/api/playback", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ command: text }) }).then((reply) => reply.status), command);

async function shoot(name) {
  if (process.env.GLIDAR_SCREENSHOTS) await page.screenshot({ path: join(process.env.GLIDAR_SCREENSHOTS, `${name}.png`) });
}

/** The picture of the 3D view, drawn now: number of different colours and a hash. */
async function pixels() {
  const draws = Number(await data("draws"));
  await page.evaluate(() => document.getElementById("point-size").dispatchEvent(new Event("input")));
  await waitUntil(async () => Number(await data("draws")) > draws, "a drawing");
  const picture = await page.locator("#view").screenshot();
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes]));
    const context2d = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context2d.drawImage(bitmap, 0, 0);
    const colours = new Map();
    let hash = 0;
    const words = new Uint32Array(context2d.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer);
    for (const word of words) {
      colours.set(word, (colours.get(word) ?? 0) + 1);
      hash = (Math.imul(hash, 31) + word) | 0;
    }
    return { colours: colours.size, hash };
  }, picture.toString("base64"));
}

async function pause() {
  await page.locator("#play").click();
  await until(() => document.body.dataset.playing === "false", "the pause");
  // messages that were published before the pause have arrived when one more step has
  const time = await page.locator("#time").textContent();
  await page.locator("#step").click();
  await waitUntil(async () => await page.locator("#time").textContent() !== time, "a step");
}

async function showsTheCloud() {
  await until(() => Number(document.body.dataset.points) > 10000, "a cloud");
  await until(() => document.querySelectorAll("#images canvas[data-images]").length === 2, "both images");
  await until(() => [...document.querySelectorAll("#labels span")].map((label) => label.textContent).sort().join() === "base_link,camera,lidar,map", "the frames");
  await until(() => document.body.dataset.boxes === "2", "both boxes");
  assert.equal(await data("state"), "live");
  assert.equal(await page.locator("#empty").isVisible(), false);
  assert.equal(await page.locator("#banner").isVisible(), false);
}

async function changesWithTheCloud() {
  await pause();
  const first = await pixels();
  assert.ok(first.colours > 100, `${first.colours} colours`);
  assert.equal((await pixels()).hash, first.hash);
  await page.locator("#step").click();
  await waitUntil(async () => (await pixels()).hash !== first.hash, "another picture after a step");
  assert.ok(feed.lines.includes("command 2"));
}

async function coloursByEveryField() {
  const offered = await page.locator("#colour-by option").allTextContents();
  assert.deepEqual(offered, ["height", "range", "range error against ground truth", "intensity", "ring", "time", "true_range", "class"]);
  const hashes = new Set();
  for (const name of ["height", "range", "range error against ground truth", "intensity", "ring", "class"]) {
    await page.locator("#colour-by").selectOption({ label: name });
    hashes.add((await pixels()).hash);
    await shoot(name.replaceAll(" ", "_"));
  }
  assert.equal(hashes.size, 6);
  assert.equal(await page.locator("#bar-min").textContent(), "one colour per value");
  await page.locator("#colour-by").selectOption({ label: "height" });
}

async function controlsTheView() {
  const before = (await pixels()).hash;
  const box = await page.locator("#view").boundingBox();
  await page.mouse.move(box.x + 300, box.y + 300);
  await page.mouse.down();
  await page.mouse.move(box.x + 400, box.y + 330, { steps: 4 });
  await page.mouse.up();
  const orbited = (await pixels()).hash;
  await page.mouse.wheel(0, -200);
  await waitUntil(async () => (await pixels()).hash !== orbited, "the zoom");
  await page.locator("#view").focus();
  await page.keyboard.press("t");
  const top = (await pixels()).hash;
  assert.equal(new Set([before, orbited, top]).size, 3);
  await page.locator("#view-reset").click();
  assert.equal((await pixels()).hash, before);
}

async function explainsAPoint() {
  const box = await page.locator("#view").boundingBox();
  for (let y = 0.5; y < 0.9 && !(await page.locator("#picked").isVisible()); y += 0.04) await page.mouse.click(box.x + box.width / 2, box.y + box.height * y);
  assert.ok(await page.locator("#picked").isVisible(), "a point is found");
  await until(() => /\n/.test(document.getElementById("explanation").textContent), "the explanation");
  assert.match(await page.locator("#picked-fields").textContent(), /true_range/);
  assert.match(await page.locator("#explanation").textContent(), /range/);
  await shoot("point");
}

async function switchesTopics() {
  const box = page.locator("#topics li", { hasText: "/points" }).locator("input");
  await box.uncheck();
  await until(() => document.body.dataset.points === "0", "no points");
  await box.check();
  await until(() => Number(document.body.dataset.points) > 10000, "the points again");
}

async function connectsAgain() {
  assert.equal(await feed.stop(), 0);
  await until(() => document.body.dataset.state === "lost", "the loss");
  assert.match(await page.locator("#banner").textContent(), /connection to GLIDAR is lost/);
  await shoot("lost");
  const draws = Number(await data("draws"));
  problems.length = 0; // refused connections are reported in the console
  const again = await startFeed(process.argv[2] ?? "VLP-16", feed.port);
  await until(() => document.body.dataset.state === "live", "the connection");
  await waitUntil(async () => Number(await data("draws")) > draws, "a new cloud");
  await again.stop();
}

try {
  await page.goto(feed.url);
  await showsTheCloud();
  await shoot("live");
  await changesWithTheCloud();
  await coloursByEveryField();
  await controlsTheView();
  await explainsAPoint();
  await switchesTopics();
  assert.equal(await post("play"), 200);
  await until(() => document.body.dataset.playing === "true", "playing");
  assert.deepEqual(problems, []);
  await connectsAgain();
} finally {
  await context.close();
  await feed.stop();
  rmSync(profile, { recursive: true, force: true });
}
