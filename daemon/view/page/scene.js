// Robot, ghost and person, drawn by WebGL 2 without a library: triangles with one light from above, and nothing else.
import { multiply } from "./kinematics.js";

const MOST_PARTS = 200; // 16,000 bytes of the 16,384 that a uniform block may have everywhere
// Every vertex names its part; where the parts are and their colours come in one block, so that a body of many parts is one draw.
const VERTEX = `#version 300 es
in vec3 place; in vec3 normal; in float part; uniform mat4 view; uniform int base; out vec3 n, p; flat out vec3 colour;
layout(std140) uniform Parts { mat4 models[${MOST_PARTS}]; vec4 colours[${MOST_PARTS}]; };
void main() {
  int k = int(part) - base; mat4 model = models[k];
  vec4 w = model * vec4(place, 1.0); p = w.xyz; n = mat3(model) * normal; colour = colours[k].rgb; gl_Position = view * w;
}`;
const FRAGMENT = `#version 300 es
precision highp float; in vec3 n, p; flat in vec3 colour; uniform vec3 eye; uniform float opacity; out vec4 seen;
void main() {
  vec3 flatN = cross(dFdx(p), dFdy(p));
  vec3 m = dot(n, n) > 1e-8 ? normalize(n) : normalize(flatN);
  if (dot(m, eye - p) < 0.0) m = -m;
  seen = vec4(colour * (0.62 + 0.16 * m.z + 0.34 * max(0.0, dot(m, normalize(vec3(0.6, 0.35, 0.75))))), opacity);
}`;
const BACK = [0.914, 0.929, 0.949];

