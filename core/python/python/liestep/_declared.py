"""Lagrangians and forces: texts with numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from . import _native
from .errors import DeclarationError

if TYPE_CHECKING:
    from ._control import Control
    from ._ensemble import Ensemble
    from ._stepper import Stepper

#: A parameter: its type in the text, and its numbers, those of a matrix row by row.
Value = tuple[str, tuple[float, ...]]
Group = str | Mapping[str, str]


@dataclass(frozen=True)
class Point:
    """A point fixed in space, made by `point`."""

    coordinates: tuple[float, ...]


def point(coordinates: Any) -> Point:
    """A point fixed in space, on a group of affine maps: where `advected` a vector would be a direction.

    Examples
    --------
    >>> import liestep as ls
    >>> ls.point([1, 2, 3]).coordinates
    (1.0, 2.0, 3.0)
    """
    import numpy as np

    array = np.asarray(coordinates, dtype=float)
    if array.ndim != 1 or not 0 < array.size < 4:
        raise DeclarationError(f"a point has one to three coordinates, not the shape {array.shape}")
    return Point(tuple(array.tolist()))


def _value(name: str, value: Any) -> Value:
    import numpy as np

    if isinstance(value, Point):
        return f"Point{len(value.coordinates)}<f64>", value.coordinates
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        message = f"`{name}` is a number, a vector or a matrix of numbers, not {value!r}"
        raise DeclarationError(message) from error
    numbers = tuple(array.ravel().tolist())
    # As the letters of the field have it.
    if name.startswith("J") and array.shape in ((3,), (3, 3)):
        if array.shape == (3,):
            numbers = tuple(np.diag(array).ravel().tolist())
        return ("NonstandardInertia" if name.endswith("_d") else "Inertia"), numbers
    match array.shape:
        case ():
            return "f64", numbers
        case (rows,) if rows > 0:
            return f"SVector<f64, {rows}>", numbers
        case (rows, columns) if rows == columns > 0:
            return f"SMatrix<f64, {rows}, {rows}>", numbers
    raise DeclarationError(f"`{name}` has the shape {array.shape}: give a number, a vector or a square matrix")


def _group(group: Group) -> str:
    if isinstance(group, str):
        return f"group = {group}"
    return "group(" + ", ".join(f"{name} = {one}" for name, one in group.items()) + ")"


def _renamed(text: str, names: Mapping[str, str]) -> str:
    if not names:
        return text
    pattern = r"(?<![\w.])(" + "|".join(map(re.escape, names)) + r")(?!\w)"
    return re.sub(pattern, lambda found: names[found[1]], text)


@dataclass(frozen=True)
class Term:
    """A text with numbers; what `liestep.lagrangian` and `liestep.force` return, and sums of them.

    It is data: it pickles, compares and adds. What it declares is derived where it is made, and proved there.
    """

    group: str
    role: str
    head: str
    text: str
    advected: Mapping[str, str]
    numbers: Mapping[str, Value]
    #: The library's name, or what it is a sum of.
    name: str = "Lagrangian"
    forces: tuple[Term, ...] = field(default=())

    def __hash__(self) -> int:
        return hash((self.declaration, tuple(self.numbers.items()), self.forces))

    @property
    def declaration(self) -> str:
        """The declaration as Rust has it."""
        return self._declared("")

    def _declared(self, words: str) -> str:
        advected = "".join(f"{name} = {source}, " for name, source in self.advected.items())
        carried = f"advected({advected.rstrip(', ')}), " if advected else ""
        if self.head.startswith("pace = "):
            carried = "given(E_0 = E_0_of_the_start), " + carried
        fields = ", ".join(f"{name}: {kind}" for name, (kind, _) in self.numbers.items())
        return f"#[{self.role}({self.group}, {words}{carried}{self.head} =\n{self.text}\n)]\nstruct Declared {{ {fields} }}"

    def _derived(self, gradients: bool = False) -> _native.Derived:
        try:
            return _native.Derived(self._declared("gradients, " if gradients else ""))
        except DeclarationError as error:
            raise self._placed(error) from None

    def _placed(self, error: DeclarationError) -> DeclarationError:
        """With lines of the text that was given, which is the second of the declaration."""
        lines = self.text.count("\n") + 1
        own = [
            (message, line - 1, column) if 1 < line <= 1 + lines else (message, 0, 0)
            for message, line, column in error.mistakes
        ]
        return DeclarationError.of(own) if own else error

    def _values(self) -> list[tuple[str, list[float]]]:
        return [(name, list(value)) for name, (_, value) in self.numbers.items()]

    def _scene(self) -> _native.Scene:
        if not self.forces:
            return _native.Scene(self._derived(), self._values())
        force = _summed(self.forces)
        return _native.Scene(self._derived(), self._values(), force._derived(), force._values())

    @property
    def derivation(self) -> str:
        """What was derived, as text: the momentum, the equation of a step, its Jacobian, and how it was proved."""
        own = self._derived().derivation
        return "\n".join([own, *(force.derivation for force in self.forces)])

    @property
    def latex(self) -> str:
        """The equations as LaTeX, an ``align*`` for each term."""
        own = self._derived().latex
        return "\n".join([own, *(force.latex for force in self.forces)])

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters by their names."""
        import numpy as np

        def shaped(kind: str, numbers: tuple[float, ...]) -> Any:
            if kind == "f64":
                return numbers[0]
            rows = round(len(numbers) ** 0.5)
            is_matrix = "Matrix" in kind or "Inertia" in kind
            return np.array(numbers).reshape((rows, rows) if is_matrix else (len(numbers),))

        return {name: shaped(*value) for name, value in self.numbers.items()}

    def with_(self, **parameters: Any) -> Term:
        """The same with other values of parameters.

        Examples
        --------
        >>> import liestep as ls
        >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1.0, rho=[0, 0, 1])
        >>> top.with_(m=2.0).parameters["m"]
        2.0
        """
        numbers = dict(self.numbers)
        for name, value in parameters.items():
            if name not in numbers:
                raise DeclarationError(f"there is no parameter `{name}`: there are {', '.join(numbers)}")
            kind, found = _value(name, value)
            if len(found) != len(numbers[name][1]):
                raise DeclarationError(f"`{name}` has {len(numbers[name][1])} numbers, not {len(found)}")
            numbers[name] = (numbers[name][0], found)
        return replace(self, numbers=numbers)

    def __add__(self, other: Term) -> Term:
        if not isinstance(other, Term):
            return NotImplemented
        if self.group != other.group:
            raise DeclarationError(f"terms of one group add: these are on `{self.group}` and `{other.group}`")
        if other.role == "force":
            return replace(self, forces=(*self.forces, other), name=f"{self.name} + {other.name}")
        if self.role == "force":
            return other + self
        summed = _summed((replace(self, forces=()), replace(other, forces=())))
        return replace(summed, forces=self.forces + other.forces)

    def stepper(self, step: float, **method: Any) -> Stepper:
        """What makes steps of this length, s; see `liestep.Stepper`."""
        from ._stepper import Stepper

        return Stepper(self, step, **method)

    def for_accuracy(self, tolerance: float, **run: Any) -> Any:
        """The run by the method and the step that are the cheapest for a tolerance; see `liestep.Stepper.run`.

        Examples
        --------
        >>> import liestep as ls
        >>> run = ls.body([1, 2, 2.5]).for_accuracy(1e-8, velocity=[0.01, 2, 0.02], until=5)
        >>> run.error < 1e-8
        True
        """
        from ._stepper import accurate

        return accurate(self, tolerance, **run)

    def control(self, *, step: float, steps: int, **task: Any) -> Control:
        """A motion from here to there by torques, in the shortest time or by the least effort; see `liestep.Control`.

        Examples
        --------
        >>> import liestep as ls
        >>> plan = ls.body([4, 3, 2]).control(step=0.02, steps=50, goal=ls.euler(0, 1.5), bound=30).solve()
        >>> plan.converged, bool(abs(plan.torque).max() <= 30)
        (True, True)
        """
        from ._control import Control

        return Control(self, step=step, steps=steps, **task)

    def ensemble(self, members: int, *, step: float = 0.01, **rest: Any) -> Ensemble:
        """Many motions drawn at random; see `liestep.Ensemble`."""
        from ._ensemble import Ensemble

        return Ensemble(self, members, step=step, **rest)

    def __repr__(self) -> str:
        numbers = ", ".join(f"{name}={value}" for name, value in self.parameters.items())
        return f"<{self.role} {self.name} on {self.group.removeprefix('group = ')}: {numbers}>".replace("\n", "")

    def _repr_latex_(self) -> str:
        return self.latex

    def _repr_markdown_(self) -> str:
        # Counts, what is conserved and how it was proved stand below the equations.
        text = self.derivation.strip()
        return f"**{self.name}**\n\n{self.latex}\n\n<details><summary>as text</summary>\n\n```text\n{text}\n```\n</details>"


