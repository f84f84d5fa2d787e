// What the 3D scene consists of, as objects of three.js. All of them are in the world's frame W: z up, metres.
import * as THREE from "./three/three.module.min.js";
import { colourOf, torqueColour } from "./colours.js";

const mostModules = 64;
const mostArrows = 128;
const arrow_m_per_n = 0.02; // length of the arrow of a contact force
const unitX = new THREE.Vector3(1, 0, 0);
const turn = new THREE.Quaternion();
const place = new THREE.Vector3();
const size = new THREE.Vector3();
const matrix = new THREE.Matrix4();
const paint = new THREE.Color();

/** Frees what the graphics card holds of an object and of all that belongs to it, and takes it out of its scene. */
export function discard(object) {
  object.traverse((part) => {
    part.geometry?.dispose();
    part.material?.dispose();
    part.dispose?.();
  });
  object.removeFromParent();
}

const lit = (colour, more = {}) => new THREE.MeshLambertMaterial({ color: colour, ...more });
const flat = (colour, more = {}) => new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide, ...more });

/** A band on the ground along points [[x, y], ...]; WebGL draws lines one pixel wide only. */
function ribbon(points, width, height, material) {
  const corners = [];
  points.forEach(([x, y], i) => {
    const [ax, ay] = points[Math.max(0, i - 1)];
    const [bx, by] = points[Math.min(points.length - 1, i + 1)];
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const nx = (-(by - ay) / length) * (width / 2);
    const ny = ((bx - ax) / length) * (width / 2);
    corners.push(x + nx, y + ny, height, x - nx, y - ny, height);
  });
  const triangles = [];
  for (let i = 0; i + 1 < points.length; ++i)
    triangles.push(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(triangles);
  return new THREE.Mesh(geometry, material);
}

/** Points [[x, y], ...] as small discs on the ground. */
function dots(points, radius, height, material) {
  const mesh = new THREE.InstancedMesh(new THREE.CircleGeometry(radius, 12), material, points.length);
  points.forEach(([x, y], i) => mesh.setMatrixAt(i, matrix.makeTranslation(x, y, height)));
  return mesh;
}

function disc(x, y, radius, height, material) {
  const mesh = new THREE.Mesh(new THREE.CircleGeometry(radius, 48), material);
  mesh.position.set(x, y, height);
  return mesh;
}

/** An object or obstacle: a box with its extents, or a cylinder with radius, radius and height. */
function solid({ box, size_m: [x, y, z] }, material) {
  if (box) return new THREE.Mesh(new THREE.BoxGeometry(x, y, z), material);
  return new THREE.Mesh(new THREE.CylinderGeometry(x, x, z, 32).rotateX(Math.PI / 2), material);
}

/** `pose` is [x, y, yaw, z, qx, qy, qz, qw]. */
function put(object, pose) {
  object.position.set(pose[0], pose[1], pose[3]);
  object.quaternion.set(pose[4], pose[5], pose[6], pose[7]);
}

/** Ground, line, zones and obstacles: what does not move during an epoch. */
export function scenery(scene) {
  const group = new THREE.Group();
  const xs = scene.line.map(([x]) => x).concat(scene.zones.map((zone) => zone.x_m), 0);
  const ys = scene.line.map(([, y]) => y).concat(scene.zones.map((zone) => zone.y_m), 0);
  const extent = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
  const side = 2 * Math.ceil(extent / 2 + 4);
  const [x, y] = [xs, ys].map((all) => Math.round((Math.max(...all) + Math.min(...all)) / 2));
  const ground = new THREE.Mesh(new THREE.PlaneGeometry(side, side), flat("#eef0ee"));
  ground.position.set(x, y, -0.004);
  const grid = new THREE.GridHelper(side, side, "#c4c8c4", "#d8dcd8").rotateX(Math.PI / 2); // one square is 1 m
  grid.position.set(x, y, -0.002);
  group.add(ground, grid);
  if (scene.line.length > 1)
    group.add(ribbon(scene.line, scene.line_width_m, 0.002, flat(colourOf(scene.line_colour))));
  for (const zone of scene.zones) {
    const material = flat(colourOf(zone.colour), { transparent: true, opacity: 0.35, depthWrite: false });
    group.add(disc(zone.x_m, zone.y_m, zone.radius_m, 0.001, material));
  }
  for (const obstacle of scene.obstacles) {
    const mesh = solid(obstacle, lit("#8a8a8a"));
    put(mesh, obstacle.pose);
    group.add(mesh);
  }
  return group;
}

/** The objects that the robot retrieves. Their number and sizes are those of the first state. */
export class Objects {
  constructor(objects) {
    this.group = new THREE.Group();
    for (const object of objects) this.group.add(solid(object, lit(colourOf(object.colour))));
  }
  show(objects) {
    objects.forEach((object, i) => this.group.children[i] && put(this.group.children[i], object.pose));
  }
}

/** The modules, each in the colour of the torque of the joint behind it. */
export class Robot {
  constructor({ module_length_m: length, module_radius_m: radius }) {
    this.group = new THREE.Group();
    // A little shorter than the distance of the joints, so that each module is seen as one.
    const body = new THREE.CapsuleGeometry(radius * 0.98, length * 0.62, 6, 16).rotateZ(Math.PI / 2);
    this.modules = new THREE.InstancedMesh(body, lit("#ffffff"), mostModules);
    this.modules.frustumCulled = false; // its place is that of its instances
    this.head = new THREE.Group();
    for (const y of [-1, 1]) {
      const eye = new THREE.Mesh(new THREE.SphereGeometry(radius * 0.3, 12, 8), lit("#202020"));
      eye.position.set(length * 0.42, y * radius * 0.5, radius * 0.6);
      this.head.add(eye);
    }
    this.group.add(this.modules, this.head);
  }
  show(modules, torques) {
    this.modules.count = Math.min(mostModules, modules.length);
    size.set(1, 1, 1);
    for (let i = 0; i < this.modules.count; ++i) {
      const pose = modules[i];
      place.set(pose[0], pose[1], pose[3]);
      turn.set(pose[4], pose[5], pose[6], pose[7]);
      this.modules.setMatrixAt(i, matrix.compose(place, turn, size));
      const [r, g, b] = torqueColour(torques?.[i]);
      this.modules.setColorAt(i, paint.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace));
    }
    this.modules.instanceMatrix.needsUpdate = true;
    if (this.modules.instanceColor) this.modules.instanceColor.needsUpdate = true;
    this.head.visible = modules.length > 0;
    if (modules.length > 0) put(this.head, modules[0]);
  }
}

