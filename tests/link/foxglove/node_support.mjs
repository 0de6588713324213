// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
/** What the tests in Node.js share: packages from npm, waiting, the feed. */
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { createInterface } from "node:readline";

const SKIPPED = 77;
const MAX_WAIT_MS = 300_000; // machines may be very busy; a passing test never waits so long
const PAUSE_MS = 20;

export function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(SKIPPED);
}

/** Loads packages of package.json; skips the test if they are not installed. */
export function loadPackages(...names) {
  const folder = process.env.GLIDAR_NODE_MODULES ?? "";
  if (!existsSync(join(folder, names[0]))) skip(`no packages from npm in '${folder}'; ./dev test installs them where npm and its registry are available`);
  const require = createRequire(join(folder, "x.js"));
  return names.map((name) => require(name));
}

export async function waitUntil(condition, what) {
  const end = Date.now() + MAX_WAIT_MS;
  while (Date.now() < end) {
    const value = await condition();
    if (value) return value;
    await new Promise((resolve) => { setTimeout(resolve, PAUSE_MS); });
  }
  throw new Error(`waited in vain for ${what}`);
}

/** Starts the feed; resolves to {url, port, lines, stop()} when it listens. */
export async function startFeed(sensor, port = 0, frames = 4) {
  const feed = spawn(process.env.GLIDAR_FOXGLOVE_FEED, [sensor, String(port), String(frames)], { stdio: ["pipe", "pipe", "inherit"] });
  const lines = [];
  let hasEnded = false;
  createInterface({ input: feed.stdout }).on("line", (line) => lines.push(line));
  const ended = new Promise((resolve) => { feed.on("exit", (code) => { hasEnded = true; resolve(code); }); });
  const stop = async () => {
    feed.stdin.end();
    return ended;
  };
  await waitUntil(() => lines.length > 0 || hasEnded, "the feed");
  if (lines.length === 0) throw new Error("the feed ended before it listened");
  const url = lines.shift();
  return { url, port: Number(new URL(url).port), lines, stop };
}
