// The page: what the daemon says is shown, what a person presses is sent. Two modes: a daemon, or a recorded run.
import { Line, get, newId, stamp } from "./wire.js";
import { Robot } from "./kinematics.js";
import { Scene } from "./scene.js";
import { History, degrees, plot } from "./plots.js";
import { scrubber } from "./recorded.js";

const $ = (id) => document.getElementById(id);
const EXAMPLES = ["wave with your right hand", "clap three times", "raise both arms and hold them", "nod twice", "cross your arms", "look to the left, then bow", "point up with your left hand", "shrug your shoulders"];
const NEEDS = {
  limp: "torque is off; a text arms the robot by itself", arming: "torque comes on, slowly to the rest pose", idle: "ready for a text",
  moving: "playing", holding: "stopped and holds; a text goes on", parking: "slowly to the park pose, then torque off",
  fault: "needs a reset, then arm", estop: "e-stop: needs a reset, then arm",
};
const REMEDY = {
  late: "adapter or baud: mmmd doctor", missing: "look at its cable and power", faulted: "reset; mmmd servo get shows why",
  quarantined: "silent for long: cable, power, id; mmmd scan",
};
const LOST_S = 1.5;
const SEEN = 0.004; // radians or metres of change that can be seen
const view = { state: null, robot: null, seenS: 0, history: new History(), joint: 0, run: null, frames: 0, passed: [], drawn: null };
globalThis.mmmd = view; // for tests and for the curious

// ---- halts: first of all, and by two ways at once, so that one broken connection does not keep a stop
const ctl = new Line("ctl", heardCtl);
function halt(verb, pressedMs) {
  const id = newId(), request = { ...stamp(), type: verb, id }, body = JSON.stringify(request);
  view.halt = { id, verb, pressedMs, ackMs: null, done: false };
  const again = () => { if (view.halt?.id === id && !view.halt.ackMs) get.post("/v1/ctl", body).then(heardCtl).catch(() => { $("halted").textContent = `${verb} NOT SENT. Use the power switch`; }); };
  const sent = ctl.send(request);
  $("halted").textContent = `${verb} sent`;
  if (sent) setTimeout(again, 250); else again();
  setTimeout(() => { if (view.halt?.id === id && !view.halt.ackMs) $("halted").textContent = `${verb}: NO ANSWER. Use the power switch`; }, 1000);
}
function heardCtl(event) {
  const last = view.halt;
  if (view.asked && event.id === view.asked.id) return heardVerb(event);
  if (!last || event.id !== last.id) { if (event.found) answer(`${event.asked}: ${event.found}; ${event.do}`, "bad"); return; }
  const done = event.type === "carried_out" || (event.type === "ack" && event.carried_out !== false);
  if (last.done || (last.ackMs && !done)) return; // both ways answer, and not in order
  last.ackMs ??= performance.now();
  last.done = done;
  $("halted").textContent = `${last.verb} ${done ? "carried out" : event.type === "ack" ? "asked for, not carried out yet" : `${event.found}; ${event.do}`}`;
  if (done) setTimeout(() => { if (view.halt === last) $("halted").textContent = ""; }, 4000);
}
for (const verb of ["stop", "estop"]) $(verb).addEventListener("pointerdown", (e) => { e.preventDefault(); halt(verb, e.timeStamp); });
for (const verb of ["stop", "estop"]) $(verb).addEventListener("click", (e) => { if (e.detail === 0) halt(verb, e.timeStamp); }); // by keyboard or a screen reader
const typing = (target) => target.matches?.("input:not([type=range]):not([type=checkbox]), textarea");
addEventListener("keydown", (e) => {
  if (view.run || e.repeat || !(e.key === "Escape" || (e.key === " " && !typing(e.target)))) return;
  e.preventDefault(); halt("stop", e.timeStamp);
}, true);
addEventListener("keyup", (e) => { if (e.key === " " && !typing(e.target)) e.preventDefault(); }, true); // a focused button is not pressed

// ---- the 3D view, after the first paint: without a GPU a browser needs a second to compile its shaders
let scene = null;
if (!document.hidden) await new Promise((painted) => { requestAnimationFrame(() => setTimeout(painted)); });
try { scene = new Scene($("scene")); } catch (error) { $("legend").textContent = `No 3D view: ${error.message}. All else works.`; }
view.scene = scene;

