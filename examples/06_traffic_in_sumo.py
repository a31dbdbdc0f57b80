"""The FMUs in a traffic simulator: our car among 50 of SUMO, on the road of the study.

SUMO moves the others and tells which car is ahead of ours; the FMUs move ours, and SUMO is told
where it is. The network is made of the route that the function drives, so both know the same
positions and speeds. You see every ten seconds what is ahead and what the function does about it,
at the end how close it came. Nobody touches a pedal.

    pip install eclipse-sumo traci
    pldf build --native
    python 06_traffic_in_sumo.py             # or name the FMUs' folder and for how many seconds:
    python 06_traffic_in_sumo.py dist/native 60
"""

import runpy
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pldf
import sumo
import traci

STEP_S = 0.01
SUMO_STEP_S = 0.1
CARS = 50
PIECE_M = 50
REACH_M = 200.0
START_M = 5.0
START_MPS = 15.0
BIN = Path(sumo.SUMO_HOME) / "bin"
# From the example before: an FMU by names, what feeds what.
own_master = runpy.run_path(str(Path(__file__).with_name("03_own_master.py")))


def network(route, folder):
    """Write the route as a chain of edges with two lanes; return where each begins, in m."""
    s_m = np.arange(route.nodes)
    speed_mps = pldf.base_profile(route)  # what limits and curves allow
    begins = list(range(0, route.nodes - PIECE_M, PIECE_M))
    ends = [*begins[1:], route.nodes - 1]
    x, y = (np.interp(s_m, route.s_m, line) for line in (route.x_m, route.y_m))
    nodes = [f'<node id="n{s}" x="{x[s]:.3f}" y="{y[s]:.3f}"/>' for s in (*begins, ends[-1])]
    edges = []
    for k, (a, b) in enumerate(zip(begins, ends, strict=True)):
        shape = " ".join(f"{x[s]:.3f},{y[s]:.3f}" for s in range(a, b + 1))
        edges.append(
            f'<edge id="e{k}" from="n{a}" to="n{b}" numLanes="2" length="{b - a}" '
            f'speed="{speed_mps[a:b].max():.3f}" shape="{shape}"/>'
        )
    (folder / "road.nod.xml").write_text(f"<nodes>{''.join(nodes)}</nodes>", encoding="utf-8")
    (folder / "road.edg.xml").write_text(f"<edges>{''.join(edges)}</edges>", encoding="utf-8")
    subprocess.run(
        [BIN / "netconvert", "-n", "road.nod.xml", "-e", "road.edg.xml", "-o", "road.net.xml",
         "--no-internal-links", "--no-turnarounds"],
        cwd=folder, check=True, capture_output=True,
    )  # fmt: skip
    return begins


def traffic(begins, length_m, folder):
    """Write 50 cars along the road, most of them ahead of ours, some behind, and ours."""
    rng = np.random.default_rng(1)
    edges = [f"e{k}" for k in range(len(begins))]
    rows = []
    for number, s in enumerate(np.linspace(60.0, 0.85 * length_m, CARS)):
        k = int(np.searchsorted(begins, s, side="right")) - 1
        rows.append(
            f'<vehicle id="car{number}" type="car" depart="0" departPos="{s - begins[k]:.1f}" '
            f'departLane="{rng.integers(2)}" departSpeed="desired">'
            f'<route edges="{" ".join(edges[k:])}"/></vehicle>'
        )
    rows.append(
        f'<vehicle id="ours" type="ours" depart="0" departPos="{START_M}" departLane="0" '
        f'departSpeed="{START_MPS}"><route edges="{" ".join(edges)}"/></vehicle>'
    )
    types = (
        '<vType id="car" speedFactor="normc(0.75,0.1,0.5,1.0)" sigma="0.5"/>'
        '<vType id="ours" minGap="0" color="1,0,0"/>'  # so that getLeader gives the whole gap
    )
    (folder / "cars.rou.xml").write_text(f"<routes>{types}{''.join(rows)}</routes>", "utf-8")


def lead_of_ours():
    """Return the gap to the car ahead of ours and its speed; None without one in reach."""
    leader = traci.vehicle.getLeader("ours", REACH_M)
    if not leader or leader[1] > REACH_M:
        return None
    return leader[1], traci.vehicle.getSpeed(leader[0])


