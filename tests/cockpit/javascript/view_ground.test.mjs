import assert from "node:assert/strict";
import { test } from "node:test";

import { Raycaster, Vector3 } from "../../../fmu_src/pldf/cockpit/page/vendor/three.js";
import { Ground } from "../../../fmu_src/pldf/cockpit/page/view/ground.js";
import { TILE_M, tile } from "../../../fmu_src/pldf/cockpit/page/view/terrain.js";
import { roadModel } from "./road_support.mjs";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/engine/road.js").RoadModel} RoadModel */

const BRIDGE = { kind: /** @type {const} */ ("bridge"), from_m: 500, to_m: 700, name: "" };

/** Up and down through bends. @param {Parameters<typeof roadModel>[2]} about */
function hilly(about = {}) {
  return roadModel(
    1500,
    {
      x_m: (s) => s * 0.9,
      y_m: (s) => 120 * Math.sin(s / 280),
      grade: (s) => 0.06 * Math.sin(s / 130),
    },
    about,
  );
}

/**
 * Height of the land as it is drawn.
 * @param {Map<string, ReturnType<typeof tile>>} tiles
 * @param {Ground} ground
 * @param {number} x_m
 * @param {number} y_m
 * @param {boolean} fine
 */
function drawn(tiles, ground, x_m, y_m, fine) {
  const [i, j] = [x_m, y_m].map((at) => Math.floor(at / TILE_M));
  const key = `${i} ${j} ${fine}`;
  const { mesh, origin } = tiles.get(key) ?? tile(ground, i, j, fine);
  tiles.set(key, { mesh, origin });
  const from = new Vector3(x_m - origin.x_m, 5000, origin.y_m - y_m);
  const [hit] = new Raycaster(from, new Vector3(0, -1, 0)).intersectObject(mesh);
  return hit.point.y;
}

test("the land never comes through the road, near or far", () => {
  const road = hilly();
  const ground = new Ground(road);
  const tiles = new Map();
  for (let s_m = 3.3; s_m < road.length_m; s_m += 17) {
    for (const left_m of [-4, 0, 4]) {
      const { x_m, y_m, z_m } = road.at(s_m, left_m);
      for (const fine of [true, false]) {
        const land = drawn(tiles, ground, x_m, y_m, fine);
        assert.ok(land < z_m - 0.05, `${s_m} m, ${left_m} m left: ${land} over ${z_m}`);
        assert.ok(!fine || land > z_m - 2, `${s_m} m: ${land} far below ${z_m}`);
      }
    }
  }
});

test("under a bridge there is a valley, and beside its ends there is none", () => {
  const road = hilly({ stretches: [BRIDGE] });
  const ground = new Ground(road);
  const below = (/** @type {number} */ s_m) => {
    const { x_m, y_m, z_m } = road.at(s_m);
    return z_m - ground.around(x_m, y_m, 50)(x_m, y_m).z_m;
  };
  assert.ok(below(600) > 10);
  assert.ok(below(480) < 1 && below(720) < 1);
});

test("the road goes on beyond its ends, unless it would meet itself", () => {
  const straight = new Ground(hilly());
  assert.deepEqual([straight.from_m, straight.to_m], [-300, 2800]);
  const radius = 1000 / (2 * Math.PI);
  const circle = new Ground(
    roadModel(1000, {
      x_m: (s) => radius * Math.sin(s / radius),
      y_m: (s) => radius * (1 - Math.cos(s / radius)),
    }),
  );
  assert.deepEqual([circle.from_m, circle.to_m], [-0, 1000]);
});

test("where the road comes by twice, the land lies below the lower one", () => {
  // Along, round a bend, and across itself 6 m higher.
  const heading = (/** @type {number} */ s) => Math.min(Math.max(s - 200, 0), 235.6) / 50;
  const line = [[0, 0]];
  for (let s = 0; s < 700; s++) {
    line.push([line[s][0] + Math.cos(heading(s)), line[s][1] + Math.sin(heading(s))]);
  }
  const road = roadModel(700, {
    x_m: (s) => line[s][0],
    y_m: (s) => line[s][1],
    grade: (s) => (s > 200 && s < 300 ? 0.06 : 0),
  });
  const above = road.at(485.6);
  const ground = new Ground(road);
  assert.ok(Math.abs(above.y_m) < 10 && above.z_m > 5, JSON.stringify(above));
  assert.ok(ground.around(above.x_m, above.y_m, 20)(above.x_m, above.y_m).z_m < 0);
});
