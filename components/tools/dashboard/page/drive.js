// Drives the robot by a pad on the screen or by the arrow keys. The robot moves only while the pad or a key is held:
// letting go, leaving the window or losing the connection makes it stand.

const repeat_ms = 150; // the dashboard ends a drive that is not repeated within 500 ms
const idle = 0.12; // share of the pad around its middle that means 0
const fastest_turn_rad_s = 1.0;
const steps = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] }; // forwards, left

const element = (id) => document.getElementById(id);
const rounded = (value, step) => Math.round(value / step) * step;

export class Drive {
  /** `say(text, bad)` shows an answer. `stop()` is the emergency stop. */
  constructor(connection, say, stop) {
    this.connection = connection;
    this.say = say;
    this.stop = stop;
    this.wish = null; // [forwards, left], each -1 to 1; null: nothing is held
    this.refused = false; // until everything is let go
    this.waiting = false; // for an answer
    this.keys = new Set();
    this.pointer = null;
    this.pad = element("pad");
    this.pad.addEventListener("pointerdown", (event) => {
      this.pad.setPointerCapture(event.pointerId);
      this.pointer = event.pointerId;
      this.aim(event);
    });
    this.pad.addEventListener("pointermove", (event) => event.pointerId === this.pointer && this.aim(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"])
      this.pad.addEventListener(name, () => this.letGo());
    this.pad.addEventListener("contextmenu", (event) => event.preventDefault()); // of a long touch
    addEventListener("keydown", (event) => this.key(event, true));
    addEventListener("keyup", (event) => this.key(event, false));
    addEventListener("blur", () => this.letGo());
    document.addEventListener("visibilitychange", () => document.hidden && this.letGo());
    element("keys").addEventListener("change", () => this.letGo());
    setInterval(() => this.send(), repeat_ms);
  }

  aim(event) {
    const { x, y, width, height } = this.pad.getBoundingClientRect();
    const share = (at, size) => {
      const value = Math.max(-1, Math.min(1, 1 - (2 * at) / size));
      return Math.abs(value) < idle ? 0 : value;
    };
    this.hold([share(event.clientY - y, height), share(event.clientX - x, width)]);
  }

  key(event, down) {
    if (!element("keys").checked || event.target.closest?.("input[type=text], input[type=number], select")) return;
    if (event.code === "Space" && down) {
      event.preventDefault();
      return this.stop();
    }
    if (!(event.key in steps)) return;
    event.preventDefault();
    if (down === this.keys.has(event.key)) return; // the repetition of a held key
    if (down) this.keys.add(event.key);
    else this.keys.delete(event.key);
    if (this.keys.size === 0) return this.letGo();
    const wish = [0, 0];
    for (const key of this.keys) steps[key].forEach((step, axis) => (wish[axis] += step));
    this.hold(wish);
  }

  hold(wish) {
    this.wish = wish;
    this.show();
    this.send();
  }

  letGo() {
    this.keys.clear();
    this.pointer = null;
    this.refused = false;
    if (!this.wish) return;
    this.wish = null;
    this.show();
    if (this.connection.has("drive"))
      this.connection.call("drive", { speed_m_s: 0, turn_rad_s: 0 }).then(
        (text) => this.say(`drive: ${text}`, false), (error) => this.say(error.message, true));
  }

  show() {
    const [forwards, left] = this.wish ?? [0, 0];
    element("knob").style.left = `${50 - 50 * left}%`;
    element("knob").style.top = `${50 - 50 * forwards}%`;
    this.pad.classList.toggle("held", this.wish !== null);
  }

  async send() {
    if (!this.wish || this.refused || this.waiting) return;
    const [forwards, left] = this.wish;
    const speed_m_s = rounded(forwards * Number(element("speed").value), 0.05);
    const turn_rad_s = rounded(left * fastest_turn_rad_s, 0.1);
    if (speed_m_s === 0 && turn_rad_s === 0 && this.still) return;
    this.still = speed_m_s === 0 && turn_rad_s === 0; // held in the middle of the pad: to be sent once
    this.waiting = true;
    try {
      const text = await this.connection.call("drive", { speed_m_s, turn_rad_s });
      if (this.wish) this.say(`drive: ${text}`, false);
    } catch (error) {
      this.refused = this.wish !== null;
      this.say(error.message, true);
    }
    this.waiting = false;
  }
}
