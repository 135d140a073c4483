"""Motions as functions of JAX."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._declared import Sum
from ._traced import Traced
from .errors import SetupError


def jax(
    term: Sum,
    step: float,
    *,
    until: float | None = None,
    every: int | None = None,
    times: Any = None,
    attitude: Any = None,
    **method: Any,
) -> Callable[..., dict[str, Any]]:
    """A motion as a function of JAX arrays, with derivatives in both modes, on any group.

    The function has the arguments ``velocity``, ``turn`` and parameters of the term by their names: those that aren't given are
    the term's own numbers and have no derivatives. A ``turn`` displaces the attitude at the start about the axes of the
    body, rad; off SO(3) by the coordinates ``ζ`` of ``g exp ζ̂``. It returns a dictionary with ``time``, ``velocity``, ``momentum``,
    ``attitude`` (matrices, body to space; of a product all entries in a row), ``energy`` and ``spatial_momentum``, a row
    for each time.

    Steps are made outside of JAX in double precision: ``jit`` and ``vmap`` take it, one motion after the other, and other
    devices wait for it. Derivatives are those of the discrete motion, of the first order. An inertia of three rows counts
    as its symmetric part.

    Parameters
    ----------
    term : Term
        What is stepped, without a signal or a pace.
    step : float
        The length of a step, s.
    until, every, times, attitude
        As of `Stepper.run`.
    **method
        As of `Stepper`: ``composition="Suzuki 4"``.

    Raises
    ------
    SetupError
        JAX isn't installed; the errors of `Stepper` and of its run.

    Examples
    --------
    >>> import liestep as ls
    >>> import jax                                                                       # doctest: +SKIP
    >>> top = ls.body([3, 3, 4]) + ls.gravity(m=1.0, rho=[0, 0, 1])
    >>> motion = ls.jax(top, 0.01, until=2)                                              # doctest: +SKIP
    >>> height = lambda m: motion(jax.numpy.array([0.5, 2, 12]), m=m)["attitude"][-1, 2, 2]  # doctest: +SKIP
    >>> jax.grad(height)(1.0)                                                            # doctest: +SKIP
    """
    try:
        import jax as _jax
        import jax.numpy as jnp
        from jax.custom_derivatives import linear_call
    except ImportError as error:
        raise SetupError("`ls.jax` needs JAX, which isn't installed: `pip install jax`") from error
    import numpy as np

    traced = Traced(term, step, attitude, {"until": until, "every": every, "times": times}, method)

    def plain(tree: Any) -> dict[str, Any]:
        return {name: np.asarray(value, dtype=float) for name, value in tree.items()}

    def shaped(tree: Any) -> Any:
        return {name: np.asarray(value, dtype=np.dtype(jnp.result_type(float))) for name, value in tree.items()}

    def called(function: Callable[..., Any], like: Any, *trees: Any) -> Any:
        kind = jnp.result_type(float)
        shapes = {name: _jax.ShapeDtypeStruct(shape, kind) for name, shape in like.items()}
        host = lambda *trees: shaped(function(*map(plain, trees)))  # noqa: E731
        return _jax.pure_callback(host, shapes, *trees, vmap_method="sequential")

    @_jax.custom_jvp
    def motion(given: Any) -> Any:
        return called(traced.run, traced.outputs, given)

    @motion.defjvp
    def _(primals: Any, tangents: Any) -> Any:
        (given,), (change,) = primals, tangents
        inputs = {name: jnp.shape(value) for name, value in given.items()}
        along = lambda given, change: called(traced.along, traced.outputs, given, change)  # noqa: E731
        back = lambda given, by: called(traced.back, inputs, given, by)  # noqa: E731
        return motion(given), linear_call(along, back, given, change)

    def function(velocity: Any, turn: Any = None, **parameters: Any) -> dict[str, Any]:
        kind = jnp.result_type(float)
        given = {"velocity": velocity, **({} if turn is None else {"turn": turn}), **parameters}
        result: dict[str, Any] = motion({name: jnp.asarray(value, dtype=kind) for name, value in given.items()})
        return result

    return function
