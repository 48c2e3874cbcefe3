"""The diagnosis of the gap between simulation and recorded runs, with its report as objects.

The page gap-report.md explains each number, gap-method.md how it is found. Numbers are in SI units; NaN is unknown.
"""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, TypeVar, Union

import numpy as np

from kenaf import _core
from kenaf.runs import Dataset, FloatArray, PathLike, write_runs

_FORMAT = "kenaf-gap-report/2"
_Members = TypeVar("_Members")


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _numbers(values: Mapping[str, float | None]) -> dict[str, float]:
    return {name: _number(value) for name, value in values.items()}


def _members(kind: type[_Members], read: Mapping[str, Any], **made: Any) -> _Members:
    """Makes a dataclass of the members of `read` that have the names of its own, with NaN for null, and of `made`."""
    of_kind: Any = kind
    names = [member.name for member in fields(of_kind) if member.name in read and member.name not in made]
    return kind(**{name: math.nan if read[name] is None else read[name] for name in names}, **made)


@dataclass(frozen=True)
class Interval:
    """An estimate with its 95 % confidence interval."""

    value: float
    low: float
    high: float

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high

    @staticmethod
    def _of(value: float | None, ends: Sequence[float | None]) -> Interval:
        return Interval(_number(value), _number(ends[0]), _number(ends[1]))


@dataclass(frozen=True)
class Value(Interval):
    """The estimated value of a parameter."""

    spread: float
    """Standard deviation between manoeuvres."""
    unit: str
    nominal: float
    """In the robot's description."""

    @staticmethod
    def _of_json(read: Mapping[str, Any]) -> Value:
        low, high = (_number(end) for end in read["ci95"])
        return _members(Value, read, low=low, high=high)


@dataclass(frozen=True)
class Effect:
    """An effect of a stage's best model, with or without a name."""

    name: str
    """As Simulation.values takes it if the effect has one parameter or is a number of the description."""
    parameters: dict[str, Value]
    """By the parameter's name."""
    explains: float
    """Its part of the stage's squared gap, 0 to 1, on runs held out of the fit."""
    explains_by_manoeuvre: float
    """The same on manoeuvres held out."""
    channels: str
    """The kind of channels where it acts most: "track speed"."""
    explains_in_channels: float
    """Its part there."""
    evidence: float
    """By how much the deviance falls with it."""
    at_bound: bool
    """Whether the value is at the end of its range."""
    is_named: bool
    rivals: list[str]
    """Effects that do as well in its place, itself first."""
    partners: list[str]
    """Effects with which it shares what none explains alone."""
    explains_with_partners: float
    doubts: list[str]
    """Why it is not named, in sentences."""

    @property
    def value(self) -> Value:
        """The value of its first parameter, which for most effects is the only one."""
        return next(iter(self.parameters.values()))

    @staticmethod
    def _of(read: Mapping[str, Any]) -> Effect:
        return _members(
            Effect,
            read,
            parameters={name: Value._of_json(value) for name, value in read["parameters"].items()},
            channels=read["acts_most_in"]["channels"],
            explains_in_channels=_number(read["acts_most_in"]["explains"]),
        )


@dataclass(frozen=True)
class Gap:
    """The size of the gap on runs held out of the fit: rms over all channels, in units of noise."""

    before: float
    """Of the nominal simulation."""
    after: float
    """Of the best model."""
    floor: float
    """That noise and the spread of repeats leave."""
    shrink: Interval
    """1 - (after - floor) / (before - floor)."""
    shrink_by_manoeuvre: float
    """The same with all repeats of a manoeuvre held out together."""
    before_si: dict[str, float]
    """rms by channel, in the channel's unit."""
    after_si: dict[str, float]
    heldout_runs: list[str]

    @staticmethod
    def _of(read: Mapping[str, Any]) -> Gap:
        return _members(
            Gap,
            read,
            shrink=Interval._of(read["shrink"], read["shrink_ci95"]),
            before_si=_numbers(read["before_si"]),
            after_si=_numbers(read["after_si"]),
        )


