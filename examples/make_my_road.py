"""Write the two files that the examples read: ``my_road.csv`` and ``my_recording.csv``.

The road: 600 m straight at 70 km/h, a loop to the left that crosses the straight, and 400 m on at
50 km/h. The recording: somebody who presses the gas on the straight, five samples per second and
only the four columns that are needed. In your laboratory both come from measurements.

    python make_my_road.py [FOLDER]
"""

import sys
from pathlib import Path

import numpy as np

STEP_M = 5.0
KMH_PER_MPS = 3.6
# Where the curvature changes its slope, in m, and the curvature there, in 1/m.
PLACES_M = (0.0, 600.0, 650.0, 900.0, 950.0, 1350.0)
CURVATURES_PER_M = (0.0, 0.0, 1.0 / 62.5, 1.0 / 62.5, 0.0, 0.0)
SIGN_M = 950.0


def road() -> str:
    """Return the road as CSV; between the knots everything but the limit is linear."""
    fine_m = np.arange(0.0, PLACES_M[-1] + 0.005, 0.01)
    curvature = np.interp(fine_m, PLACES_M, CURVATURES_PER_M)
    heading = np.concatenate(([0.0], np.cumsum(0.005 * (curvature[1:] + curvature[:-1]))))
    middle = 0.5 * (heading[1:] + heading[:-1])
    x_m = np.concatenate(([0.0], np.cumsum(0.01 * np.cos(middle))))
    y_m = np.concatenate(([0.0], np.cumsum(0.01 * np.sin(middle))))
    lines = ["# a road of ours", "s_m,curvature_per_m,speed_limit_mps,x_m,y_m"]
    for s_m in np.arange(0.0, PLACES_M[-1] + 1.0, STEP_M):
        at = round(100.0 * s_m)
        limit_mps = (70.0 if s_m < SIGN_M else 50.0) / KMH_PER_MPS
        lines.append(f"{s_m:g},{curvature[at]:.6f},{limit_mps:.6f},{x_m[at]:.3f},{y_m[at]:.3f}")
    return "\n".join(lines) + "\n"


def recording() -> str:
    """Return 550 m on the straight: RESUME after 2 s, the gas pressed from 200 to 450 m."""
    lines = ["time_s,s_m,speed_mps,mode"]
    time_s, s_m, speed_mps = 0.0, 0.0, 70.0 / KMH_PER_MPS
    while s_m < 550.0:
        pressed = 200.0 <= s_m < 450.0
        mode = "STANDBY" if time_s < 2.0 else "GAS_OVERRIDE" if pressed else "ACTIVE"
        lines.append(f"{time_s:.1f},{s_m:.2f},{speed_mps:.3f},{mode}")
        wanted_mps = (80.0 if pressed else 70.0) / KMH_PER_MPS
        speed_mps += 0.2 * min(max(wanted_mps - speed_mps, -1.0), 1.0)
        s_m += 0.2 * speed_mps
        time_s += 0.2
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent)
    (folder / "my_road.csv").write_text(road(), encoding="utf-8", newline="\n")
    (folder / "my_recording.csv").write_text(recording(), encoding="utf-8", newline="\n")