export class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    const fast = hasGpu();
    const gl = this.gl = canvas.getContext("webgl2", { alpha: false, antialias: fast });
    if (!gl) throw new Error("this browser has no WebGL 2");
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source); gl.compileShader(shader); gl.attachShader(program, shader);
    }
    ["place", "normal", "part"].forEach((name, k) => gl.bindAttribLocation(program, k, name));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error("the shaders of the 3D view do not link");
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST); gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.at = Object.fromEntries(["view", "base", "eye", "opacity"].map((name) => [name, gl.getUniformLocation(program, name)]));
    this.block = new Float32Array(20 * MOST_PARTS);
    gl.uniformBlockBinding(program, gl.getUniformBlockIndex(program, "Parts"), 0);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, gl.createBuffer()); gl.bufferData(gl.UNIFORM_BUFFER, this.block.byteLength, gl.DYNAMIC_DRAW);
    this.dense = fast ? Math.min(1.5, devicePixelRatio || 1) : 0.7; this.arrived = 0; this.missed = 0; this.drawnMs = 0;
    this.reset(); this.listen();
  }
  mesh(vertices, indices, parts) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer()); gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
    for (const k of [0, 1]) { gl.enableVertexAttribArray(k); gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 24, 12 * k); }
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer()); gl.bufferData(gl.ARRAY_BUFFER, parts, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(2); gl.vertexAttribPointer(2, 1, gl.FLOAT, false, 4, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer()); gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    return array;
  }
  show(robot) {
    const parts = new Float32Array(robot.vertices.length / 6);
    robot.bodies.forEach((body, k) => { for (let i = body.first; i < body.first + body.count; i++) parts[robot.indices[i]] = k; });
    this.robot = robot; this.body = this.mesh(robot.vertices, robot.indices, parts);
    this.solids = null; this.reset();
  }
  reset() { this.azimuth = -0.2; this.elevation = 0.12; this.zoom = 1; this.dirty = true; }
  listen() {
    const fingers = new Map(), c = this.canvas;
    let apart = 0;
    c.addEventListener("pointerdown", (e) => { c.setPointerCapture(e.pointerId); fingers.set(e.pointerId, e); apart = 0; });
    for (const end of ["pointerup", "pointercancel"]) c.addEventListener(end, (e) => fingers.delete(e.pointerId));
    c.addEventListener("pointermove", (e) => {
      const before = fingers.get(e.pointerId);
      if (!before) return;
      fingers.set(e.pointerId, e);
      if (fingers.size === 1) {
        this.azimuth -= 0.008 * (e.clientX - before.clientX);
        this.elevation = Math.max(-0.3, Math.min(1.4, this.elevation + 0.008 * (e.clientY - before.clientY)));
      } else {
        const [a, b] = fingers.values(), now = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (apart) this.scale(apart / now);
        apart = now;
      }
      this.dirty = true;
    });
    c.addEventListener("wheel", (e) => { e.preventDefault(); this.scale(Math.exp(0.001 * e.deltaY)); }, { passive: false });
    c.addEventListener("dblclick", () => this.reset());
    new ResizeObserver(() => { this.dirty = true; }).observe(c);
  }
  scale(by) { this.zoom = Math.max(0.3, Math.min(4, this.zoom * by)); this.dirty = true; }
  camera(withPerson) {
    const r = this.robot, arm = r.arm_m, c = this.canvas, aside = withPerson ? r.person.shoulder_m[1] / 2 : 0;
    const target = [r.shoulder_m[0], r.shoulder_m[1] + aside, r.shoulder_m[2] - 0.6 * arm];
    const half = Math.tan(0.22), ratio = c.width / c.height;
    const far = this.zoom * Math.max(2.2 * arm, (1.6 * arm + aside) / ratio) / half;
    const cos = Math.cos(this.elevation);
    const away = [cos * Math.cos(this.azimuth), cos * Math.sin(this.azimuth), Math.sin(this.elevation)];
    const eye = target.map((t, k) => t + far * away[k]);
    const right = unit(cross([0, 0, 1], away)), up = cross(away, right), near = 0.05 * far, end = 60 * far;
    const look = new Float32Array(16);
    [right, up, away].forEach((row, r) => { for (let k = 0; k < 3; k++) look[4 * k + r] = row[k]; look[12 + r] = -dot(row, eye); });
    look[15] = 1;
    const lens = new Float32Array(16);
    lens[0] = 1 / (half * ratio); lens[5] = 1 / half; lens[10] = (end + near) / (near - end); lens[11] = -1; lens[14] = 2 * end * near / (near - end);
    return [multiply(lens, look), eye];
  }
  // q: measured angles; goal: commanded ones or null; person: 66 coordinates or null; faces: 3.
  draw(q, goal, person, faces) {
    this.dirty = false;
    this.keepUp();
    const gl = this.gl, c = this.canvas, dense = this.dense;
    const width = Math.round(c.clientWidth * dense), height = Math.round(c.clientHeight * dense);
    if (c.width !== width || c.height !== height) { c.width = width; c.height = height; }
    gl.viewport(0, 0, width, height); gl.clearColor(...BACK, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.robot || !width || !height) return;
    const [view, eye] = this.camera(person);
    gl.uniformMatrix4fv(this.at.view, false, view); gl.uniform3fv(this.at.eye, eye);
    const solids = new Solids();
    this.ground(solids);
    if (person) this.person(solids, person, faces);
    this.solid(solids);
    this.bodies(this.robot.places(q), 1);
    if (goal?.some((g, k) => Math.abs(g - q[k]) > 0.01)) { // first its depth alone, then only its nearest surface, so that no inner parts shine through
      const ghost = this.robot.places(goal);
      gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(4, 256); // behind the measured robot where both are in one place
      gl.colorMask(false, false, false, false); this.bodies(ghost, 1); gl.colorMask(true, true, true, true);
      gl.enable(gl.BLEND); gl.depthFunc(gl.EQUAL); this.bodies(ghost, 0.35); gl.depthFunc(gl.LESS); gl.disable(gl.BLEND); gl.disable(gl.POLYGON_OFFSET_FILL);
    }
  }
  // Where states come faster than they are drawn, on a computer that draws without a GPU, fewer pixels are drawn.
  keepUp() {
    const now = performance.now(), gap = now - this.drawnMs, missed = Math.max(0, this.arrived - 1);
    this.drawnMs = now; this.arrived = 0;
    if (gap > 1000) return; // nothing had changed, or the page was hidden
    this.missed = 0.95 * this.missed + missed;
    if (this.missed > 2 && this.dense > 0.4) { this.dense *= 0.8; this.missed = 0; } // one state in ten
  }
  parts(from, models, colours) {
    models.forEach((m, k) => { this.block.set(m, 16 * k); this.block.set(colours[k], 16 * MOST_PARTS + 4 * k); });
    this.gl.uniform1i(this.at.base, from);
    this.gl.bufferSubData(this.gl.UNIFORM_BUFFER, 0, this.block);
  }
  bodies(places, opacity) {
    const gl = this.gl, all = this.robot.bodies;
    gl.bindVertexArray(this.body); gl.uniform1f(this.at.opacity, opacity);
    for (let from = 0; from < all.length; from += MOST_PARTS) {
      const some = all.slice(from, from + MOST_PARTS), first = some[0].first, last = some[some.length - 1];
      this.parts(from, places.slice(from, from + MOST_PARTS), some.map((body) => body.colour));
      gl.drawElements(gl.TRIANGLES, last.first + last.count - first, gl.UNSIGNED_INT, 4 * first);
    }
  }
  solid({ kinds, models, colours }) {
    const gl = this.gl, key = kinds.join("");
    if (this.solids?.key !== key) this.solids = { key, ...this.joined(kinds) }; // with and without a person
    gl.bindVertexArray(this.solids.array); gl.uniform1f(this.at.opacity, 1);
    this.parts(0, models, colours);
    gl.drawElements(gl.TRIANGLES, this.solids.count, gl.UNSIGNED_INT, 0);
  }
  joined(kinds) {
    const vertices = [], indices = [], parts = [];
    kinds.forEach((kind, k) => {
      const [v, i] = kind === "rod" ? ROD : BALL, start = vertices.length / 6;
      vertices.push(...v); indices.push(...i.map((index) => index + start)); parts.push(...Array(v.length / 6).fill(k));
    });
    return { array: this.mesh(new Float32Array(vertices), new Uint32Array(indices), new Float32Array(parts)), count: indices.length };
  }
  ground(solids) {
    const r = this.robot, floor = r.floor_m, arm = r.arm_m;
    solids.rod([0, 0, floor - 0.02 * arm], [0, 0, floor], 6 * arm, [0.86, 0.88, 0.90]);
    if (r.stand_m > floor) solids.rod([0, 0, floor], [0, 0, r.stand_m], 0.18 * arm, [0.78, 0.80, 0.83]);
  }
  person(solids, joints, faces) {
    const p = this.robot.person, scale = p.scale, at = [], radius = p.radii_m.limb * scale;
    const height = (joints[3 * 16 + 1] + joints[3 * 17 + 1]) / 2; // x left, y up, z forward: to the robot's axes
    for (let j = 0; j < 22; j++) at.push([
      (joints[3 * j + 2] - joints[2]) * scale + p.shoulder_m[0], (joints[3 * j] - joints[0]) * scale + p.shoulder_m[1],
      (joints[3 * j + 1] - height) * scale + p.shoulder_m[2]]);
    const colour = (limb) => p.colours[limb] ?? p.colours[""];
    p.parents.forEach((parent, j) => { if (parent >= 0) solids.capsule(at[parent], at[j], radius, colour(p.limbs[j])); });
    for (const [elbow, wrist, side] of [[18, 20, "left"], [19, 21, "right"]]) {
      const hand = at[wrist].map((v, k) => v + p.hand_share * (v - at[elbow][k]));
      solids.capsule(at[wrist], hand, p.radii_m.hand * scale, colour(side));
    }
    const up = unit(at[15].map((v, k) => v - at[12][k])), skull = p.radii_m.skull * scale, face = [faces[2], faces[0], faces[1]];
    const head = at[15].map((v, k) => v + 0.07 * scale * up[k]);
    solids.ball(head, skull, colour(""));
    solids.capsule(head.map((v, k) => v + 0.9 * skull * face[k]), head.map((v, k) => v + 1.3 * skull * face[k]), 0.22 * skull, p.colours.nose);
  }
}

