// Houses and a church of a village.
import { between, chance } from "./chance.js";

/**
 * @typedef {import("./mesh.js").MeshBuilder} MeshBuilder the frame: front of the house, facing the road along its left
 */
/** @typedef {import("./mesh.js").Point} Point */

const WALLS = [0xf3ead8, 0xe8dcc0, 0xf6f3ea, 0xe9d3b4, 0xd9c7b0, 0xf0e0d0, 0xcfd8d4];
const ROOFS = [0x9c4a35, 0x8a3f30, 0x6d4a40, 0xa85a3e, 0x5b5653];
const GLASS = 0x3d4a55;
const FRAME = 0xf8f8f4;
const DOOR = [0x6b4a2f, 0x3f5a4a, 0x7a2f2f];
const FOUNDATION_M = 3;

/**
 * A house of two floors; ahead: along the road, left: away from it if `away` is 1, -1: to the right.
 * @param {MeshBuilder} solid @param {number} seed @param {1 | -1} away
 */
export function house(solid, seed, away) {
  const length = between(9, 13, chance(seed, 1));
  const depth = between(8, 10, chance(seed, 2));
  const floors = chance(seed, 3) < 0.3 ? 1 : 2;
  const wall = 2.8 * floors + 0.5;
  const walls = WALLS[Math.floor(chance(seed, 4) * WALLS.length)];
  const roof = ROOFS[Math.floor(chance(seed, 5) * ROOFS.length)];
  const [near, far] = [0, depth * away].sort((a, b) => a - b);
  solid.box([0, near, -FOUNDATION_M], [length, far, wall], walls);
  if (chance(seed, 6) < 0.4) gableToRoad(solid, length, near, far, wall, roof, walls);
  else gableAside(solid, length, near, far, wall, roof, walls);
  windows(solid, length, floors, away, seed);
  sideWindows(solid, near, far, length, floors);
  solid.box(
    [length * 0.25, depth * 0.4 * away - 0.3, wall + 1],
    [length * 0.25 + 0.6, depth * 0.4 * away + 0.3, wall + 4.4],
    0x8a5a48,
  );
}

/**
 * Ridge along the road.
 * @param {MeshBuilder} solid
 * @param {number} length
 * @param {number} near
 * @param {number} far
 * @param {number} wall
 * @param {number} roof
 * @param {number} walls
 */
function gableAside(solid, length, near, far, wall, roof, walls) {
  const [eave, rise, middle] = [0.5, (far - near) * 0.42, (near + far) / 2];
  const drop = (eave * rise) / ((far - near) / 2);
  const [a0, a1] = [-0.4, length + 0.4];
  solid.face(
    [
      [a1, near - eave, wall - drop],
      [a1, middle, wall + rise],
      [a0, middle, wall + rise],
      [a0, near - eave, wall - drop],
    ],
    roof,
  );
  solid.face(
    [
      [a0, far + eave, wall - drop],
      [a0, middle, wall + rise],
      [a1, middle, wall + rise],
      [a1, far + eave, wall - drop],
    ],
    roof,
  );
  solid.face(
    [
      [0, far, wall],
      [0, near, wall],
      [0, middle, wall + rise],
    ],
    walls,
  );
  solid.face(
    [
      [length, near, wall],
      [length, far, wall],
      [length, middle, wall + rise],
    ],
    walls,
  );
}

/**
 * Ridge across.
 * @param {MeshBuilder} solid
 * @param {number} length
 * @param {number} near
 * @param {number} far
 * @param {number} wall
 * @param {number} roof
 * @param {number} walls
 */
function gableToRoad(solid, length, near, far, wall, roof, walls) {
  const [eave, rise, middle] = [0.5, length * 0.4, length / 2];
  const drop = (eave * rise) / (length / 2);
  const [l0, l1] = [near - 0.4, far + 0.4];
  solid.face(
    [
      [-eave, l0, wall - drop],
      [middle, l0, wall + rise],
      [middle, l1, wall + rise],
      [-eave, l1, wall - drop],
    ],
    roof,
  );
  solid.face(
    [
      [length + eave, l1, wall - drop],
      [middle, l1, wall + rise],
      [middle, l0, wall + rise],
      [length + eave, l0, wall - drop],
    ],
    roof,
  );
  solid.face(
    [
      [0, near, wall],
      [length, near, wall],
      [middle, near, wall + rise],
    ],
    walls,
  );
  solid.face(
    [
      [length, far, wall],
      [0, far, wall],
      [middle, far, wall + rise],
    ],
    walls,
  );
}

