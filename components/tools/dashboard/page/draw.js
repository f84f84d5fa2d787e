// Drawings of the page on canvases. Colours are those of Okabe and Ito, which colour-blind readers can tell apart.

const colours = { green: "#009e73", red: "#c1341b", blue: "#0072b2", yellow: "#e69f00", unknown: "#888" };
const fullTorque = 5; // [Nm] shown in the strongest colour

/** Fits the canvas's pixels to its size on the screen and returns its context and size. */
function prepare(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "12px system-ui, sans-serif";
  return { context, width, height };
}

function torqueColour(torque) {
  const share = Math.max(-1, Math.min(1, (torque ?? 0) / fullTorque));
  const full = share < 0 ? [0, 114, 178] : [213, 94, 0];
  const mixed = full.map((part) => Math.round(150 + Math.abs(share) * (part - 150)));
  return `rgb(${mixed})`;
}

function polyline(context, points) {
  context.beginPath();
  points.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
}

function disc(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

/** A thing on the ground: {pose: [x, y, yaw], size_m, box}. */
function footprint(context, thing) {
  const [x, y, yaw] = thing.pose;
  if (!thing.box) {
    disc(context, x, y, thing.size_m[0]);
    return context.fill();
  }
  context.save();
  context.translate(x, y);
  context.rotate(yaw);
  context.fillRect(-thing.size_m[0] / 2, -thing.size_m[1] / 2, thing.size_m[0], thing.size_m[1]);
  context.restore();
}

function drawRobot(context, state) {
  const { modules } = state.world;
  const { module_length_m: length, module_radius_m: radius } = state.scene;
  modules.forEach(([x, y, yaw], i) => {
    context.save();
    context.translate(x, y);
    context.rotate(yaw);
    context.fillStyle = torqueColour(state.torque_nm?.[i]);
    context.fillRect(-length / 2, -radius, length * 0.94, 2 * radius);
    if (i === 0) {
      context.fillStyle = "#262626";
      disc(context, length * 0.3, 0, radius * 0.5);
      context.fill();
    }
    context.restore();
  });
  context.strokeStyle = "#cc79a7";
  context.lineWidth = 0.015;
  (state.force_n ?? []).forEach(([fx, fy], i) => {
    if (i >= modules.length || fx === null || fy === null || Math.hypot(fx, fy) < 1) return;
    const [x, y, yaw] = modules[i];
    const dx = (fx * Math.cos(yaw) - fy * Math.sin(yaw)) * 0.02;
    const dy = (fx * Math.sin(yaw) + fy * Math.cos(yaw)) * 0.02;
    polyline(context, [[x, y], [x + dx, y + dy]]);
    context.stroke();
  });
}

/** The pose and the map that the robot believes in, over the truth. */
function drawEstimate(context, state) {
  if (!state.start) return;
  const [x0, y0, yaw0] = state.start;
  context.save();
  context.translate(x0, y0);
  context.rotate(yaw0);
  context.setLineDash([0.05, 0.05]);
  context.strokeStyle = "#555";
  context.lineWidth = 0.02;
  if (state.map) {
    polyline(context, state.map.line);
    context.stroke();
    for (const object of state.map.objects) {
      if (object.x_m === null) continue;
      context.strokeStyle = colours[object.colour] ?? colours.unknown;
      disc(context, object.x_m, object.y_m, object.radius_m ?? 0.05);
      context.stroke();
    }
  }
  context.setLineDash([]);
  if (state.pose && state.pose[0] !== null) {
    const [x, y, yaw] = state.pose;
    context.strokeStyle = "#000";
    disc(context, x, y, 0.06);
    context.stroke();
    polyline(context, [[x, y], [x + 0.15 * Math.cos(yaw), y + 0.15 * Math.sin(yaw)]]);
    context.stroke();
  }
  context.restore();
}

function drawScale(context, height, scale) {
  context.strokeStyle = "#262626";
  context.fillStyle = "#262626";
  context.lineWidth = 2;
  polyline(context, [[12, height - 14], [12 + scale, height - 14]]);
  context.stroke();
  context.fillText("1 m", 12, height - 20);
}

/** The scene from above; `camera` {x, y, scale} is changed if it follows the robot. */
export function drawScene(canvas, state, camera, { follow, estimate }) {
  const { context, width, height } = prepare(canvas);
  const modules = state.world?.modules ?? [];
  if (!state.scene) {
    context.fillText("waiting for the scene (it exists in simulated runs only)", 12, 24);
    return;
  }
  if (follow && modules.length > 0) {
    camera.x = modules.reduce((sum, pose) => sum + pose[0], 0) / modules.length;
    camera.y = modules.reduce((sum, pose) => sum + pose[1], 0) / modules.length;
  }
  context.save();
  context.translate(width / 2, height / 2);
  context.scale(camera.scale, -camera.scale);
  context.translate(-camera.x, -camera.y);
  context.lineCap = "round";
  for (const zone of state.scene.zones) {
    context.globalAlpha = 0.25;
    context.fillStyle = colours[zone.colour] ?? colours.unknown;
    disc(context, zone.x_m, zone.y_m, zone.radius_m);
    context.fill();
  }
  context.globalAlpha = 1;
  context.strokeStyle = colours[state.scene.line_colour] ?? colours.unknown;
  context.lineWidth = state.scene.line_width_m;
  polyline(context, state.scene.line);
  context.stroke();
  context.fillStyle = "#777";
  for (const thing of state.scene.obstacles)
    footprint(context, { pose: [thing.x_m, thing.y_m, 0], size_m: thing.size_m, box: thing.box });
  for (const object of state.world?.objects ?? []) {
    context.fillStyle = colours[object.colour] ?? colours.unknown;
    footprint(context, object);
  }
  if (state.world) drawRobot(context, state);
  if (estimate) drawEstimate(context, state);
  context.restore();
  drawScale(context, height, camera.scale);
}

/** A bar for each joint. */
export function drawTorques(canvas, torques) {
  const { context, width, height } = prepare(canvas);
  const full = Math.max(1, ...torques.map((torque) => Math.abs(torque ?? 0)));
  const step = width / Math.max(1, torques.length);
  torques.forEach((torque, i) => {
    const size = ((torque ?? 0) / full) * (height / 2 - 14);
    context.fillStyle = torqueColour(torque);
    context.fillRect(i * step + 1, height / 2 - Math.max(0, size), Math.max(1, step - 2), Math.abs(size));
  });
  context.strokeStyle = "#aaa";
  polyline(context, [[0, height / 2], [width, height / 2]]);
  context.stroke();
  context.fillStyle = "#555";
  context.fillText(`+${full.toFixed(1)}`, 2, 11);
  context.fillText(`-${full.toFixed(1)}`, 2, height - 3);
}

/** The largest torque over the last minute of simulated time. */
export function drawHistory(canvas, history) {
  const { context, width, height } = prepare(canvas);
  if (history.length < 2) return;
  const end = history.at(-1).time;
  const full = Math.max(1, ...history.map((entry) => entry.torque));
  context.strokeStyle = "#0072b2";
  context.lineWidth = 1.5;
  polyline(context, history.map(({ time, torque }) => [
    width - ((end - time) / 60) * width,
    height - 14 - (torque / full) * (height - 28),
  ]));
  context.stroke();
  context.fillStyle = "#555";
  context.fillText(full.toFixed(1), 2, 11);
  context.fillText("60 s ago", 2, height - 2);
  context.fillText(`${end.toFixed(0)} s`, width - 40, height - 2);
}
