"""Lagrangians and forces: texts with numbers, and the ways of moving them."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Any

from . import _native
from ._arrays import floats, shown, text
from ._control import Control
from ._declared import Group, Sum, Summand, Value, _value
from ._ensemble import Ensemble
from ._estimate import Fit, estimate
from ._run import Run
from ._stepper import Stepper, accurate
from .errors import DeclarationError


class Term(Sum):
    """A text with numbers; what `liestep.lagrangian`, `liestep.force` and `liestep.nonholonomic` return, and sums of them.

    It is data: it pickles, compares and adds. What it declares is derived where it is made, and proved there. A sum has
    the programs of its summands: any of them on one group add, in any order.

    Parameters of one name are one parameter as long as they have one value: `with_`, the draws of an `ensemble` and
    `parameters` know them by this name. Several ``m`` of a sum are ``m_1``, ``m_2`` and so on, in the order of the summands
    that have one.

    Attributes
    ----------
    summands : tuple
        The declarations, each with its numbers.
    group : str
        The group, as ``SO3``.
    role : str
        ``"lagrangian"``, or ``"force"`` or ``"nonholonomic"`` where there are forces or constraints alone.
    has_pace : bool
        Whether it is stepped in a time of its own.
    """

    def stepper(self, step: float, **method: Any) -> Stepper:
        """What makes steps of this length, s; see `liestep.Stepper`."""
        return Stepper(self, step, **method)

    def run(self, **run: Any) -> Run:
        """The run to an accuracy of 1e-6; see `liestep.Stepper.run`. Method and step are those of `for_accuracy`.

        Without `every` and `times` it has 1001 rows, as far from each other in time. A force that isn't the same
        backwards leaves no method but the declared step, which is made ever shorter.

        Examples
        --------
        >>> import liestep as ls
        >>> run = ls.body([1, 2, 2.5]).run(velocity=[0.01, 2, 0.02], until=5)
        >>> run.error < 1e-6, len(run)
        (True, 1001)
        """
        return self.for_accuracy(1e-6, **run)

    def for_accuracy(self, tolerance: float, **run: Any) -> Run:
        """The run by the method and the step that are the cheapest for a tolerance; see `liestep.Stepper.run`.

        The tolerance is one of `liestep.Run.error`: what the state at the end is off.

        Examples
        --------
        >>> import liestep as ls
        >>> run = ls.body([1, 2, 2.5]).for_accuracy(1e-8, velocity=[0.01, 2, 0.02], until=5)
        >>> run.error < 1e-8
        True
        """
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
        return Control(self, step=step, steps=steps, **task)

    def estimate(
        self,
        *,
        step: float,
        readings: Mapping[str, tuple[Any, Any]],
        unknown: Iterable[str] = (),
        every: int = 1,
        first: int | None = None,
        velocity: Any = None,
        attitude: Any = None,
        known: Mapping[str, float] | None = None,
        **rest: Any,
    ) -> Fit:
        """The start and the parameters of a motion from readings, by least squares, on any group.

        Parameters
        ----------
        step : float
            The length of a step, s.
        readings : mapping
            Values and their standard deviation by ``velocity``, ``momentum``, ``spatial_momentum``, ``attitude`` (on SO(3)
            quaternions, matrices or SciPy's ``Rotation``; elsewhere the entries) or ``energy``: a row for each time, NaN where there
            is none.
        unknown : list of str
            Parameters that are estimated, from the term's own values on; of an inertia about known axes the three moments, else six
            numbers.
        every : int
            Steps from reading to reading.
        first : int, optional
            With so many readings the search begins, and it goes on with three times as many each time. All at once, as by default,
            the squares of a motion of many turns have minima far from the least one: a search ends there as ``"exhausted"``, or
            with `Fit.squares` far above the number of readings. Take as many as a turn or two has.
        velocity, attitude : array_like, optional
            The first guess of the start: by default the first reading of the velocity, and the identity. Beside constraints on
            velocities it satisfies them.
        known : mapping, optional
            Standard deviations of the first guess: of ``"attitude"``, rad, ``"momentum"``, and of unknown parameters.
        force : float or array_like, optional
            The standard deviation of an unknown force in each step, along `axes`; on SO(3) a torque, N m.
        inputs : mapping, optional
            Instead the standard deviations of parameters that have another value in each step, about the term's own.
        axes, tolerance, iterations : optional
            The components of the velocity along which that force acts; the last step of the search, in standard deviations,
            1e-5 by default; and its most iterations.

        Returns
        -------
        Fit

        Raises
        ------
        SetupError
            Readings, unknowns or a start that can't be used.
        StepError
            A step of the first guess that has no solution.

        Examples
        --------
        The moments of a body that a known torque turns, from its gyroscope:

        >>> import liestep as ls
        >>> import numpy as np
        >>> body = lambda J: ls.body(J, kinetic="cayley") + ls.torque([0.1, 0.05, 0.2])
        >>> gyroscope = body([1.0, 2.0, 2.5]).stepper(0.02).run(velocity=[0.5, 1, 0.2], until=4).velocity
        >>> noise = 1e-3 * np.random.default_rng(1).standard_normal(gyroscope.shape)
        >>> fit = body([1.2, 1.8, 2.2]).estimate(step=0.02, readings={"velocity": (gyroscope + noise, 1e-3)},
        ...     unknown=["J"], known={"attitude": 1e-3})
        >>> fit.verdict, bool(abs(np.diag(fit.parameters["J"]) - [1, 2, 2.5]).max() < 0.01)
        ('converged', True)

        Over ten seconds a guess that is a third off is turns apart, unless the search begins with one second:

        >>> gyroscope = body([1.0, 2.0, 2.5]).stepper(0.02).run(velocity=[0.5, 1, 2], until=10).velocity
        >>> fit = body([1.3, 1.8, 3.0]).estimate(step=0.02, readings={"velocity": (gyroscope, 1e-3)}, unknown=["J"],
        ...     known={"attitude": 1e-3}, first=50)
        >>> fit.verdict, bool(abs(np.diag(fit.parameters["J"]) - [1, 2, 2.5]).max() < 1e-6)
        ('converged', True)
        """
        return estimate(self, step=step, readings=readings, unknown=unknown, every=every, first=first, velocity=velocity,
                        attitude=attitude, known=known, **rest)

    def ensemble(self, members: int, *, step: float = 0.01, **rest: Any) -> Ensemble:
        """Many motions drawn at random; see `liestep.Ensemble`."""
        return Ensemble(self, members, step=step, **rest)


def _declared(
    role: str,
    group: Group,
    head: str,
    given: Any,
    advected: Mapping[str, str] | None,
    numbers: Mapping[str, Value],
    generators: Any = None,
) -> Term:
    """A term of a text, whose mistakes have their lines."""
    own_text = text(head.rpartition(" ")[2], given)
    for name, names in {"group": group, "advected": {} if advected is None else advected}.items():
        if not isinstance(names, Mapping) and not (name == "group" and isinstance(names, str)):
            raise DeclarationError(f"`{name}` are texts by names, as {{\"w\": \"up\"}}, not {shown(names)}")
        for one in [names] if isinstance(names, str) else [*names.keys(), *names.values()]:
            text(name, one)
    on = f"group = {group}" if isinstance(group, str) else f"group({', '.join(f'{n} = {g}' for n, g in group.items())})"
    if generators is not None:
        on += f", {_generators(generators)}"
    sources = ", ".join(f"{name} = {source}" for name, source in (advected or {}).items())
    carried = f"advected({sources}), " if sources else ""
    if head.startswith("pace = "):
        carried = "given(E_0 = E_0_of_the_start), " + carried
    fields = ", ".join(f"{name}: {value.kind}" for name, value in numbers.items())
    _native.lex(own_text)
    whole = f"#[{role}({on}, {carried}{head} =\n{own_text}\n)]\nstruct Declared {{ {fields} }}"
    try:
        return Term.of(*Summand.of(whole, numbers, role.capitalize() if role == "lagrangian" else role))
    except DeclarationError as error:
        # The text is the second line of the declaration.
        lines = own_text.count("\n") + 1
        own = [
            (message, line - 1, column) if 1 < line <= 1 + lines else (message, 0, 0)
            for message, line, column in error.mistakes
        ]
        raise (DeclarationError.of(own) if own else error) from None


def _generators(generators: Any) -> str:
    """Bases of Lie algebras as an argument: of one group, or by the names of several."""
    if not isinstance(generators, Mapping):
        return f"generators = {_basis('generators', generators)}"
    for name in generators:
        text("generators", name)
    return f"generators({', '.join(f'{name} = {_basis(name, one)}' for name, one in generators.items())})"


def _basis(name: str, generators: Any) -> str:
    basis = floats(name, generators, DeclarationError)
    if basis.ndim != 3 or basis.shape[1] != basis.shape[2]:
        raise DeclarationError(f"`{name}` are a list of square matrices, and have the shape {basis.shape}")
    return repr(basis.tolist())


def lagrangian(
    group: Group,
    *,
    generators: Any = None,
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
        ``"SO3"``, ``"SE3"``, …; of several bodies a name for each increment: ``{"F_1": "SO3", "F_2": "R3"}``; or a name of
        your own with `generators`.
    generators : array_like or mapping, optional
        A basis of the Lie algebra of a group of your own: square matrices; in a product by the group's name,
        ``{"Own": basis}``.
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
        Numbers, vectors, square matrices, and what is carried otherwise than a covector (`liestep.point`, `contravariant`,
        `covariant`, `mixed`), or how they change with time (`liestep.signal`), by their names. Names that begin with ``J`` are inertias, kg m², given by a
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

    A flow of linear maps of volume one, on a group of your own:

    >>> import numpy as np
    >>> unit = lambda i, j: np.eye(3)[[i]].T @ np.eye(3)[[j]]
    >>> basis = [unit(i, j) for i in range(3) for j in range(3) if i != j] + [unit(k, k) - unit(2, 2) for k in range(2)]
    >>> flow = ls.lagrangian("SL3", generators=basis, K=np.diag([1, 2, 3]),
    ...     l_d="(((F - I) * K * (F - I).transpose()).trace()"
    ...         " + ((I - inverse(F)) * K * (I - inverse(F)).transpose()).trace()) / (4 * h)")
    >>> run = flow.stepper(0.01).run(velocity=np.full(8, 0.1), until=1)
    >>> bool(abs(np.linalg.det(run.attitude.reshape(-1, 3, 3)) - 1).max() < 1e-13)
    True

    The flow beside a body that turns:

    >>> both = ls.lagrangian({"F": "SL3", "Q": "SO3"}, generators={"SL3": basis}, K=np.diag([1, 2, 3]), J_d=[1, 2, 2.5],
    ...     l_d="(((F - I) * K * (F - I).transpose()).trace()"
    ...         " + ((I - inverse(F)) * K * (I - inverse(F)).transpose()).trace()) / (4 * h)"
    ...         " + ((Q - I) * J_d * (Q - I).transpose()).trace() / (2 * h)")
    >>> both.stepper(0.01).run(velocity=np.full(11, 0.1), until=1).attitude.shape
    (101, 13)
    """
    if (l_d is None) == (l is None) or (l is None) != (discretise is None):
        for name in parameters:
            if alike := difflib.get_close_matches(name, ["discretise"], n=1, cutoff=0.6):
                raise DeclarationError(f"`{name}` isn't known here; did you mean `{alike[0]}`?")
        raise DeclarationError("a Lagrangian has `l_d`, or `l` with `discretise`, as in `discretise=\"trapezoid(Cayley)\"`")
    numbers = {name: _value(name, value) for name, value in parameters.items()}
    head = "l_d"
    if l is not None:
        names = [name.strip() for name in text("velocity", velocity).split(",")]
        named = f"velocity = {names[0]}, " if len(names) == 1 else f"velocity({', '.join(names)}), "
        # A potential has none.
        is_used = names != ["Omega"] or "Omega" in text("l", l)
        head = f"{named if is_used else ''}discretise = {text('discretise', discretise)}, l"
    if pace is not None:
        head = f"pace = {{ {text('pace', pace)} }}, {head}"
        numbers["E_0_of_the_start"] = Value("f64", (0.0,))
    return _declared("lagrangian", group, head, l_d if l is None else l, advected, numbers, generators)


def force(
    group: Group,
    *,
    work: str,
    generators: Any = None,
    advected: Mapping[str, str] | None = None,
    displacement: str | None = None,
    **parameters: Any,
) -> Term:
    """A force from the virtual work of one step, by the displacements ``eta`` and ``eta_next`` at its ends.

    Parameters
    ----------
    group, generators, advected, **parameters
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
    if displacement is not None:
        head = f"displacement({text('displacement', displacement)}), work"
    return _declared("force", group, head, work, advected, numbers, generators)


def nonholonomic(
    group: Group,
    *,
    zero: str,
    generators: Any = None,
    advected: Mapping[str, str] | None = None,
    velocity: str = "Omega",
    discretise: str = "trapezoid(Cayley)",
    **parameters: Any,
) -> Term:
    """A constraint that is linear in the velocity, such as rolling without sliding; it adds to Lagrangians of its group.

    Each increment satisfies it, and each velocity after a step, to rounding, by the discrete Lagrange–d'Alembert principle. The
    step isn't symplectic any more, and momenta are kept along directions alone that satisfy the constraint.

    Parameters
    ----------
    group, generators, advected, **parameters
        As of `lagrangian`.
    zero : str
        Linear in the velocity, a scalar, which the motion keeps at zero. Several constraints are several terms.
    velocity : str
        What the velocity is called in `zero`; of several bodies names with commas.
    discretise : str
        The rule by which an increment satisfies it.

    Returns
    -------
    Term
        What adds to others. The velocity at the start of a run has to satisfy it.

    Raises
    ------
    DeclarationError
        With line and column of the text; also where it isn't linear in the velocity.

    Examples
    --------
    Suslov's body can't turn about an axis of its own:

    >>> import liestep as ls
    >>> suslov = ls.body([[2, 0, 0], [0, 1.5, 0.4], [0, 0.4, 1]]) + ls.nonholonomic("SO3", zero="a.dot(Omega)", a=[0, 0, 1])
    >>> run = suslov.stepper(0.01).run(velocity=[-1.2, 0.7, 0], until=10)
    >>> bool(abs(run.velocity[:, 2]).max() < 1e-14)
    True
    """
    numbers = {name: _value(name, value) for name, value in parameters.items()}
    names = [name.strip() for name in text("velocity", velocity).split(",")]
    named = f"velocity = {names[0]}" if len(names) == 1 else f"velocity({', '.join(names)})"
    return _declared("nonholonomic", group, f"{named}, discretise = {text('discretise', discretise)}, zero", zero, advected, numbers, generators)


def hamiltonian(
    group: Group,
    *,
    h: str,
    generators: Any = None,
    advected: Mapping[str, str] | None = None,
    momentum: str = "mu",
    **parameters: Any,
) -> Term:
    """A Hamiltonian of the body momentum and of what is advected: no velocity needs to have a momentum.

    Its step is a Poisson map of order two, which keeps Casimirs and momenta in space to rounding; compositions of it are of
    order four and more. Runs start with a ``momentum``. All terms stand in one text.

    Parameters
    ----------
    group, generators, advected, **parameters
        As of `lagrangian`.
    h : str
        A smooth function of the momentum and of what is advected, J.
    momentum : str
        What the momentum is called in `h`; of several bodies names with commas.

    Returns
    -------
    Term
        What is stepped by ``stepper(step)``.

    Raises
    ------
    DeclarationError
        With line and column of the text.

    Examples
    --------
    A sub-Riemannian geodesic on the Heisenberg group, along two of three directions, is a circle in the plane:

    >>> import liestep as ls
    >>> geodesic = ls.hamiltonian("Heisenberg", h="((mu[0]).powi(2) + (mu[1]).powi(2)) / 2")
    >>> run = geodesic.stepper(0.01).run(momentum=[0.8, -0.3, 1.5], until=10)
    >>> bool(abs(run["energy"] - 0.365).max() < 1e-12)
    True
    """
    numbers = {name: _value(name, value) for name, value in parameters.items()}
    names = [name.strip() for name in text("momentum", momentum).split(",")]
    named = f"momentum = {names[0]}" if len(names) == 1 else f"momentum({', '.join(names)})"
    return _declared("hamiltonian", group, f"{named}, h", h, advected, numbers, generators)
