// The road and the land around the driver: built piece by piece before they are seen.
import { Group, Mesh } from "../vendor/three.js";
import { Ground } from "./ground.js";
import { SIGHT_M, SOLID, asphaltOf, surfaceOf } from "./materials.js";
import { PIECE_M, piece } from "./piece.js";
import { furnitureOf } from "./plan.js";
import { crossSection } from "./profile.js";
import { TILE_M, tile } from "./terrain.js";
import { asphaltTexture, grassTexture } from "./textures.js";

/** @typedef {import("../engine/road.js").RoadModel} RoadModel */
/** @typedef {import("./mesh.js").Origin} Origin */
/** @typedef {import("./plants.js").Detail} Detail */
/** @typedef {{group: Group | Mesh, origin: Origin, detail: Detail}} Built */

const BEHIND_M = 300;
const NEAR_M = 140;
const FAR_M = 420;
const BUILDING_MS = 4; // per frame: a drive must not stutter
const STAYS_M = 2; // nothing new to be seen
const JUMP_M = 150;
const AT_ONCE_M = 250; // so near there is never a hole, however fast a drive is shown

export class World {
  /** @param {RoadModel} road @param {number} anisotropy how sharp pictures are at a flat angle */
  constructor(road, anisotropy) {
    this.road = road;
    this.group = new Group();
    const section = crossSection(road);
    /** @type {import("./piece.js").Kit} */
    this.kit = {
      road,
      section,
      furniture: furnitureOf(road),
      ground: new Ground(road),
      asphalt: asphaltOf(asphaltTexture(section, anisotropy)),
      grass: surfaceOf(grassTexture(anisotropy)),
      paving: SOLID,
    };
    /** @type {Map<string, Built>} */
    this.built = new Map();
    /** the place around which all is built */
    this.around_m = Infinity;
  }

  /**
   * Build what comes into sight around a place and drop what is out of it: what is near first, the
   * rest for a few milliseconds at a time; all at once where nothing of it is there.
   * @param {number} s_m
   */
  surround(s_m) {
    const moved_m = Math.abs(s_m - this.around_m);
    if (moved_m < STAYS_M) return;
    const until_ms = moved_m < JUMP_M ? performance.now() + BUILDING_MS : Infinity;
    const wanted = [...this.#pieces(s_m), ...this.#tiles(s_m)];
    const keys = new Set(wanted.map((each) => each.key));
    for (const [key, built] of this.built) if (!keys.has(key)) this.#drop(key, built);
    const missing = wanted.filter(({ key, detail }) => this.built.get(key)?.detail !== detail);
    let late = false;
    for (const { key, detail, distance_m, build } of missing.sort(
      (a, b) => a.distance_m - b.distance_m,
    )) {
      const there = this.built.get(key);
      const waits = there !== undefined || distance_m > AT_ONCE_M;
      if (waits && performance.now() > until_ms) {
        late = true; // the next frame goes on
        continue;
      }
      if (there) this.#drop(key, there);
      this.#keep(key, detail, build());
    }
    if (!late) this.around_m = s_m;
  }

  /** Put everything where it lies as seen from a point. @param {Origin} eye */
  shift(eye) {
    for (const { group, origin } of this.built.values()) {
      group.position.set(origin.x_m - eye.x_m, 0, eye.y_m - origin.y_m);
    }
  }

  dispose() {
    for (const [key, built] of this.built) this.#drop(key, built);
    for (const material of [this.kit.asphalt, this.kit.grass]) {
      material.uniforms.map.value.dispose();
      material.dispose();
    }
  }

  /** @param {number} s_m */
  #pieces(s_m) {
    const { ground } = this.kit;
    const [first, last] = [
      Math.floor(ground.from_m / PIECE_M),
      Math.ceil(ground.to_m / PIECE_M) - 1,
    ];
    const [from, to] = [s_m - BEHIND_M, s_m + SIGHT_M].map((at) => Math.floor(at / PIECE_M));
    const wanted = [];
    for (let k = Math.max(from, first); k <= Math.min(to, last); k++) {
      const middle = (k + 0.5) * PIECE_M;
      const distance_m = Math.abs(middle - s_m);
      const detail = middle < s_m - PIECE_M ? far(distance_m) : detailAt(distance_m);
      wanted.push({
        key: `piece ${k}`,
        detail,
        distance_m,
        build: () => piece(this.kit, k, detail),
      });
    }
    return wanted;
  }

  /** @param {number} s_m */
  #tiles(s_m) {
    const { x_m, y_m } = this.road.at(s_m);
    const [i0, j0] = [x_m, y_m].map((at) => Math.floor(at / TILE_M));
    const reach = Math.ceil(SIGHT_M / TILE_M);
    const wanted = [];
    for (let i = i0 - reach; i <= i0 + reach; i++) {
      for (let j = j0 - reach; j <= j0 + reach; j++) {
        const distance_m = Math.hypot((i + 0.5) * TILE_M - x_m, (j + 0.5) * TILE_M - y_m);
        if (distance_m > SIGHT_M + TILE_M) continue;
        const detail = far(distance_m);
        const build = () => {
          const { mesh, origin } = tile(this.kit.ground, i, j, detail > 0);
          return { group: mesh, origin };
        };
        wanted.push({ key: `tile ${i} ${j}`, detail, distance_m, build });
      }
    }
    return wanted;
  }

  /**
   * @param {string} key
   * @param {Detail} detail
   * @param {{group: Group | Mesh, origin: Origin}} made
   */
  #keep(key, detail, { group, origin }) {
    this.group.add(group);
    this.built.set(key, { group, origin, detail });
  }

  /** @param {string} key @param {Built} built */
  #drop(key, { group }) {
    this.group.remove(group);
    group.traverse((part) => part instanceof Mesh && part.geometry.dispose());
    this.built.delete(key);
  }
}

/** @param {number} distance_m @returns {Detail} */
function detailAt(distance_m) {
  return distance_m < NEAR_M ? 2 : far(distance_m);
}

/** @param {number} distance_m @returns {0 | 1} */
function far(distance_m) {
  return distance_m < FAR_M ? 1 : 0;
}
