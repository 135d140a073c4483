"""Motions as functions of PyTorch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._declared import Sum
from ._traced import Traced
from .errors import SetupError


def torch(
    term: Sum,
    step: float,
    *,
    until: float | None = None,
    every: int | None = None,
    times: Any = None,
    attitude: Any = None,
    **method: Any,
) -> Callable[..., dict[str, Any]]:
    """A motion as a function of PyTorch's tensors, with derivatives in both modes, on any group.

    Arguments, results and parameters are those of `liestep.jax`, with tensors on the CPU in double precision.

    Raises
    ------
    SetupError
        PyTorch isn't installed; the errors of `Stepper` and of its run.

    Examples
    --------
    >>> import liestep as ls
    >>> import torch                                                                     # doctest: +SKIP
    >>> motion = ls.torch(ls.body([1, 2, 2.5]), 0.01, until=1)                           # doctest: +SKIP
    >>> velocity = torch.tensor([0.1, 2.0, 0.1], requires_grad=True)                     # doctest: +SKIP
    >>> motion(velocity)["energy"][-1].backward()                                        # doctest: +SKIP
    """
    try:
        import torch as _torch
    except ImportError as error:
        raise SetupError("`ls.torch` needs PyTorch, which isn't installed: `pip install torch`") from error

    traced = Traced(term, step, attitude, {"until": until, "every": every, "times": times}, method)
    read = list(traced.outputs)

    def plain(names: Any, tensors: Any) -> dict[str, Any]:
        return {name: one.detach().cpu().double().numpy() for name, one in zip(names, tensors, strict=True)}

    def tensors(found: Any, names: Any) -> tuple[Any, ...]:
        return tuple(_torch.from_numpy(found[name].copy()) for name in names)

    class Motion(_torch.autograd.Function):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, names: Any, *given: Any) -> Any:
            ctx.names, ctx.kinds = names, [one.dtype for one in given]
            ctx.save_for_backward(*given)
            ctx.save_for_forward(*given)
            return tensors(traced.run(plain(names, given)), read)

        @staticmethod
        def backward(ctx: Any, *by: Any) -> Any:
            found = traced.back(plain(ctx.names, ctx.saved_tensors), plain(read, by))
            own = zip(tensors(found, ctx.names), ctx.kinds, strict=True)
            return None, *(one.to(kind) for one, kind in own)

        @staticmethod
        def jvp(ctx: Any, _: Any, *change: Any) -> Any:
            given = plain(ctx.names, ctx.saved_tensors)
            moved = {name: one for name, one in zip(ctx.names, change, strict=True) if one is not None}
            zeros = {name: value * 0 for name, value in given.items()}
            return tensors(traced.along(given, zeros | plain(moved, moved.values())), read)

    def function(velocity: Any, turn: Any = None, **parameters: Any) -> dict[str, Any]:
        given = {"velocity": velocity, **({} if turn is None else {"turn": turn}), **parameters}
        made = Motion.apply(tuple(given), *(_torch.as_tensor(value) for value in given.values()))
        return dict(zip(read, made, strict=True))

    return function
