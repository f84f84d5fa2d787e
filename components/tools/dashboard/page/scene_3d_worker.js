// Draws the scene in three dimensions, in a thread of its own: where the processor draws, an image takes longer than
// the page may wait. Receives {canvas, ratio, smooth} once, and then {scene, view, size}: what is to be shown, from
// where, and how large. Only the newest is drawn. Sends {ready}, {failed: reason}, {lost} and {restored}.
import * as THREE from "./three/three.module.min.js";
import { discard, Estimate, Forces, Objects, Robot, scenery } from "./scene_3d_parts.js";

class Drawing {
  constructor({ canvas, ratio, smooth }) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: smooth });
    this.renderer.setPixelRatio(ratio);
    this.renderer.debug.checkShaderErrors = false; // the check waits for the graphics card
    this.world = new THREE.Scene();
    this.world.background = new THREE.Color("#f8faf9");
    this.world.add(new THREE.HemisphereLight("#ffffff", "#b0b4b0", 2.2));
    const sun = new THREE.DirectionalLight("#ffffff", 1.6);
    sun.position.set(-2, -3, 6);
    this.world.add(sun);
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.02, 200);
    this.size = [0, 0];
    this.key = null; // of the scene that is drawn
  }

  /** Builds what belongs to a scene; after a reset or a new run everything is built again. */
  build(key, scene, objects) {
    if (key === this.key) return;
    for (const part of [this.ground, this.objects?.group, this.robot?.group, this.forces?.group, this.estimate?.group])
      if (part) discard(part);
    this.ground = scenery(scene);
    this.objects = new Objects(objects);
    this.robot = new Robot(scene);
    this.forces = new Forces();
    this.estimate = new Estimate(scene);
    for (const part of [this.objects, this.robot, this.forces, this.estimate]) this.world.add(part.group);
    this.world.add(this.ground);
    this.key = key;
  }

  draw({ key, scene, world, torque_nm, contacts, estimate, view, size }) {
    this.build(key, scene, world.objects);
    this.objects.show(world.objects);
    this.robot.show(world.modules, torque_nm);
    this.forces.show(contacts ?? []);
    this.estimate.show(estimate ?? {});
    this.camera.position.fromArray(view.position);
    this.camera.quaternion.fromArray(view.quaternion);
    if (size[0] !== this.size[0] || size[1] !== this.size[1]) {
      this.size = size;
      this.renderer.setSize(...size, false);
      this.camera.aspect = size[0] / Math.max(1, size[1]);
      this.camera.updateProjectionMatrix();
    }
    this.renderer.render(this.world, this.camera);
  }
}

let drawing = null;
let newest = null; // what is not drawn yet
let scene = null; // comes once for each key

function begin(data) {
  try {
    drawing = new Drawing(data);
  } catch (error) {
    return postMessage({ failed: String(error.message ?? error) });
  }
  data.canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    postMessage({ lost: true });
  });
  data.canvas.addEventListener("webglcontextrestored", () => postMessage({ restored: true }));
  postMessage({ ready: true });
}

function drawNewest() {
  const shown = newest;
  newest = null;
  drawing.draw(shown);
}

onmessage = ({ data }) => {
  if (data.canvas) return begin(data);
  if (data.scene) scene = data.scene;
  if (!newest && drawing) requestAnimationFrame(drawNewest);
  newest = { ...data, scene };
};
