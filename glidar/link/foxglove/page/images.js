// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Camera images of sensor_msgs/msg/Image and CompressedImage, on a canvas each. */
import { typicalInterval } from "/cloud.js";
import { MAPS } from "/colours.js";

const MAX_SIDE = 8192;

/** Encodings of sensor_msgs/image_encodings.hpp with 8 bits: bytes of a pixel and places of red, green,
 * blue. */
const BYTE_ENCODINGS = new Map([
  ["mono8", [1, 0, 0, 0]], ["8UC1", [1, 0, 0, 0]],
  ["rgb8", [3, 0, 1, 2]], ["8UC3", [3, 2, 1, 0]], ["bgr8", [3, 2, 1, 0]],
  ["rgba8", [4, 0, 1, 2]], ["8UC4", [4, 2, 1, 0]], ["bgra8", [4, 2, 1, 0]],
]);
/** Bytes of a number; metres of a unit; how DataView reads it. */
const NUMBER_ENCODINGS = new Map([
  ["16UC1", { size: 2, unit: 0.001, get: "getUint16" }],
  ["mono16", { size: 2, unit: 1, get: "getUint16" }],
  ["32FC1", { size: 4, unit: 1, get: "getFloat32" }],
]);

function checkSize(image, pixelBytes) {
  const { width, height, step, data } = image;
  if (width > MAX_SIDE || height > MAX_SIDE) throw new Error(`image of ${width} x ${height}; at most ${MAX_SIDE} pixels are shown`);
  if (width === 0 || height === 0) throw new Error("the image is empty");
  if (step < width * pixelBytes || step * (height - 1) + width * pixelBytes > data.byteLength) throw new Error(`${data.byteLength} bytes hold no image of ${width} x ${height}`);
}

function paintBytes(image, [bytes, red, green, blue], pixels) {
  checkSize(image, bytes);
  for (let y = 0, out = 0; y < image.height; ++y) {
    for (let x = 0, at = y * image.step; x < image.width; ++x, at += bytes, out += 4) {
      pixels[out] = image.data[at + red];
      pixels[out + 1] = image.data[at + green];
      pixels[out + 2] = image.data[at + blue];
      pixels[out + 3] = 255;
    }
  }
  return "";
}

/** Colours numbers between their typical ends; those without a value stay dark. */
function paintNumbers(image, { size, unit, get }, pixels) {
  checkSize(image, size);
  const view = new DataView(image.data.buffer, image.data.byteOffset, image.data.byteLength);
  const values = new Float32Array(image.width * image.height);
  for (let y = 0, i = 0; y < image.height; ++y) {
    for (let x = 0; x < image.width; ++x, ++i) {
      const value = view[get](y * image.step + x * size, !image.isBigEndian);
      values[i] = value === 0 && image.encoding === "16UC1" ? NaN : value * unit;
    }
  }
  const [min, max] = typicalInterval(values);
  const map = MAPS.get(image.encoding === "mono16" ? "grey" : "turbo");
  values.forEach((value, i) => {
    const index = 4 * Math.round(255 * Math.min(Math.max((value - min) / (max - min), 0), 1));
    pixels.set(Number.isFinite(value) ? map.subarray(index, index + 4) : [20, 20, 20, 255], 4 * i);
  });
  return `${min.toPrecision(3)} to ${max.toPrecision(3)}${unit === 1 && image.encoding === "mono16" ? "" : " m"}`;
}

/** Draws an image message; resolves to a note for the caption. */
export async function drawImage(canvas, message) {
  if (message.format !== undefined) {
    const bitmap = await createImageBitmap(new Blob([message.data]));
    Object.assign(canvas, { width: bitmap.width, height: bitmap.height });
    canvas.getContext("2d").drawImage(bitmap, 0, 0);
    bitmap.close();
    return "";
  }
  const bytes = BYTE_ENCODINGS.get(message.encoding);
  const numbers = NUMBER_ENCODINGS.get(message.encoding);
  if (bytes === undefined && numbers === undefined) throw new Error(`the encoding ${message.encoding} is not supported`);
  if (message.width > MAX_SIDE || message.height > MAX_SIDE) checkSize(message, 1);
  const picture = new ImageData(Math.max(message.width, 1), Math.max(message.height, 1));
  const note = bytes !== undefined ? paintBytes(message, bytes, picture.data) : paintNumbers(message, numbers, picture.data);
  Object.assign(canvas, { width: picture.width, height: picture.height });
  canvas.getContext("2d").putImageData(picture, 0, 0);
  return note;
}

/** The images of all topics below each other; shows the newest one of each topic only. */
export class ImagePanel {
  #parent;
  #entries = new Map();
  #report;

  constructor(parent, report) {
    this.#parent = parent;
    this.#report = report;
  }

  show(topic, message) {
    const entry = this.#entries.get(topic) ?? this.#create(topic);
    entry.next = message;
    if (!entry.isBusy) this.#draw(topic, entry);
  }

  remove(topic) {
    this.#entries.get(topic)?.figure.remove();
    this.#entries.delete(topic);
  }

  async #draw(topic, entry) {
    entry.isBusy = true;
    while (entry.next !== undefined) {
      const message = entry.next;
      entry.next = undefined;
      try {
        const note = await drawImage(entry.canvas, message);
        entry.caption.textContent = note === "" ? topic : `${topic} · ${note}`;
        entry.canvas.dataset.images = Number(entry.canvas.dataset.images ?? 0) + 1;
        this.#report(topic, "");
      } catch (error) {
        this.#report(topic, error.message);
      }
      await new Promise((resolve) => { requestAnimationFrame(resolve); });
    }
    entry.isBusy = false;
  }

  #create(topic) {
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    const canvas = document.createElement("canvas");
    caption.textContent = topic;
    canvas.dataset.topic = topic;
    figure.append(caption, canvas);
    this.#parent.append(figure);
    const entry = { figure, caption, canvas, isBusy: false, next: undefined };
    this.#entries.set(topic, entry);
    return entry;
  }
}
