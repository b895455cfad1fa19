// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/page_parts.hpp"

namespace vam::report_tool {

// The three-dimensional view is drawn with WebGL 2: positions as fractions of the box, one colour per vertex, light
// from the eye.
const char* const page_script = R"js('use strict';
for (const box of document.querySelectorAll('.series')) {
  const frames = JSON.parse(box.querySelector('script').textContent);
  const image = box.querySelector('img'), slider = box.querySelector('input'), label = box.querySelector('output');
  const show = n => { slider.value = n; label.value = frames[n][0]; image.src = 'data:image/png;base64,' + frames[n][1]; };
  slider.addEventListener('input', () => show(+slider.value));
  const button = box.querySelector('button');
  let timer = 0;
  if (button) button.addEventListener('click', () => {
    if (timer) { clearInterval(timer); timer = 0; button.textContent = 'play'; return; }
    timer = setInterval(() => show((+slider.value + 1) % frames.length), 120);
    button.textContent = 'stop';
  });
}
const bytes = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
const vertexShader = `#version 300 es
in vec3 p; in vec3 n; in vec3 c; uniform mat3 turn; uniform vec3 middle; uniform vec2 zoom; uniform float depth;
out vec3 normal; out vec3 colour;
void main() { vec3 q = turn * (p - middle); normal = turn * n; colour = c; gl_Position = vec4(q.xy * zoom, -q.z * depth, 1.0); }`;
const fragmentShader = `#version 300 es
precision highp float; in vec3 normal; in vec3 colour; out vec4 shown;
void main() { shown = vec4(colour * (0.35 + 0.65 * abs(normalize(normal).z)), 1.0); }`;
function faceNormals(points, triangles) {  // as long as the faces are large
  const faces = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const u = [0, 1, 2].map(i => points[b + i] - points[a + i]), v = [0, 1, 2].map(i => points[c + i] - points[a + i]);
    faces.set([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], t);
  }
  return faces;
}
// Of each corner of each triangle: the sum over the faces around it that are within 30 degrees of its own, so that
// sharp edges stay sharp.
function normals(points, triangles) {
  const faces = faceNormals(points, triangles), sums = new Float32Array(3 * triangles.length);
  const last = new Int32Array(points.length / 3).fill(-1), next = new Int32Array(triangles.length);
  triangles.forEach((point, corner) => { next[corner] = last[point]; last[point] = corner; });
  const times = (s, t) => faces[s] * faces[t] + faces[s + 1] * faces[t + 1] + faces[s + 2] * faces[t + 2];
  const long = faces.map((_, t) => t % 3 ? 0 : Math.sqrt(times(t, t)));
  triangles.forEach((point, corner) => {
    const own = corner - corner % 3;
    for (let other = last[point]; other >= 0; other = next[other]) {
      const face = other - other % 3;
      if (times(own, face) < Math.cos(Math.PI / 6) * long[own] * long[face]) continue;
      for (let i = 0; i < 3; ++i) sums[3 * corner + i] += faces[face + i];
    }
  });
  return sums;
}
function ofCorners(values, triangles) {
  const spread = new values.constructor(3 * triangles.length);
  triangles.forEach((point, corner) => { for (let i = 0; i < 3; ++i) spread[3 * corner + i] = values[3 * point + i]; });
  return spread;
}
function programOf(gl) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source); gl.compileShader(shader); gl.attachShader(program, shader);
  }
  ['p', 'n', 'c'].forEach((name, at) => gl.bindAttribLocation(program, at, name));
  gl.linkProgram(program); gl.useProgram(program); gl.enable(gl.DEPTH_TEST); gl.clearColor(1, 1, 1, 1);
  return program;
}
function loaded(gl, low, side, [positions, colours, corners]) {
  const places = new Uint16Array(bytes(positions).buffer), points = new Float32Array(places.length);
  for (let i = 0; i < places.length; ++i) points[i] = low[i % 3] + side[i % 3] * places[i] / 65535;
  const triangles = new Uint16Array(bytes(corners).buffer), array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const attribute = (at, values, type, scaled) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer()); gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(at); gl.vertexAttribPointer(at, 3, type, scaled, 0, 0);
  };
  attribute(0, ofCorners(points, triangles), gl.FLOAT, false);
  attribute(1, normals(points, triangles), gl.FLOAT, false);
  attribute(2, ofCorners(bytes(colours), triangles), gl.UNSIGNED_BYTE, true);
  return {array, count: triangles.length};
}
function draw(view) {
  const {canvas, gl, low, side} = view, reach = Math.hypot(...side) / 2, layer = view.layers[view.shown];
  const sharp = window.devicePixelRatio || 1;
  canvas.width = Math.round(canvas.clientWidth * sharp); canvas.height = Math.round(canvas.clientHeight * sharp);
  gl.viewport(0, 0, canvas.width, canvas.height); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  const [cy, sy, cp, sp] = [Math.cos(view.yaw), Math.sin(view.yaw), Math.cos(view.pitch), Math.sin(view.pitch)];
  const uniform = name => gl.getUniformLocation(view.program, name);
  // Columns: the images of x, y and z of the part; z points upwards, the eye looks at the x-z plane from -y and above.
  gl.uniformMatrix3fv(uniform('turn'), false, [cy, sp * sy, -cp * sy, -sy, sp * cy, -cp * cy, 0, cp, sp]);
  gl.uniform3fv(uniform('middle'), low.map((begin, i) => begin + side[i] / 2));
  const scale = 0.95 * view.zoom / reach, wide = canvas.height / canvas.width;
  gl.uniform2f(uniform('zoom'), scale * Math.min(1, wide), scale * Math.min(1, 1 / wide));
  gl.uniform1f(uniform('depth'), 0.5 / reach);
  gl.bindVertexArray(layer.array);
  gl.drawArrays(gl.TRIANGLES, 0, layer.count);
}
function turn(view, yaw, pitch) {
  view.yaw += yaw;
  view.pitch = Math.max(-1.57, Math.min(1.57, view.pitch + pitch));
  draw(view);
}
function control(view) {
  const canvas = view.canvas;
  let from = null;
  canvas.addEventListener('pointerdown', event => { from = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener('pointerup', () => { from = null; });
  canvas.addEventListener('pointermove', event => {
    if (!from) return;
    turn(view, 0.01 * (event.clientX - from[0]), 0.01 * (event.clientY - from[1]));
    from = [event.clientX, event.clientY];
  });
  canvas.addEventListener('wheel', event => { event.preventDefault(); view.zoom *= Math.exp(-0.001 * event.deltaY); draw(view); }, {passive: false});
  canvas.addEventListener('keydown', event => {
    const step = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]}[event.key];
    if (!step) return;
    event.preventDefault(); turn(view, ...step);
  });
  window.addEventListener('resize', () => draw(view));
}
function body(box) {
  const [low, high, packed] = JSON.parse(box.querySelector('script').textContent);
  const canvas = box.querySelector('canvas');
  const gl = canvas.getContext('webgl2', {antialias: true, preserveDrawingBuffer: true});
  if (!gl) { canvas.replaceWith(box.querySelector('template').content); return; }
  const side = high.map((end, i) => end - low[i]);
  const view = {canvas, gl, low, side, program: programOf(gl), shown: 0, yaw: -0.6, pitch: 0.45, zoom: 1};
  view.layers = packed.map(layer => loaded(gl, low, side, layer));
  box.querySelectorAll('input').forEach((choice, n) => choice.addEventListener('change', () => {
    view.shown = n;
    box.querySelectorAll('.scale').forEach((scale, at) => { scale.hidden = at !== n; });
    draw(view);
  }));
  control(view);
  draw(view);
}
document.querySelectorAll('.body').forEach(body);
)js";

}  // namespace vam::report_tool
