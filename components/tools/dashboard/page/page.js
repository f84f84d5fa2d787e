// The page of the dashboard: what arrives is shown once in each frame of the screen, and buttons call services.
import { Connection } from "./connection.js";
import { Drive } from "./drive.js";
import { drawImage } from "./images.js";
import { Machine } from "./machine.js";
import { Parameters } from "./parameters.js";
import { Scene } from "./scene.js";
import { buildTasks } from "./tasks.js";
import { showTexts } from "./texts.js";
import { Timeline } from "./timeline.js";
import { drawTorques, TorqueHistory } from "./torques.js";

const element = (id) => document.getElementById(id);
// The service of each button and field. Those that the dashboard does not offer are disabled.
const services = {
  stop: "stop", clear_stop: "clear_stop", take: "take", release: "release",
  pause: "pause", resume: "resume", step: "step", pace: "pace",
  task_start: "task", task_cancel: "stand", parameter_read: "param_list",
};
const plain = ["stop", "clear_stop", "take", "release", "pause", "resume"]; // buttons whose request is empty
const part_ms = 60; // each part of the page beside the scene is shown anew after four times this

let state = null;
let scenes = false; // whether the scene must be drawn
let shown = 0; // time at which a part of the page was shown
let part = 0; // the part that is shown next

const scene = new Scene(() => (scenes = true));
const history = new TorqueHistory(element("history"));
let machine = null;

function say(text, bad) {
  element("answer").textContent = text;
  element("answer").className = bad ? "bad" : "";
}

/** Calls a service, shows its answer or the reason of its refusal, and returns the answer; null: it was refused. */
async function call(name, request) {
  say(`${name}: waiting for the answer`, false);
  try {
    const answer = await connection.call(name, request);
    say(`${name}: ${answer}`, false);
    return answer;
  } catch (error) {
    say(error.message, true);
    return null;
  }
}

function onChange(text, kind) {
  element("connection").textContent = text;
  element("connection").className = "badge " + kind;
  for (const [id, service] of Object.entries(services)) {
    const offered = kind === "good" && connection.has(service);
    element(id).disabled = !offered;
    if (kind === "good") element(id).closest("label, button").hidden = !offered; // a recording obeys fewer of them
  }
  if (kind !== "good") return;
  element("operate").hidden = !connection.has("drive");
  if (element("parameters").open) parameters.read(); // another run may have begun meanwhile
}

function onMessage(topic, view, from) {
  if (topic !== "view/state") return drawImage(element(topic === "view/camera" ? "camera" : "processed"), view, from);
  state = JSON.parse(new TextDecoder().decode(new Uint8Array(view.buffer, from)));
  if (state.world && state.torque_nm) history.add(state.world.time_s, state.torque_nm);
  scenes = true;
}

/** Shows the pace of the run, or the speed of the replay, unless the user is just choosing another one. */
function showPace() {
  const { run, replay } = state;
  const pace = replay ? replay.speed : run ? (run.realtime ? 1 : run.pace) : null;
  const field = element("pace");
  if (pace === null || document.activeElement === field) return;
  const known = [...field.options].find((option) => option.value !== "" && Number(option.value) === pace);
  field.value = known ? known.value : "";
  field.options[0].textContent = `${pace} times`;
}

function showMission(mission) {
  const drawn = !mission || machine?.show(mission.state);
  element("state").textContent = drawn ? "" : `state: ${mission.state}`; // of a planner of the user's own
}

function frame() {
  requestAnimationFrame(frame);
  if (!state) return;
  if (scenes) {
    scenes = false;
    scene.draw(state);
  }
  // One part in a frame: all together would take longer than the time between two frames of the screen.
  if (performance.now() - shown < part_ms) return;
  shown = performance.now();
  parts[part]();
  part = (part + 1) % parts.length;
}

const parts = [
  () => drawTorques(element("torques"), state.torque_nm ?? []),
  () => history.draw(),
  () => showTexts(state),
  () => {
    showMission(state.mission);
    showPace();
    timeline.show(state.replay);
  },
];

const connection = new Connection(["view/state", "view/camera", "view/processed"], {
  message: onMessage,
  change: (text, kind) => onChange(text, kind),
  parameters: (values) => parameters.take(values),
});

for (const name of plain) element(name).addEventListener("click", () => call(name, {}));
element("step").addEventListener("click", () => call("step", { ticks: 1 }));
element("pace").addEventListener("change", (event) => call("pace", { pace: Number(event.target.value) }));
const timeline = new Timeline(connection, call);
new Drive(connection, say, () => call("stop", {}));
const parameters = new Parameters(connection, call);
addEventListener("resize", () => (scenes = true));

/// A file of the dashboard, which may end and come back in the middle of it.
async function load(name) {
  for (;;) {
    try {
      return await (await fetch(name)).json();
    } catch {
      await new Promise((done) => setTimeout(done, 1000)); // the connection says that it is lost
    }
  }
}

const [tasks, states] = await Promise.all([load("tasks.json"), load("machine.json")]);
buildTasks(tasks, call);
machine = new Machine(element("machine"), states);
requestAnimationFrame(frame);
