// The sky with far hills: a picture around everything, so far away that it never comes nearer.
import { LinearFilter, Mesh, SphereGeometry } from "../vendor/three.js";
import { chance, hills } from "./chance.js";
import { HAZE, pictureOf } from "./materials.js";
import { canvas, textureOf } from "./textures.js";

const WIDTH = 4096;
const HEIGHT = 1024;
// The picture reaches from below the horizon to so far above it; the rest is plain.
const BELOW_DEG = 8;
const ABOVE_DEG = 62;
const HORIZON = (HEIGHT * ABOVE_DEG) / (ABOVE_DEG + BELOW_DEG);
export const ZENITH = "#3f7fc0";
const RADIUS_M = 2000;

export function sky() {
  const { made, pen } = canvas(WIDTH, HEIGHT);
  const air = pen.createLinearGradient(0, 0, 0, HORIZON);
  air.addColorStop(0, ZENITH);
  air.addColorStop(0.5, "#74abdb");
  air.addColorStop(0.85, "#b4d3e8");
  air.addColorStop(1, HAZE);
  pen.fillStyle = air;
  pen.fillRect(0, 0, WIDTH, HORIZON);
  pen.fillStyle = HAZE;
  pen.fillRect(0, HORIZON, WIDTH, HORIZON);
  clouds(pen);
  ridge(pen, 95, 5, "#93afc4", 1);
  ridge(pen, 62, 8, "#7d9fae", 2);
  ridge(pen, 36, 13, "#749a8c", 3);
  const picture = textureOf(made);
  picture.generateMipmaps = false;
  picture.minFilter = LinearFilter;
  const dome = new Mesh(band(), pictureOf(picture, true));
  dome.renderOrder = 2; // only where nothing is before it
  dome.frustumCulled = false;
  return dome;
}

function band() {
  const [low, high] = [90 + BELOW_DEG, 90 - ABOVE_DEG].map((degrees) => (degrees * Math.PI) / 180);
  return new SphereGeometry(RADIUS_M, 48, 16, 0, 2 * Math.PI, high, low - high);
}

/** @param {CanvasRenderingContext2D} pen */
function clouds(pen) {
  for (let k = 0; k < 40; k++) {
    const x = WIDTH * chance(k, 51);
    const y = HORIZON * (0.35 + 0.56 * chance(k, 52));
    const size = 16 + 130 * (1 - y / HORIZON) * (0.5 + chance(k, 53));
    for (let puff = 0; puff < 26; puff++) {
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
  const misty = pen.createLinearGradient(0, HORIZON - height, 0, HORIZON);
  misty.addColorStop(0, color);
  misty.addColorStop(1, HAZE);
  pen.fillStyle = misty;
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