// ---- requests: what sets motion going names the state that was on the screen. Held up on its way for 3 s, it is refused by the daemon.
const unseen = (name) => answer(`${name}: not sent; the robot's state has not been seen yet: wait until the page shows it`, "bad");
const MOVES = ["say", "gesture", "look", "idle"];
const cmd = new Line("cmd", heardCmd, (open) => { if (open) cmd.send({ type: "capabilities", id: newId() }); });
let lastId = "";
function options() {
  const o = {};
  for (const key of ["tempo", "amplitude"]) if (+$(key).value !== 1) o[key] = +$(key).value;
  for (const key of ["mirror", "loop", "hold"]) if ($(key).checked) o[key] = true;
  if ($("after").checked) o.when = "after";
  return o;
}
function ask(request) {
  const id = newId(), moves = MOVES.includes(request.type) && request.on !== false;
  view.asked = null; // the answer that is shown belongs to the last press
  if (moves && !view.state && request.type !== "say") return unseen(request.type);
  if (["say", "gesture"].includes(request.type)) lastId = id;
  const shown = moves ? { state_t_mono: view.state?.t_mono ?? 0 } : {}; // 0 is before any daemon: only a text that means stop counts then
  if (!cmd.send({ id, ...shown, ...request })) answer("no connection to the server", "bad");
}
function answer(text, kind = "") { $("answer").textContent = text; $("answer").className = kind; $("answer").scrollTop = 0; }
function heardCmd(event) {
  if (event.type === "capabilities") return capable(event);
  if (event.found) return answer(`${event.asked}: ${event.found}; ${event.do}`, "bad");
  if (event.type === "ack") return answer(`${event.verb}${event.note ? `: ${event.note}` : ""}`);
  if (event.id !== lastId) return;
  if (event.type === "cancelled") return answer(`ended by ${event.by}`);
  if (event.type === "accepted") answer(`understood: ${event.understood}${event.reason ? ` (${event.reason})` : ""}${event.lacks ? `; this robot lacks: ${event.lacks}` : ""}`, event.status === "degraded" || event.lacks ? "warn" : "");
  if (event.type === "done" && event.shown) answer(`done: ${event.shown}: ${event.missing ? `its motion ${event.seen}; on the robot: ${event.missing}` : event.seen}`, event.missing ? "warn" : "");
}

const said = JSON.parse(localStorage.getItem("said") || "[]");
let back = -1;
$("examples").append(...EXAMPLES.map((text) => Object.assign(document.createElement("option"), { value: text })));
$("say").addEventListener("submit", (e) => {
  e.preventDefault();
  const text = $("text").value.trim() || $("text").placeholder;
  said.unshift(text); said.splice(50); back = -1;
  localStorage.setItem("said", JSON.stringify(said));
  answer("…"); ask({ type: "say", text, ...options() });
  $("text").value = ""; $("text").blur(); // so that the space bar stops
});
$("text").addEventListener("keydown", (e) => {
  if (e.key !== "ArrowUp" && e.key !== "ArrowDown") return;
  e.preventDefault();
  back = Math.max(-1, Math.min(said.length - 1, back + (e.key === "ArrowUp" ? 1 : -1)));
  $("text").value = back < 0 ? "" : said[back];
});

