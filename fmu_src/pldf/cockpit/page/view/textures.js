// Pictures painted once when the view begins: asphalt with its lines, grass, sky.
import {
  CanvasTexture,
  ClampToEdgeWrapping,
  RepeatWrapping,
  SRGBColorSpace,
} from "../vendor/three.js";
import { chance } from "./chance.js";

/** @typedef {"dashed" | "solid" | "town"} Marking of the middle: overtaking or not; none at the edges */
/** @typedef {{left_m: number, right_m: number, lines: {at_m: number, kind: "edge" | "middle" | "lane"}[]}} CrossSection */

/** a dash of the middle line and the gap behind it; the picture of the road repeats so */
export const DASH_PERIOD_M = 12;
const DASH_M = 4;
const LINE_M = 0.15;
const WIDTH_PX = 512;
const LENGTH_PX = 1024;

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
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = anisotropy;
  texture.wrapS = texture.wrapT = repeat ? RepeatWrapping : ClampToEdgeWrapping;
  return texture;
}

/**
 * The road from edge to edge, 12 m of it.
 * @param {CrossSection} section @param {Marking} marking @param {number} anisotropy
 */
export function roadTexture(section, marking, anisotropy) {
  const { made, pen } = canvas(WIDTH_PX, LENGTH_PX);
  const width_m = section.left_m + section.right_m;
  const px = WIDTH_PX / width_m;
  pen.fillStyle = "#66686a";
  pen.fillRect(0, 0, WIDTH_PX, LENGTH_PX);
  wheelTracks(pen, section, px);
  grain(pen, WIDTH_PX, LENGTH_PX, 26, 3);
  patches(pen);
  for (const line of section.lines) {
    if (line.kind === "edge" && marking === "town") continue;
    const x = (section.left_m - line.at_m) * px;
    paintLine(pen, x, px, line.kind === "edge" || (line.kind === "middle" && marking === "solid"));
  }
  return textureOf(made, { repeat: true, anisotropy });
}

/** @param {CanvasRenderingContext2D} pen @param {number} x @param {number} px per m @param {boolean} solid */
function paintLine(pen, x, px, solid) {
  const length = solid ? LENGTH_PX : (LENGTH_PX * DASH_M) / DASH_PERIOD_M;
  const width = LINE_M * px;
  pen.fillStyle = "#e9e9e4";
  pen.fillRect(x - width / 2, 0, width, length);
  for (let k = 0; k < length / 3; k++) {
    pen.fillStyle = `rgba(90,92,94,${0.1 + 0.35 * chance(k, 9, Math.round(x))})`;
    pen.fillRect(x - width / 2 + width * chance(k, 1), length * chance(k, 2), 2, 2);
  }
}

/** Where wheels run the road is darker. @param {CanvasRenderingContext2D} pen @param {CrossSection} section @param {number} px */
function wheelTracks(pen, section, px) {
  const sides = section.lines.map((line) => line.at_m).sort((a, b) => a - b);
  for (let k = 1; k < sides.length; k++) {
    for (const off_m of [-0.75, 0.75]) {
      const x = (section.left_m - (sides[k] + sides[k - 1]) / 2 - off_m) * px;
      const track = pen.createLinearGradient(x - 0.5 * px, 0, x + 0.5 * px, 0);
      track.addColorStop(0, "rgba(40,41,44,0)");
      track.addColorStop(0.5, "rgba(40,41,44,0.3)");
      track.addColorStop(1, "rgba(40,41,44,0)");
      pen.fillStyle = track;
      pen.fillRect(x - 0.5 * px, 0, px, LENGTH_PX);
    }
  }
}

/** Mended places and joints: something to see of one's own speed. @param {CanvasRenderingContext2D} pen */
function patches(pen) {
  for (let k = 0; k < 7; k++) {
    pen.fillStyle = `rgba(${k % 2 ? "30,31,33" : "140,142,142"},${0.06 + 0.12 * chance(k, 21)})`;
    const [x, y] = [WIDTH_PX * chance(k, 22), LENGTH_PX * chance(k, 23)];
    pen.fillRect(x, y, 20 + 110 * chance(k, 24), 14 + 80 * chance(k, 25));
  }
  pen.strokeStyle = "rgba(25,26,28,0.55)";
  pen.lineWidth = 1.5;
  for (let k = 0; k < 5; k++) {
    pen.beginPath();
    let [x, y] = [WIDTH_PX * chance(k, 31), LENGTH_PX * chance(k, 32)];
    pen.moveTo(x, y);
    for (let i = 0; i < 8; i++) {
      x += 34 * (chance(k, i, 33) - 0.5);
      y += 26 * chance(k, i, 34);
      pen.lineTo(x, y);
    }
    pen.stroke();
  }
}

/** @param {CanvasRenderingContext2D} pen @param {number} width @param {number} height @param {number} strength @param {number} size */
function grain(pen, width, height, strength, size) {
  const image = pen.getImageData(0, 0, width, height);
  const { data } = image;
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const fine = chance(x, y, 5) - 0.5;
      const coarse = chance(Math.floor(x / size), Math.floor(y / size), 6) - 0.5;
      const change = strength * (fine + coarse);
      const at = 4 * (y * width + x);
      for (let k = 0; k < 3; k++) data[at + k] += change;
    }
  }
  pen.putImageData(image, 0, 0);
}

/** Light and dark of grass, to be multiplied with its colour. @param {number} anisotropy */
export function grassTexture(anisotropy) {
  const size = 256;
  const { made, pen } = canvas(size, size);
  pen.fillStyle = "#d0d0d0";
  pen.fillRect(0, 0, size, size);
  for (let k = 0; k < 2600; k++) {
    const tone = Math.round(120 + 135 * chance(k, 41));
    pen.strokeStyle = `rgba(${tone},${tone},${Math.round(tone * 0.8)},0.4)`;
    const [x, y] = [size * chance(k, 42), size * chance(k, 43)];
    const [dx, dy] = [8 * (chance(k, 44) - 0.5), 4 + 8 * chance(k, 45)];
    for (const [ox, oy] of [[0, 0], [size, 0], [0, size], [-size, 0], [0, -size]]) {
      pen.beginPath();
      pen.moveTo(x + ox, y + oy);
      pen.lineTo(x + dx + ox, y - dy + oy);
      pen.stroke();
    }
  }
  grain(pen, size, size, 20, 2);
  return textureOf(made, { repeat: true, anisotropy });
}
