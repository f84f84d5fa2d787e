// The page of the dashboard: a client of the Foxglove WebSocket protocol that shows a run and commands it.
import { readImage } from "./cdr.js";
import { drawHistory, drawScene, drawTorques } from "./draw.js";

const element = (id) => document.getElementById(id);
const commands = ["stop", "clear_stop", "release", "pause", "resume", "step", "pace"];
const wanted = { "view/state": 1, "view/camera": 2, "view/processed": 3 };

let socket = null;
let services = {}; // id by name
let calls = new Map(); // name by number
let callNumber = 0;
let state = null;
let received = 0; // time of the last state
let names = []; // states of the mission, in the order in which they appeared
let history = []; // {time, torque}
let dirty = false;
const camera = { scale: 130, x: 0, y: 0 };

function setConnection(text, kind) {
  element("connection").textContent = text;
  element("connection").className = "badge " + kind;
  const on = kind === "good";
  for (const name of commands) element(name).disabled = !on || !(name in services);
}

function say(text, bad) {
  element("answer").textContent = text;
  element("answer").className = bad ? "bad" : "";
}

function connect() {
  services = {};
  setConnection("connecting", "");
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  socket = new WebSocket(`${scheme}//${location.host}/`, ["foxglove.sdk.v1"]);
  socket.binaryType = "arraybuffer";
  socket.onmessage = (message) => {
    if (typeof message.data === "string") onText(JSON.parse(message.data));
    else onFrame(new DataView(message.data));
  };
  socket.onclose = () => {
    setConnection("not connected; trying again", "bad");
    for (const name of calls.values()) say(`${name}: the connection was lost before the answer`, true);
    calls.clear();
    setTimeout(connect, 1000);
  };
}

function onText(message) {
  if (message.op === "advertise") {
    const list = message.channels
      .filter((channel) => channel.topic in wanted)
      .map((channel) => ({ id: wanted[channel.topic], channelId: channel.id }));
    if (list.length > 0) socket.send(JSON.stringify({ op: "subscribe", subscriptions: list }));
  } else if (message.op === "advertiseServices") {
    for (const service of message.services) services[service.name] = service.id;
    setConnection("connected", "good");
  } else if (message.op === "serverInfo") {
    setConnection("connected", "good");
  } else if (message.op === "serviceCallFailure") {
    calls.delete(message.callId);
    say(message.message, true);
  } else if (message.op === "status" && message.level > 0) {
    say(message.message, true);
  }
}

function onFrame(view) {
  const kind = view.getUint8(0);
  if (kind === 3) {
    const call = view.getUint32(5, true);
    const from = 13 + view.getUint32(9, true);
    const answer = JSON.parse(new TextDecoder().decode(new Uint8Array(view.buffer, from)));
    say(`${calls.get(call) ?? ""}: ${answer.text}`, false);
    calls.delete(call);
  }
  if (kind !== 1) return;
  const subscription = view.getUint32(1, true);
  if (subscription === wanted["view/state"]) {
    state = JSON.parse(new TextDecoder().decode(new Uint8Array(view.buffer, 13)));
    received = performance.now();
    noteState();
    dirty = true;
  } else {
    drawImage(subscription === wanted["view/camera"] ? "camera" : "processed", readImage(view, 13));
  }
}

function noteState() {
  const present = state.mission?.state;
  if (present && !names.includes(present)) names.push(present);
  const time = state.world?.time_s;
  if (time === undefined || !state.torque_nm) return;
  const newest = history.at(-1);
  if (newest && time < newest.time) history = []; // a new epoch
  if (newest && time - newest.time < 0.05) return;
  history.push({ time, torque: Math.max(...state.torque_nm.map((torque) => Math.abs(torque ?? 0))) });
  while (history.length > 0 && history[0].time < time - 60) history.shift();
}

function drawImage(id, { width, height, rgb }) {
  const canvas = element(id);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height);
  for (let i = 0, k = 0; i < rgb.length; i += 3, k += 4) {
    image.data[k] = rgb[i];
    image.data[k + 1] = rgb[i + 1];
    image.data[k + 2] = rgb[i + 2];
    image.data[k + 3] = 255;
  }
  context.putImageData(image, 0, 0);
}

function call(name, request) {
  if (socket.readyState !== WebSocket.OPEN || !(name in services)) return say(`${name}: not connected`, true);
  const body = new TextEncoder().encode(JSON.stringify(request));
  const frame = new DataView(new ArrayBuffer(17 + body.length));
  frame.setUint8(0, 2);
  frame.setUint32(1, services[name], true);
  frame.setUint32(5, ++callNumber, true);
  frame.setUint32(9, 4, true);
  new TextEncoder().encodeInto("json", new Uint8Array(frame.buffer, 13, 4));
  new Uint8Array(frame.buffer, 17).set(body);
  calls.set(callNumber, name);
  say(`${name}: waiting for the answer`, false);
  socket.send(frame.buffer);
}

