"""Simulation of manoeuvres: one by one, or any number on all cores."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from kenaf import _core
from kenaf.runs import Run


@dataclass(frozen=True, eq=False)
class Commands:
    """Commands of your own, from the world's start pose on. Each holds until the next; the last time ends the run."""

    t_s: npt.ArrayLike
    """Times of the commands, shape (n,), increasing from 0 on."""
    track_mps: npt.ArrayLike
    """Speeds of the left and the right track, shape (n, 2)."""
    flipper_rad: npt.ArrayLike | None = None
    """Angles of the flippers front left, front right, rear left, rear right, shape (n, 4); None: as described."""
    name: str = "commands"
    """The name of the run's manoeuvre."""


@dataclass(frozen=True, eq=False)
class Simulation:
    """One run to simulate. The same values give the same run, bit for bit, on any number of cores; the defaults are
    those of `kenaf-gap simulate`, whose run number k is that of repeat=k. dataclasses.replace() changes single values."""

    manoeuvre: Union[str, Run, Commands]
    """A shipped name (kenaf.manoeuvres()), the path of a TOML file, "replay:FILE.csv"; a run, whose commands are
    replayed from its first pose; or commands of your own."""
    robot: str = "kenaf"
    """A shipped name (kenaf.robots()), or the path of a TOML file."""
    world: str = ""
    """A shipped name (kenaf.worlds()), or the path of an SDF file; "": the manoeuvre's own, for commands "flat"."""
    values: Mapping[str, float] = field(default_factory=dict)
    """Numbers in which the robot differs from its description: names of kenaf.parameters(), such as "drive_lag" and
    "track.friction_across"."""
    physics: Mapping[str, float] = field(default_factory=dict)
    """time_step_s, solver_iterations, contact_stiffness_npm, contact_damping_nspm."""
    seed: int = 1
    """Of noise and scatter."""
    repeat: int = 0
    """Repeats of one seed have different noise and scatter."""
    noise: float = 1.0
    """Factor of the noise of all sensors; 0: none."""
    scatter: float = 1.0
    """Factor of the scatter of start poses, 5 mm in x and y and 0.01 rad in yaw; 0: none. Not for replays."""
    sample_period_s: float = 0.01
    """Time between rows, and between commands; a multiple of the time step."""


def _commands_for_core(commands: Commands) -> tuple[Any, Any, Any]:
    t_s = np.asarray(commands.t_s, dtype=np.float64)
    if t_s.ndim != 1 or len(t_s) < 2 or t_s[0] != 0 or not np.all(np.diff(t_s) > 0):
        raise ValueError("t_s: must increase from 0 on, and have at least two times")
    for name, values in (("track_mps", commands.track_mps), ("flipper_rad", commands.flipper_rad)):
        if values is not None and not np.all(np.isfinite(np.asarray(values, dtype=np.float64))):
            raise ValueError(f"{name}: has a value that is not finite")
    return t_s, commands.track_mps, commands.flipper_rad


def _for_core(simulation: Simulation) -> dict[str, Any]:
    asked: dict[str, Any] = {**vars(simulation), "manoeuvre": None, "run": None, "commands": None}
    manoeuvre = simulation.manoeuvre
    if isinstance(manoeuvre, str):
        asked["manoeuvre"] = asked["name"] = manoeuvre
    elif isinstance(manoeuvre, Run):
        asked.update(run=dict(manoeuvre), name=manoeuvre.manoeuvre, world=simulation.world or manoeuvre.world)
    elif isinstance(manoeuvre, Commands):
        asked.update(commands=_commands_for_core(manoeuvre), name=manoeuvre.name, world=simulation.world or "flat")
    else:
        raise TypeError(f"manoeuvre: is a {type(manoeuvre).__name__}, not a name, a Run or Commands")
    asked["values"] = dict(simulation.values)
    asked["physics"] = dict(simulation.physics)
    return asked


def simulate_all(
    simulations: Iterable[Simulation],
    *,
    jobs: int = 0,
    columns: Sequence[str] = (),
    progress: Callable[[int], None] | None = None,
) -> list[Run]:
    """Simulates any number of runs on `jobs` threads (0: one per core), and returns them in the order asked.

    columns: those to keep, in this order, to save memory; (): all. t_s must be among them.
    progress: called some ten times a second with the number of finished runs.

    Raises ValueError, before anything is simulated, if a simulation cannot be made as asked; InputError for a file. A
    simulation that goes wrong does not raise: its Run has a `fault`, and its rows up to there. Warns of elements of a
    world that the simulator does not support."""
    asked = [_for_core(simulation) for simulation in simulations]
    if columns and "t_s" not in columns:
        raise ValueError("columns: t_s must be among them")
    outs = _core.simulate(asked, jobs, list(columns), progress)
    return [
        Run(out.pop("columns"), manoeuvre=one["name"], **{**out, "world": one["world"] or out["world"]})
        for one, out in zip(asked, outs)
    ]


def simulate(manoeuvre: Union[str, Run, Commands], **values: Any) -> Run:
    """Simulates one run: simulate_all() of Simulation(manoeuvre, **values) alone."""
    return simulate_all([Simulation(manoeuvre, **values)])[0]


@dataclass(frozen=True)
class Manoeuvre:
    """A shipped manoeuvre."""

    name: str
    summary: str
    world: str
    at_most_s: float
    """Its longest duration."""


@dataclass(frozen=True)
class Parameter:
    """A number in which a robot may differ from its description: a name of Simulation.values."""

    name: str
    """ "drive_lag" and "command_slew:slowness_s2pm" for effects, "track.friction_across" for numbers of the description."""
    unit: str
    """ "m", "s^2/m"; "1" for a ratio."""
    stage: str
    """Where it acts: "command", "drive", "body", "contact", "terrain", "sensor"."""
    summary: str
    neutral: float
    """Without the effect; for a number of the description the described value."""
    present: float
    """In the description, which may have effects."""
    min: float
    """The range in which a diagnosis searches."""
    max: float
    is_number_of_description: bool


def robots() -> list[str]:
    """Returns the names of the shipped robots."""
    return _core.robots()


def worlds() -> list[str]:
    """Returns the names of the shipped worlds."""
    return _core.worlds()


def manoeuvres() -> list[Manoeuvre]:
    """Returns the shipped manoeuvres."""
    return [Manoeuvre(**one) for one in _core.manoeuvres()]


def parameters(robot: str = "kenaf") -> list[Parameter]:
    """Returns what a diagnosis of a robot searches: effects and numbers of its description."""
    return [Parameter(**one) for one in _core.parameters(robot)]


def noise(robot: str = "kenaf", scale: float = 1.0) -> dict[str, float]:
    """Returns the noise of simulated columns, 1 sigma in the column's unit, as Dataset.noise takes it."""
    return _core.noise_of(robot, scale)

