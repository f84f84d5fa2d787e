// Colours of the page: those of Okabe and Ito, which colour-blind readers can distinguish.

const named = { green: "#009e73", red: "#c1341b", blue: "#0072b2", yellow: "#e69f00" };
const fullTorque = 5; // [Nm] shown in the strongest colour
const still = [150, 150, 150];
const negative = [0, 114, 178];
const positive = [213, 94, 0];

const canvas = typeof document === "undefined" ? new OffscreenCanvas(1, 1) : document.createElement("canvas");
const probe = canvas.getContext("2d"); // a worker has no CSS.supports

function isColour(name) {
  probe.fillStyle = "#010203";
  probe.fillStyle = name;
  return probe.fillStyle !== "#010203";
}

/** The colour of a line, an object or a zone, by its name in the messages. A name that is new has the meaning that it
 *  has in style sheets. */
export const colourOf = (name) => named[name] ?? (isColour(name) ? name : "#888888");

/** [red, green, blue], each 0 to 255: grey without torque, blue for negative and orange for positive torque [Nm]. */
export function torqueColour(torque) {
  const share = Math.max(-1, Math.min(1, (torque ?? 0) / fullTorque));
  const full = share < 0 ? negative : positive;
  return still.map((part, i) => Math.round(part + Math.abs(share) * (full[i] - part)));
}
