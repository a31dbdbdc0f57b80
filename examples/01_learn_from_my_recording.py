"""Learn from a recording of our own: what one drive teaches, where, and why not elsewhere.

The recording has the four columns that are needed: time, arc length, speed, mode. Pedals are
derived from the mode, and what the function drove from the road. You see where the driver
intervened, what was learned from it, and the speeds that the next drive will follow; the profile
is written to a file that the FMUs and ``pldf profiles`` read.

    python 01_learn_from_my_recording.py                 # or name a road and a recording:
    python 01_learn_from_my_recording.py road.xodr drive.csv
"""

import sys
from pathlib import Path

import pldf
from pldf.recordings.offline import explain

KMH_PER_MPS = 3.6
HERE = Path(__file__).parent

road, drive = sys.argv[1:] or (HERE / "my_road.csv", HERE / "my_recording.csv")
route = pldf.open_route(str(road))
learned = pldf.learn(pldf.read_recording(drive), route)

report = explain(learned)
print(f"pedals in {report['rates']['pedal']:.0%} of the time")
for entry in report["interventions"]:
    place = f"{entry['start_m']:.0f} m to {entry['end_m']:.0f} m"
    print(f"intervention from {place}: {entry['told']}")

before_mps, after_mps = pldf.base_profile(route), learned.iteration.learned_mps
print("   place  before   after")
for s_m in range(0, route.nodes, 100):
    speeds = f"{KMH_PER_MPS * before_mps[s_m]:7.1f} {KMH_PER_MPS * after_mps[s_m]:7.1f} km/h"
    print(f"{s_m:6d} m {speeds}")

pldf.write_profile("my_profile.pldf", learned.profile)
print("written to my_profile.pldf")
