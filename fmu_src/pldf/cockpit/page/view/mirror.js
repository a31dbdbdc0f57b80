// The rear-view mirror.
import {
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  WebGLRenderTarget,
} from "../vendor/three.js";
import { pictureOf } from "./materials.js";

const WIDTH_PX = 384;
const HEIGHT_PX = 96;
const SHARE = 0.24; // of the picture's width
const ASIDE = 0.1;
const TOP = 0.03;
// In a narrow window it hangs below the buttons that the page has at the top.
const NARROW_PX = 700;
const BUTTONS_PX = 76;
const FOV_DEG = 13; // upright
const SIGHT_M = 2600; // as far as the sky
const FRAME_SHARE = 0.05;

export class Mirror {
  /**
   * @param {number} side +1: the driver sits on the left and it hangs on the right, -1: the other way round
   */
  constructor(side) {
    this.side = side;
    this.target = new WebGLRenderTarget(WIDTH_PX, HEIGHT_PX, { minFilter: LinearFilter });
    this.camera = new PerspectiveCamera(FOV_DEG, WIDTH_PX / HEIGHT_PX, 2.5, SIGHT_M);
    this.camera.rotation.order = "YXZ";
    this.lens = new OrthographicCamera(0, 1, 1, 0, -1, 1);
    this.scene = new Scene();
    this.glass = new Mesh(flipped(), pictureOf(this.target.texture));
    this.frame = new Mesh(new PlaneGeometry(1, 1), new MeshBasicMaterial({ color: 0x15171a }));
    this.glass.position.z = 0.1;
    this.scene.add(this.frame, this.glass);
  }

  /** @param {number} width @param {number} height */
  resize(width, height) {
    const [w, h] = [SHARE, (SHARE * width * HEIGHT_PX) / WIDTH_PX / height];
    this.glass.scale.set(w, h, 1);
    const top = width < NARROW_PX ? BUTTONS_PX / height : TOP;
    this.glass.position.set(0.5 + ASIDE * this.side, 1 - h / 2 - top, 0.1);
    this.frame.scale.set(w * (1 + FRAME_SHARE), h * (1 + 4 * FRAME_SHARE), 1);
    this.frame.position.set(this.glass.position.x, this.glass.position.y, 0);
  }

  /**
   * See what is behind.
   * @param {import("../vendor/three.js").WebGLRenderer} renderer
   * @param {import("../vendor/three.js").Scene} scene
   * @param {PerspectiveCamera} eye
   */
  see(renderer, scene, eye) {
    this.camera.position.copy(eye.position);
    this.camera.rotation.set(-eye.rotation.x, eye.rotation.y + Math.PI, 0);
    renderer.setRenderTarget(this.target);
    renderer.render(scene, this.camera);
    renderer.setRenderTarget(null);
  }

  /** Show it over the picture. @param {import("../vendor/three.js").WebGLRenderer} renderer */
  show(renderer) {
    renderer.autoClear = false;
    renderer.render(this.scene, this.lens);
    renderer.autoClear = true;
  }

  dispose() {
    this.target.dispose();
    for (const part of [this.glass, this.frame]) {
      part.geometry.dispose();
      part.material.dispose();
    }
  }
}

/** What is on the left behind us is on the left of a mirror. */
function flipped() {
  const plane = new PlaneGeometry(1, 1);
  const uv = plane.getAttribute("uv");
  for (let k = 0; k < uv.count; k++) uv.setX(k, 1 - uv.getX(k));
  return plane;
}