// ---- verbs: by POST where the connection is not open. Never twice: an arm that arrives late could undo what was pressed after it.
// Each names the state that was on the screen: held up on its way for 3 s, it is refused by the daemon. A stop names none.
const DONE = { arm: /idle|holding|moving/, park: /limp/, torque: /limp/, reset: /limp|arming|idle|holding|moving/ };
const PATIENCE_MS = 3000;
$("verbs").addEventListener("click", (e) => {
  const verb = e.target.dataset?.verb, name = e.target.textContent;
  if (!verb) return;
  if (!view.state) return unseen(name);
  const request = { ...stamp(), type: verb, id: newId(), state_t_mono: view.state.t_mono, ...(verb === "torque" ? { on: false } : {}) };
  const asked = view.asked = { id: request.id, verb, name, ackS: null, from: "" };
  const silent = () => { if (view.asked === asked && asked.ackS === null) answer(`${name}: NO ANSWER; not carried out if it arrives later than 3 s after the press. Look at the robot's state before you press again`, "bad"); };
  answer(`${name}: sent`);
  if (ctl.send(request)) { setTimeout(silent, PATIENCE_MS); return; }
  answer(`${name}: the connection is lost; sent by another way`, "warn");
  get.post("/v1/ctl", JSON.stringify(request), AbortSignal.timeout(PATIENCE_MS)).then(heardCtl).catch(silent);
});
function heardVerb(event) {
  const asked = view.asked;
  if (event.found) { view.asked = null; return answer(`${asked.name}: ${event.found}; ${event.do}`, "bad"); }
  Object.assign(asked, { ackS: event.t_mono, from: event.state });
  answer(`${asked.name}: accepted`);
}
// What became of a verb that was accepted: told by the states after its answer.
function outcome(s) {
  const asked = view.asked;
  if (!asked || asked.ackS === null || s.t_mono <= asked.ackS) return;
  const done = DONE[asked.verb].test(s.state), off = !done && s.state !== asked.from && ["limp", "fault", "estop"].includes(s.state);
  asked.from = s.state;
  if (!done && !off) return;
  view.asked = null;
  answer(`${asked.name}: ${done ? "carried out" : "broken off"}, the robot is ${s.state}${off && s.reason ? `: ${s.reason}` : ""}`, off ? "bad" : "");
}
$("cancel").addEventListener("click", () => ask({ type: "cancel" }));
$("record").addEventListener("submit", (e) => { e.preventDefault(); if ($("name").value) ask({ type: "record", name: $("name").value }); });
for (const key of ["yaw", "pitch"]) $(key).addEventListener("change", () => ask({ type: "look", yaw_deg: +$("yaw").value, pitch_deg: +$("pitch").value }));
$("free").addEventListener("click", () => { ask({ type: "look" }); for (const key of ["yaw", "pitch"]) { $(key).value = 0; $(key).dispatchEvent(new Event("input")); } });
$("idle").addEventListener("change", () => ask($("idle").value === "off" ? { type: "idle", on: false } : { type: "idle", on: true, style: $("idle").value }));
for (const range of document.querySelectorAll("input[type=range]")) range.addEventListener("input", () => { if (range.nextElementSibling?.matches("output")) range.nextElementSibling.value = range.value; });

function capable(event) {
  view.capable = event;
  const buttons = event.gestures.map((g) => {
    const b = Object.assign(document.createElement("button"), { textContent: g.name.replaceAll("_", " "), title: `${g.text}, ${g.seconds.toFixed(1)} s`, type: "button" });
    b.addEventListener("click", () => { answer("…"); ask({ type: "gesture", name: g.name, ...options() }); });
    return b;
  });
  $("gestures").replaceChildren(...buttons);
}
$("filter").addEventListener("input", () => { for (const b of $("gestures").children) b.hidden = !`${b.textContent} ${b.title}`.includes($("filter").value.toLowerCase()); });

