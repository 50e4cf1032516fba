// A recorded run (`daemon/view/recorded_run.py`): a slider, a play button, and the frame at hand.
const $ = (id) => document.getElementById(id);

export function scrubber(message, changed) {
  const length = new DataView(message).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length)));
  const angles = new Float32Array(message.slice(4 + length)), n = head.frames, joints = angles.length / (2 * n);
  const of = (k, measured) => angles.subarray((k + measured * n) * joints, (k + measured * n + 1) * joints);
  const rows = Array.from({ length: n }, (_, k) => ({ t: k / head.fps, goal: of(k, 0), present: of(k, 1) }));
  let at = 0, playing = 0;
  function go(k) {
    at = Math.max(0, Math.min(n - 1, Math.round(k)));
    $("at").value = at;
    $("time").textContent = `${(at / head.fps).toFixed(1)} of ${((n - 1) / head.fps).toFixed(1)} s`;
    $("spans").textContent = head.spans.find((s) => at >= s.first && at < s.end)?.text ?? "";
    changed();
  }
  $("at").max = n - 1;
  $("at").addEventListener("input", () => go(+$("at").value));
  function play(on) {
    clearInterval(playing); playing = 0;
    $("play").textContent = on ? "pause" : "play";
    if (!on) return;
    if (at >= n - 1) at = 0;
    const began = performance.now(), from = at;
    playing = setInterval(() => { go(from + (performance.now() - began) / 1000 * head.fps); if (at >= n - 1) play(false); }, 1000 / head.fps);
  }
  $("play").addEventListener("click", () => play(!playing));
  addEventListener("keydown", (e) => { if (e.key === " " && !e.target.matches("input")) { e.preventDefault(); play(!playing); } });
  go(0);
  return { head, frame: () => ({ q: rows[at].present, goal: rows[at].goal, person: null, faces: null }), rows: () => rows, plotEnd: () => Math.max(20, at / head.fps) };
}
