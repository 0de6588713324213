// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** The points of a PointCloud2 message as arrays for WebGL. */

/** Types of sensor_msgs/msg/PointField by their constants. */
const TYPES = new Map([
  [1, { size: 1, get: "getInt8" }],
  [2, { size: 1, get: "getUint8" }],
  [3, { size: 2, get: "getInt16" }],
  [4, { size: 2, get: "getUint16" }],
  [5, { size: 4, get: "getInt32" }],
  [6, { size: 4, get: "getUint32" }],
  [7, { size: 4, get: "getFloat32" }],
  [8, { size: 8, get: "getFloat64" }],
]);

/** Names under which drivers and GLIDAR publish the same quantity. */
const RANGE = ["range_m", "range", "distance"];
const TRUE_RANGE = ["true_range_m", "true_range", "ground_truth_range"];
const CATEGORIES = /^(class|class_id|instance|instance_id|status|return|return_type|return_source|tag|label)$/;
const NO_VALUE = 0xffffffff;

/** Throws Error unless every point is inside the data. */
export function checkLayout(cloud) {
  for (const field of cloud.fields) {
    const type = TYPES.get(field.type);
    if (type === undefined) throw new Error(`field ${field.name} has the unknown type ${field.type}`);
    if (field.offset + type.size * Math.max(field.count, 1) > cloud.pointStep) throw new Error(`field ${field.name} exceeds the point of ${cloud.pointStep} bytes`);
  }
  const rowBytes = cloud.width * cloud.pointStep;
  if (cloud.height > 1 && cloud.rowStep < rowBytes) throw new Error(`rows of ${cloud.rowStep} bytes hold no ${cloud.width} points`);
  if (cloud.height > 0 && (cloud.height - 1) * cloud.rowStep + rowBytes > cloud.data.byteLength) throw new Error(`${cloud.data.byteLength} bytes hold no ${cloud.width} x ${cloud.height} points`);
  for (const name of ["x", "y", "z"]) {
    if (!cloud.fields.some((field) => field.name === name)) throw new Error(`the cloud has no field ${name}`);
  }
}

function findField(cloud, names) {
  return cloud.fields.find((field) => names.includes(field.name));
}

/** A field of every point as Float32Array. 32-bit floats at multiples of 4 bytes are read directly; all
 * other layouts, such as points of 22 bytes, value by value. */
function column(cloud, field) {
  const count = cloud.width * cloud.height;
  const values = new Float32Array(count);
  const { get } = TYPES.get(field.type);
  const { data, pointStep } = cloud;
  const rowGap = cloud.height > 1 ? cloud.rowStep - cloud.width * pointStep : 0;
  const start = data.byteOffset + field.offset;
  if (field.type === 7 && start % 4 === 0 && pointStep % 4 === 0 && rowGap === 0 && !cloud.isBigEndian) {
    const floats = new Float32Array(data.buffer, start, count === 0 ? 0 : (count - 1) * (pointStep / 4) + 1);
    for (let i = 0, at = 0; i < count; ++i, at += pointStep / 4) values[i] = floats[at];
    return values;
  }
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const little = !cloud.isBigEndian;
  let at = field.offset;
  for (let i = 0; i < count; ++i, at += pointStep) {
    if (i > 0 && i % cloud.width === 0) at += rowGap;
    values[i] = view[get](at, little);
  }
  return values;
}

/** x y z of every point, 3 numbers each. */
export function positions(cloud) {
  const [x, y, z] = ["x", "y", "z"].map((name) => column(cloud, findField(cloud, [name])));
  const all = new Float32Array(3 * x.length);
  for (let i = 0; i < x.length; ++i) {
    all[3 * i] = x[i];
    all[3 * i + 1] = y[i];
    all[3 * i + 2] = z[i];
  }
  return all;
}

/** What the points of a cloud can be coloured by: key and name for the user. */
export function colourings(cloud) {
  const list = [{ key: "height", name: "height" }, { key: "range", name: "range" }];
  if (canShowError(cloud)) list.push({ key: "error", name: "range error against ground truth" });
  for (const field of cloud.fields) {
    if (!["x", "y", "z", ...RANGE].includes(field.name)) list.push({ key: `field:${field.name}`, name: field.name });
  }
  return list;
}

function canShowError(cloud) {
  return findField(cloud, ["error", "range_error"]) !== undefined || findField(cloud, TRUE_RANGE) !== undefined;
}

function distances(cloud, xyz) {
  const field = findField(cloud, RANGE);
  if (field !== undefined && (field.type === 7 || field.type === 8)) return column(cloud, field);
  const values = new Float32Array(xyz.length / 3);
  for (let i = 0; i < values.length; ++i) values[i] = Math.hypot(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
  return values;
}

/** Measured minus true range, in double precision where the fields are. */
function errors(cloud, xyz) {
  const given = findField(cloud, ["error", "range_error"]);
  if (given !== undefined) return column(cloud, given);
  const truth = column(cloud, findField(cloud, TRUE_RANGE));
  const measured = distances(cloud, xyz);
  for (let i = 0; i < truth.length; ++i) truth[i] = measured[i] - truth[i];
  return truth;
}

/** The values to colour by, one per point; undefined: height, which depends on the pose. */
export function scalars(cloud, key, xyz) {
  if (key === "height") return undefined;
  if (key === "range") return distances(cloud, xyz);
  if (key === "error" && canShowError(cloud)) return errors(cloud, xyz);
  const field = key.startsWith("field:") ? findField(cloud, [key.slice(6)]) : undefined;
  return field === undefined ? undefined : column(cloud, field);
}

export function isCategory(key) {
  return key.startsWith("field:") && CATEGORIES.test(key.slice(6));
}

/** Interval of most values: without 1 % of outliers at each end, from a sample. */
export function typicalInterval(values) {
  const step = Math.max(1, Math.floor(values.length / 5000));
  const sample = [];
  for (let i = 0; i < values.length; i += step) {
    if (Number.isFinite(values[i]) && values[i] < NO_VALUE) sample.push(values[i]);
  }
  if (sample.length === 0) return [0, 1];
  sample.sort((a, b) => a - b);
  const cut = Math.floor(sample.length / 100);
  const min = sample[cut];
  const max = sample[sample.length - 1 - cut];
  return max > min ? [min, max] : [min - 0.5, max + 0.5];
}

/** All fields of one point as text, for the user. */
export function describePoint(cloud, index) {
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  const row = Math.floor(index / cloud.width);
  const start = row * cloud.rowStep + (index - row * cloud.width) * cloud.pointStep;
  return cloud.fields.map((field) => {
    const type = TYPES.get(field.type);
    const value = view[type.get](start + field.offset, !cloud.isBigEndian);
    return [field.name, Number.isInteger(value) ? String(value) : value.toPrecision(7)];
  });
}
