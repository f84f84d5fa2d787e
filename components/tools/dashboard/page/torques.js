// The torques of the joints: bars of the present ones, and their history.
import { polyline, prepare } from "./canvas.js";
import { torqueColour } from "./colours.js";

const span_s = 60; // of simulated time
const step_s = 0.1;
const columns = span_s / step_s;

/** A bar for each joint, from head to tail. */
export function drawTorques(canvas, torques) {
  const { context, width, height } = prepare(canvas);
  const full = Math.max(1, ...torques.map((torque) => Math.abs(torque ?? 0)));
  const step = width / Math.max(1, torques.length);
  torques.forEach((torque, i) => {
    const size = ((torque ?? 0) / full) * (height / 2 - 14);
    context.fillStyle = `rgb(${torqueColour(torque)})`;
    context.fillRect(i * step + 1, height / 2 - Math.max(0, size), Math.max(1, step - 2), Math.abs(size));
  });
  context.strokeStyle = "#aaa";
  polyline(context, [[0, height / 2], [width, height / 2]]);
  context.stroke();
  context.fillStyle = "#555";
  context.fillText(`+${full.toFixed(1)}`, 2, 11);
  context.fillText(`-${full.toFixed(1)}`, 2, height - 3);
}

/** The last minute of simulated time: a row of colours for each joint, and the largest torque as a line. */
export class TorqueHistory {
  constructor(canvas) {
    this.canvas = canvas;
    this.largest = []; // {time, torque}
    this.image = null; // a column for each 0.1 s, a row for each joint; drawn larger
  }

  add(time, torques) {
    const newest = this.largest.at(-1)?.time;
    if (newest !== undefined && (time < newest || time > newest + 10 || this.image?.height !== torques.length)) {
      this.largest = []; // a new epoch, or another place in a recording
      this.image = null;
    } else if (newest !== undefined && time - newest < step_s * 0.99) {
      return;
    }
    if (torques.length === 0) return;
    this.image ??= new ImageData(columns, torques.length);
    const before = this.largest.at(-1)?.time ?? time - step_s;
    const shift = Math.max(1, Math.min(columns, Math.round((time - before) / step_s)));
    this.shift(shift, torques);
    this.largest.push({ time, torque: Math.max(...torques.map((torque) => Math.abs(torque ?? 0))) });
    while (this.largest[0].time < time - span_s) this.largest.shift();
  }

  /** Moves the image to the left and fills the columns that become free. */
  shift(count, torques) {
    const { data } = this.image;
    torques.forEach((torque, row) => {
      const begin = row * columns * 4;
      const end = begin + columns * 4;
      data.copyWithin(begin, begin + count * 4, end);
      const [r, g, b] = torqueColour(torque);
      for (let at = end - count * 4; at < end; at += 4) data.set([r, g, b, 255], at);
    });
  }

  draw() {
    const { context, width, height } = prepare(this.canvas);
    if (!this.image) return;
    this.small ??= document.createElement("canvas");
    Object.assign(this.small, { width: columns, height: this.image.height });
    this.small.getContext("2d").putImageData(this.image, 0, 0);
    const middle = Math.round(height * 0.55);
    context.imageSmoothingEnabled = false;
    context.drawImage(this.small, 0, 0, width, middle - 4);
    const end = this.largest.at(-1).time;
    const full = Math.max(1, ...this.largest.map((entry) => entry.torque));
    context.strokeStyle = "#0072b2";
    context.lineWidth = 1.5;
    polyline(context, this.largest.map(({ time, torque }) => [
      width - ((end - time) / span_s) * width,
      height - 14 - (torque / full) * (height - middle - 18),
    ]));
    context.stroke();
    context.fillStyle = "#555";
    context.fillText(`largest: ${full.toFixed(1)}`, 2, middle + 9);
    context.fillText(`${span_s} s ago`, 2, height - 2);
    context.fillText(`${end.toFixed(0)} s`, width - 40, height - 2);
  }
}
