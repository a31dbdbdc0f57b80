"""A recording with other names and units than ours: suggest a mapping file, complete it, learn.

The simulator logs milliseconds, kilometres, km/h and its own words for what the function does;
``simulator.csv`` is such a log of the drive in ``my_recording.csv``. The program does what a person
does with an editor: it answers the questions of the suggested map. What is learned is the same.

    python 05_a_simulator_recording.py
"""

from pathlib import Path

import pldf
from pldf.recordings.suggest import suggest_map

HERE = Path(__file__).parent
WORDS = {"STANDBY": "ready", "ACTIVE": "driving", "GAS_OVERRIDE": "driver presses"}

# What the simulator would have logged.
rows = [line.split(",") for line in (HERE / "my_recording.csv").read_text().splitlines()[1:]]
log = ["Time [ms],Station [km],Ego speed [km/h],ACC state"]
for time_s, s_m, speed_mps, mode in rows:
    numbers = (1000.0 * float(time_s), float(s_m) / 1000.0, 3.6 * float(speed_mps))
    log.append(",".join([*map(repr, numbers), WORDS[mode]]))
Path("simulator.csv").write_text("\n".join(log) + "\n")

# pldf check simulator.csv --suggest-map > simulator.toml
text = suggest_map("simulator.csv")
for mode, word in WORDS.items():
    text = text.replace(f'"{word}" = "?"', f'"{word}" = "{mode}"')
Path("simulator.toml").write_text(text)

# pldf learn --route my_road.csv --recording simulator.csv --map simulator.toml --out simulator.pldf
recording = pldf.read_recording("simulator.csv", "simulator.toml")
print(*recording.notes, sep="\n")
learned = pldf.learn(recording, pldf.open_route(str(HERE / "my_road.csv")))
pldf.write_profile("simulator.pldf", learned.profile)
print(f"{learned.iteration.learned_mps[400] * 3.6:.1f} km/h at 400 m from now on")
