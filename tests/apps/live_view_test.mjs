// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The live view of glidar stream and glidar replay, with Foxglove's own client.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { loadPackages, waitUntil } from "../link/foxglove/node_support.mjs";

const [{ FoxgloveClient }, WebSocket, { parse }, { MessageReader }] = loadPackages("@foxglove/ws-protocol", "ws", "@foxglove/rosmsg", "@foxglove/rosmsg2-serialization");
const PROGRAM = process.env.GLIDAR_PROGRAM;
const RIG = `models: [{model: builtin:box, class: crate, pose: {position: [4, 0, 0]}}]
sensors:
  - {name: lidar, sensor: VLP-16}
  - {name: camera, sensor: {optics: {type: pinhole, width: 32, height: 24, fx: 30, fy: 30, cx: 16, cy: 12}}, pose: {euler_deg: {roll: -90, yaw: -90}}}
imus: [{name: imu, imu: {rate_hz: 100}}]
rig_pose: {position: [0, 0, 0.5]}
rig_motion: {twist: {velocity_m_s: [0.1, 0, 0], rate_rad_s: [0, 0, 0.5], frame: body}}
`;
const SPIN = ["builtin:box", "--width", "32", "--height", "24", "--fov", "20", "--object-rate", "0,1,0", "--rate", "20"];
const folder = mkdtempSync(join(tmpdir(), "glidar-live-"));
writeFileSync(join(folder, "rig.yaml"), RIG);
const environment = { ...process.env, XDG_CACHE_HOME: join(folder, "cache") };

/** Runs the program; resolves to {port, process, lines, ended} when the live view listens. */
async function start(...words) {
  const program = spawn(PROGRAM, words, { cwd: folder, env: environment, stdio: ["ignore", "pipe", "pipe"] });
  const lines = [];
  let code;
  for (const stream of [program.stdout, program.stderr]) createInterface({ input: stream }).on("line", (line) => lines.push(line));
  const ended = new Promise((resolve) => { program.on("close", (status) => { code = status; resolve(status); }); });
  const url = () => lines.map((line) => line.match(/live view: http:\/\/localhost:(\d+)\/$/)).find((match) => match);
  await waitUntil(() => url() || code !== undefined, "the live view");
  assert.ok(url(), lines.join("\n"));
  return { port: Number(url()[1]), program, lines, ended };
}

function run(...words) {
  const done = spawnSync(PROGRAM, words, { cwd: folder, env: environment, encoding: "utf-8" });
  assert.equal(done.status, 0, done.stderr);
}

