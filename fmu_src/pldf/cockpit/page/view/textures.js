// Pictures painted once when the view begins: asphalt and grass.
import { CanvasTexture, ClampToEdgeWrapping, RepeatWrapping } from "../vendor/three.js";
import { chance } from "./chance.js";

/** @typedef {import("./profile.js").CrossSection} CrossSection */

/** so much of the road one picture shows, before it comes again */
export const ASPHALT_M = 16;
/** side of the land that one picture of grass covers */
export const GRASS_M = 5;
const ASPHALT_PX = [512, 1024];
const GRASS_PX = 256;
const GRAIN_PX = 128;

/** @param {number} width @param {number} height */
export function canvas(width, height) {
  const made = document.createElement("canvas");
  made.width = width;
  made.height = height;
  const pen = made.getContext("2d");
  if (!pen) throw new Error("this browser cannot paint on a canvas");
  return { made, pen };
}

/** @param {HTMLCanvasElement} picture */
export function textureOf(picture, { repeat = false, anisotropy = 1 } = {}) {
  const texture = new CanvasTexture(picture);
  texture.anisotropy = anisotropy;
  texture.wrapS = texture.wrapT = repeat ? RepeatWrapping : ClampToEdgeWrapping;
  return texture;
}

/**
 * The road from edge to edge, without its lines.
 * @param {CrossSection} section
 * @param {number} anisotropy
 */
export function asphaltTexture(section, anisotropy) {
  const [width, height] = ASPHALT_PX;
  const { made, pen } = canvas(width, height);
  pen.fillStyle = "#7b7d80";
  pen.fillRect(0, 0, width, height);
  const px = width / (section.left_m + section.right_m);
  for (const at_m of wheelTracks(section)) track(pen, (section.left_m - at_m) * px, px);
  patches(pen);
  cracks(pen);
  pen.globalCompositeOperation = "overlay";
  pen.fillStyle = pen.createPattern(grain(0.26), "repeat") ?? "#808080";
  pen.fillRect(0, 0, width, height);
  return textureOf(made, { repeat: true, anisotropy });
}

/**
 * Where wheels run: beside the middle of each lane.
 * @param {CrossSection} section
 * @returns {number[]}
 */
function wheelTracks({ lines }) {
  const edges = lines.map((line) => line.at_m).sort((a, b) => a - b);
  const middles = edges.slice(1).map((at, k) => (at + edges[k]) / 2);
  return middles.flatMap((at) => [at - 0.75, at + 0.75]);
}

/** @param {CanvasRenderingContext2D} pen @param {number} x @param {number} px per m */
function track(pen, x, px) {
  const dark = pen.createLinearGradient(x - 0.55 * px, 0, x + 0.55 * px, 0);
  dark.addColorStop(0, "rgba(48,49,52,0)");
  dark.addColorStop(0.5, "rgba(48,49,52,0.32)");
  dark.addColorStop(1, "rgba(48,49,52,0)");
  pen.fillStyle = dark;
  pen.fillRect(x - 0.55 * px, 0, 1.1 * px, ASPHALT_PX[1]);
}

/** Mended places: something to see of one's own speed. @param {CanvasRenderingContext2D} pen */
function patches(pen) {
  const [width, height] = ASPHALT_PX;
  for (let k = 0; k < 9; k++) {
    pen.fillStyle = `rgba(${k % 2 ? "40,41,44" : "165,166,166"},${0.1 + 0.14 * chance(k, 21)})`;
    const [x, y] = [width * chance(k, 22), height * chance(k, 23)];
    pen.fillRect(x, y, 20 + 110 * chance(k, 24), 14 + 60 * chance(k, 25));
  }
}

/** @param {CanvasRenderingContext2D} pen */
function cracks(pen) {
  const [width, height] = ASPHALT_PX;
  pen.strokeStyle = "rgba(30,31,33,0.6)";
  pen.lineWidth = 2;
  for (let k = 0; k < 6; k++) {
    pen.beginPath();
    let [x, y] = [width * chance(k, 31), height * chance(k, 32)];
    pen.moveTo(x, y);
    for (let i = 0; i < 8; i++) {
      x += 34 * (chance(k, i, 33) - 0.5);
      y += 22 * chance(k, i, 34);
      pen.lineTo(x, y);
    }
    pen.stroke();
  }
}

/** Light and dark of grass, to be multiplied with its colour. @param {number} anisotropy */
export function grassTexture(anisotropy) {
  const { made, pen } = canvas(GRASS_PX, GRASS_PX);
  pen.fillStyle = "#d8d8d4";
  pen.fillRect(0, 0, GRASS_PX, GRASS_PX);
  for (let k = 0; k < 1800; k++) {
    const tone = Math.round(130 + 125 * chance(k, 41));
    pen.strokeStyle = `rgba(${tone},${tone},${Math.round(tone * 0.8)},0.45)`;
    const [x, y] = [GRASS_PX * chance(k, 42), GRASS_PX * chance(k, 43)];
    blade(pen, x, y, 8 * (chance(k, 44) - 0.5), 4 + 8 * chance(k, 45));
  }
  return textureOf(made, { repeat: true, anisotropy });
}

/**
 * Also where the picture goes on.
 * @param {CanvasRenderingContext2D} pen
 * @param {number} x
 * @param {number} y
 * @param {number} dx
 * @param {number} dy
 */
function blade(pen, x, y, dx, dy) {
  pen.beginPath();
  for (const [ox, oy] of [
    [0, 0],
    [GRASS_PX, 0],
    [0, GRASS_PX],
    [-GRASS_PX, 0],
  ]) {
    pen.moveTo(x + ox, y + oy);
    pen.lineTo(x + dx + ox, y - dy + oy);
  }
  pen.stroke();
}

/** Grey of every pixel by chance. @param {number} strength */
function grain(strength) {
  const { made, pen } = canvas(GRAIN_PX, GRAIN_PX);
  const image = pen.getImageData(0, 0, GRAIN_PX, GRAIN_PX);
  for (let k = 0; k < GRAIN_PX * GRAIN_PX; k++) {
    const [x, y] = [k % GRAIN_PX, Math.floor(k / GRAIN_PX)];
    const coarse = chance(x >> 2, y >> 2, 6) - 0.5;
    const tone = 128 + 127 * strength * (chance(k, 5) - 0.5 + coarse);
    image.data.set([tone, tone, tone, 255], 4 * k);
  }
  pen.putImageData(image, 0, 0);
  return made;
}