@dataclass(frozen=True)
class Dependence:
    """A dependence of what is left: the residual of `channel` follows intercept + slope * `on`."""

    channel: str
    on: str
    share: float
    """Of the residual, on held-out runs."""
    slope: float
    intercept: float
    unit: str
    on_unit: str
    words: str
    look_at: list[str]
    """Keys of the description and effects."""


@dataclass(frozen=True)
class ChannelGap:
    """The gap in one channel, in its unit."""

    channel: str
    unit: str
    rms: float
    floor: float
    share: float


@dataclass(frozen=True)
class PhaseGap:
    """The gap in a phase of a manoeuvre, with the place in its middle."""

    manoeuvre: str
    run: str
    phase: str
    from_s: float
    to_s: float
    x_m: float
    y_m: float
    share: float


@dataclass(frozen=True)
class Ranked:
    """A candidate alone, fitted to all runs."""

    name: str
    values: dict[str, float]
    explains: float
    evidence: float


@dataclass(frozen=True)
class Proposal:
    """A manoeuvre that would separate effects which these runs cannot."""

    manoeuvre: str
    world: str
    separates: list[str]
    expected_score: float
    """In standard deviations, for one run."""
    suffices: bool
    duration_s: float
    largest_tilt_rad: float
    fall_m: float
    impact_mps2: float
    current_share: float
    fails: bool
    """Whether the simulated robot fails in it."""
    words: str


@dataclass(frozen=True)
class Stage:
    """The verdict on one stage: from command to drive, from drive to body, or from body to sensor."""

    name: str
    verdict: str
    """ "none", "named", "ambiguous" or "unknown"."""
    named: list[str]
    ambiguous_sets: list[list[str]]
    complete: bool
    """Whether what is left is within noise and spread."""
    share_of_gap: float
    """Of the squared gap of all stages."""
    explains: Interval
    """Share of the squared gap that the best model removes on held-out runs, 0 to 1."""
    gap: Gap
    effects: list[Effect]
    """The best model."""
    left: float
    """Share of the gap that the best model leaves."""
    depends_on: list[Dependence]
    p_gap: float
    """p value of the gap without an effect."""
    p_left: float
    """p value of what is left if the best model is right."""
    noise_from_repeats: bool
    channels: list[ChannelGap]
    """Where the gap is."""
    phases: list[PhaseGap]
    """When it is."""
    ranking: list[Ranked]
    """Each candidate alone, best first."""
    shown: list[str]
    """Effects that these runs show."""
    angle_deg: FloatArray
    """Between each two of them, shape (len(shown), len(shown)): 0 the same, 90 nothing in common."""

    @staticmethod
    def _of(read: Mapping[str, Any]) -> Stage:
        shown = read["isolability"]["effects"]
        return _members(
            Stage,
            read,
            name=read["stage"],
            explains=Interval._of(read["explains"], read["explains_ci95"]),
            gap=Gap._of(read["gap"]),
            effects=[Effect._of(one) for one in read["effects"]],
            left=_number(read["left"]["share"]),
            depends_on=[_members(Dependence, one) for one in read["left"]["depends_on"]],
            channels=[_members(ChannelGap, one) for one in read["where"]["channels"]],
            phases=[_members(PhaseGap, one) for one in read["where"]["phases"]],
            ranking=[_members(Ranked, one, values=_values(one["parameters"])) for one in read["ranking"]],
            shown=shown,
            angle_deg=np.array(read["isolability"]["angle_deg"], dtype=np.float64).reshape(len(shown), len(shown)),
        )


def _values(parameters: Mapping[str, Any]) -> dict[str, float]:
    return {name: _number(parameter["value"]) for name, parameter in parameters.items()}