/** A client that subscribes to all topics; `messages` has those of each topic. */
function connect(port) {
  const socket = new WebSocket(`ws://127.0.0.1:${port}/`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
  const client = new FoxgloveClient({ ws: socket });
  const messages = new Map();
  const readers = new Map();
  const of = (topic) => messages.get(topic) ?? [];
  client.on("error", (error) => { throw error; });
  client.on("advertise", (channels) => {
    for (const { id, topic, encoding, schema } of channels) {
      const reader = encoding === "json" ? (data) => JSON.parse(new TextDecoder().decode(data)) : ((cdr) => (data) => cdr.readMessage(data))(new MessageReader(parse(schema, { ros2: true })));
      readers.set(client.subscribe(id), [topic, reader]);
    }
  });
  client.on("message", ({ subscriptionId, timestamp, data }) => {
    const [topic, read] = readers.get(subscriptionId);
    messages.set(topic, [...of(topic), { timestamp, message: read(data) }]);
  });
  return { client, socket, messages, of };
}

const post = async (port, path, body) => {
  const origin = `http://127.0.0.1:${port}`;
  const reply = await fetch(`${origin}${path}`, { method: "POST", headers: { "Content-Type": "application/json", Origin: origin }, body: JSON.stringify(body) });
  return [reply.status, reply.headers.get("content-type")?.includes("json") ? await reply.json() : await reply.text()];
};
const command = (port, word) => post(port, "/api/playback", { command: word });

function points({ message }) {
  const view = new DataView(message.data.buffer, message.data.byteOffset);
  const getters = { 2: "getUint8", 4: "getUint16", 6: "getUint32", 7: "getFloat32", 8: "getFloat64" };
  return Array.from({ length: message.width }, (_, i) => Object.fromEntries(message.fields.map((field) => [field.name, view[getters[field.datatype]](i * message.point_step + field.offset, true)])));
}

async function streamsARig() {
  const { port, program, ended } = await start("stream", "rig.yaml", "--rate", "10", "--foxglove", "0");
  const { client, messages, of } = connect(port);
  const topics = ["/lidar/points", "/lidar/boxes", "/camera/boxes", "/lidar/range/image_raw", "/lidar/intensity/image_raw", "/camera/points", "/camera/depth/image_raw", "/camera/depth/camera_info", "/camera/intensity/image_raw", "/imu/data", "/tf", "/tf_static", "/odom", "/clock"];
  await waitUntil(() => topics.every((topic) => of(topic).length > 0), "messages of all topics");
  assert.deepEqual([...messages.keys()].sort(), topics.sort());
  const cloud = of("/lidar/points")[0];
  const all = points(cloud);
  assert.deepEqual(Object.keys(all[0]), ["x", "y", "z", "intensity", "ring", "time", "range", "true_range", "instance", "class"]);
  assert.ok(all.length > 100 && all.every(({ range, true_range: truth }) => Math.abs(range - truth) < 0.3));
  const [box, ...others] = of("/lidar/boxes")[0].message.markers;
  assert.deepEqual([others.length, box.ns, box.id, box.type, box.header.frame_id], [0, "crate", 1, 1, "lidar"]);
  assert.deepEqual([box.scale.x, box.pose.position.x, box.pose.position.z], [2, 4, -0.5]);
  const known = JSON.parse(box.text);
  assert.deepEqual([known.class, known.points, known.occlusion], ["crate", all.length, 0]);
  assert.ok(known.beams > 100);
  const { width, height, encoding, data } = of("/lidar/range/image_raw")[0].message;
  assert.deepEqual([height, encoding, data.length], [16, "32FC1", 4 * 16 * width]);
  assert.deepEqual([of("/camera/depth/image_raw")[0].message.width, of("/camera/depth/camera_info")[0].message.width], [32, 32]);
  assert.deepEqual(of("/tf_static")[0].message.transforms.map((one) => one.child_frame_id), ["lidar", "camera_link", "camera_depth_optical_frame", "imu"]);
  assert.ok(Math.abs(of("/imu/data")[0].message.angular_velocity.z - 0.5) < 1e-9);
  const index = Math.floor(all.length / 2);
  const [status, { text }] = await post(port, "/api/pick", { topic: "/lidar/points", time_ns: String(cloud.timestamp), index });
  assert.equal(status, 200);
  assert.match(text, new RegExp(`ring ${all[index].ring}\\n`));
  assert.ok(text.split(/[^0-9.]+/).some((word) => word.includes(".") && Math.abs(Number(word) - all[index].range) < 2e-6 * all[index].range + 1e-6), `${text}\nhas no range ${all[index].range}`);
  const [, { text: unknown }] = await post(port, "/api/pick", { topic: "/lidar/points", time_ns: "7", index });
  assert.match(unknown, /is not known/);
  const second = spawnSync(PROGRAM, ["stream", "builtin:box", "--foxglove", String(port)], { cwd: folder, env: environment, encoding: "utf-8" });
  assert.equal(second.status, 2);
  assert.match(second.stderr, /^glidar: error: --foxglove.*another program uses this port/);
  program.kill("SIGINT");
  assert.equal(await ended, 130);
  client.close();
}

async function isNotDelayedByAViewerThatNeverReads() {
  const { port, program, ended } = await start("stream", "builtin:box", "--sensor", "OS1-128", "--eye", "0,0,0", "--rate", "max", "--foxglove", "0");
  const lazy = connect(port);
  await waitUntil(() => lazy.of("/lidar/points").length > 0, "a cloud for the first viewer");
  lazy.socket.pause();
  const other = connect(port);
  let bytes = 0;
  const MANY = 100e6; // more than the buffers of a connection hold
  await waitUntil(() => {
    bytes += other.of("/lidar/points").reduce((sum, { message }) => sum + message.data.length, 0);
    other.messages.clear();
    return bytes > MANY;
  }, "many clouds for the other viewer");
  program.kill("SIGINT");
  assert.equal(await ended, 130);
  lazy.socket.terminate();
  other.client.close();
}

async function replaysUnderControl() {
  run("stream", ...SPIN, "--frames", "4", "--record", "r.jsonl", "-o", "first.pcd", "--no-sidecar");
  const { port, program, lines, ended } = await start("replay", "r.jsonl", "--foxglove", "0", "-o", "again.pcd", "--no-sidecar", "-o", "again.mcap");
  const { client, of } = connect(port);
  const clouds = () => of("/camera/points");
  const state = () => of("/glidar/playback").at(-1)?.message;
  await waitUntil(() => clouds().length === 1 && state() !== undefined, "the first frame");
  assert.equal(state().playing, false);
  assert.equal((await command(port, "step"))[0], 200);
  await waitUntil(() => clouds().length === 2, "the second frame");
  assert.equal(state().playing, false);
  assert.equal(readdirSync(folder).filter((name) => /^again_\d+\.pcd$/.test(name)).length <= 2, true);
  await command(port, "play");
  await waitUntil(() => readdirSync(folder).includes("again_000003.pcd") && state().playing, "the last frame");
  const stamps = clouds().map(({ timestamp }) => timestamp);
  assert.deepEqual(stamps, [...stamps].sort((a, b) => Number(a - b)));
  await waitUntil(() => clouds().at(-1).timestamp === 150000000n, "the cloud of the last frame");
  program.kill("SIGINT");
  assert.equal(await ended, 130, lines.join("\n"));
  for (let k = 0; k < 4; ++k) assert.deepEqual(readFileSync(join(folder, `again_00000${k}.pcd`)), readFileSync(join(folder, `first_00000${k}.pcd`)));
  assert.ok(readdirSync(folder).includes("again.mcap"));
  client.close();
}

try {
  await streamsARig();
  await isNotDelayedByAViewerThatNeverReads();
  await replaysUnderControl();
} finally {
  rmSync(folder, { recursive: true, force: true });
}
