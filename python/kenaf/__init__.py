"""Simulation of tracked robots, recorded runs, and the diagnosis of what differs between the two.

    import kenaf

    run = kenaf.simulate("straight", values={"drive_lag": 0.05})
    run["t_s"], run["x_m"]                     # NumPy arrays of shape (rows,)

    runs = kenaf.simulate_all([kenaf.Simulation("straight", seed=seed) for seed in range(100)])   # on all cores

    report = kenaf.diagnose("real")            # a folder of recorded runs
    report.named                               # ["drive_lag"]

Units are SI, angles radians. World frame: z up. Body frame: x forward, y left, z up; pitch is positive nose down. The
columns of a run are those of the page logs.md.

`from kenaf import hrt` controls a robot, real or simulated: see kenaf.hrt.

Errors. ValueError: an argument is wrong; InputError, a ValueError: a file is, with its name, line and column.
RuntimeError: a file cannot be written. KeyboardInterrupt ends long calculations.

Threads. All functions may be called from any thread; calculations run without the interpreter's lock.
"""

from kenaf._core import InputError
from kenaf.diagnosis import (
    ChannelGap,
    Dependence,
    Effect,
    Gap,
    Interval,
    PhaseGap,
    Proposal,
    Ranked,
    Report,
    Stage,
    Value,
    diagnose,
    read_report,
)
from kenaf.runs import Dataset, Run, read_run, read_runs, write_run, write_runs
from kenaf.simulation import (
    Commands,
    Manoeuvre,
    Parameter,
    Simulation,
    manoeuvres,
    noise,
    parameters,
    robots,
    simulate,
    simulate_all,
    worlds,
)

__all__ = [
    "ChannelGap",
    "Commands",
    "Dataset",
    "Dependence",
    "Effect",
    "Gap",
    "InputError",
    "Interval",
    "Manoeuvre",
    "Parameter",
    "PhaseGap",
    "Proposal",
    "Ranked",
    "Report",
    "Run",
    "Simulation",
    "Stage",
    "Value",
    "diagnose",
    "manoeuvres",
    "noise",
    "parameters",
    "read_report",
    "read_run",
    "read_runs",
    "robots",
    "simulate",
    "simulate_all",
    "worlds",
    "write_run",
    "write_runs",
]
