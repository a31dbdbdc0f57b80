// Builds meshes of flat coloured faces, with day light already in their colours: one material, no
// lights, few calls to draw.
import { BufferAttribute, BufferGeometry, Mesh } from "../vendor/three.js";
import { SOLID } from "./materials.js";

/** @typedef {[number, number, number]} Point ahead, left, up of a frame (m) */
/**
 * @typedef {{x_m: number, y_m: number, z_m: number, heading_rad: number}} Frame in the world: east, north, up
 */
/** @typedef {{x_m: number, y_m: number}} Origin the point of the world where a mesh has its zero */

// Where the light comes from (three's axes: east, up, south), and how much from sun and sky.
const SUN = normalized([-0.5, 0.7, 0.5]);
const SUN_SHARE = 0.36;
const SKY_SHARE = 0.84;

/** @param {number} hex @returns {[number, number, number]} 0..1 */
export function rgb(hex) {
  return [(hex >> 16) / 255, ((hex >> 8) & 255) / 255, (hex & 255) / 255];
}

/** @param {Origin} origin @param {number} x_m @param {number} y_m @param {number} z_m */
export function toScene(origin, x_m, y_m, z_m) {
  return /** @type {Point} */ ([x_m - origin.x_m, z_m, origin.y_m - y_m]);
}

/** Faces in the frame of something that stands in the world. */
export class MeshBuilder {
  /** @param {Origin} origin */
  constructor(origin) {
    this.origin = origin;
    /** @type {number[]} */
    this.positions = [];
    /** @type {number[]} */
    this.colors = [];
    /** @type {Frame} */
    this.frame = { ...origin, z_m: 0, heading_rad: 0 };
    this.cos = 1;
    this.sin = 0;
  }

  /** Points of what follows are in this frame. @param {Frame} frame */
  stand(frame) {
    this.frame = frame;
    this.cos = Math.cos(frame.heading_rad);
    this.sin = Math.sin(frame.heading_rad);
    return this;
  }

  /** @param {Point} point @returns {Point} in the scene */
  place([ahead, left, up]) {
    const { x_m, y_m, z_m } = this.frame;
    const x = x_m + ahead * this.cos - left * this.sin;
    const y = y_m + ahead * this.sin + left * this.cos;
    return toScene(this.origin, x, y, z_m + up);
  }

  /** Corners against the clock, seen from outside. @param {Point[]} corners @param {number} hex */
  face(corners, hex, shade = 1) {
    this.sceneFace(
      corners.map((corner) => this.place(corner)),
      hex,
      shade,
    );
  }

  /** The same, already in the scene. @param {Point[]} at @param {number} hex */
  sceneFace(at, hex, shade = 1) {
    const light = shade * lightOn(at[0], at[1], at[2]);
    const [red, green, blue] = rgb(hex);
    for (let k = 2; k < at.length; k++) {
      for (const corner of [at[0], at[k - 1], at[k]]) {
        this.positions.push(corner[0], corner[1], corner[2]);
        this.colors.push(red * light, green * light, blue * light);
      }
    }
  }

  /**
   * An upright box; without its bottom.
   * @param {Point} low corner behind, right, below @param {Point} high @param {number} hex
   */
  box([a0, l0, u0], [a1, l1, u1], hex, top = hex) {
    this.face(
      [
        [a1, l1, u0],
        [a1, l0, u0],
        [a1, l0, u1],
        [a1, l1, u1],
      ]
        .map(point)
        .reverse(),
      hex,
    );
    this.face(
      [
        [a0, l0, u0],
        [a0, l1, u0],
        [a0, l1, u1],
        [a0, l0, u1],
      ]
        .map(point)
        .reverse(),
      hex,
    );
    this.face(
      [
        [a0, l1, u0],
        [a1, l1, u0],
        [a1, l1, u1],
        [a0, l1, u1],
      ]
        .map(point)
        .reverse(),
      hex,
    );
    this.face(
      [
        [a1, l0, u0],
        [a0, l0, u0],
        [a0, l0, u1],
        [a1, l0, u1],
      ]
        .map(point)
        .reverse(),
      hex,
    );
    this.face(
      [
        [a0, l0, u1],
        [a1, l0, u1],
        [a1, l1, u1],
        [a0, l1, u1],
      ].map(point),
      top,
    );
  }

  /**
   * A cone, or part of one.
   * @param {Point} foot @param {number} low_m radius at the foot @param {number} high_m radius at
   *   the top @param {number} height_m @param {number} sides @param {number} hex
   */
  cone([a, l, u], low_m, high_m, height_m, sides, hex, shade = 1) {
    for (let k = 0; k < sides; k++) {
      const [from, to] = [k, k + 1].map((i) => (2 * Math.PI * i) / sides);
      const [c0, s0, c1, s1] = [Math.cos(from), Math.sin(from), Math.cos(to), Math.sin(to)];
      /** @type {Point[]} */
      const corners = [
        [a + low_m * c0, l + low_m * s0, u],
        [a + low_m * c1, l + low_m * s1, u],
        [a + high_m * c1, l + high_m * s1, u + height_m],
        [a + high_m * c0, l + high_m * s0, u + height_m],
      ];
      this.face(high_m > 0 ? corners : corners.slice(0, 3), hex, shade);
    }
  }

  /** @returns {Mesh | null} null: it has no faces */
  mesh(material = SOLID) {
    if (!this.positions.length) return null;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.positions), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(this.colors), 3));
    return new Mesh(geometry, material);
  }
}

/** @param {number[]} numbers @returns {Point} */
function point(numbers) {
  return /** @type {Point} */ (numbers);
}

/** How light a face is. @param {Point} a @param {Point} b @param {Point} c */
export function lightOn(a, b, c) {
  const [ux, uy, uz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const [vx, vy, vz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
  const normal = normalized([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx]);
  return lightAlong(normal);
}

/** @param {Point} normal of length 1, in the scene */
export function lightAlong([x, y, z]) {
  const sun = Math.max(x * SUN[0] + y * SUN[1] + z * SUN[2], 0);
  return SUN_SHARE * sun + SKY_SHARE * (0.8 + 0.2 * y);
}

/** @param {Point} vector @returns {Point} */
function normalized([x, y, z]) {
  const length = Math.hypot(x, y, z) || 1;
  return [x / length, y / length, z / length];
}
