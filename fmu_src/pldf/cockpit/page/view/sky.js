// The sky with far hills: a picture around everything, so far away that it never comes nearer.
import { BackSide, Mesh, MeshBasicMaterial, SphereGeometry } from "../vendor/three.js";
import { chance, hills } from "./chance.js";
import { canvas, textureOf } from "./textures.js";

/** colour of the haze in which far things are lost */
export const HAZE = "#cfdde6";
const WIDTH = 2048;
const HEIGHT = 1024;
const HORIZON = HEIGHT / 2;
const RADIUS_M = 2000;

export function sky() {
  const { made, pen } = canvas(WIDTH, HEIGHT);
  const air = pen.createLinearGradient(0, 0, 0, HORIZON);
  air.addColorStop(0, "#3f7fc0");
  air.addColorStop(0.55, "#7db1dd");
  air.addColorStop(0.88, "#bdd7ea");
  air.addColorStop(1, HAZE);
  pen.fillStyle = air;
  pen.fillRect(0, 0, WIDTH, HORIZON);
  pen.fillStyle = HAZE;
  pen.fillRect(0, HORIZON, WIDTH, HORIZON);
  clouds(pen);
  ridge(pen, 46, 5, "#a9c0d0", 1);
  ridge(pen, 30, 8, "#93b0b8", 2);
  ridge(pen, 17, 13, "#8aab9c", 3);
  const material = new MeshBasicMaterial({
    map: textureOf(made),
    side: BackSide,
    fog: false,
    depthWrite: false,
  });
  const dome = new Mesh(new SphereGeometry(RADIUS_M, 32, 24), material);
  dome.renderOrder = -1;
  dome.frustumCulled = false;
  return dome;
}

/** @param {CanvasRenderingContext2D} pen */
function clouds(pen) {
  for (let k = 0; k < 46; k++) {
    const x = WIDTH * chance(k, 51);
    const y = HORIZON * (0.5 + 0.43 * chance(k, 52));
    const size = 7 + 75 * (1 - y / HORIZON) * (0.5 + chance(k, 53));
    for (let puff = 0; puff < 22; puff++) {
      const px = x + size * 4.5 * (chance(k, puff, 54) - 0.5);
      const py = y - size * 0.5 * chance(k, puff, 55) + size * 0.2;
      blob(pen, px, py, size * (0.35 + 0.6 * chance(k, puff, 56)));
    }
  }
}

/** @param {CanvasRenderingContext2D} pen @param {number} x @param {number} y @param {number} radius */
function blob(pen, x, y, radius) {
  for (const turn of [-WIDTH, 0, WIDTH]) {
    const white = pen.createRadialGradient(x + turn, y, 0, x + turn, y, radius);
    white.addColorStop(0, "rgba(255,255,255,0.34)");
    white.addColorStop(1, "rgba(255,255,255,0)");
    pen.fillStyle = white;
    pen.fillRect(x + turn - radius, y - radius * 0.6, 2 * radius, 1.2 * radius);
  }
}

/** @param {CanvasRenderingContext2D} pen @param {number} height @param {number} waves @param {string} color @param {number} seed */
function ridge(pen, height, waves, color, seed) {
  pen.fillStyle = color;
  pen.beginPath();
  pen.moveTo(0, HORIZON + 6);
  for (let x = 0; x <= WIDTH; x += 4) {
    // Around the circle, so that both ends of the picture meet.
    const turn = (2 * Math.PI * x) / WIDTH;
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    const wide = hills(c * waves * 0.5 + 20, s * waves * 0.5 + 20, seed);
    const fine = hills(c * waves * 3 + 50, s * waves * 3 + 50, seed + 10);
    pen.lineTo(x, HORIZON - height * (0.5 + 0.4 * wide + 0.1 * fine));
  }
  pen.lineTo(WIDTH, HORIZON + 6);
  pen.fill();
}