class Solids { // rods and balls of one frame: their kinds, places and colours
  kinds = []; models = []; colours = [];
  rod(a, b, radius, colour) {
    const along = b.map((v, k) => v - a[k]), length = Math.hypot(...along) || 1e-9;
    const z = along.map((v) => v / length), x = unit(cross(Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], z)), y = cross(z, x);
    this.#add("rod", [...x.map((v) => v * radius), 0, ...y.map((v) => v * radius), 0, ...along, 0, ...a, 1], colour);
  }
  ball([x, y, z], radius, colour) { this.#add("ball", [radius, 0, 0, 0, 0, radius, 0, 0, 0, 0, radius, 0, x, y, z, 1], colour); }
  capsule(a, b, radius, colour) { this.rod(a, b, radius, colour); this.ball(b, radius, colour); } // one bone's start is another's end
  #add(kind, model, colour) { this.kinds.push(kind); this.models.push(model); this.colours.push(colour); }
}

function hasGpu() {
  const gl = document.createElement("canvas").getContext("webgl2"), info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl ? gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return !/swiftshader|llvmpipe|software/i.test(name);
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const n = Math.hypot(...a) || 1; return a.map((v) => v / n); };

function grid(rows, columns, point) {
  const vertices = [], indices = [];
  for (let r = 0; r < rows; r++) for (let c = 0; c < columns; c++) vertices.push(...point(r / (rows - 1), 2 * Math.PI * c / (columns - 1)));
  for (let r = 0; r + 1 < rows; r++) for (let c = 0; c + 1 < columns; c++) {
    const k = r * columns + c;
    indices.push(k, k + 1, k + columns + 1, k, k + columns + 1, k + columns);
  }
  return [vertices, indices];
}
function sphere() {
  return grid(7, 13, (v, turn) => {
    const up = Math.PI * (v - 0.5), p = [Math.cos(up) * Math.cos(turn), Math.cos(up) * Math.sin(turn), Math.sin(up)];
    return [...p, ...p];
  });
}
function cylinder() { // of height and radius 1, closed at both ends
  const rows = [[0, 0, -1], [1, 0, -1], [1, 0, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]];
  return grid(rows.length, 13, (v, turn) => {
    const [radius, z, end] = rows[Math.round(v * (rows.length - 1))], x = Math.cos(turn), y = Math.sin(turn);
    return [radius * x, radius * y, z, ...(end ? [0, 0, end] : [x, y, 0])];
  });
}
const BALL = sphere(), ROD = cylinder();