def _summed(terms: tuple[Term, ...]) -> Term:
    """One declaration of several, parameters of one name and other values called anew."""
    first, *others = terms
    for other in others:
        if other.head != first.head:
            message = f"texts of one form add, and these are `{first.head}` and `{other.head}`"
            raise DeclarationError(f"{message}: write both as `l_d`, or both as `l` with one `discretise`")
        names: dict[str, str] = {}
        taken = {**first.numbers, **dict.fromkeys(first.advected)}
        for name in [*other.numbers, *other.advected]:
            # What is the same in both is written once.
            same = first.numbers.get(name) == other.numbers.get(name) if name in other.numbers else (
                first.advected.get(name) == other.advected[name] and other.advected[name] not in names
            )
            if name in taken and not same:
                count = next(n for n in range(2, 1000) if f"{name}_{n}" not in {**taken, **other.numbers})
                names[name] = f"{name}_{count}"
        numbers = {names.get(name, name): value for name, value in other.numbers.items()}
        advected = {names.get(name, name): _renamed(source, names) for name, source in other.advected.items()}
        first = replace(
            first,
            text=f"({first.text})\n + ({_renamed(other.text, names)})",
            numbers={**first.numbers, **numbers},
            advected={**first.advected, **advected},
            name=f"{first.name} + {other.name}",
        )
    return first


