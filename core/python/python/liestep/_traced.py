"""Motions as functions of arrays, with derivatives forwards and back, for programs that trace functions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._arrays import floats, shown
from ._declared import Carried, Sum
from ._gradient import Covectors, Motion
from ._run import Run, rotations
from ._stepper import Stepper, _start
from .errors import SetupError

if TYPE_CHECKING:
    from ._arrays import Array

#: The quantities that are read of a run, and the names that derivatives have for them.
READ = {"velocity": "velocity", "momentum": "momentum", "attitude": "matrix", "energy": "energy", "spatial_momentum": "spatial_momentum"}


class Traced:
    """A motion as a function of its velocity at the start, of a turn of its attitude there, and of parameters."""

    def __init__(self, term: Sum, step: float, attitude: Any, rows: Mapping[str, Any], method: Mapping[str, Any]) -> None:
        if not isinstance(term, Sum):
            raise SetupError(f"a motion is that of a term, as `ls.body(J)`, and not of {shown(term)}")
        if term._signals() or term.has_pace:
            raise SetupError("a function with derivatives is one of a term without a signal or a pace: see `Run.gradient`")
        self.term, self.step, self._rows, self._method = term, step, dict(rows), dict(method)
        stepper = Stepper(term, step, **self._method)
        self.dimension: int = term.summands[0].derived().dimension
        self._factors = stepper._native.factors
        self._attitude: list[float] = stepper.start(velocity=[0.0] * self.dimension, attitude=attitude)._native.attitude
        # A motion at rest has the rows, and what has none says so here.
        run = self._run({"velocity": floats("velocity", [0.0] * self.dimension, SetupError)})
        # Methods without derivatives say so here, too.
        run._known().transition(0, None)
        self.outputs = {name: value.shape for name, value in self._read(run).items()}

    def run(self, given: Mapping[str, Array]) -> dict[str, Array]:
        """All that is read of the motion."""
        return self._read(self._run(given))

    def _stepper(self, given: Mapping[str, Array]) -> Stepper:
        import numpy as np

        parameters: dict[str, Any] = {}
        for name, value in given.items():
            if name in ("velocity", "turn"):
                continue
            kind = self._kind(name)
            if "Inertia" in kind:
                parameters[name] = (value + value.T) / 2 if value.ndim == 2 else value
            elif kind.startswith(("f64", "SVector", "SMatrix")):
                parameters[name] = np.asarray(value)
            else:
                # An advected parameter of another kind keeps it.
                parameters[name] = Carried(kind, tuple(value.ravel().tolist()))
        term = self.term.with_(**parameters)
        return Stepper(term, self.step, **self._method)

    def _kind(self, name: str) -> str:
        return self.term._value(self.term._found(name)[0]).kind

    def _begin(self, given: Mapping[str, Array]) -> Any:
        turn = given.get("turn")
        moved = self._attitude if turn is None else self._turned(turn)
        start = _start(None, given["velocity"])
        start.attitude = moved
        return start

    def _turned(self, turn: Array) -> list[float]:
        return self.term._scene().displaced(self._attitude, turn.ravel().tolist())

    def _run(self, given: Mapping[str, Array]) -> Run:
        stepper = self._stepper(given)
        course = stepper._course(self._rows.get("until"), self._rows.get("every"), self._rows.get("times"), None)
        return stepper._made(self._begin(given), course, [])

    def _read(self, run: Run) -> dict[str, Array]:
        attitude = entries(run, self._factors)
        if len(self._factors) == 1:
            rows = self._factors[0][1]
            attitude = attitude.reshape(-1, rows, rows)
        return {"velocity": run.velocity, "momentum": run.momentum, "attitude": attitude, "energy": run.energy,
                "spatial_momentum": run.spatial_momentum, "time": run.time}

    def back(self, given: Mapping[str, Array], by: Mapping[str, Array]) -> dict[str, Array]:
        """The derivatives of a scalar by all that is given, from those by all that is read."""
        import numpy as np

        run = self._run(given)
        covectors = Covectors()
        for name, own in READ.items():
            if name in by and np.any(by[name]):
                setattr(covectors, own, floats(name, by[name], SetupError).ravel().tolist())
        stepper = run._known().stepper
        made = stepper._native.gradient(stepper.step, stepper.method, Motion(run._known().start, run.time.tolist()), covectors)
        numbers, found = np.array(made["parameters"]), {}
        for name, value in given.items():
            if name == "velocity":
                found[name] = np.array(made["velocity"])
            elif name == "turn":
                found[name] = self._slopes(value).T @ np.array(made["attitude"])
            else:
                found[name] = self._to_given(name, value, sum(numbers[first : first + count] for first, count in self._places(name)))
        return {name: value.reshape(np.shape(given[name])) for name, value in found.items()}

    def along(self, given: Mapping[str, Array], change: Mapping[str, Array]) -> dict[str, Array]:
        """The changes of all that is read along changes of what is given."""
        import numpy as np

        run = self._run(given)
        stepper = run._known().stepper
        numbers = np.zeros(len(self.term.numbers))
        for name, value in given.items():
            if name not in ("velocity", "turn") and name in change:
                for first, count in self._places(name):
                    numbers[first : first + count] = self._from_given(name, value, change[name])
        turn = self._slopes(given["turn"]) @ change["turn"] if "turn" in given else np.zeros(self.dimension)
        velocity = np.asarray(change.get("velocity", np.zeros(self.dimension)))
        motion = Motion(run._known().start, run.time.tolist())
        made = stepper._native.along(stepper.step, stepper.method, motion, (turn.tolist(), velocity.tolist(), numbers.tolist()))
        found = {name: np.array(made[own]).reshape(self.outputs[name]) for name, own in READ.items()}
        return found | {"time": np.zeros(self.outputs["time"])}

    def _places(self, name: str) -> list[tuple[int, int]]:
        places = self.term._found(name)
        return [(self.term._first_number(place), len(self.term._value(place).numbers)) for place in places]

    def _is_direction(self, name: str) -> bool:
        at, which = self.term._found(name)[0]
        summand = self.term.summands[at]
        return summand.numbers[which][0] in summand.directions

    def _from_given(self, name: str, value: Array, change: Array) -> Array:
        """The change of a parameter's numbers for that of a value that is given."""
        import numpy as np

        if "Inertia" in self._kind(name):
            return (np.diag(change) if value.ndim == 1 else (change + change.T) / 2).ravel()
        if self._is_direction(name):
            length = np.linalg.norm(value)
            return (change - value * (value @ change) / length**2) / length
        return np.ravel(change)

    def _to_given(self, name: str, value: Array, numbers: Any) -> Array:
        """The transpose of `_from_given`."""
        import numpy as np

        if "Inertia" in self._kind(name):
            matrix = numbers.reshape(3, 3)
            return np.diag(matrix) if value.ndim == 1 else (matrix + matrix.T) / 2
        return self._from_given(name, value, numbers) if self._is_direction(name) else np.asarray(numbers)

    def _slopes(self, turn: Array) -> Array:
        """The derivatives of a displacement by its coordinates, where these are `turn`."""
        columns = floats("turn", self.term._scene().turn_slopes(turn.ravel().tolist()), SetupError)
        return columns.reshape(self.dimension, self.dimension).T


def entries(run: Run, factors: list[tuple[str, int]]) -> Array:
    """The entries of the attitudes' matrices, factor after factor, a row for each row."""
    import numpy as np

    columns, parts, first = run.names[1:], [], 0
    for kind, rows in factors:
        count = {"rotation": 4, "translation": rows - 1}.get(kind, rows * rows)
        own = np.stack([run[name] for name in columns[first : first + count]], axis=1)
        first += count
        if kind == "rotation":
            own = rotations(own)
        elif kind == "translation":
            matrices = np.tile(np.eye(rows), (len(own), 1, 1))
            matrices[:, :-1, -1] = own
            own = matrices
        parts.append(own.reshape(len(own), -1))
    return np.concatenate(parts, axis=1)
