"""One FMU in some 30 lines of fmpy: the driving function drives a point on a road of our own.

The simulator here knows where its car is, in x and y, and nothing of arc lengths. You see time,
place, speed and why it is driven: along the straight at 70 km/h, slower through the loop, which
crosses the straight, and at 50 km/h behind the sign at 950 m.

    pldf build --only AdaptivePLDF
    python 02_one_fmu.py                     # or name an FMU and its road:
    pldf build --native && pldf route my_road.csv --export my_road.prepared
    python 02_one_fmu.py dist/native/AdaptivePLDF.fmu my_road.prepared
"""

import sys
from pathlib import Path
from shutil import rmtree

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

ROAD = Path(__file__).with_name("my_road.csv")
STEP_S = 0.01

fmu, route_file = sys.argv[1:] or ("dist/AdaptivePLDF.fmu", str(ROAD))
line = np.genfromtxt(ROAD, delimiter=",", names=True, skip_header=1)
model = read_model_description(fmu)
number = {variable.name: variable.valueReference for variable in model.modelVariables}
(reasons,) = (kind.items for kind in model.typeDefinitions if kind.name == "Reason")

folder = extract(fmu)
pldf = FMU2Slave(
    guid=model.guid, unzipDirectory=folder, instanceName="pldf",
    modelIdentifier=model.coSimulation.modelIdentifier,
)  # fmt: skip
pldf.instantiate()
pldf.setString([number["route_file"]], [str(Path(route_file).resolve())])
pldf.setInteger([number["localization"]], [1])  # 1 = XY
inputs = [number[f"vehicle.{name}"] for name in ("x_m", "y_m", "speed_mps", "acceleration_mps2")]

s_m, speed_mps, request_mps2 = 0.0, 15.0, 0.0
pldf.setupExperiment(startTime=0.0)
pldf.enterInitializationMode()
pldf.setReal(inputs, [line["x_m"][0], line["y_m"][0], speed_mps, request_mps2])
pldf.exitInitializationMode()

for k in range(20_000):
    x_m, y_m = (np.interp(s_m, line["s_m"], line[name]) for name in ("x_m", "y_m"))
    pldf.setReal(inputs, [x_m, y_m, speed_mps, request_mps2])
    pldf.setBoolean([number["lever.resume"]], [50 <= k < 80])  # switch it on after half a second
    pldf.doStep(k * STEP_S, STEP_S)
    (request_mps2,) = pldf.getReal([number["acceleration_request_mps2"]])
    speed_mps = max(speed_mps + request_mps2 * STEP_S, 0.0)
    s_m += speed_mps * STEP_S
    if k % 500 == 0:
        (reason,) = pldf.getInteger([number["hmi.reason"]])
        where = f"{k * STEP_S:5.1f} s {s_m:7.1f} m {3.6 * speed_mps:5.1f} km/h"
        print(where, reasons[reason].name)
    if s_m > line["s_m"][-1] - 1.0:
        break
pldf.terminate()  # here the function would learn
pldf.freeInstance()
rmtree(folder, ignore_errors=True)
print(f"at the end of the road after {k * STEP_S:.1f} s")
