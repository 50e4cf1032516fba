// Column-major 4 x 4 matrices, and where a robot's bodies are for given joint angles.
export const identity = () => new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

export function multiply(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; c++) for (let r = 0; r < 4; r++) {
    let sum = 0;
    for (let k = 0; k < 4; k++) sum += a[4 * k + r] * b[4 * c + k];
    out[4 * c + r] = sum;
  }
  return out;
}

export function placed([w, x, y, z], [px, py, pz]) {
  return new Float32Array([
    1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0,
    2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0,
    2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0, px, py, pz, 1]);
}

function turnedAbout(axis, anchor, angle) {
  const s = Math.sin(angle / 2), R = placed([Math.cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]], [0, 0, 0]);
  for (let r = 0; r < 3; r++) R[12 + r] = anchor[r] - (R[r] * anchor[0] + R[4 + r] * anchor[1] + R[8 + r] * anchor[2]);
  return R;
}

export class Robot {
  // `message`: what `daemon/view/robot_shapes.py` writes.
  constructor(message) {
    const length = new DataView(message).getUint32(0, true);
    Object.assign(this, JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length))));
    const start = 4 + length, end = start + 24 * this.n_vertices;
    this.vertices = new Float32Array(message.slice(start, end));
    this.indices = new Uint32Array(message.slice(end));
  }
  places(q) {
    const all = [];
    for (const body of this.bodies) {
      let T = placed(body.quat, body.pos);
      if (body.parent >= 0) T = multiply(all[body.parent], T);
      for (const j of body.joints) T = multiply(T, turnedAbout(j.axis, j.anchor, (q[j.index] ?? 0) - j.zero_rad));
      all.push(T);
    }
    return all;
  }
}
