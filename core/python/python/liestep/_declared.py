"""Declared texts with their numbers, and sums of them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from . import _native
from ._arrays import floats
from ._signal import Signal, diagonal
from .errors import DeclarationError

if TYPE_CHECKING:
    from ._arrays import Array

Group = str | Mapping[str, str]


class Value(NamedTuple):
    """A parameter: its type in the text, and its numbers, those of a matrix row by row."""

    kind: str
    numbers: tuple[float, ...]
    #: The signal that gives the numbers over time; those here are of the start.
    signal: Signal | None = None


class Change(NamedTuple):
    """A parameter that changes with time: its first number among those of all summands, how many it has, and its signal."""

    name: str
    first: int
    width: int
    is_direction: bool
    source: Any


@dataclass(frozen=True)
class Carried:
    """A value that a group carries otherwise than a covector, made by `point`, `contravariant`, `covariant` or `mixed`."""

    #: Its type in the text.
    kind: str
    numbers: tuple[float, ...]
    signal: Signal | None = None


def _carried(kind: str, value: Any, dimensions: tuple[int, ...], is_said: str) -> Carried:
    if isinstance(value, Signal):
        return replace(_carried(kind, value.first, dimensions, is_said), signal=value)
    array = floats(kind, value, DeclarationError)
    if array.ndim not in dimensions or array.size == 0 or len(set(array.shape)) > 1:
        raise DeclarationError(f"{is_said}, not the shape {array.shape}")
    rows = array.shape[0]
    name = {"point": f"Point{rows}<f64>"}.get(kind, f"{kind.capitalize()}{'Vector' if array.ndim == 1 else 'Tensor'}<f64, {rows}>")
    return Carried(name, tuple(array.ravel().tolist()))


def point(coordinates: Any) -> Carried:
    """A point fixed in space, on a group of affine maps: where `advected` a vector would be a direction.

    Examples
    --------
    >>> import liestep as ls
    >>> ls.point([1, 2, 3]).numbers
    (1.0, 2.0, 3.0)
    """
    carried = _carried("point", coordinates, (1,), "a point has one to three coordinates")
    if len(carried.numbers) > 3:
        raise DeclarationError(f"a point has one to three coordinates, not {len(carried.numbers)}")
    return carried


def contravariant(value: Any) -> Carried:
    """A vector that the group's matrices carry, ``g⁻¹ a`` as the body sees it, or a tensor, ``g⁻¹ A g⁻ᵀ``.

    Parameters
    ----------
    value : array_like
        A vector, or a square matrix.

    Raises
    ------
    DeclarationError
        Another shape, or numbers that aren't real.
    """
    return _carried("contravariant", value, (1, 2), "what is contravariant is a vector or a square matrix")


def covariant(value: Any) -> Carried:
    """A tensor ``A`` that the body sees as ``gᵀ A g``: a metric of space.

    Parameters
    ----------
    value : array_like
        A square matrix.

    Raises
    ------
    DeclarationError
        Another shape, or numbers that aren't real.
    """
    return _carried("covariant", value, (2,), "a covariant tensor is a square matrix")


def mixed(value: Any) -> Carried:
    """A tensor ``A`` that the body sees as ``g⁻¹ A g``: a linear map of space.

    Parameters
    ----------
    value : array_like
        A square matrix.

    Raises
    ------
    DeclarationError
        Another shape, or numbers that aren't real.
    """
    return _carried("mixed", value, (2,), "a mixed tensor is a square matrix")


def _value(name: str, value: Any) -> Value:
    import numpy as np

    if isinstance(value, Carried):
        return Value(value.kind, value.numbers, value.signal)
    if isinstance(value, Signal):
        if name.startswith("J") and value.shape == (3,):
            value = value.mapped(diagonal)
        return _value(name, value.first)._replace(signal=value)
    array = floats(name, value, DeclarationError)
    numbers = tuple(array.ravel().tolist())
    # As the letters of the field have it.
    if name.startswith("J") and array.shape in ((3,), (3, 3)):
        if array.shape == (3,):
            numbers = tuple(np.diag(array).ravel().tolist())
        return Value("NonstandardInertia" if re.search(r"_d(_?\d+)?$", name) else "Inertia", numbers)
    match array.shape:
        case ():
            return Value("f64", numbers)
        case (rows,) if rows > 0:
            return Value(f"SVector<f64, {rows}>", numbers)
        case (rows, columns) if rows == columns > 0:
            return Value(f"SMatrix<f64, {rows}, {rows}>", numbers)
    raise DeclarationError(f"`{name}` has the shape {array.shape}: give a number, a vector or a square matrix")


def _direction(name: str, value: Value) -> Value:
    numbers = value.numbers
    length = sum(number * number for number in numbers) ** 0.5
    if not abs(length - 1) <= _native.OFF_UNIT:
        unit = ", ".join(f"{number / length:.6g}" for number in numbers) if 0 < length < float("inf") else "0, 0, 1"
        raise DeclarationError(f"`{name}` is a direction, and isn't of length one but of {length:.6g}: write [{unit}]")
    if value.signal is not None and not value.signal.has_unit_values:
        raise DeclarationError(f"`{name}` is a direction, and its signal has values of other lengths than one")
    return value._replace(numbers=tuple(number / length for number in numbers))


@dataclass(frozen=True)
class Summand:
    """A declaration as Rust has it, with numbers for its parameters."""

    text: str
    numbers: tuple[tuple[str, Value], ...]
    #: The library's name, or what it is.
    name: str
    #: Those of the parameters that are of length one.
    directions: tuple[str, ...] = ()

    @classmethod
    def of(
        cls, text: str, numbers: Mapping[str, Value], name: str, directions: Iterable[str] = ()
    ) -> tuple[Summand, _native.Derivation]:
        """Derives and proves the text, and compares its parameters with what is given."""
        derived, lengths = _native.Derivation(text), {}
        for field, length in derived.parameters:
            lengths[field] = length
            if field not in numbers:
                raise DeclarationError(f"`{name}` has parameters {', '.join(dict(derived.parameters))}: give {field}")
            if len(numbers[field].numbers) != length:
                raise DeclarationError(f"`{field}` has {length} numbers, and {len(numbers[field].numbers)} were given")
        given = {field: numbers[field] for field in lengths}
        given |= {field: _direction(field, given[field]) for field in directions}
        return cls(text, tuple(given.items()), name, tuple(directions)), derived

    def with_value(self, name: str, value: Value) -> Summand:
        """A summand with another value of a parameter."""
        if name in self.directions:
            value = _direction(name, value)
        return replace(self, numbers=tuple((own, value if own == name else old) for own, old in self.numbers))

    def derived(self) -> _native.Derivation:
        """The derivation of the text, which is made once."""
        return _native.Derivation(self.text)


#: Summands and parameters by their numbers.
Place = tuple[int, int]
AnySum = TypeVar("AnySum", bound="Sum")


@dataclass(frozen=True)
class Sum:
    """Declarations on one group, whose programs are added: no text is changed, and the order doesn't matter.

    Summands may have parameters of one name. ``m`` is that of all of them as long as they are equal; ``m_1`` and ``m_2``
    are those of the first and of the second summand that has an ``m``.
    """

    summands: tuple[Summand, ...]
    #: As it is written: ``SO3``, ``(SO3, R3)``.
    group: str
    #: ``"lagrangian"``, or ``"force"`` or ``"nonholonomic"`` where there are forces or constraints alone.
    role: str
    has_pace: bool

    @classmethod
    def of(cls: type[AnySum], summand: Summand, derived: _native.Derivation) -> AnySum:
        """A sum of one summand."""
        return cls((summand,), derived.group, derived.role, derived.has_pace)

    def __add__(self: AnySum, other: Sum) -> AnySum:
        if not isinstance(other, Sum):
            return NotImplemented
        if self.group != other.group:
            raise DeclarationError(f"terms of one group add: these are on `{self.group}` and `{other.group}`")
        role = self.role if self.role == other.role else "lagrangian"
        return replace(self, summands=self.summands + other.summands, role=role, has_pace=self.has_pace or other.has_pace)

    def __radd__(self: AnySum, other: object) -> AnySum:
        # Python begins the sum of a list with zero.
        return self if other == 0 else NotImplemented

    @property
    def name(self) -> str:
        """The names of the summands."""
        return " + ".join(summand.name for summand in self.summands)

    @property
    def declaration(self) -> str:
        """The declarations as Rust has them."""
        return "\n\n".join(summand.text for summand in self.summands)

    @property
    def derivation(self) -> str:
        """What was derived, as text: the momentum, the equation of a step, its Jacobian, and how it was proved."""
        return "\n".join(summand.derived().derivation for summand in self.summands)

    @property
    def latex(self) -> str:
        """The equations as LaTeX, an ``align*`` for each summand."""
        return "\n".join(summand.derived().latex for summand in self.summands)

    def c(self, *, compensated: bool = False) -> str:
        """A step of the sum as C99 without dependencies: the bits of `Term.stepper`'s own step, where contraction is off.

        Its head says the order of the parameters, and what the functions do; all names begin with that of the sum.

        Parameters
        ----------
        compensated : bool
            Whether rounding errors of attitude, momentum and what is advected are added to their next changes, as by
            ``stepper(step, compensated=True)`` and ``liestep derive --c --compensated``.

        Raises
        ------
        DeclarationError
            The sum has no kinetic energy, or is to have compensated sums beside a pace or constraints on velocities.

        Examples
        --------
        >>> import liestep as ls
        >>> "int rigid_body_step(const rigid_body_stepper *stepper, rigid_body_state *state)" in ls.body([1, 2, 2.5]).c()
        True
        """
        return self._scene().c(compensated)

    @property
    def certificate(self) -> str:
        """The step of the sum as data with its claims, as JSON: what `liestep.verify` checks.

        Raises
        ------
        DeclarationError
            The sum has no kinetic energy.

        Examples
        --------
        >>> import json
        >>> import liestep as ls
        >>> from liestep.verify import verified
        >>> found = verified(json.loads(ls.body([1, 2, 2.5]).certificate))
        >>> len(found), all(found.values())
        (17, True)
        """
        return self._scene().certificate

    @property
    def numbers(self) -> Array:
        """The numbers of all parameters in one row, in the order of the C text; those of a matrix row by row."""
        return floats("numbers", [number for _, numbers in self._terms() for number in numbers], DeclarationError)

    def _terms(self) -> list[tuple[_native.Derivation, list[float]]]:
        return [
            (summand.derived(), [number for _, value in summand.numbers for number in value.numbers])
            for summand in self.summands
        ]

    def _changes(self) -> list[Change]:
        """The parameters that change with time."""
        changes = []
        for at, summand in enumerate(self.summands):
            for which, (name, (_, numbers, signal)) in enumerate(summand.numbers):
                if signal is not None:
                    width, is_direction = len(numbers), name in summand.directions
                    changes.append(Change(name, self._first_number((at, which)), width, is_direction, signal.source))
        return changes

    def _signals(self) -> dict[str, Signal]:
        """The signals by the names of parameters."""
        values = [(name, value.signal) for summand in self.summands for name, value in summand.numbers]
        return {name: signal for name, signal in values if signal is not None}

    def _scene(self) -> _native.Scene:
        return _native.Scene(self._terms(), self._changes())

    def _value(self, place: Place) -> Value:
        return self.summands[place[0]].numbers[place[1]][1]

    def _places(self) -> dict[str, list[Place]]:
        """All names, and where the parameters are that they stand for."""
        named: dict[str, list[Place]] = {}
        for at, summand in enumerate(self.summands):
            for which, (name, _) in enumerate(summand.numbers):
                named.setdefault(name, []).append((at, which))
        several = {name: places for name, places in named.items() if len(places) > 1}
        for name, places in several.items():
            # A text may have a parameter of such a name itself.
            mark = "_"
            while any(f"{name}{mark}{number}" in named for number in range(1, len(places) + 1)):
                mark += "_"
            named |= {f"{name}{mark}{number}": [place] for number, place in enumerate(places, 1)}
        return named

    def _are_equal(self, places: list[Place]) -> bool:
        return len({self._value(place)[1:] for place in places}) == 1

    def _found(self, name: str) -> list[Place]:
        """The places of the parameters that a name stands for."""
        named = self._places()
        if name not in named:
            raise DeclarationError(f"there is no parameter `{name}`: there are {', '.join(self.parameters)}")
        if not self._are_equal(named[name]):
            own = [one for one, places in named.items() if len(places) == 1 and places[0] in named[name]]
            raise DeclarationError(f"`{name}` has several values: write {' or '.join(own)}")
        return named[name]

    def _first_number(self, place: Place) -> int:
        """The place of a parameter's first number among those of all summands."""
        before = [numbers for summand in self.summands[: place[0]] for numbers in summand.numbers]
        before += self.summands[place[0]].numbers[: place[1]]
        return sum(len(value.numbers) for _, value in before)

    def _shown(self) -> dict[str, list[Place]]:
        """The names under which `parameters` has them, in order, and their places."""
        named = self._places()
        several = {name for name, places in named.items() if not self._are_equal(places)}
        shared = {place for name, places in named.items() if len(places) > 1 and name not in several for place in places}
        shown = {
            name: places for name, places in named.items()
            if name not in several and (len(places) > 1 or places[0] not in shared)
        }
        return {name: shown[name] for name in sorted(shown, key=lambda name: shown[name][0])}

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters by their names."""
        values = {name: self._value(places[0]) for name, places in self._shown().items()}
        return {name: value.signal or _shaped(value.kind, value.numbers) for name, value in values.items()}

    def _seen(self, numbers: list[float]) -> dict[str, Any]:
        """The advected values by the names of their parameters, from the numbers of all summands."""
        found: dict[Place, tuple[float, ...]] = {}
        first = 0
        for at, summand in enumerate(self.summands):
            for which, length in summand.derived().carried:
                if which is not None:
                    found[at, which] = tuple(numbers[first : first + length])
                first += length
        kind = {place: self._value(place).kind for place in found}
        return {
            name: _shaped(kind[places[0]], found[places[0]]) for name, places in self._shown().items() if places[0] in found
        }

    def with_(self: AnySum, **parameters: Any) -> AnySum:
        """The same with other values of parameters.

        Examples
        --------
        >>> import liestep as ls
        >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1.0, rho=[0, 0, 1])
        >>> top.with_(m=2.0).parameters["m"]
        2.0

        The stiffnesses of two springs are set together while they are equal, and one by one.

        >>> two = sum(ls.spring(k=3, length=1, at=at, anchor=[0, 0, 3]) for at in ([0, 0, 1], [1, 0, 0]))
        >>> two.with_(k=5).parameters["k"], two.with_(k_2=7).parameters["k_2"]
        (5.0, 7.0)
        """
        summands = list(self.summands)
        for name, value in parameters.items():
            for at, which in self._found(name):
                own, old = self.summands[at].numbers[which]
                found = _value(own, value)
                if len(found.numbers) != len(old.numbers):
                    raise DeclarationError(f"`{name}` has {len(old.numbers)} numbers, not {len(found.numbers)}")
                summands[at] = summands[at].with_value(own, found._replace(kind=old.kind))
        return replace(self, summands=tuple(summands))

    def __repr__(self) -> str:
        numbers = ", ".join(f"{name}={value}" for name, value in self.parameters.items())
        return f"<{self.role} {self.name} on {self.group}: {numbers}>".replace("\n", "")

    def _repr_latex_(self) -> str:
        return self.latex

    def _repr_markdown_(self) -> str:
        # Counts, what is conserved and how it was proved stand below the equations.
        text = self.derivation.strip()
        return f"**{self.name}**\n\n{self.latex}\n\n<details><summary>as text</summary>\n\n```text\n{text}\n```\n</details>"


def _shaped(kind: str, numbers: tuple[float, ...]) -> Any:
    import numpy as np

    if kind == "f64":
        return numbers[0]
    rows = round(len(numbers) ** 0.5)
    is_matrix = any(word in kind for word in ("Matrix", "Inertia", "Tensor"))
    return np.array(numbers).reshape((rows, rows) if is_matrix else (len(numbers),))
