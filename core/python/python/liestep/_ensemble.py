"""Many motions of one declaration, drawn at random."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _native
from ._arrays import floats, number, shown, whole
from ._declared import Sum
from ._run import Columns
from ._stepper import Stepper, _Start, _start
from .errors import SetupError


@dataclass(frozen=True)
class Spread:
    """What numbers are drawn from: made by `normal`, `uniform` and `rotation`."""

    kind: str
    first: tuple[float, ...] = ()
    second: tuple[float, ...] = ()


def _spread(kind: str, first: Any, second: Any) -> Spread:
    import numpy as np

    one, two = (floats("what is drawn", value, SetupError) for value in (first, second))
    try:
        one, two = np.broadcast_arrays(one, two)
    except ValueError as error:
        raise SetupError(f"what is drawn has the shapes {one.shape} and {two.shape}: give one for both") from error
    if one.size == 0:
        raise SetupError("what is drawn has no number")
    if not (np.isfinite(one).all() and np.isfinite(two).all()):
        raise SetupError("what is drawn is drawn from finite numbers")
    return Spread(kind, tuple(one.ravel().tolist()), tuple(two.ravel().tolist()))


def normal(mean: Any, deviation: Any) -> Spread:
    """Numbers of the normal distribution, each component by itself.

    A drawn attitude is a quaternion, which is normalised: half of an angle in rad as the deviation turns by that about each axis.

    Examples
    --------
    >>> import liestep as ls
    >>> ls.normal([0, 0, 12], 0.1).second
    (0.1, 0.1, 0.1)
    """
    spread = _spread("normal", mean, deviation)
    if min(spread.second) < 0:
        raise SetupError("a standard deviation isn't below zero")
    return spread


def uniform(least: Any, end: Any) -> Spread:
    """Numbers from the first to below the second, each as likely."""
    spread = _spread("uniform", least, end)
    if any(one >= two for one, two in zip(spread.first, spread.second, strict=True)):
        raise SetupError("a range goes from a number to a larger one")
    return spread


def rotation() -> Spread:
    """An attitude of SO(3), each as likely."""
    return Spread("rotation")


@dataclass
class _Draw:
    of: str
    place: int
    at: list[int]
    kind: str
    first: float
    second: float


@dataclass
class _Members:
    name: str
    members: int
    seed: int
    until: float
    every: int | None
    chunk: int | None
    folder: str
    threads: int
    share: tuple[int, int]
    turns: bool
    progress: Callable[[int, int], None] | None


class Many(Columns):
    """What is there of an ensemble: a row for each member and kept time.

    Its columns are in `names`: ``member``, ``step``, ``status``, ``t``, the attitude, as ``q_w`` to ``q_z`` on SO(3), the velocity, the
    momentum and the energy; ``many.group("q_")`` has those of a beginning as an array.

    Attributes
    ----------
    finished, failed : int
        How many members came to their ends, and how many didn't.
    missing, chunks : int
        The chunks that are left to other shares, or to the next run; and all.
    failures : list of (int, int, str)
        Members that didn't: their number, the steps that they made, and why there are no more.
    """

    def __init__(self, made: dict[str, Any]) -> None:
        super().__init__(made["table"])
        self.finished: int = made["finished"]
        self.failed: int = made["failed"]
        self.missing: int = made["missing"]
        self.chunks: int = made["chunks"]
        self.failures: list[tuple[int, int, str]] = made["failures"]
        self.faults: list[str] = made["faults"]


class Ensemble:
    """Many motions of one declaration; made by `Term.ensemble`.

    Parameters
    ----------
    term : Term
        What moves.
    members : int
        How many.
    step, **method
        As of `liestep.Stepper`.
    velocity, attitude
        A start, or what it is drawn from: `normal`, `uniform`, `rotation`. Angles by their names, or rates relative to a local
        vertical, are drawn by the table ``ensemble`` of a file, `liestep.scene`.
    seed : int
        The same seed draws the same members, on every machine.
    **drawn
        Parameters by their names, as `liestep.Term` has them, and what they are drawn from.

    Examples
    --------
    >>> import liestep as ls, tempfile
    >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])
    >>> many = top.ensemble(100, velocity=ls.normal([0, 0, 12], 0.1), seed=7, m=ls.uniform(0.9, 1.1))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     ends = many.run(folder, until=1, progress=False)
    >>> ends.finished, len(ends)
    (100, 100)
    """

    def __init__(
        self,
        term: Sum,
        members: int,
        *,
        step: float = 0.01,
        velocity: Any,
        attitude: Any = None,
        seed: int = 0,
        method: dict[str, Any] | None = None,
        **drawn: Spread,
    ) -> None:
        whole("members", members, 1, 10**9)
        whole("seed", seed, 0, 2**63 - 1)
        if method is not None and not isinstance(method, dict):
            raise SetupError(f'a method is one of `liestep.Stepper`, as {{"composition": "Suzuki 4"}}, not {shown(method)}')
        self.stepper = Stepper(term, step, **(method or {}))
        for name, signal in term._signals().items():
            if signal.is_function:
                raise SetupError(f"`{name}` is a function, and members have signals by values: write `ls.signal(times, function, …)`")
        self.members, self.seed = members, seed
        self._draws: list[_Draw] = []
        self._turns = isinstance(attitude, Spread) and attitude.kind == "rotation"
        if isinstance(attitude, Spread) and attitude.kind == "normal" and len(attitude.first) == 9 and all(attitude.second):
            raise SetupError(
                "a matrix whose entries are all drawn is no attitude: draw a quaternion, `attitude=ls.normal(quaternion, deviation)`, which is "
                "normalised, where half of an angle in rad as the deviation turns by that about each axis; or `ls.rotation()`"
            )
        start = {"velocity": velocity, "attitude": attitude}
        for name, spread in {**start, **drawn}.items():
            if isinstance(spread, Spread) and spread.kind != "rotation":
                at = [] if name in start else self._numbers_of(name, spread)
                pairs = enumerate(zip(spread.first, spread.second, strict=True))
                self._draws += [_Draw(name, place, at, spread.kind, *pair) for place, pair in pairs]
                start[name] = list(spread.first)
            elif name in inspect.signature(Ensemble.run).parameters:
                raise SetupError(f"`{name}` belongs into the run, as `term.ensemble(100, …).run(folder, {name}=…)`")
            elif name in drawn:
                raise SetupError(f"`{name}` is drawn from `ls.normal(…)` or `ls.uniform(…)`, not from {shown(spread)}")
        self._start: _Start = _start(None if self._turns else start["attitude"], start["velocity"])

    def _numbers_of(self, name: str, spread: Spread) -> list[int]:
        """The places of the first numbers that a draw replaces, among those of all summands."""
        term = self.stepper.term
        places = term._found(name)
        for place in places:
            own, (_, numbers, signal) = term.summands[place[0]].numbers[place[1]]
            if len(numbers) != len(spread.first):
                raise SetupError(f"`{name}` has {len(numbers)} numbers, and {len(spread.first)} are drawn")
            if signal is not None:
                raise SetupError(f"`{name}` is a signal, which isn't drawn: draw the other parameters")
            if own in term.summands[place[0]].directions:
                raise SetupError(f"`{name}` is a direction, of length one, and isn't drawn: draw the attitude instead")
        return [term._first_number(place) for place in places]

    def run(
        self,
        folder: str | Path,
        *,
        until: float,
        every: int | None = None,
        threads: int = 0,
        share: str = "0/1",
        chunk: int | None = None,
        progress: bool | Callable[[int, int], None] = True,
    ) -> Many:
        """Makes what is missing in a folder, and reads what is there then.

        A folder of fewer members of the same ensemble goes on; of one with more the first members are read. Ctrl-C stops a
        run, and its message says what is kept.

        Parameters
        ----------
        folder : path
            Where the files are, one for each chunk of members; a run that was ended goes on there.
        until : float
            The time that each member comes to, s, a whole number of steps; zero keeps the starts.
        every : int, optional
            Steps from row to row of a member; the ends only, if it isn't given.
        threads : int
            How many; zero means all cores.
        share : str
            ``"1/4"``: only this one of four shares, the rest being left to others.
        chunk : int, optional
            The members of a file; by default few in the first files and more in later ones.
        progress : bool or callable
            Whether a terminal shows how far it is, or what to tell it: the chunks that are there, and all.

        Returns
        -------
        Many
        """
        end = number("until", until)
        whole("threads", threads, 0, 2**16)
        for name, steps in {"every": every, "chunk": chunk}.items():
            if steps is not None:
                whole(name, steps, 1, 2**63 - 1)
        if not isinstance(share, str):
            raise SetupError(f'a share is a text, as "1/4", not {shown(share)}')
        listener = _bar if progress is True else None if progress is False else progress
        term, (kind, scheme, *rest) = self.stepper.term, self.stepper.method
        # One plan is told from another by all that it is made of.
        over_time = [(name, signal.key()) for name, signal in term._signals().items()]
        plan_name = repr((term.summands, over_time, kind, scheme, rest, self.stepper.step, self._draws, self._start, self._turns))
        plan = _Members(plan_name, self.members, self.seed, end, every, chunk, str(folder), threads,
                        _native.share(share), self._turns, listener)
        made = self.stepper._native.members(self.stepper.step, self.stepper.method, self._start, self._draws, plan)
        return Many(made)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self.__dict__,)

    def __repr__(self) -> str:
        return f"<Ensemble of {self.members} × {self.stepper.term.name}, seed {self.seed}>"


def _again(state: dict[str, Any]) -> Ensemble:
    ensemble = Ensemble.__new__(Ensemble)
    ensemble.__dict__.update(state)
    return ensemble


def _bar(done: int, chunks: int) -> None:
    """A line that fills, in a terminal alone."""
    if not sys.stderr.isatty():
        return
    filled = 30 * done // max(chunks, 1)
    end = "\n" if done == chunks else ""
    sys.stderr.write(f"\r[{'#' * filled}{'.' * (30 - filled)}] {done} of {chunks} chunks{end}")
    sys.stderr.flush()
