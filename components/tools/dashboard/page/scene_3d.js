// The scene in three dimensions, with three.js. Throws if the browser has no WebGL.
import * as THREE from "./three/three.module.min.js";
import { OrbitControls } from "./three/OrbitControls.js";
import { discard, Estimate, Forces, Objects, Robot, scenery } from "./scene_3d_parts.js";

/** True where the browser draws with the processor, as in many virtual machines: smooth edges cost too much there. */
function drawnBySoftware() {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) throw new Error("it has no WebGL 2");
  const info = probe.getExtension("WEBGL_debug_renderer_info");
  const name = probe.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : probe.RENDERER);
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** Draws states on a canvas. A mouse or fingers turn, zoom and move the view; `changed` is called after each of them. */
export class Scene3d {
  constructor(canvas, changed) {
    this.canvas = canvas;
    const slow = drawnBySoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !slow });
    this.renderer.setPixelRatio(slow ? 1 : Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.debug.checkShaderErrors = false; // the check waits for the graphics card
    this.world = new THREE.Scene();
    this.world.background = new THREE.Color("#f8faf9");
    this.world.add(new THREE.HemisphereLight("#ffffff", "#b0b4b0", 2.2));
    const sun = new THREE.DirectionalLight("#ffffff", 1.6);
    sun.position.set(-2, -3, 6);
    this.world.add(sun);
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.02, 200);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-1.4, -1.5, 1.3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02; // not from below the ground
    this.controls.minDistance = 0.3;
    this.controls.maxDistance = 60;
    this.drawing = false;
    this.controls.addEventListener("change", () => this.drawing || changed()); // following the robot is no change
    this.key = null; // of the scene that is drawn
    this.followed = null; // the place of the robot at which the view points
  }

  /** Builds what belongs to a scene; after a reset or a new run everything is built again. */
  build(state) {
    const objects = state.world.objects;
    const key = JSON.stringify([state.scene.epoch, state.scene.scenario, state.scene.seed, objects.length]);
    if (key === this.key) return;
    for (const part of [this.ground, this.objects?.group, this.robot?.group, this.forces?.group, this.estimate?.group])
      if (part) discard(part);
    this.ground = scenery(state.scene);
    this.objects = new Objects(objects);
    this.robot = new Robot(state.scene);
    this.forces = new Forces();
    this.estimate = new Estimate(state.scene);
    for (const part of [this.objects, this.robot, this.forces, this.estimate]) this.world.add(part.group);
    this.world.add(this.ground);
    this.key = key;
    this.followed = null;
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
    if (!state.scene || !state.world) return;
    this.build(state);
    this.objects.show(state.world.objects);
    this.robot.show(state.world.modules, state.torque_nm);
    this.forces.show(state.contacts ?? []);
    this.estimate.show(state);
    this.estimate.group.visible &&= estimate;
    if (follow && state.world.modules.length > 0) this.follow(state.world.modules);
    else if (!follow) this.followed = null;
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    const ratio = this.renderer.getPixelRatio();
    if (this.canvas.width !== Math.floor(width * ratio) || this.canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / Math.max(1, height);
      this.camera.updateProjectionMatrix();
    }
    this.drawing = true;
    this.controls.update();
    this.drawing = false;
    this.renderer.render(this.world, this.camera);
  }
}