function rows(parent, items, fill) {
  while (parent.children.length > items.length) parent.lastChild.remove();
  while (parent.children.length < items.length)
    parent.append(document.createElement(parent.tagName === "TBODY" ? "tr" : "li"));
  items.forEach((item, i) => fill(parent.children[i], item));
}

function showTexts() {
  const { run, world, mission, task, authority } = state;
  const parts = [];
  if (state.scene) parts.push(`${state.scene.scenario}, seed ${state.scene.seed}`);
  if (world) parts.push(`${world.time_s.toFixed(1)} s`);
  if (run) parts.push(run.paused ? "paused" : `${(run.real_time_factor ?? 0).toFixed(1)} times real time`);
  if (authority) parts.push(authority.source ? `authority: ${authority.source}` : "nobody has authority");
  if (state.stopped) parts.push("EMERGENCY STOP");
  element("run").textContent = parts.join(" · ");
  element("run").className = state.stopped ? "bad" : "";
  element("mission").textContent = mission
    ? `${mission.outcome}: object ${Math.min(mission.object + 1, mission.objects)} of ${mission.objects}` +
      ` (${mission.colour}), ${mission.recoveries} recoveries ${mission.reason}`
    : "no mission";
  rows(element("states"), names, (item, name) => {
    item.textContent = name;
    item.className = name === mission?.state ? "present" : "";
  });
  element("task").textContent = task ? `task ${task.task}: ${task.goal} ${task.phase} ${task.reason}` : "";
  rows(element("events"), state.events.slice().reverse(), (item, event) => {
    item.textContent = `${event.time_s.toFixed(1)} s  ${event.text}`;
    item.className = event.trouble ? "bad" : "";
  });
  rows(element("processes"), state.processes, (row, process) => {
    const step = process.step_p99_us === null ? "" : `${(process.step_p99_us / 1000).toFixed(1)} ms`;
    const again = process.incarnation > 1 ? ` (started ${process.incarnation} times)` : "";
    const cells = [process.component, process.state + again, process.tick, step, process.refused];
    while (row.children.length < cells.length) row.append(document.createElement("td"));
    cells.forEach((cell, i) => (row.children[i].textContent = cell));
    row.title = `pid ${process.pid} on ${process.host}; ${process.last_refusal}`;
  });
}

function frame() {
  requestAnimationFrame(frame);
  if (state && performance.now() - received > 3000 && socket.readyState === WebSocket.OPEN)
    setConnection("connected, but nothing arrives", "bad");
  else if (dirty && socket.readyState === WebSocket.OPEN) setConnection("connected", "good");
  if (!dirty) return;
  dirty = false;
  drawScene(element("scene"), state, camera, {
    follow: element("follow").checked,
    estimate: element("estimate").checked,
  });
  drawTorques(element("torques"), state.torque_nm ?? []);
  drawHistory(element("history"), history);
  showTexts();
}

for (const name of commands) {
  if (name === "pace") continue;
  element(name).addEventListener("click", () => call(name, name === "step" ? { ticks: 1 } : {}));
}
element("pace").addEventListener("change", (event) => call("pace", { pace: Number(event.target.value) }));
for (const id of ["follow", "estimate"]) element(id).addEventListener("change", () => (dirty = true));

// Zoom and move the scene, with a mouse or with fingers.
const pointers = new Map();
const scene = element("scene");
scene.addEventListener("wheel", (event) => {
  event.preventDefault();
  camera.scale = Math.min(800, Math.max(10, camera.scale * Math.exp(-event.deltaY * 0.001)));
  dirty = true;
}, { passive: false });
scene.addEventListener("pointerdown", (event) => {
  scene.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, event);
});
for (const name of ["pointerup", "pointercancel"])
  scene.addEventListener(name, (event) => pointers.delete(event.pointerId));
scene.addEventListener("pointermove", (event) => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const others = [...pointers.values()].filter((other) => other.pointerId !== event.pointerId);
  if (others.length === 1) {
    const distance = (a) => Math.hypot(a.clientX - others[0].clientX, a.clientY - others[0].clientY);
    camera.scale = Math.min(800, Math.max(10, (camera.scale * distance(event)) / Math.max(1, distance(before))));
  } else if (others.length === 0) {
    camera.x -= (event.clientX - before.clientX) / camera.scale;
    camera.y += (event.clientY - before.clientY) / camera.scale;
    element("follow").checked = false;
  }
  pointers.set(event.pointerId, event);
  dirty = true;
});
addEventListener("resize", () => (dirty = true));

connect();
requestAnimationFrame(frame);
