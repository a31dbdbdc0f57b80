// Where in its lane the car is, if the person steers: a point that moves along its heading.
// It shows what steering does and feeds no FMU: the way along the road is the vehicle FMU's alone.

/** Lateral acceleration of a full turn of the wheel, in m/s2; slow cars turn by curvature. */
const LATERAL_MAX_MPS2 = 4.0;
const CURVATURE_MAX_PER_M = 0.1;
/** How fast the wheel that nobody turns brings the car back along the road, per second. */
const ALIGNING_PER_S = 1.2;
const HEADING_MAX_RAD = 0.35;
/** Beyond the edge of the road the car does not go. */
const BEYOND_EDGE_M = 1.0;

/** A car on a road with two edges. */
export class Lateral {
  /**
   * @param {(s_m: number) => number} curvature_per_m of the road, positive in left curves
   * @param {{left_m: number, right_m: number}} room from the lane's middle to the edges
   */
  constructor(curvature_per_m, { left_m, right_m }) {
    this.curvature_per_m = curvature_per_m;
    this.left_max_m = left_m + BEYOND_EDGE_M;
    this.right_max_m = right_m + BEYOND_EDGE_M;
    this.lateral_m = 0;
    this.heading_rad = 0;
  }

  /**
   * Advance by one step.
   * @param {number} steering -1 (right) .. 1 (left)
   * @param {number} speed_mps
   * @param {number} s_m
   * @param {number} step_s
   */
  step(steering, speed_mps, s_m, step_s) {
    const turn_per_m = steering * wheelCurvature(speed_mps) - this.curvature_per_m(s_m);
    const back_rad = this.heading_rad * ALIGNING_PER_S * step_s;
    const heading_rad = this.heading_rad + turn_per_m * speed_mps * step_s - back_rad;
    this.heading_rad = within(heading_rad, -HEADING_MAX_RAD, HEADING_MAX_RAD);
    const lateral_m = this.lateral_m + Math.sin(this.heading_rad) * speed_mps * step_s;
    this.lateral_m = within(lateral_m, -this.right_max_m, this.left_max_m);
    if (this.lateral_m !== lateral_m) {
      this.heading_rad = 0;
    }
  }
}

/**
 * Return the curvature of a full turn: gentle where the car is fast.
 * @param {number} speed_mps
 */
function wheelCurvature(speed_mps) {
  return Math.min(CURVATURE_MAX_PER_M, LATERAL_MAX_MPS2 / Math.max(speed_mps * speed_mps, 1));
}

/**
 * @param {number} value
 * @param {number} low
 * @param {number} high
 */
function within(value, low, high) {
  return Math.max(low, Math.min(value, high));
}
