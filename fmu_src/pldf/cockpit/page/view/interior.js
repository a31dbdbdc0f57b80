// What a driver sees of the own car: dashboard, bonnet, steering wheel, pillars.
import {
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  Mesh,
  TorusGeometry,
} from "../vendor/three.js";
import { SOLID } from "./materials.js";
import { rgb } from "./mesh.js";

const DASH = 0x1d1f22;
const EDGE = 0x2c2f33;
const WHEEL = 0x141517;
const WHEEL_RADIUS_M = 0.19;
const STEERING_RATIO = 15;
const WHEELBASE_M = 2.6;
const WHEEL_MAX_RAD = 2;

/** Moves with the eye. */
export class Interior {
  /** @param {number} side +1: the driver sits on the left */
  constructor(side) {
    this.group = new Group();
    this.wheel = new Group();
    this.#steeringWheel();
    this.#bonnet(side);
    this.#dashboard();
    this.group.add(this.wheel);
    // First, so that nothing is painted behind it in vain.
    this.group.renderOrder = -1;
    this.group.traverse((part) => (part.renderOrder = -1));
  }

  /** @param {number} curvature_per_m of the path that is driven */
  steer(curvature_per_m) {
    const angle = Math.atan(WHEELBASE_M * curvature_per_m) * STEERING_RATIO;
    this.wheel.rotation.z = Math.max(Math.min(angle, WHEEL_MAX_RAD), -WHEEL_MAX_RAD);
  }

  /** @param {import("../vendor/three.js").PerspectiveCamera} camera */
  follow(camera) {
    this.group.position.copy(camera.position);
    this.group.quaternion.copy(camera.quaternion);
  }

  #steeringWheel() {
    const rim = new Mesh(painted(new TorusGeometry(WHEEL_RADIUS_M, 0.016, 8, 40), WHEEL), SOLID);
    const spokes = triangles([
      [-0.18, 0.02, 0],
      [-0.18, -0.02, 0],
      [0.18, -0.02, 0],
      [-0.18, 0.02, 0],
      [0.18, -0.02, 0],
      [0.18, 0.02, 0],
      [-0.05, 0, 0],
      [-0.04, -0.18, 0],
      [0.04, -0.18, 0],
      [-0.05, 0, 0],
      [0.04, -0.18, 0],
      [0.05, 0, 0],
    ]);
    this.wheel.add(rim, new Mesh(painted(spokes, WHEEL), SOLID));
    this.wheel.position.set(0, -0.44, -0.62);
    this.wheel.rotation.order = "XYZ";
    this.wheel.rotation.x = -0.35;
  }

  /** @param {number} side */
  #bonnet(side) {
    const middle = 0.36 * side;
    const [points, colors] = [/** @type {number[][]} */ ([]), /** @type {number[]} */ ([])];
    const rows = [
      [-1.0, -0.45, 0.8],
      [-1.3, -0.405, 0.82],
      [-1.6, -0.43, 0.79],
      [-1.8, -0.52, 0.74],
    ];
    const across = 10;
    const at = (/** @type {number[]} */ [z, y, half], /** @type {number} */ k) => {
      const share = (2 * k) / across - 1;
      return [middle + share * half, y - 0.07 * share ** 4, z];
    };
    for (let row = 1; row < rows.length; row++) {
      for (let k = 0; k < across; k++) {
        const [a, b, c, d] = [
          at(rows[row - 1], k),
          at(rows[row - 1], k + 1),
          at(rows[row], k + 1),
          at(rows[row], k),
        ];
        points.push(a, b, c, a, c, d);
        for (const [i, j] of [
          [row - 1, k],
          [row - 1, k + 1],
          [row, k + 1],
          [row - 1, k],
          [row, k + 1],
          [row, k],
        ]) {
          const light = 0.16 + 0.16 * Math.sin((Math.PI * j) / across) + 0.07 * i;
          colors.push(light * 0.62, light * 0.85, light);
        }
      }
    }
    const geometry = triangles(points);
    geometry.setAttribute("color", new Float32BufferAttribute(colors, 3));
    this.group.add(new Mesh(geometry, SOLID));
  }

  #dashboard() {
    const top = quad([-2, -0.36, -0.75], [2, -0.36, -0.75], [2, -0.345, -1.0], [-2, -0.345, -1.0]);
    const front = quad([-2, -1.2, -0.7], [2, -1.2, -0.7], [2, -0.36, -0.75], [-2, -0.36, -0.75]);
    this.group.add(new Mesh(painted(top, EDGE), SOLID), new Mesh(painted(front, DASH), SOLID));
  }

  dispose() {
    this.group.traverse((part) => part instanceof Mesh && part.geometry.dispose());
  }
}

/** @param {number[][]} points three of each face */
function triangles(points) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(points.flat(), 3));
  return geometry;
}

/** @param {number[]} a @param {number[]} b @param {number[]} c @param {number[]} d */
function quad(a, b, c, d) {
  return triangles([a, b, c, a, c, d]);
}

/** In one colour. @param {BufferGeometry} geometry @param {number} hex */
function painted(geometry, hex) {
  const { count } = geometry.getAttribute("position");
  const colors = Array.from({ length: count }, () => rgb(hex)).flat();
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 3));
  return geometry;
}
