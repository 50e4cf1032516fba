// A plot over time on a canvas: as many seconds as it is wide, fixed memory.
const DEG = 180 / Math.PI;
export const SECONDS = 20;
const MOST = 600;

export class History {
  constructor() { this.rows = []; }
  add(t, row) {
    const last = this.rows[this.rows.length - 1];
    if (last && t <= last.t) this.rows = [];
    this.rows.push({ t, ...row });
    if (this.rows.length > MOST) this.rows.splice(0, this.rows.length - MOST);
  }
}

export function plot(canvas, { title, unit, rows, series, limits = [], end, seconds = SECONDS }) {
  const dense = devicePixelRatio || 1, w = canvas.clientWidth, h = canvas.clientHeight;
  if (!w || !h) return;
  if (canvas.width !== Math.round(w * dense)) { canvas.width = Math.round(w * dense); canvas.height = Math.round(h * dense); }
  const pen = canvas.getContext("2d", { willReadFrequently: true });
  pen.setTransform(dense, 0, 0, dense, 0, 0); pen.clearRect(0, 0, w, h);
  pen.font = "12px system-ui, sans-serif"; pen.textBaseline = "top";
  const from = end - seconds, seen = rows.filter((r) => r.t >= from && r.t <= end);
  const values = seen.flatMap((r) => series.map((s) => s.of(r))).filter(Number.isFinite);
  let low = Math.min(...values, 0), high = Math.max(...values, 1e-3);
  for (const l of limits) if (l > low - 0.5 * (high - low) && l < high + 0.5 * (high - low)) { low = Math.min(low, l); high = Math.max(high, l); }
  const margin = 0.1 * (high - low); low -= margin; high += margin;
  const left = 44, top = 18, bottom = h - 4;
  const x = (t) => left + (w - left - 4) * (t - from) / seconds, y = (v) => bottom - (bottom - top) * (v - low) / (high - low);
  pen.fillStyle = "#6b7280";
  pen.fillText(`${title}, ${unit}`, 0, 0);
  pen.textAlign = "right";
  for (const v of [low + margin, high - margin]) pen.fillText(v.toFixed(Math.abs(v) < 10 ? 1 : 0), left - 4, y(v) - 6);
  let right = w - 4;
  for (const s of [...series].reverse()) { pen.fillStyle = s.colour; pen.fillText(s.name, right, 0); right -= pen.measureText(s.name).width + 12; }
  pen.textAlign = "left";
  pen.strokeStyle = "#e5e7eb"; pen.strokeRect(left, top, w - left - 4, bottom - top);
  pen.save(); pen.beginPath(); pen.rect(left, top, w - left - 4, bottom - top); pen.clip();
  pen.setLineDash([4, 3]); pen.strokeStyle = "#8d6e63";
  for (const l of limits) { pen.beginPath(); pen.moveTo(left, y(l)); pen.lineTo(w, y(l)); pen.stroke(); }
  pen.setLineDash([]);
  for (const s of series) {
    pen.strokeStyle = s.colour; pen.lineWidth = 1.5; pen.beginPath();
    let down = false;
    for (const r of seen) {
      const v = s.of(r);
      if (!Number.isFinite(v)) { down = false; continue; }
      if (down) pen.lineTo(x(r.t), y(v)); else pen.moveTo(x(r.t), y(v));
      down = true;
    }
    pen.stroke();
  }
  pen.restore();
}

export const degrees = (rad) => rad * DEG;