// ---- what is published
new Line("pub", heardPub, (open) => { if (!open) lost("The page has lost its server. It tries again by itself; a STOP does not get through."); });
function heardPub(event) {
  if (event.type === "state") heardState(event);
  else if (event.type === "health") heardHealth(event);
  else listed(event);
}
function lost(why) { $("lost").textContent = why; $("lost").hidden = !why; document.body.classList.toggle("lost", !!why); }
function heardState(s) {
  view.seenS = performance.now() / 1000;
  if (!view.state || view.state.robot !== s.robot) meet(s.robot);
  if (view.state?.state !== s.state) { view.passed.push(s.state); view.passed.splice(0, view.passed.length - 50); listed({ type: "state", now: s.state, reason: s.reason }); }
  const again = view.state && s.uptime_s < view.state.uptime_s;
  view.state = s;
  if (again) cmd.send({ type: "capabilities", id: newId() });
  view.history.add(s.t_mono, { goal: s.goal_rad, present: s.present_rad, effort: s.effort });
  if (!$("lost").hidden) { lost(""); if (!view.capable) cmd.send({ type: "capabilities", id: newId() }); }
  if (scene && changed(s)) { scene.dirty = true; scene.arrived++; }
  head(s); outcome(s);
}
// Whether a drawing of this state would look different from the one on the screen: a robot at rest is not drawn again.
function changed(s) {
  const d = view.drawn, other = (key) => s[key]?.length !== d[key]?.length || s[key]?.some((v, k) => Math.abs(v - d[key][k]) > SEEN);
  return !d || ["present_rad", "goal_rad", "person_m", "person_faces"].some(other);
}
function head(s) {
  const sim = s.bus.startsWith("sim:");
  set("robot", s.robot); set("kind", sim ? "SIMULATOR" : `HARDWARE ${s.bus.replace("dxl://", "").split("?")[0]}`, `badge ${sim ? "sim" : "hardware"}`);
  set("state", s.state, `badge ${["fault", "estop"].includes(s.state) ? "bad" : ["idle", "moving"].includes(s.state) ? "good" : ""}`);
  const generator = s.generator.startsWith("ready") ? "" : `; generator ${s.generator}: gestures work`;
  const torque = !["fault", "estop"].includes(s.state) ? "" : s.torque === false ? "without torque; " : s.torque ? "TORQUE ON: keep your hands out; " : "";
  set("needs", torque + (s.reason || (s.must_arm && s.state === "limp" ? "torque is off; press arm" : NEEDS[s.state])) + generator + (s.recording ? `; recording ${s.recording}` : ""));
  if ($("needs").title !== $("needs").textContent) $("needs").title = $("needs").textContent;
  document.querySelector("[data-verb=reset]").classList.toggle("pale", !["fault", "estop"].includes(s.state)); // not disabled: a state may come late
  if (document.activeElement !== $("idle") && $("idle").value !== s.idle) $("idle").value = s.idle;
}
function set(id, text, kind) {
  if ($(id).textContent !== text) $(id).textContent = text;
  if (kind !== undefined && $(id).className !== kind) $(id).className = kind;
}
function queue(s) {
  const c = s.command, part = (id, from, to) => { $(id).style.left = `${100 * from}%`; $(id).style.width = `${100 * (to - from)}%`; };
  $("queue").hidden = false;
  if (!c) { for (const id of ["played", "committed", "open"]) part(id, 0, 0); set("running", s.waiting.length ? `${s.waiting.length} wait` : "nothing is played"); return; }
  const rate = view.capable?.rate_hz || 100, all = Math.max(c.frames, 1), pushed = c.frames_pushed, played = Math.max(0, pushed - s.queued_ms * rate / 1000);
  part("played", 0, played / all); part("committed", played / all, pushed / all); part("open", pushed / all, 1);
  set("running", `${(played / rate).toFixed(1)} of ${(all / rate).toFixed(1)} s${s.waiting.length ? `, ${s.waiting.length} wait` : ""}: “${c.text}”`);
  if ($("running").title !== c.text) $("running").title = c.text;
}
function heardHealth(h) {
  const rows = h.servos.map((s) => {
    const hot = s.temperature_c >= 60, row = document.createElement("tr"), bad = s.state !== "ok" || hot;
    const cells = [s.id, s.joint, s.state, s.temperature_c === null ? "–" : `${s.temperature_c} °C`, `${s.effort.toFixed(0)} ${s.effort_unit}`, bad ? REMEDY[s.state] || "hot: let it rest" : ""];
    row.append(...cells.map((text) => Object.assign(document.createElement("td"), { textContent: text })));
    if (bad) row.className = "bad";
    return row;
  });
  const first = document.createElement("tr");
  first.append(...["id", "joint", "state", "temperature", "effort", "do"].map((text) => Object.assign(document.createElement("th"), { textContent: text })));
  $("servos").replaceChildren(first, ...rows);
  const bad = h.servos.filter((s) => s.state !== "ok").length;
  set("well", bad ? `(${bad} not well)` : `(${h.servos.length} well)`);
  view.health = h;
}
function listed(event) {
  const { type, id, v, seq, t_mono, ...rest } = event, item = document.createElement("li");
  item.textContent = `${new Date().toLocaleTimeString()} ${type === "log" ? `${rest.level} ${rest.process}: ${rest.text}` : `${type} ${Object.entries(rest).filter(([, x]) => x !== null && x !== "" && !(Array.isArray(x) && !x.length)).map(([k, x]) => `${k} ${typeof x === "number" ? +x.toFixed(3) : JSON.stringify(x)}`).join(", ")}`}`;
  $("events").prepend(item);
  while ($("events").children.length > 100) $("events").lastChild.remove();
}

