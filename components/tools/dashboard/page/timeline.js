// The time line of a recording: shows where the replay is, and seeks.

const element = (id) => document.getElementById(id);
const clock = (seconds) =>
  `${Math.floor(seconds / 60)}:${String((seconds % 60).toFixed(1)).padStart(4, "0")}`;

export class Timeline {
  /** `call(service, request)` calls a service and shows its answer. */
  constructor(connection, call) {
    this.connection = connection;
    this.call = call;
    this.held = false; // by the user, whose place must not be overwritten
    this.asked = null; // place of the newest seek [s]
    this.seeking = false;
    this.slider = element("position");
    this.slider.addEventListener("pointerdown", () => (this.held = true));
    for (const name of ["pointerup", "pointercancel", "blur"])
      this.slider.addEventListener(name, () => (this.held = false));
    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    element("play").addEventListener("click", () => call(this.state?.paused || this.state?.ended ? "resume" : "pause", {}));
  }

  /** Asks for one place after the other: a slider that is dragged makes more than a replay can reach. */
  async seek(time_s) {
    this.asked = time_s;
    element("place").textContent = `${clock(time_s)} of ${clock(this.state?.length_s ?? 0)}`;
    if (this.seeking) return;
    this.seeking = true;
    while (this.asked !== null) {
      const next = this.asked;
      this.asked = null;
      await this.call("seek", { time_s: next });
    }
    this.seeking = false;
  }

  show(replay) {
    element("timeline").hidden = !replay;
    this.state = replay;
    if (!replay) return;
    element("play").disabled = !this.connection.has("pause");
    element("play").textContent = replay.ended ? "Play again" : replay.paused ? "Play" : "Pause";
    this.slider.max = replay.length_s;
    this.slider.disabled = !this.connection.has("seek");
    if (this.held || this.seeking) return;
    this.slider.value = replay.position_s;
    element("place").textContent = `${clock(replay.position_s)} of ${clock(replay.length_s)}`;
    element("recording").textContent = replay.file;
  }
}
