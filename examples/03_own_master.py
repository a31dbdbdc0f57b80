"""The three FMUs in a master loop of our own: one driver, two drives, what was learned in between.

An input is fed by the output of the same name; an input ``vehicle.NAME`` by the vehicle's ``NAME``.
All three step with the values of the last communication point. You see the share of the time in
which the driver's pedals and lever corrected the function: first with the base profile (A2), then
with what that drive taught (B1). It is ``pldf drive`` in one page.

    pldf build
    python 03_own_master.py                  # or name the FMUs' folder and the road:
    python 03_own_master.py dist/native my_road.prepared
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

# The vehicle first: the others plan from where it is.
MODELS = ("LongitudinalVehicle", "ScriptedDriver", "AdaptivePLDF")
STEP_S = 0.01
ROAD_M = 1350.0
PHASES = {
    "A2": {"apply_learned": False, "learn_faithful": True},
    "B1": {"apply_learned": True, "learn_faithful": True},
}


class Part:
    """One FMU, its values by name."""

    def __init__(self, path, folder):
        model = read_model_description(path)
        self.name = model.modelName
        self.variables = {variable.name: variable for variable in model.modelVariables}
        self.fmi = FMU2Slave(
            guid=model.guid, unzipDirectory=extract(path, folder), instanceName=self.name,
            modelIdentifier=model.coSimulation.modelIdentifier,
        )  # fmt: skip
        self.fmi.instantiate()

    def names(self, causality):
        """Return the names of the inputs, outputs or parameters."""
        return [v.name for v in self.variables.values() if v.causality == causality]

    def set(self, name, value):
        """Set a variable; enumerations are numbers."""
        variable = self.variables[name]
        kind = {"Enumeration": "Integer"}.get(variable.type, variable.type)
        getattr(self.fmi, f"set{kind}")([variable.valueReference], [value])

    def get(self, name):
        """Return the value of a variable."""
        variable = self.variables[name]
        kind = {"Enumeration": "Integer"}.get(variable.type, variable.type)
        return getattr(self.fmi, f"get{kind}")([variable.valueReference])[0]


def wires(parts):
    """Return (source, output, target, input) of all connections."""
    found = []
    for target in parts:
        for name in target.names("input"):
            for source in parts:
                vehicle = source.name == "LongitudinalVehicle"
                output = name.removeprefix("vehicle.") if vehicle else name
                if source is not target and output in source.names("output"):
                    found.append((source, output, target, name))
    return found


def exchange(connections):
    """Read all outputs, then set all inputs."""
    for target, name, value in [(t, i, s.get(o)) for s, o, t, i in connections]:
        target.set(name, value)


def drive(parts, parameters):
    """Drive to the end of the road; return the rates, in % of the time."""
    pldf = parts[-1]
    for part in parts:
        for name, value in parameters.items():
            if name in part.variables:
                part.set(name, value)
        part.fmi.setupExperiment(startTime=0.0)
        part.fmi.enterInitializationMode()
    connections = wires(parts)
    exchange(connections)
    for part in parts:
        part.fmi.exitInitializationMode()
    k = 0
    while parts[0].get("s_m") < ROAD_M:
        exchange(connections)
        for part in parts:
            part.fmi.doStep(k * STEP_S, STEP_S)
        k += 1
    rates = [100.0 * pldf.get(f"rate.{kind}") for kind in ("pedal", "set_speed", "combined")]
    for part in parts:
        part.fmi.terminate()  # learning and saving happen here
        part.fmi.freeInstance()
    return rates


if __name__ == "__main__":
    road = str(Path(__file__).with_name("my_road.csv"))
    fmus, route_file = sys.argv[1:] or ("dist", road)
    with TemporaryDirectory(ignore_cleanup_errors=True) as store:
        for phase, settings in PHASES.items():
            parts = [Part(f"{fmus}/{model}.fmu", f"{store}/{phase}/{model}") for model in MODELS]
            same = {"route_file": str(Path(route_file).resolve()), "profile_store": store}
            pedal, set_speed, combined = drive(parts, {**same, **settings})
            print(f"{phase}: pedal {pedal:.1f} %, lever {set_speed:.1f} %, either {combined:.1f} %")
