// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Foxglove's own client and decoder read the stream.
import assert from "node:assert/strict";
import { loadPackages, startFeed, waitUntil } from "./node_support.mjs";

const [{ FoxgloveClient }, WebSocket, { parse }, { MessageReader }] = loadPackages("@foxglove/ws-protocol", "ws", "@foxglove/rosmsg", "@foxglove/rosmsg2-serialization");

function connect(port) {
  const state = { info: undefined, topics: new Map(), messages: new Map(), times: [], problems: [] };
  const client = new FoxgloveClient({ ws: new WebSocket(`ws://127.0.0.1:${port}/`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
  const readers = new Map();
  client.on("serverInfo", (info) => { state.info = info; });
  client.on("time", ({ timestamp }) => state.times.push(timestamp));
  client.on("error", (error) => state.problems.push(error.message));
  client.on("status", (status) => state.problems.push(status.message));
  client.on("advertise", (channels) => {
    for (const channel of channels) {
      state.topics.set(channel.topic, channel);
      if (channel.encoding !== "cdr") continue;
      const reader = new MessageReader(parse(channel.schema, { ros2: true }));
      readers.set(client.subscribe(channel.id), [channel.topic, reader]);
    }
  });
  client.on("message", ({ subscriptionId, timestamp, data }) => {
    const [topic, reader] = readers.get(subscriptionId);
    if (!state.messages.has(topic)) state.messages.set(topic, []);
    state.messages.get(topic).push({ timestamp, message: reader.readMessage(data), bytes: data.byteLength });
  });
  return { state, client };
}

function checkCloud({ timestamp, message }) {
  assert.equal(message.header.frame_id, "lidar");
  assert.equal(timestamp, BigInt(message.header.stamp.sec) * 1000000000n + BigInt(message.header.stamp.nsec ?? message.header.stamp.nanosec));
  assert.equal(message.point_step, 34);
  assert.equal(message.data.length, 34 * message.width);
  assert.ok(message.width > 10000);
  const view = new DataView(message.data.buffer, message.data.byteOffset);
  for (let i = 0; i < message.width; i += 97) {
    const [x, y, z, range] = [0, 4, 8, 22].map((offset) => view.getFloat32(34 * i + offset, true));
    assert.ok(Math.abs(Math.hypot(x, y, z) - range) < 0.2, `point ${i}: ${x} ${y} ${z} at ${range} m`);
  }
}

function checkFrames(messages) {
  const [fixed] = messages.get("/tf_static");
  assert.deepEqual(fixed.message.transforms.map((one) => one.child_frame_id), ["lidar", "camera"]);
  const [moving] = messages.get("/tf");
  assert.equal(moving.message.transforms[0].header.frame_id, "map");
  const { position } = messages.get("/odom")[0].message.pose.pose;
  assert.equal(position.y, -0.9);
}

const feed = await startFeed("VLP-16");
const { state, client } = connect(feed.port);
const topics = ["/points", "/tf", "/tf_static", "/odom", "/camera/depth", "/camera/compressed"];
await waitUntil(() => topics.every((topic) => state.messages.has(topic)) && state.messages.get("/points").length >= 3, "messages of all topics");
assert.equal(state.info.name, "GLIDAR");
assert.deepEqual(state.info.capabilities, ["time"]);
state.messages.get("/points").forEach(checkCloud);
checkFrames(state.messages);
const depth = state.messages.get("/camera/depth")[0].message;
assert.deepEqual([depth.width, depth.height, depth.encoding, depth.data.length], [160, 120, "16UC1", 38400]);
assert.equal(state.messages.get("/camera/compressed")[0].message.format, "png");
assert.ok(state.times.length > 0 && state.times.every((time) => time >= 1000000000000n));
assert.deepEqual(state.problems, []);
client.close();
assert.equal(await feed.stop(), 0);
console.log(`${state.messages.get("/points").length} clouds of ${state.messages.get("/points")[0].message.width} points`);
