"""Recorded and simulated runs, and datasets of them, in the format kenaf-runs/1."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from kenaf import _core

FloatArray = npt.NDArray[np.float64]
PathLike = Union[str, "os.PathLike[str]"]


class Run(Mapping[str, FloatArray]):
    """One run: a mapping from column names ("t_s", "track_left_mps") to float64 arrays of shape (rows,).

    A value that was not measured is NaN. The unit is the last word of a column's name. `dict(run)` is what
    pandas.DataFrame takes. Arrays of runs that Kenaf made share its memory.
    """

    def __init__(
        self,
        columns: Mapping[str, npt.ArrayLike],
        *,
        file: str = "",
        manoeuvre: str = "",
        world: str = "",
        reading: str = "",
        succeeded: bool | None = None,
        gave_up: bool = False,
        fault: str = "",
        phase_began_s: npt.ArrayLike = (),
    ) -> None:
        """Makes a run of arrays of equal length, among them t_s, which increases; does not copy float64 arrays.

        Raises ValueError if the lengths differ or t_s is missing."""
        self._columns = {name: np.asarray(values, dtype=np.float64) for name, values in columns.items()}
        shapes = {values.shape for values in self._columns.values()}
        if "t_s" not in self._columns:
            raise ValueError("the run has no column t_s")
        if len(shapes) != 1 or len(next(iter(shapes))) != 1:
            raise ValueError("the run's columns are not all of one length: " + self._shapes_in_words())
        self.file = file
        """Its file as its dataset names it; "" if it is not from a file."""
        self.manoeuvre = manoeuvre
        """Runs with the same one repeat each other."""
        self.world = world
        """A shipped name, or the path of an SDF file."""
        self.reading = reading
        """How the file was read if its form is not the usual one: "decimal commas"."""
        self.succeeded = succeeded
        """Of a simulated run: by the manoeuvre's own criterion; None if it has none."""
        self.gave_up = gave_up
        """Whether the simulated operator gave up."""
        self.fault = fault
        """Why a simulation ended early; "" if it did not."""
        self.phase_began_s: FloatArray = np.asarray(phase_began_s, dtype=np.float64)
        """Of a simulated manoeuvre's phases that were reached, shape (phases,)."""

    def _shapes_in_words(self) -> str:
        return ", ".join(f"{name} {values.shape}" for name, values in self._columns.items())

    def __getitem__(self, name: str) -> FloatArray:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        name = self.file or self.manoeuvre or "run"
        return f"<kenaf.Run {name!r}: {self.row_count} rows, {len(self)} columns, {self.duration_s:g} s>"

    @property
    def row_count(self) -> int:
        """Number of rows."""
        return len(self._columns["t_s"])

    @property
    def duration_s(self) -> float:
        """From the first row to the last; 0 for a run without rows."""
        t_s = self._columns["t_s"]
        return float(t_s[-1] - t_s[0]) if len(t_s) else 0.0

    def stacked(self, names: Sequence[str]) -> FloatArray:
        """Returns the named columns side by side, shape (rows, len(names)); copies them."""
        return np.column_stack([self[name] for name in names])


@dataclass
class Dataset(Sequence[Run]):
    """A sequence of runs of one robot, with what the diagnosis has to know of them."""

    runs: list[Run]
    robot: str = "kenaf"
    """A shipped name, or the path of a TOML file."""
    world: str = "flat"
    """Of runs that do not name theirs: a shipped name, or the path of an SDF file."""
    source: str = "real"
    """ "real" or "sim"."""
    description: str = ""
    noise: dict[str, float] = field(default_factory=dict)
    """1 sigma by column, in the column's unit; unknown for missing columns."""

    def __getitem__(self, index: Any) -> Any:
        return self.runs[index]

    def __len__(self) -> int:
        return len(self.runs)


def read_run(file: PathLike) -> Run:
    """Reads one run: a CSV file. Raises InputError, with file, line and column."""
    columns, reading = _core.read_run(os.fspath(file))
    return Run(columns, file=os.path.basename(os.fspath(file)), reading=reading)


def read_runs(folder: PathLike) -> Dataset:
    """Reads a dataset: a folder with dataset.toml and its runs. Raises InputError, with file, line and column."""
    read = _core.read_dataset(os.fspath(folder))
    read["runs"] = [Run(run.pop("columns"), **run) for run in read["runs"]]
    return Dataset(**read)


def write_run(file: PathLike, run: Mapping[str, npt.ArrayLike]) -> None:
    """Writes one run as a CSV file, which is complete or absent. Raises ValueError if times do not increase, and
    RuntimeError if the file cannot be written."""
    _core.write_run(os.fspath(file), dict(run))


def write_runs(folder: PathLike, dataset: Dataset, *, force: bool = False) -> None:
    """Writes a dataset, all of it or nothing: run-000.csv and so on, dataset.toml, and copies of a robot or world that is
    a file. Raises RuntimeError if the folder is not empty and `force` is False, or if it cannot be written."""
    runs = [
        {
            "columns": dict(run),
            "manoeuvre": run.manoeuvre,
            "world": run.world or dataset.world,
            "fault": run.fault,
        }
        for run in dataset
    ]
    whole = {name: getattr(dataset, name) for name in ("robot", "world", "source", "description", "noise")}
    _core.write_dataset(os.fspath(folder), {**whole, "runs": runs}, force)
