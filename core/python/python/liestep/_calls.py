"""Calls with arguments that a function doesn't have: what to write instead."""

from __future__ import annotations

import difflib
import functools
import inspect
from collections.abc import Callable, Mapping
from typing import Any

from .errors import CallError

_UNTIL = "the end is `until=10`, s"
_START = "the start has `velocity=[0.5, 2, 12]`, rad/s in the axes of the body"
_ATTITUDE = "the start has `attitude=ls.euler(0, 0.8, 0)`"
_METHOD = 'a method is given before, as `term.stepper(0.01, composition="Suzuki 4")`'
_SCHEME = 'a method has its kind, as `composition="Suzuki 4"`, of those that `ls.schemes()` lists'

#: Words for what another argument or another call has, by the names of functions.
ADVICE: list[tuple[tuple[str, ...], str, str]] = [
    (("Stepper.run", "Stepper.start"), "step dt h time_step timestep", "a step is given before, as `term.stepper(0.01).run(…)`"),
    (("Stepper.run",), "accuracy tolerance tol rtol atol", "a run to an accuracy is `term.for_accuracy(1e-8, …)`"),
    (("Stepper.run", "Ensemble.run"), "duration t_end t_final t_max tmax end time horizon T", _UNTIL),
    (("Stepper.run",), "steps n_steps t_span", f"{_UNTIL}, which is their number times the step"),
    (("Stepper.run",), "t_eval", "times of rows are `times=[0, 0.5, 1]`, s"),
    (("Stepper.run", "Stepper.start"), "omega Omega w v0 velocities angular_velocity", _START),
    (("Stepper.run", "Stepper.start"), "euler quaternion orientation rotation R q angles", _ATTITUDE),
    (("Stepper.run",), "method scheme composition splitting processed collocation substeps compensated density", _METHOD),
    (("Ensemble.run",), "step dt h", "a step is given before, as `term.ensemble(100, step=0.01, …)`"),
    (("Stepper",), "dt h time_step timestep", "the step is `step=0.01`, s"),
    (("Stepper",), "method scheme integrator order", _SCHEME),
    (("Stepper",), "accuracy tolerance tol rtol atol", "a run to an accuracy is `term.for_accuracy(1e-8, …)`"),
    (("Stepper",), "until duration t_end velocity momentum attitude every times events", "it belongs into the run, as `term.stepper(0.01).run(until=10, …)`"),
]


def _called(call: str) -> str:
    """The words of a call: `run` for ``Stepper.run``, `stepper` for ``Stepper``."""
    return call.rpartition(".")[2] if "." in call else call[0].lower() + call[1:]


def _message(call: str, known: Mapping[str, inspect.Parameter], args: int, given: Mapping[str, Any]) -> str | None:
    """The message about a call's arguments, where their names or their number are wrong."""
    named = [name for name, one in known.items() if one.kind is not inspect.Parameter.POSITIONAL_ONLY and name != "self"]
    takes_any = any(one.kind is inspect.Parameter.VAR_KEYWORD for one in known.values())
    for name in () if takes_any else (name for name in given if name not in known):
        said = f"`{_called(call)}` has no `{name:.40}`"
        for calls, words, advice in ADVICE:
            if call in calls and name in words.split():
                return f"{said}: {advice}"
        if alike := difflib.get_close_matches(name, named, n=1, cutoff=0.6):
            return f"{said}; did you mean `{alike[0]}`?"
        return f"{said}: it has {', '.join(named)}" if named else f"{said}, and takes no arguments"
    places = [one for one in known.values() if one.kind in (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)]
    by_name = [name for name, one in known.items() if one.kind is inspect.Parameter.KEYWORD_ONLY]
    if args > len(places) and by_name:
        return f"`{_called(call)}` takes {', '.join(by_name)} by their names, as `{_called(call)}({by_name[0]}=…)`"
    if args > len(places) and takes_any:
        first = ", ".join(one.name for one in places if one.name != "self")
        example = ", as `velocity=[0.5, 2, 12], until=10`" if _called(call) in ("run", "for_accuracy") else ""
        return f"`{_called(call)}` takes {f'all but {first}' if first else 'arguments'} by their names{example}"
    return None


def _advised(call: str, function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def calling(*args: Any, **given: Any) -> Any:
        try:
            return function(*args, **given)
        except TypeError as error:
            if isinstance(error, CallError):
                raise
            signature = inspect.signature(function)
            try:
                signature.bind(*args, **given)
            except TypeError:
                message = _message(call, signature.parameters, len(args), given)
                if message is None:
                    raise error from None
                raise CallError(message) from None
            raise

    return calling


#: Classes of loops with a million calls a second, to which another call would add a quarter.
IN_LOOPS = ("State", "Moment")


def advise(module: dict[str, Any], names: list[str]) -> None:
    """Lets the functions and methods of these names say what to write where a call has arguments that they don't have."""
    done: set[type] = set()
    for name in names:
        one = module[name]
        if inspect.isfunction(one):
            module[name] = _advised(name, one)
            # It pickles by its place.
            setattr(inspect.getmodule(one), name, module[name])
        elif inspect.isclass(one) and not issubclass(one, Exception) and name not in IN_LOOPS:
            for owner in one.__mro__:
                if owner.__module__.startswith(__package__ or "liestep") and owner not in done:
                    done.add(owner)
                    _advise_methods(owner)


def _advise_methods(owner: type) -> None:
    for name, member in list(vars(owner).items()):
        is_made = name == "__init__" and not hasattr(owner, "__dataclass_fields__")
        if inspect.isfunction(member) and (is_made or not name.startswith("_")):
            setattr(owner, name, _advised(owner.__name__ if is_made else f"{owner.__name__}.{name}", member))
