// What faces are painted with: shaders of a few instructions, since on machines without a graphics
// card the processor runs them for each of a million pixels. Colours are those of the screen
// throughout; light is in the colours of the corners, haze is reckoned at the corners.
import { DoubleSide, ShaderMaterial } from "../vendor/three.js";

/** @typedef {import("../vendor/three.js").Texture} Texture */

/** colour of the haze in which far things are lost */
export const HAZE_HEX = 0xb9cfd6;
/** so far one sees, and from where on the haze begins (m) */
export const SIGHT_M = 1200;
const CLEAR_M = 260;

const HAZE_GLSL = `vec3(${[16, 8, 0].map((bits) => (((HAZE_HEX >> bits) & 255) / 255).toFixed(4)).join(", ")})`;

/**
 * @param {{picture?: boolean, light?: boolean, far?: boolean, cut?: boolean}} kind with a picture, with
 *   colours at the corners, hazy from afar, cut out where its picture is transparent
 */
function shaders({ picture = false, light = false, far = false, cut = false }) {
  const given = (/** @type {boolean} */ there, /** @type {string} */ line) => (there ? line : "");
  const vertexShader = `
    ${given(picture, "varying vec2 at;")}
    ${given(light, "attribute vec3 color; varying vec3 tint;")}
    ${given(far, "varying float hazy;")}
    void main() {
      vec4 seen = modelViewMatrix * vec4(position, 1.0);
      ${given(picture, "at = uv;")}
      ${given(light, "tint = color;")}
      ${given(far, `hazy = clamp((-seen.z - ${CLEAR_M.toFixed(1)}) / ${(SIGHT_M - CLEAR_M).toFixed(1)}, 0.0, 1.0);`)}
      gl_Position = projectionMatrix * seen;
    }`;
  const fragmentShader = `
    ${given(picture, "uniform sampler2D map; varying vec2 at;")}
    ${given(light, "varying vec3 tint;")}
    ${given(far, "varying float hazy;")}
    void main() {
      vec4 paint = ${picture ? "texture2D(map, at)" : "vec4(1.0)"};
      ${given(cut, "if (paint.a < 0.5) discard;")}
      ${given(light, "paint.rgb *= tint;")}
      ${given(far, `paint.rgb = mix(paint.rgb, ${HAZE_GLSL}, hazy);`)}
      gl_FragColor = vec4(paint.rgb, 1.0);
    }`;
  return { vertexShader, fragmentShader };
}

/** Faces with colours. */
export const SOLID = new ShaderMaterial(shaders({ light: true, far: true }));

/** A surface: its picture times the colours at its corners. @param {Texture} map */
export function surfaceOf(map) {
  return new ShaderMaterial({
    ...shaders({ picture: true, light: true, far: true }),
    uniforms: { map: { value: map } },
  });
}

/**
 * The surface on which lines are painted: a little farther away than it is.
 * @param {Texture} map
 */
export function asphaltOf(map) {
  const material = surfaceOf(map);
  material.polygonOffset = true;
  material.polygonOffsetFactor = 2;
  material.polygonOffsetUnits = 8;
  return material;
}

/** A plate with a picture, as a sign. @param {Texture} map */
export function plateOf(map) {
  return new ShaderMaterial({
    ...shaders({ picture: true, far: true, cut: true }),
    uniforms: { map: { value: map } },
  });
}

/** A picture as it is. @param {Texture} map */
export function pictureOf(map) {
  return new ShaderMaterial({ ...shaders({ picture: true }), uniforms: { map: { value: map } } });
}

/** Colours behind all else. */
export function skyPaint() {
  return new ShaderMaterial({ ...shaders({ light: true }), side: DoubleSide, depthWrite: false });
}
