// The scene in three dimensions: the page's side of it. A thread of its own draws it with three.js. Throws if the
// browser has no WebGL.
import * as THREE from "./three/three.module.min.js";
import { OrbitControls } from "./three/OrbitControls.js";

/** True where the browser draws with the processor, as in many virtual machines: smooth edges cost too much there. */
function drawnBySoftware() {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) throw new Error("it has no WebGL 2");
  const info = probe.getExtension("WEBGL_debug_renderer_info");
  const name = probe.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : probe.RENDERER);
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** Shows states on a canvas. A mouse or fingers turn, zoom and move the view; `changed` is called after each of them. */
export class Scene3d {
  /** Calls `report` with {ready}, {failed: reason}, {lost} or {restored}. */
  constructor(canvas, changed, report) {
    const slow = drawnBySoftware();
    const ratio = slow ? 1 : Math.min(window.devicePixelRatio || 1, 2);
    this.canvas = canvas;
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.02, 200);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-1.4, -1.5, 1.3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02; // not from below the ground
    this.controls.minDistance = 0.3;
    this.controls.maxDistance = 60;
    this.drawing = false;
    this.controls.addEventListener("change", () => this.drawing || changed()); // following the robot is no change
    this.key = null; // of the scene that is shown
    this.followed = null; // the place of the robot at which the view points
    const offscreen = canvas.transferControlToOffscreen();
    this.worker = new Worker("scene_3d_worker.js", { type: "module" });
    this.worker.onmessage = ({ data }) => report(data);
    this.worker.onerror = (event) => report({ failed: event.message ?? "its program cannot be loaded" });
    this.worker.postMessage({ canvas: offscreen, ratio, smooth: !slow }, [offscreen]);
  }

  /** Moves the view with the robot: turning and zooming around it stay as the user left them. */
  follow(modules) {
    const centre = new THREE.Vector3();
    for (const pose of modules) centre.add(new THREE.Vector3(pose[0], pose[1], 0));
    centre.divideScalar(modules.length);
    const from = this.followed ?? this.controls.target;
    const step = centre.clone().sub(from);
    this.controls.target.add(step);
    this.camera.position.add(step);
    this.followed = centre;
  }

  draw(state, { follow, estimate }) {
    const { scene, world, torque_nm, contacts, start, pose, map } = state;
    if (!scene || !world) return;
    const key = JSON.stringify([scene.epoch, scene.scenario, scene.seed, world.objects.length]);
    if (key !== this.key) this.followed = null; // another epoch or run
    if (follow && world.modules.length > 0) this.follow(world.modules);
    else if (!follow) this.followed = null;
    this.drawing = true;
    this.controls.update();
    this.drawing = false;
    const view = { position: this.camera.position.toArray(), quaternion: this.camera.quaternion.toArray() };
    const size = [this.canvas.clientWidth, this.canvas.clientHeight];
    this.worker.postMessage({
      key, world, torque_nm, contacts, view, size,
      scene: key === this.key ? null : scene, // it is needed once
      estimate: estimate ? { start, pose, map } : null,
    });
    this.key = key;
  }
}
