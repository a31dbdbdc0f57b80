// What a driver sees of the own car: dashboard, bonnet, steering wheel, pillars.
import {
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  TorusGeometry,
} from "../vendor/three.js";

const WHEEL_RADIUS_M = 0.19;
const STEERING_RATIO = 15;
const WHEELBASE_M = 2.6;
const WHEEL_MAX_RAD = 2;

/** Moves with the eye. */
export class Interior {
  /** @param {number} side +1: the driver sits on the left */
  constructor(side) {
    this.group = new Group();
    this.materials = {
      dash: new MeshBasicMaterial({ color: 0x1d1f22 }),
      edge: new MeshBasicMaterial({ color: 0x2c2f33 }),
      bonnet: new MeshBasicMaterial({ vertexColors: true }),
      wheel: new MeshBasicMaterial({ color: 0x141517 }),
    };
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
    const rim = new Mesh(new TorusGeometry(WHEEL_RADIUS_M, 0.016, 8, 40), this.materials.wheel);
    const spokes = triangles([
      [-0.18, 0.02, 0], [-0.18, -0.02, 0], [0.18, -0.02, 0],
      [-0.18, 0.02, 0], [0.18, -0.02, 0], [0.18, 0.02, 0],
      [-0.05, 0, 0], [-0.04, -0.18, 0], [0.04, -0.18, 0],
      [-0.05, 0, 0], [0.04, -0.18, 0], [0.05, 0, 0],
    ]);
    this.wheel.add(rim, new Mesh(spokes, this.materials.wheel));
    this.wheel.position.set(0, -0.44, -0.62);
    this.wheel.rotation.order = "XYZ";
    this.wheel.rotation.x = -0.35;
  }

  /** @param {number} side */
  #bonnet(side) {
    const middle = 0.36 * side;
    const [points, colors] = [/** @type {number[][]} */ ([]), /** @type {number[]} */ ([])];
    const rows = [[-1.0, -0.45, 0.8], [-1.3, -0.405, 0.82], [-1.6, -0.43, 0.79], [-1.8, -0.52, 0.74]];
    const across = 10;
    const at = (/** @type {number[]} */ [z, y, half], /** @type {number} */ k) => {
      const share = (2 * k) / across - 1;
      return [middle + share * half, y - 0.07 * share ** 4, z];
    };
    for (let row = 1; row < rows.length; row++) {
      for (let k = 0; k < across; k++) {
        const [a, b, c, d] = [at(rows[row - 1], k), at(rows[row - 1], k + 1), at(rows[row], k + 1), at(rows[row], k)];
        points.push(a, b, c, a, c, d);
        for (const [i, j] of [[row - 1, k], [row - 1, k + 1], [row, k + 1], [row - 1, k], [row, k + 1], [row, k]]) {
          const light = 0.02 + 0.08 * Math.sin((Math.PI * j) / across) + 0.045 * i;
          colors.push(light * 0.45, light * 0.75, light);
        }
      }
    }
    const geometry = triangles(points);
    geometry.setAttribute("color", new Float32BufferAttribute(colors, 3));
    this.group.add(new Mesh(geometry, this.materials.bonnet));
  }

  #dashboard() {
    const top = quad([-2, -0.36, -0.75], [2, -0.36, -0.75], [2, -0.345, -1.0], [-2, -0.345, -1.0]);
    const front = quad([-2, -1.2, -0.7], [2, -1.2, -0.7], [2, -0.36, -0.75], [-2, -0.36, -0.75]);
    this.group.add(new Mesh(top, this.materials.edge), new Mesh(front, this.materials.dash));
  }

  dispose() {
    this.group.traverse((part) => part instanceof Mesh && part.geometry.dispose());
    for (const material of Object.values(this.materials)) material.dispose();
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
