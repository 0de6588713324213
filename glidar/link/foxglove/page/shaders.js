// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Programs of WebGL 2. */

const POINT_VERTEX = `#version 300 es
in vec3 position;
in float value;
uniform mat4 model;
uniform mat4 projection;
uniform float size;
uniform vec2 interval;
uniform int mode;  // 0 value, 1 height, 2 category
uniform sampler2D map;
out vec3 colour;
void main() {
  vec4 place = model * vec4(position, 1.0);
  bool isHidden = position.x > 1e29;
  gl_Position = isHidden ? vec4(2.0, 2.0, 2.0, 1.0) : projection * place;
  gl_PointSize = size;
  float number = mode == 1 ? place.z : value;
  float share = clamp((number - interval.x) / (interval.y - interval.x), 0.0, 1.0);
  int index = mode == 2 ? int(mod(number, 256.0)) : int(share * 255.0 + 0.5);
  bool hasNoValue = mode != 1 && (value < -1e37 || (mode == 2 && value > 4.29e9));
  colour = hasNoValue ? vec3(0.35) : texelFetch(map, ivec2(index, 0), 0).rgb;
}`;

const POINT_FRAGMENT = `#version 300 es
precision highp float;
in vec3 colour;
uniform float size;
out vec4 result;
void main() {
  vec2 offset = gl_PointCoord - 0.5;
  if (size > 3.5 && dot(offset, offset) > 0.25) discard;
  result = vec4(colour, 1.0);
}`;

const LINE_VERTEX = `#version 300 es
in vec3 position;
uniform mat4 model;
uniform mat4 projection;
void main() { gl_Position = projection * (model * vec4(position, 1.0)); }`;

const LINE_FRAGMENT = `#version 300 es
precision highp float;
uniform vec4 colour;
out vec4 result;
void main() { result = colour; }`;

function compile(gl, type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(`shader: ${gl.getShaderInfoLog(shader)}`);
  return shader;
}

/** The program and the places of its uniforms. Attribute 0 is the position, 1 the value. */
function link(gl, vertex, fragment, uniforms) {
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl, gl.VERTEX_SHADER, vertex));
  gl.attachShader(program, compile(gl, gl.FRAGMENT_SHADER, fragment));
  gl.bindAttribLocation(program, 0, "position");
  gl.bindAttribLocation(program, 1, "value");
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(`program: ${gl.getProgramInfoLog(program)}`);
  return { program, at: Object.fromEntries(uniforms.map((name) => [name, gl.getUniformLocation(program, name)])) };
}

export function pointProgram(gl) {
  return link(gl, POINT_VERTEX, POINT_FRAGMENT, ["model", "projection", "size", "interval", "mode", "map"]);
}

export function lineProgram(gl) {
  return link(gl, LINE_VERTEX, LINE_FRAGMENT, ["model", "projection", "colour"]);
}
