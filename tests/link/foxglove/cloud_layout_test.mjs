// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The page's readers of CDR and of PointCloud2 layouts, without a browser.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const load = (name) => import(`data:text/javascript,${encodeURIComponent(readFileSync(new URL(`../../../glidar/link/foxglove/page/${name}`, import.meta.url), "utf8"))}`);
const { CdrReader } = await load("cdr.js");
const { checkLayout, colourings, describePoint, positions, scalars, typicalInterval } = await load("cloud.js");

/** A cloud of `count` points at (i, 2 i, 3 i) with a ring and a time. */
function cloud({ step, width, height = 1, gap = 0, isBigEndian = false, shift = 0 }) {
  const rowStep = step * width + gap;
  const data = new Uint8Array(rowStep * height + shift).subarray(shift);
  const view = new DataView(data.buffer, data.byteOffset);
  for (let i = 0; i < width * height; ++i) {
    const at = Math.floor(i / width) * rowStep + (i % width) * step;
    [i, 2 * i, 3 * i].forEach((value, k) => view.setFloat32(at + 4 * k, value, !isBigEndian));
    view.setUint16(at + 12, i, !isBigEndian);
    view.setFloat32(at + 14, i / 10, !isBigEndian);
  }
  const fields = [["x", 0, 7], ["y", 4, 7], ["z", 8, 7], ["ring", 12, 4], ["time", 14, 7]].map(([name, offset, type]) => ({ name, offset, type, count: 1 }));
  return { width, height, pointStep: step, rowStep, isBigEndian, data, fields };
}

function readsEveryLayout() {
  for (const layout of [{ step: 18 }, { step: 20 }, { step: 22 }, { step: 20, shift: 1 }, { step: 20, isBigEndian: true }, { step: 20, height: 3, gap: 7 }, { step: 18, height: 3, gap: 1 }]) {
    const one = cloud({ width: 5, ...layout });
    checkLayout(one);
    const xyz = positions(one);
    const last = xyz.length / 3 - 1;
    assert.deepEqual([...xyz.slice(-3)], [last, 2 * last, 3 * last], JSON.stringify(layout));
    assert.equal(scalars(one, "field:ring", xyz)[last], last);
    assert.ok(Math.abs(scalars(one, "range", xyz)[2] - Math.hypot(2, 4, 6)) < 1e-5);
    assert.equal(describePoint(one, last).find(([name]) => name === "ring")[1], String(last));
  }
}

function rejectsInvalidLayouts() {
  const invalid = [
    (one) => { one.width = 6; },
    (one) => { one.height = 2; },
    (one) => { one.width = 0xffffffff; one.rowStep = 0; },
    (one) => { one.pointStep = 17; },
    (one) => { one.fields[0].type = 9; },
    (one) => { one.fields[0].name = "a"; },
    (one) => { one.fields[4].count = 2; },
  ];
  for (const spoil of invalid) {
    const one = cloud({ step: 18, width: 5 });
    spoil(one);
    assert.throws(() => checkLayout(one), Error, String(spoil));
  }
}

function coloursByErrorIfThereIsGroundTruth() {
  const one = cloud({ step: 18, width: 3 });
  assert.ok(!colourings(one).some(({ key }) => key === "error"));
  one.fields.push({ name: "range", offset: 4, type: 7, count: 1 }, { name: "true_range", offset: 0, type: 7, count: 1 });
  assert.ok(colourings(one).some(({ key }) => key === "error"));
  assert.deepEqual([...scalars(one, "error", positions(one))], [0, 1, 2]);
  assert.deepEqual(typicalInterval([NaN, 1, 2, Infinity, 3]), [1, 3]);
  assert.deepEqual(typicalInterval([NaN]), [0, 1]);
}

function readsAlignedCdr() {
  const bytes = new Uint8Array([0, 1, 0, 0, 7, 0, 0, 0, 3, 0, 0, 0, 97, 98, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f]);
  const reader = new CdrReader(bytes.subarray(0, 28));
  assert.equal(reader.u8(), 7);
  assert.equal(reader.string(), "ab");
  assert.throws(() => { for (;;) reader.f64(); }, RangeError);
  assert.throws(() => new CdrReader(new Uint8Array([0, 7, 0, 0])), RangeError);
  assert.throws(() => new CdrReader(new Uint8Array([0, 1, 0, 0, 255, 255, 255, 255])).bytes(), RangeError);
  assert.throws(() => new CdrReader(new Uint8Array([0, 1, 0, 0, 255, 255, 255, 255])).count(13), RangeError);
}

readsEveryLayout();
rejectsInvalidLayouts();
coloursByErrorIfThereIsGroundTruth();
readsAlignedCdr();
