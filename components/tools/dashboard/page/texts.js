// The parts of the page that are text. All texts of the run become text nodes: nothing of it is read as HTML.

const element = (id) => document.getElementById(id);

/** Writing the same text again would make the browser lay the page out again. */
function write(node, text, kind = "") {
  if (node.textContent !== text) node.textContent = text;
  if (node.className !== kind) node.className = kind;
}

/** Makes as many children as there are items, and fills each. */
export function rows(parent, items, fill) {
  while (parent.children.length > items.length) parent.lastChild.remove();
  while (parent.children.length < items.length)
    parent.append(document.createElement(parent.tagName === "TBODY" ? "tr" : "li"));
  items.forEach((item, i) => fill(parent.children[i], item));
}

function runText({ scene, world, run, stopped, replay }) {
  const parts = [];
  if (scene) parts.push(`${scene.scenario}, seed ${scene.seed}`);
  if (world) parts.push(`${world.time_s.toFixed(1)} s`);
  if (replay) parts.push("a recording");
  else if (run) parts.push(run.paused ? "paused" : `${(run.real_time_factor ?? 0).toFixed(1)} times real time`);
  if (stopped) parts.push("EMERGENCY STOP");
  return parts.join(" · ");
}

function missionText(mission) {
  if (!mission) return "no mission";
  const next = mission.object < mission.objects ? `now ${mission.colour}, ` : "";
  const objects = mission.objects > 0 // a mission along the line only has none
    ? `${mission.delivered} of ${mission.objects} objects delivered, ${next}`
    : "";
  return `${mission.outcome}: ${objects}${mission.recoveries} recoveries ${mission.reason}`;
}

function showProcess(row, process) {
  const step = process.step_p99_us === null ? "" : `${(process.step_p99_us / 1000).toFixed(1)} ms`;
  const again = process.incarnation > 1 ? ` (started ${process.incarnation} times)` : "";
  const cells = [process.component, process.state + again, process.tick, step, process.refused];
  while (row.children.length < cells.length) row.append(document.createElement("td"));
  cells.forEach((cell, i) => write(row.children[i], String(cell)));
  const title = `pid ${process.pid} on ${process.host}; ${process.last_refusal}`;
  if (row.title !== title) row.title = title;
}

export function showTexts(state) {
  write(element("run"), runText(state), state.stopped ? "bad" : "");
  write(element("mission"), missionText(state.mission));
  const { task, authority } = state;
  write(element("task"), task ? `task ${task.task}: ${task.goal} ${task.phase} ${task.reason}` : "");
  write(element("authority"), authority?.source ? `authority: ${authority.source}` : "no source has authority");
  rows(element("events"), state.events.slice().reverse(), (item, event) =>
    write(item, `${event.time_s.toFixed(1)} s  ${event.text}`, event.trouble ? "bad" : ""));
  rows(element("processes"), state.processes, showProcess);
}
