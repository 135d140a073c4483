"""Motions as functions of JAX."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
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
    body, rad; off SO(3) by the coordinates ``ζ`` of ``g exp ζ̂``. The result is a dictionary with ``time``, ``velocity``, ``momentum``,
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
    except ImportError as error:
        raise SetupError("`ls.jax` needs JAX, which isn't installed: `pip install jax`") from error

    along = _tangent()
    traced = Traced(term, step, attitude, {"until": until, "every": every, "times": times}, method)
    read = tuple(traced.outputs)

    motion = _jax.custom_jvp(lambda given: _called(traced.run, traced.outputs, given))

    def changed(primals: Any, tangents: Any) -> Any:
        (given,), (change,) = primals, tangents
        names = tuple(given)
        made = along.bind(*given.values(), *(change[name] for name in names), traced=traced, names=names)
        return motion(given), dict(zip(read, made, strict=True))

    motion.defjvp(changed)

    def function(velocity: Any, turn: Any = None, **parameters: Any) -> dict[str, Any]:
        kind = jnp.result_type(float)
        given = {"velocity": velocity, **({} if turn is None else {"turn": turn}), **parameters}
        result: dict[str, Any] = motion({name: jnp.asarray(value, dtype=kind) for name, value in given.items()})
        return result

    return function


def _called(function: Callable[..., Any], shapes: dict[str, tuple[int, ...]], *trees: Any) -> Any:
    """A function of dictionaries of arrays, called outside of JAX."""
    import jax as _jax
    import jax.numpy as jnp
    import numpy as np

    kind = jnp.result_type(float)

    def host(*trees: Any) -> Any:
        plain = [{name: np.asarray(value, dtype=float) for name, value in tree.items()} for tree in trees]
        return {name: np.asarray(value, dtype=np.dtype(kind)) for name, value in function(*plain).items()}

    like = {name: _jax.ShapeDtypeStruct(shape, kind) for name, shape in shapes.items()}
    return _jax.pure_callback(host, like, *trees, vmap_method="sequential")


@cache
def _tangent() -> Any:
    """The tangent map of a motion as an operation of JAX, which is linear in the second half of its arguments: its transpose
    is `Traced.back`."""
    import jax as _jax
    import jax.numpy as jnp
    from jax.extend.core import Primitive
    from jax.interpreters import ad, batching, mlir

    along = Primitive("liestep_tangent")
    along.multiple_results = True

    def made(*arrays: Any, traced: Traced, names: tuple[str, ...]) -> list[Any]:
        given, change = (dict(zip(names, part, strict=True)) for part in (arrays[: len(names)], arrays[len(names) :]))
        found = _called(traced.along, traced.outputs, given, change)
        return [found[name] for name in traced.outputs]

    def shaped(*_: Any, traced: Traced, names: tuple[str, ...]) -> list[Any]:
        return [_jax.core.ShapedArray(shape, jnp.result_type(float)) for shape in traced.outputs.values()]

    def transposed(by: Any, *arrays: Any, traced: Traced, names: tuple[str, ...]) -> list[Any]:
        given = dict(zip(names, arrays[: len(names)], strict=True))
        full = dict(zip(traced.outputs, map(ad.instantiate_zeros, by), strict=True))
        found = _called(traced.back, {name: jnp.shape(value) for name, value in given.items()}, given, full)
        slopes = zip(names, arrays[len(names) :], strict=True)
        return [None] * len(names) + [found[name] if ad.is_undefined_primal(one) else None for name, one in slopes]

    def batched(arrays: Any, axes: Any, **rest: Any) -> Any:
        size = next(array.shape[axis] for array, axis in zip(arrays, axes, strict=True) if axis is not None)
        rows = [
            jnp.broadcast_to(array, (size, *jnp.shape(array))) if axis is None else jnp.moveaxis(array, axis, 0)
            for array, axis in zip(arrays, axes, strict=True)
        ]
        found = _jax.lax.map(lambda one: along.bind(*one, **rest), rows)
        return found, [0] * len(found)

    along.def_impl(made)
    along.def_abstract_eval(shaped)
    ad.primitive_transposes[along] = transposed
    batching.primitive_batchers[along] = batched
    mlir.register_lowering(along, mlir.lower_fun(made, multiple_results=True))
    return along