def step_fmus(parts, connections, lead, at):
    """Step the FMUs up to SUMO's next step; in between, the car ahead keeps its speed."""
    pldf_fmu, vehicle = parts[-1], parts[0]
    begin_m = vehicle.get("s_m")
    for k in range(round(SUMO_STEP_S / STEP_S)):
        own_master["exchange"](connections)
        pldf_fmu.set("lead.present", lead is not None)
        if lead is not None:
            moved_m = k * STEP_S * lead[1] - (vehicle.get("s_m") - begin_m)
            pldf_fmu.set("lead.gap_m", lead[0] + moved_m)
            pldf_fmu.set("lead.speed_mps", lead[1])
        for part in parts:
            part.fmi.doStep(at + k * STEP_S, STEP_S)


def drive(parts, length_m, seconds):
    """Drive ours among the others; return a row per step of SUMO."""
    vehicle, driver, function = parts
    vehicle.set("start_s_m", START_M)
    vehicle.set("start_speed_mps", START_MPS)
    driver.set("kind", 0)  # switches the function on, then hands off
    for part in parts:
        part.fmi.setupExperiment(startTime=0.0)
        part.fmi.enterInitializationMode()
    connections = own_master["wires"](parts)
    own_master["exchange"](connections)
    for part in parts:
        part.fmi.exitInitializationMode()
    traci.simulationStep()
    traci.vehicle.setSpeedMode("ours", 0)  # SUMO shall do as told, and not brake for us
    traci.vehicle.setLaneChangeMode("ours", 0)
    rows = []
    while vehicle.get("s_m") < length_m - 50.0 and len(rows) * SUMO_STEP_S < seconds:
        at, lead, before_m = len(rows) * SUMO_STEP_S, lead_of_ours(), vehicle.get("s_m")
        step_fmus(parts, connections, lead, at)
        # Within its step SUMO moves a car by its new speed: so both are at the same place.
        traci.vehicle.setSpeed("ours", (vehicle.get("s_m") - before_m) / SUMO_STEP_S)
        traci.simulationStep()
        rows.append((at, before_m, vehicle.get("speed_mps"), *(lead or (np.nan, np.nan)),
                     function.get("following.limits")))  # fmt: skip
        if len(rows) % 100 == 1:
            ahead = f"a car {lead[0]:5.1f} m ahead" if lead else "nobody ahead"
            follows = ", follows it" if rows[-1][-1] else ""
            print(f"{at:5.0f} s {before_m:6.0f} m {3.6 * rows[-1][2]:5.1f} km/h  {ahead}{follows}")
    return np.array(rows)


def tell(rows):
    """Print how the drive went."""
    _, _, speed_mps, gap_m, _, follows = rows.T
    share, seconds = 100.0 * follows.mean(), len(rows) * SUMO_STEP_S
    moving = np.where(speed_mps > 5.0, speed_mps, np.nan)
    time_gap_s = np.nanmin(gap_m / moving)
    print(f"{seconds:.0f} s, in {share:.0f} % of them the car ahead limited ours")
    print(f"smallest gap {np.nanmin(gap_m):.1f} m, smallest time gap {time_gap_s:.1f} s")


if __name__ == "__main__":
    fmus = sys.argv[1] if len(sys.argv) > 1 else "dist/native"
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 600.0
    route = pldf.open_route("study")
    with TemporaryDirectory(ignore_cleanup_errors=True) as place:
        traffic(network(route, Path(place)), route.length_m, Path(place))
        traci.start(
            [str(BIN / "sumo"), "-n", f"{place}/road.net.xml", "-r", f"{place}/cars.rou.xml",
             "--step-length", str(SUMO_STEP_S), "--seed", "1", "--no-step-log", "--no-warnings",
             "--collision.action", "warn", "--time-to-teleport", "-1"]
        )  # fmt: skip
        part, models = own_master["Part"], own_master["MODELS"]
        parts = [part(f"{fmus}/{model}.fmu", f"{place}/{model}") for model in models]
        tell(drive(parts, route.length_m, seconds))
        traci.close()
        for one in parts:
            one.fmi.terminate()
            one.fmi.freeInstance()