// ---- drawing: only when something has changed, 30 times a second at most; plots and time line 5 times
async function meet(name) {
  const reply = await get(`/v1/robot/${encodeURIComponent(name)}`);
  if (!reply.ok) { $("legend").textContent = (await reply.json()).found; return; }
  view.robot = new Robot(await reply.arrayBuffer());
  $("joint").replaceChildren(...view.robot.joints.map((j, k) => Object.assign(document.createElement("option"), { value: k, textContent: j.name })));
  scene?.show(view.robot);
  const swatch = (side) => `rgb(${view.robot.person.colours[side].map((c) => Math.round(255 * c))})`;
  [...$("legend").querySelectorAll("b")].forEach((b, k) => { b.style.color = swatch(["left", "right"][k]); });
}
$("joint").addEventListener("change", () => { view.joint = +$("joint").value; });
function shown() {
  if (view.run) return view.run.frame();
  const s = view.state;
  return s && { q: s.present_rad, goal: s.goal_rad, person: s.person_m?.length === 66 ? s.person_m : null, faces: s.person_faces };
}
function paint() {
  const now = shown();
  if (!scene?.dirty || !now || !view.robot || document.hidden) return;
  scene.draw(now.q, now.goal, now.person, now.faces);
  view.drawn = view.state; view.frames++;
}
function plots() {
  if (document.hidden || !view.robot) return;
  const j = view.joint, joint = view.robot.joints[j], rows = view.run ? view.run.rows() : view.history.rows;
  const end = view.run ? view.run.plotEnd() : rows[rows.length - 1]?.t ?? 0;
  const goal = { name: "goal", colour: "#2471a3", of: (r) => degrees(r.goal[j]) }, measured = { name: "measured", colour: "#c0392b", of: (r) => degrees(r.present[j]) };
  plot($("plot-angle"), { title: "angle", unit: "degrees", rows, series: [goal, measured], limits: [degrees(joint.min_rad), degrees(joint.max_rad)], end });
  const speeds = rows.slice(1).map((r, k) => ({ t: r.t, v: degrees((r.present[j] - rows[k].present[j]) / (r.t - rows[k].t)) }));
  const limit = degrees(joint.velocity_rad_s);
  plot($("plot-speed"), { title: "velocity", unit: "degrees/s", rows: speeds, series: [{ name: `limit ${limit.toFixed(0)}`, colour: "#8d6e63", of: () => NaN }, { name: "measured", colour: "#c0392b", of: (r) => r.v }], limits: [limit, -limit], end });
  const servo = view.health?.servos.findIndex((s) => s.joint.split("+").includes(joint.name)) ?? -1;
  if (!view.run && servo >= 0) {
    const { effort_unit: unit, temperature_c: hot } = view.health.servos[servo];
    plot($("plot-effort"), { title: unit === "mA" ? "current" : "load", unit, rows, series: [{ name: hot === null ? "" : `${hot} °C`, colour: "#b35c00", of: (r) => r.effort[servo] }], end });
  }
}
Object.assign(view, { heard: heardPub, paint, plots, cmd, ctl }); // a test plays an hour of messages in a minute
setInterval(paint, 33);
setInterval(() => { if (view.state) queue(view.state); plots(); }, 200);
setInterval(() => {
  if (!view.run && performance.now() / 1000 - view.seenS > LOST_S && $("lost").hidden) {
    lost("The daemon does not answer: nothing here is of now, and the robot may still move. Look at the terminal of `mmmd run`; the page goes on when the daemon is back.");
    set("state", "unknown", "badge bad");
  }
}, 250);

// ---- a recorded run
const recorded = await get("/v1/run");
if (recorded.status === 200) {
  document.body.classList.add("recorded");
  lost("");
  view.run = scrubber(await recorded.arrayBuffer(), () => { if (scene) scene.dirty = true; });
  set("robot", view.run.head.robot); set("kind", "RECORDED", "badge"); set("state", view.run.head.file, "badge"); set("needs", "nothing here moves a robot");
  $("scrub").hidden = false;
  await meet(view.run.head.robot);
}