/** The contact forces as arrows in the direction in which they push the robot. */
export class Forces {
  constructor() {
    const material = lit("#cc3d8f", { depthTest: false, transparent: true, opacity: 0.9 }); // seen through the body
    const shaft = new THREE.CylinderGeometry(0.007, 0.007, 1, 8).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);
    const tip = new THREE.ConeGeometry(0.018, 0.045, 12).rotateZ(-Math.PI / 2);
    this.shafts = new THREE.InstancedMesh(shaft, material, mostArrows);
    this.tips = new THREE.InstancedMesh(tip, material, mostArrows);
    this.group = new THREE.Group().add(this.shafts, this.tips);
    for (const mesh of [this.shafts, this.tips]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = 2;
      mesh.count = 0;
    }
  }
  /** `contacts`: [[x, y, z, fx, fy, fz], ...] in metres and newtons. */
  show(contacts) {
    const count = Math.min(mostArrows, contacts.length);
    for (let i = 0; i < count; ++i) {
      const [x, y, z, fx, fy, fz] = contacts[i];
      const force = Math.hypot(fx, fy, fz);
      const length = force * arrow_m_per_n;
      place.set(fx / force, fy / force, fz / force);
      turn.setFromUnitVectors(unitX, place);
      place.multiplyScalar(length);
      const end = [x + place.x, y + place.y, z + place.z];
      this.shafts.setMatrixAt(i, matrix.compose(place.set(x, y, z), turn, size.set(length, 1, 1)));
      this.tips.setMatrixAt(i, matrix.compose(place.set(...end), turn, size.set(1, 1, 1)));
    }
    for (const mesh of [this.shafts, this.tips]) {
      mesh.count = count;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }
}

/** The robot's estimated pose and map, drawn in the frame M of its map. */
export class Estimate {
  constructor({ module_length_m: length, module_radius_m: radius }) {
    this.group = new THREE.Group();
    const material = lit("#000000", { transparent: true, opacity: 0.75, depthTest: false });
    this.head = new THREE.Group();
    const nose = new THREE.Mesh(new THREE.ConeGeometry(radius * 0.6, length * 1.2, 16).rotateZ(-Math.PI / 2), material);
    nose.position.set(length, 0, 3 * radius);
    const ring = new THREE.Mesh(new THREE.TorusGeometry(radius * 1.7, radius * 0.18, 8, 32), material);
    ring.position.z = 3 * radius;
    nose.renderOrder = ring.renderOrder = 3;
    this.head.add(nose, ring);
    this.group.add(this.head);
    this.map = new THREE.Group();
    this.tick = null; // of the map that is drawn
  }
  show({ start, pose, map }) {
    this.group.visible = Boolean(start);
    if (!start) return;
    this.group.position.set(start[0], start[1], 0);
    this.group.rotation.z = start[2];
    this.head.visible = Boolean(pose) && pose[0] !== null;
    if (this.head.visible) {
      this.head.position.set(pose[0], pose[1], 0);
      this.head.rotation.z = pose[2];
    }
    if (!map || map.tick === this.tick) return;
    this.tick = map.tick;
    discard(this.map);
    this.map = new THREE.Group();
    // Its points are in the order of discovery, so that neighbours in the list may lie far apart.
    if (map.line.length > 0) this.map.add(dots(map.line, 0.013, 0.006, flat("#303030")));
    if (map.obstacles.length > 0) this.map.add(dots(map.obstacles, 0.02, 0.12, flat("#b04090")));
    for (const object of map.objects) {
      if (object.x_m === null) continue;
      const radius = object.radius_m ?? 0.05;
      const material = flat(colourOf(object.colour), { wireframe: true, transparent: true, opacity: 0.6 });
      const height = object.zone ? 0.01 : (object.height_m ?? 0.2);
      const shape = new THREE.CylinderGeometry(radius, radius, height, 16, 1, true).rotateX(Math.PI / 2);
      const mesh = new THREE.Mesh(shape, material);
      mesh.position.set(object.x_m, object.y_m, height / 2 + 0.004);
      this.map.add(mesh);
    }
    this.group.add(this.map);
  }
}
