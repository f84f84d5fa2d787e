// Shows the scene in 3D, or from above if the browser has no WebGL or the user prefers it.
import { SceneFromAbove } from "./scene_from_above.js";

const element = (id) => document.getElementById(id);

export class Scene {
  /** `changed` is called when the scene must be drawn again. */
  constructor(changed) {
    this.changed = changed;
    this.above = new SceneFromAbove(element("scene_from_above"), () => {
      if (this.above.moved) element("follow").checked = this.above.moved = false;
      changed();
    });
    this.solid = null;
    for (const id of ["follow", "estimate", "solid"]) element(id).addEventListener("change", () => this.choose());
    element("solid").disabled = true;
    this.choose();
    this.load();
  }

  /** three.js is loaded apart, so that the page works without it. */
  async load() {
    try {
      const { Scene3d } = await import("./scene_3d.js");
      this.solid = new Scene3d(element("scene_3d"), this.changed, (report) => this.hear(report));
    } catch (error) {
      this.giveUp(error.message ?? error);
    }
  }

  /** What the thread that draws in 3D says. */
  hear({ failed, lost }) {
    if (failed) this.giveUp(failed);
    else if (lost) this.fall("the browser has lost its graphics");
    else this.rise();
  }

  giveUp(reason) {
    this.solid = null;
    this.fall(`this browser cannot draw in 3D (${reason})`);
  }

  rise() {
    element("solid").disabled = false;
    element("solid").checked = true;
    element("scene_note").textContent = "";
    this.choose();
  }

  fall(reason) {
    element("solid").disabled = true;
    element("solid").checked = false;
    element("scene_note").textContent = `${reason}: the scene is shown from above`;
    this.choose();
  }

  choose() {
    const solid = element("solid").checked && this.solid !== null;
    element("scene_3d").hidden = !solid;
    element("scene_from_above").hidden = solid;
    element("scene_hint").textContent = solid
      ? "drag: turn; wheel or two fingers: zoom; right button or two fingers: move"
      : "wheel or two fingers: zoom; drag: move";
    this.changed();
  }

  draw(state) {
    element("scene_missing").hidden = Boolean(state.scene);
    const options = { follow: element("follow").checked, estimate: element("estimate").checked };
    if (element("scene_3d").hidden) this.above.draw(state, options);
    else this.solid.draw(state, options);
  }
}
