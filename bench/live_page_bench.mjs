// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Clouds per second that the page of the live view receives and draws, in Chromium without a GPU, while an OS1-128
// measures a street ten times per second (131,072 beams).
//
//   bench/live_page_bench.mjs BUILD_FOLDER [SECONDS]     needs Chromium and build/npm, which ./dev test installs
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";

const root = resolve(import.meta.dirname, "..");
const { chromium } = createRequire(join(root, "build/npm/node_modules/x.js"))("playwright-core");
const folder = process.argv[2] ?? join(root, "build/dev");
const seconds = Number(process.argv[3] ?? 20);

const program = spawn(join(folder, "apps/glidar/glidar"),
  ["stream", join(root, "examples/street.yaml"), "--sensor", "OS1-128", "--rate", "10", "--sensor-rate", "0,0,0.1", "--columns", "xyz,intensity,ring,range,class", "--foxglove", "0"],
  { stdio: ["ignore", "pipe", "pipe"] });
const url = await new Promise((found, failed) => {
  const lines = [];
  for (const stream of [program.stdout, program.stderr]) {
    createInterface({ input: stream }).on("line", (line) => {
      lines.push(line);
      const match = line.match(/live view: (http:\/\/localhost:\d+\/)$/);
      if (match) found(match[1]);
    });
  }
  program.on("close", () => failed(new Error(lines.join("\n"))));
});

const profile = mkdtempSync(join(tmpdir(), "glidar-page-bench-"));
const browser = await chromium.launchPersistentContext(profile, {
  executablePath: "/usr/bin/chromium",
  viewport: { width: 1200, height: 720 },
  args: ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run"],
});
try {
  const page = browser.pages()[0] ?? await browser.newPage();
  await page.goto(url);
  await page.waitForFunction(() => Number(document.body.dataset.points) > 1000, undefined, { timeout: 0 });
  const read = () => page.evaluate(() => ({ draws: Number(document.body.dataset.draws), points: Number(document.body.dataset.points), rates: document.getElementById("rates").textContent }));
  const first = await read();
  const start = performance.now();
  const rates = [];
  while (performance.now() - start < 1000 * seconds) {
    await page.waitForTimeout(1000);
    rates.push(Number.parseFloat((await read()).rates));
  }
  const last = await read();
  const elapsed = (performance.now() - start) / 1000;
  rates.sort((a, b) => a - b);
  console.log(`clouds per second: median ${rates[rates.length >> 1].toFixed(1)}, least ${rates[0].toFixed(1)}`);
  console.log(`pictures per second: ${((last.draws - first.draws) / elapsed).toFixed(1)}, each with ${last.points} points`);
} finally {
  await browser.close();
  program.kill("SIGINT");
  rmSync(profile, { recursive: true, force: true });
}