@dataclass(frozen=True)
class Report:
    """What a diagnosis found. print(report) shows the summary of one screen."""

    verdict: str
    """ "none" if all stages are; "ambiguous" if one is; else "named" if one is; else "unknown"."""
    named: list[str]
    ambiguous_sets: list[list[str]]
    complete: bool
    """Whether what is left in every stage is within noise and spread."""
    stages: list[Stage]
    """Those that the runs measure, from command to sensor."""
    doubts: list[str]
    """Why effects of best models are not named, in sentences."""
    next_manoeuvres: list[Proposal]
    warnings: list[str]
    """What was left out or looks wrong."""
    text: str = ""
    """The summary; "" of a report that was read from a file."""
    html: str = ""
    """The page report.html; likewise."""
    robot_toml: str = ""
    """The corrected robot's description; likewise, and "" if there is nothing to correct."""

    @property
    def effects(self) -> list[Effect]:
        """The effects of all stages' best models."""
        return [effect for stage in self.stages for effect in stage.effects]

    @property
    def values(self) -> dict[str, float]:
        """The named effects with their values, as Simulation.values takes them."""
        found: dict[str, float] = {}
        for effect in self.effects:
            if effect.is_named:
                several = len(effect.parameters) > 1
                for name, value in effect.parameters.items():
                    found[f"{effect.name}:{name}" if several else effect.name] = value.value
        return found

    @property
    def main_stage(self) -> Stage | None:
        """The stage with most of the gap; None without a gap."""
        with_gap = [stage for stage in self.stages if stage.verdict != "none"]
        return max(with_gap, key=lambda stage: stage.share_of_gap) if with_gap else None

    def __str__(self) -> str:
        return self.text or f"{self.verdict.upper()}: {', '.join(self.named) or 'nothing'}"

    @staticmethod
    def _of(read: Mapping[str, Any], **more: str) -> Report:
        return _members(
            Report,
            read,
            stages=[Stage._of(stage) for stage in read["stages"]],
            next_manoeuvres=[_members(Proposal, one) for one in read["next_manoeuvres"]],
            **more,
        )


def read_report(file: PathLike) -> Report:
    """Reads report.json of a diagnosis. Raises ValueError if it is none, or of another version."""
    with open(file, encoding="utf-8") as opened:
        read = json.load(opened)
    if not isinstance(read, dict) or read.get("format") != _FORMAT:
        raise ValueError(f"{os.fspath(file)}: is no report of the format {_FORMAT}")
    return Report._of(read)


def diagnose(
    dataset: Union[PathLike, Dataset],
    *,
    out: PathLike = "",
    robot: str = "",
    world: str = "",
    against: PathLike = "",
    effects: PathLike = "",
    without: Sequence[str] = (),
    most_runs: int = 24,
    unchecked: bool = False,
    strict: bool = False,
    propose_next: bool = True,
    jobs: int = 0,
    seed: int = 1,
    progress: Callable[[str, float], None] | None = None,
) -> Report:
    """Names the effects that cause the gap between recorded runs and their simulation: `kenaf-gap diagnose`.

    dataset: a folder, or runs in memory.
    out: a folder for report.json, report.html and the corrected robot; "": none is written.
    robot, world: replace the dataset's; "": its own.
    against: a dataset from before a change, of which only the change is diagnosed.
    effects: a TOML file with effects of your own, to search for in addition.
    without: effects to leave out, by name.
    most_runs: how many runs of a larger dataset are used.
    unchecked: whether to use runs that the checks refuse. strict: whether one refused run refuses the dataset.
    propose_next: whether to look for manoeuvres that would separate what these runs cannot, by more simulations.
    jobs: threads; 0: one per core. The result does not depend on it.
    seed: of resampling.
    progress: called some ten times a second with what is done and with the share of the whole that is done, 0 to 1.

    Takes a minute for six runs. Raises InputError if the dataset cannot be read or is refused, ValueError for unknown
    names, RuntimeError if `out` cannot be written or holds inputs."""
    asked = {
        "robot": robot,
        "world": world,
        "against": os.fspath(against),
        "effects": os.fspath(effects),
        "without": list(without),
        "most_runs": most_runs,
        "unchecked": unchecked,
        "strict": strict,
        "propose_next": propose_next,
        "jobs": jobs,
        "seed": seed,
    }
    with tempfile.TemporaryDirectory(prefix="kenaf-") as temporary:
        if isinstance(dataset, Dataset):
            write_runs(temporary, dataset)
        folder = temporary if isinstance(dataset, Dataset) else os.fspath(dataset)
        report_json, text, html, robot_toml = _core.diagnose(folder, asked, os.fspath(out), progress)
    return Report._of(json.loads(report_json), text=text, html=html, robot_toml=robot_toml)
