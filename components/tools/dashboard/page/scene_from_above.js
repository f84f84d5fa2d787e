// The scene from above on a 2D canvas: for browsers without WebGL, and for those who prefer it.
import { polyline, prepare } from "./canvas.js";
import { colourOf, torqueColour } from "./colours.js";

const arrow_m_per_n = 0.02; // length of the arrow of a contact force

function disc(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

/** A thing on the ground: {pose: [x, y, yaw, ...], size_m, box}. */
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
  const { module_length_m: length, module_radius_m: radius } = state.scene;
  state.world.modules.forEach(([x, y, yaw], i) => {
    context.save();
    context.translate(x, y);
    context.rotate(yaw);
    context.fillStyle = `rgb(${torqueColour(state.torque_nm?.[i])})`;
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
  for (const [x, y, , fx, fy] of state.contacts ?? []) {
    polyline(context, [[x, y], [x + fx * arrow_m_per_n, y + fy * arrow_m_per_n]]);
    context.stroke();
  }
}

/** The robot's estimated pose and map, over the true ones. */
function drawEstimate(context, state) {
  if (!state.start) return;
  const [x0, y0, yaw0] = state.start;
  context.save();
  context.translate(x0, y0);
  context.rotate(yaw0);
  context.fillStyle = "#303030";
  context.setLineDash([0.05, 0.05]);
  context.lineWidth = 0.02;
  if (state.map) {
    // Points in the order of discovery: neighbours in the list may lie far apart.
    for (const [x, y] of state.map.line) context.fillRect(x - 0.013, y - 0.013, 0.026, 0.026);
    for (const object of state.map.objects) {
      if (object.x_m === null) continue;
      context.strokeStyle = colourOf(object.colour);
      disc(context, object.x_m, object.y_m, object.radius_m ?? 0.05);
      context.stroke();
    }
    context.fillStyle = "#b04090";
    for (const [x, y] of state.map.obstacles) context.fillRect(x - 0.02, y - 0.02, 0.04, 0.04);
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

/** Draws states on a canvas. The wheel and two fingers zoom, dragging moves; `changed` is called after each of them. */
export class SceneFromAbove {
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.scale = 130; // [pixels/m]
    this.centre = [0, 0]; // [m] in W
    this.moved = false; // by dragging, since the robot was followed last
    this.pointers = new Map();
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * 0.001));
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
    });
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
  }

  zoom(factor) {
    this.scale = Math.min(800, Math.max(10, this.scale * factor));
    this.changed();
  }

  drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const others = [...this.pointers.values()].filter((other) => other.pointerId !== event.pointerId);
    if (others.length === 1) {
      const distance = (a) => Math.hypot(a.clientX - others[0].clientX, a.clientY - others[0].clientY);
      this.zoom(distance(event) / Math.max(1, distance(before)));
    } else if (others.length === 0) {
      this.centre[0] -= (event.clientX - before.clientX) / this.scale;
      this.centre[1] += (event.clientY - before.clientY) / this.scale;
      this.moved = true;
    }
    this.pointers.set(event.pointerId, event);
    this.changed();
  }

  draw(state, { follow, estimate }) {
    const { context, width, height } = prepare(this.canvas);
    const modules = state.world?.modules ?? [];
    if (!state.scene) return;
    if (follow && modules.length > 0)
      this.centre = [0, 1].map((axis) => modules.reduce((sum, pose) => sum + pose[axis], 0) / modules.length);
    context.save();
    context.translate(width / 2, height / 2);
    context.scale(this.scale, -this.scale);
    context.translate(-this.centre[0], -this.centre[1]);
    context.lineCap = "round";
    context.globalAlpha = 0.25;
    for (const zone of state.scene.zones) {
      context.fillStyle = colourOf(zone.colour);
      disc(context, zone.x_m, zone.y_m, zone.radius_m);
      context.fill();
    }
    context.globalAlpha = 1;
    context.strokeStyle = colourOf(state.scene.line_colour);
    context.lineWidth = state.scene.line_width_m;
    polyline(context, state.scene.line);
    context.stroke();
    context.fillStyle = "#777";
    for (const obstacle of state.scene.obstacles) footprint(context, obstacle);
    for (const object of state.world?.objects ?? []) {
      context.fillStyle = colourOf(object.colour);
      footprint(context, object);
    }
    if (state.world) drawRobot(context, state);
    if (estimate) drawEstimate(context, state);
    context.restore();
    drawScale(context, height, this.scale);
  }
}