def lagrangian(
    group: Group,
    *,
    advected: Mapping[str, str] | None = None,
    l_d: str | None = None,
    l: str | None = None,  # noqa: E741
    discretise: str | None = None,
    velocity: str = "Omega",
    pace: str | None = None,
    **parameters: Any,
) -> Term:
    """A Lagrangian from its text: derived, and proved, in milliseconds.

    Parameters
    ----------
    group : str or mapping
        ``"SO3"``, ``"SE3"``, …; of several bodies a name for each increment: ``{"F_1": "SO3", "F_2": "R3"}``.
    advected : mapping, optional
        What is carried along: the name that the body sees it by, and the parameter that it is in space.
    l_d : str
        The Lagrangian of one step, by the increment ``F``, the step ``h`` and the identity ``I``; or instead
    l, discretise : str
        the continuous Lagrangian, and how it is discretised: ``"trapezoid(Cayley)"``.
    velocity : str
        What the velocity is called in `l`; of several bodies names with commas.
    pace : str, optional
        On SO(3) the pace ``s`` of a transformed time, ``dt = s dτ``, a function of what is advected, three vectors at most:
        the step is one of ``τ``, and runs are in seconds.
    **parameters
        Numbers, vectors, square matrices and points (`liestep.point`) by their names. Names that begin with ``J`` are inertias, kg m², given by a
        matrix or by three moments; those that end in ``_d`` nonstandard ones.

    Returns
    -------
    Term
        What adds to others, and is stepped by ``stepper(step)``.

    Raises
    ------
    DeclarationError
        With line and column of the text.

    Examples
    --------
    >>> import liestep as ls
    >>> top = ls.lagrangian("SO3", advected={"w": "up"}, discretise="trapezoid(Cayley)",
    ...     l="1/2 * Omega.dot(J * Omega) - m * g * w.dot(rho)",
    ...     J=[3, 3, 4], m=1, g=9.81, rho=[0, 0, 1], up=[0, 0, 1])
    >>> run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=10)
    >>> bool(abs(run["energy"] - run["energy"][0]).max() < 1e-2)
    True
    """
    if (l_d is None) == (l is None) or (l is None) != (discretise is None):
        raise DeclarationError("a Lagrangian has `l_d`, or `l` with `discretise`")
    numbers = {name: _value(name, value) for name, value in parameters.items()}
    head, text = "l_d", l_d or ""
    if l is not None:
        names = [name.strip() for name in velocity.split(",")]
        named = f"velocity = {names[0]}" if len(names) == 1 else f"velocity({', '.join(names)})"
        head, text = f"{named}, discretise = {discretise}, l", l
    if pace is not None:
        head = f"pace = {{ {pace} }}, {head}"
        numbers["E_0_of_the_start"] = ("f64", (0.0,))
    term = Term(_group(group), "lagrangian", head, text, dict(advected or {}), numbers)
    term._derived()
    return term


def force(
    group: Group,
    *,
    work: str,
    advected: Mapping[str, str] | None = None,
    displacement: str | None = None,
    **parameters: Any,
) -> Term:
    """A force from the virtual work of one step, by the displacements ``eta`` and ``eta_next`` at its ends.

    Parameters
    ----------
    group, advected, **parameters
        As of `lagrangian`.
    work : str
        Linear in ``eta`` and ``eta_next``.
    displacement : str, optional
        Of several bodies the names of the displacements, with commas.

    Examples
    --------
    >>> import liestep as ls
    >>> damping = ls.force("SO3", work="-c * vee(F - F.transpose()).dot(eta) / 2", c=0.1)
    >>> run = (ls.body([1, 2, 2.5]) + damping).stepper(0.01).run(velocity=[0, 1, 0], until=1)
    >>> bool(run["energy"][-1] < run["energy"][0])
    True
    """
    numbers = {name: _value(name, value) for name, value in parameters.items()}
    head = "work"
    if displacement:
        head = f"displacement({displacement}), work"
    term = Term(_group(group), "force", head, work, dict(advected or {}), numbers, name="force")
    term._derived()
    return term
