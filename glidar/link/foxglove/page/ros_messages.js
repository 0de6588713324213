// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Decoders of the ROS 2 messages that the page shows, by schema name. Fields are in the order of the
 * message definitions of common_interfaces. */
import { CdrReader } from "/cdr.js";

/** Nanoseconds as BigInt. */
function readTime(reader) {
  const seconds = reader.i32();
  return BigInt(seconds) * 1000000000n + BigInt(reader.u32());
}

function readHeader(reader) {
  return { timeNs: readTime(reader), frameId: reader.string() };
}

/** Position and quaternion x y z w. */
function readPose(reader) {
  return { position: reader.f64s(3), rotation: reader.f64s(4) };
}

function pointCloud2(reader) {
  const header = readHeader(reader);
  const height = reader.u32();
  const width = reader.u32();
  const fields = [];
  for (let left = reader.count(13); left > 0; --left) {
    fields.push({ name: reader.string(), offset: reader.u32(), type: reader.u8(), count: reader.u32() });
  }
  const isBigEndian = reader.bool();
  const pointStep = reader.u32();
  const rowStep = reader.u32();
  const data = reader.bytes();
  return { header, height, width, fields, isBigEndian, pointStep, rowStep, data };
}

function image(reader) {
  const header = readHeader(reader);
  const height = reader.u32();
  const width = reader.u32();
  const encoding = reader.string();
  const isBigEndian = reader.u8() !== 0;
  const step = reader.u32();
  return { header, height, width, encoding, isBigEndian, step, data: reader.bytes() };
}

function compressedImage(reader) {
  return { header: readHeader(reader), format: reader.string(), data: reader.bytes() };
}

function tfMessage(reader) {
  const transforms = [];
  for (let left = reader.count(70); left > 0; --left) {
    const header = readHeader(reader);
    transforms.push({ header, childFrameId: reader.string(), ...readPose(reader) });
  }
  return { transforms };
}

function odometry(reader) {
  const header = readHeader(reader);
  return { header, childFrameId: reader.string(), ...readPose(reader) };
}

/** The parts of a marker that only other shapes than cubes use. */
function skipMarkerParts(reader) {
  reader.i32(); // lifetime
  reader.u32();
  reader.bool(); // frame_locked
  for (let left = reader.count(24); left > 0; --left) reader.f64s(3); // points
  for (let left = reader.count(16); left > 0; --left) reader.f32s(4); // colors
  reader.string(); // texture_resource
  compressedImage(reader);
  for (let left = reader.count(8); left > 0; --left) reader.f32s(2); // uv_coordinates
}

function marker(reader) {
  const header = readHeader(reader);
  const ns = reader.string();
  const [id, type, action] = [reader.i32(), reader.i32(), reader.i32()];
  const pose = readPose(reader);
  const scale = reader.f64s(3);
  const colour = reader.f32s(4);
  skipMarkerParts(reader);
  const text = reader.string();
  reader.string(); // mesh_resource
  reader.string(); // mesh_file
  reader.bytes();
  reader.bool(); // mesh_use_embedded_materials
  return { header, ns, id, type, action, ...pose, scale, colour, text };
}

function markerArray(reader) {
  const markers = [];
  for (let left = reader.count(180); left > 0; --left) markers.push(marker(reader));
  return { markers };
}

const DECODERS = new Map([
  ["sensor_msgs/msg/PointCloud2", pointCloud2],
  ["sensor_msgs/msg/Image", image],
  ["sensor_msgs/msg/CompressedImage", compressedImage],
  ["tf2_msgs/msg/TFMessage", tfMessage],
  ["nav_msgs/msg/Odometry", odometry],
  ["visualization_msgs/msg/MarkerArray", markerArray],
]);

export const PLAYBACK_SCHEMA = "glidar.Playback";

/** Whether the page shows messages of this channel. */
export function isShown(channel) {
  if (channel.schemaName === PLAYBACK_SCHEMA) return channel.encoding === "json";
  return channel.encoding === "cdr" && DECODERS.has(channel.schemaName);
}

/** The message; throws Error if its bytes are invalid. */
export function decodeMessage(channel, bytes) {
  if (channel.encoding === "json") return JSON.parse(new TextDecoder().decode(bytes));
  return DECODERS.get(channel.schemaName)(new CdrReader(bytes));
}