/**
 * To the road, with a door.
 * @param {MeshBuilder} solid
 * @param {number} length
 * @param {number} floors
 * @param {1 | -1} away
 * @param {number} seed
 */
function windows(solid, length, floors, away, seed) {
  const count = Math.floor(length / 2.6);
  const door = Math.floor(chance(seed, 7) * count);
  for (let floor = 0; floor < floors; floor++) {
    for (let k = 0; k < count; k++) {
      const at = ((k + 0.5) * length) / count;
      if (floor === 0 && k === door) {
        upright(solid, at - 0.55, at + 0.55, 0, 2.1, away, DOOR[seed % 3], 0.04);
        continue;
      }
      const up = 1 + 2.8 * floor;
      upright(solid, at - 0.65, at + 0.65, up - 0.1, up + 1.4, away, FRAME, 0.03);
      upright(solid, at - 0.55, at - 0.04, up, up + 1.3, away, GLASS, 0.06);
      upright(solid, at + 0.04, at + 0.55, up, up + 1.3, away, GLASS, 0.06);
    }
  }
}

/**
 * @param {MeshBuilder} solid
 * @param {number} from
 * @param {number} to
 * @param {number} low
 * @param {number} high
 * @param {1 | -1} away
 * @param {number} hex
 * @param {number} out
 */
function upright(solid, from, to, low, high, away, hex, out) {
  const left = -out * away;
  /** @type {Point[]} */
  const corners = [
    [from, left, low],
    [to, left, low],
    [to, left, high],
    [from, left, high],
  ];
  solid.face(away > 0 ? corners : corners.reverse(), hex);
}

/**
 * On the ends, seen by who comes along the road.
 * @param {MeshBuilder} solid
 * @param {number} near
 * @param {number} far
 * @param {number} length
 * @param {number} floors
 */
function sideWindows(solid, near, far, length, floors) {
  for (let floor = 0; floor < floors; floor++) {
    const [low, high] = [1 + 2.8 * floor, 2.3 + 2.8 * floor];
    for (const share of [0.28, 0.72]) {
      const left = near + (far - near) * share;
      solid.face(
        [
          [-0.05, left + 0.5, low],
          [-0.05, left - 0.5, low],
          [-0.05, left - 0.5, high],
          [-0.05, left + 0.5, high],
        ],
        GLASS,
      );
      solid.face(
        [
          [length + 0.05, left - 0.5, low],
          [length + 0.05, left + 0.5, low],
          [length + 0.05, left + 0.5, high],
          [length + 0.05, left - 0.5, high],
        ],
        GLASS,
      );
    }
  }
}

/** @param {MeshBuilder} solid @param {1 | -1} away */
export function church(solid, away) {
  const [near, far] = [0, 9 * away].sort((a, b) => a - b);
  solid.box([0, near, -FOUNDATION_M], [18, far, 7], 0xf1eadb);
  gableAside(solid, 18, near, far, 7, 0x7a3f33, 0xf1eadb);
  const [low, high] = [2 * away, 7 * away].sort((a, b) => a - b);
  solid.box([-5, low, -FOUNDATION_M], [0, high, 16], 0xf1eadb);
  const middle = (low + high) / 2;
  solid.cone([-2.5, middle, 16], 3.4, 0, 10, 8, 0x5f6a66);
  for (const up of [10, 13]) {
    solid.face(
      [
        [-5.05, middle + 0.7, up],
        [-5.05, middle - 0.7, up],
        [-5.05, middle - 0.7, up + 1.8],
        [-5.05, middle + 0.7, up + 1.8],
      ],
      GLASS,
    );
  }
}
