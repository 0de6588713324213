// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Colour maps as tables of 256 RGB colours. */

/** Interpolates between colours of 6 hexadecimal digits. */
function ramp(stops) {
  const colours = stops.map((text) => [0, 2, 4].map((i) => parseInt(text.slice(i, i + 2), 16)));
  const table = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const place = (i / 255) * (colours.length - 1);
    const first = Math.min(Math.floor(place), colours.length - 2);
    for (let c = 0; c < 3; ++c) table[4 * i + c] = Math.round(colours[first][c] + (place - first) * (colours[first + 1][c] - colours[first][c]));
    table[4 * i + 3] = 255;
  }
  return table;
}

function grey() { return ramp(["202020", "ffffff"]); }

/** Polynomial approximation of Turbo by A. Mikhailov, "Turbo, an improved rainbow colormap for
 * visualization", Google AI blog, 2019 (Apache-2.0). */
function turbo() {
  const coefficients = [
    [0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943],
    [0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604],
    [0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973],
  ];
  const table = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    for (let c = 0; c < 3; ++c) {
      const value = coefficients[c].reduceRight((sum, k) => sum * (i / 255) + k, 0);
      table[4 * i + c] = Math.round(255 * Math.min(Math.max(value, 0), 1));
    }
    table[4 * i + 3] = 255;
  }
  return table;
}

/** Distinct neighbours: hues that advance by the golden angle. */
function categories() {
  const table = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const hue = (i * 137.508) % 360;
    const lightness = 0.55 + 0.12 * ((i % 3) - 1);
    for (let c = 0; c < 3; ++c) {
      const k = (c * 240 + hue) % 360;
      const wave = Math.min(Math.max(Math.abs(k / 60 - 3) - 1, 0), 1);
      table[4 * i + c] = Math.round(255 * (lightness + 0.7 * (wave - 0.5) * (1 - Math.abs(2 * lightness - 1))));
    }
    table[4 * i + 3] = 255;
  }
  return table;
}

export const MAPS = new Map([
  ["turbo", turbo()],
  ["viridis", ramp(["440154", "472d7b", "3b528b", "2c728e", "21918c", "28ae80", "5ec962", "addc30", "fde725"])],
  ["blue to red", ramp(["2166ac", "67a9cf", "f2f2f2", "ef8a62", "b2182b"])],
  ["grey", grey()],
]);

export const CATEGORY_MAP = categories();
