// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Takes docs/images/live-view.png: the page of `glidar stream examples/drive.yaml --foxglove` in Chromium without a display,
// after three seconds of the drive.
//
//   node scripts/shoot_live_view.mjs GLIDAR_PROGRAM PICTURE.png     needs Chromium and build/npm, which ./dev test installs
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";

const root = resolve(import.meta.dirname, "..");
const { chromium } = createRequire(join(root, "build/npm/node_modules/x.js"))("playwright-core");
const [program, picture] = process.argv.slice(2);
const SHOWN_S = 3;

const simulation = spawn(program, ["stream", join(root, "examples/drive.yaml"), "--foxglove", "0", "--rate", "2"],
  { stdio: ["ignore", "inherit", "pipe"] });
const url = await new Promise((found, failed) => {
  createInterface({ input: simulation.stderr }).on("line", (line) => {
    const match = line.match(/live view: (http:\S+)$/);
    if (match) found(match[1]);
  });
  simulation.on("close", () => failed(new Error("the simulation ended")));
});
const profile = mkdtempSync(join(tmpdir(), "glidar-shoot-"));
const browser = await chromium.launchPersistentContext(profile, {
  executablePath: "/usr/bin/chromium",
  viewport: { width: 1100, height: 640 },
  args: ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run"],
});
try {
  const page = browser.pages()[0] ?? await browser.newPage();
  page.setDefaultTimeout(0);
  await page.goto(url);
  await page.waitForFunction((seconds) => Number(document.body.dataset.points) > 1000 &&
    document.querySelectorAll("#images canvas[data-images]").length > 0 &&
    Number.parseFloat(document.getElementById("time").textContent) >= seconds, SHOWN_S);
  await page.screenshot({ path: picture });
} finally {
  await browser.close();
  simulation.kill("SIGINT");
  rmSync(profile, { recursive: true, force: true });
}
