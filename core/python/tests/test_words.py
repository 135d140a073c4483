"""Messages speak of what Python has."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import heavy_top

import liestep as ls


def declared(l: str, **parameters: object) -> object:  # noqa: E741
    return ls.lagrangian("SO3", l=l, discretise="trapezoid(Cayley)", J=[3, 3, 4], **parameters)


TURNS = "1/2 * Omega.dot(J * Omega)"
E = ls.DeclarationError


@pytest.mark.parametrize("made,message", [
    (lambda: declared(TURNS + " - m"), "`m` isn't known here: pass it by its name, or write its value\nknown: I, Omega, J"),
    (lambda: declared(TURNS + " * (0.1 * t).exp()"), "a Lagrangian has no time: pass what changes with it as a `ls.signal`"),
    (lambda: ls.force("SO3", work="t * a.dot(eta)", a=[0, 0, 1]), "virtual work has no time: pass what changes with it as a `ls.signal`"),
    (lambda: declared(TURNS + " - w.dot(a)", a=[0, 0, 1]), 'declare it with `advected={"w": "up"}`, where `up` holds its spatial value'),
    (lambda: declared(TURNS, m=3), "`m` isn't used in the Lagrangian: leave it out, or use it"),
    (lambda: declared(TURNS + " - w.z", up=np.eye(3), advected={"w": "up"}), "carries a vector of 3: use a list of 3 numbers"),
    (lambda: declared(TURNS + " - a.dot(a) / a", a=[0, 0, 1]), "multiply by `inverse(F)`, or by that of a parameter"),
    (lambda: ls.lagrangian("SE2", l_d="(F - I).norm_squared() / h + h * p.z", advected={"p": "up"}, up=ls.point([1, 2, 3])),
     "moves points of 2: use `ls.point` of 2 numbers"),
], ids=lambda one: one if isinstance(one, str) else "")
def test_a_mistake_of_a_text_has_words_of_python(made, message):
    with pytest.raises(ls.DeclarationError) as found:
        made()
    every = "\n".join(one for one, _, _ in found.value.mistakes) or str(found.value)
    assert message in every
    assert not any(word in every for word in ("struct", "step_with", "<f64", "given(", "field"))


def test_a_step_without_a_solution_has_words_of_python():
    with pytest.raises(ls.StepError) as found:
        heavy_top().stepper(1.0).run(velocity=[0, 0, 12], until=3)
    said = str(found.value)
    assert 'let `substeps` divide such steps. On SO(3) `ls.body(J, kinetic="geodesic")` turns a spin exactly' in said
    assert "or_substeps" not in said and "Body`" not in said


@pytest.mark.parametrize("call,message", [
    (lambda top: top.run(velocity=[0, 0, 1], until=1, step=0.01), "`run` has no `step`: a step is given before, as `term.stepper(0.01).run(…)`"),
    (lambda top: top.run(velocity=[0, 0, 1], until=1, accuracy=1e-8), "a run to an accuracy is `term.for_accuracy(1e-8, …)`"),
    (lambda top: top.stepper(0.01).run(velocity=[0, 0, 1], duration=1), "`run` has no `duration`: the end is `until=10`, s"),
    (lambda top: top.stepper(0.01).run(velocty=[0, 0, 1], until=1), "`run` has no `velocty`; did you mean `velocity`?"),
    (lambda top: top.stepper(0.01, method="Suzuki 4"), "`stepper` has no `method`: a method has its kind"),
    (lambda top: top.stepper(0.01).run([0, 0, 1]), "`run` takes velocity, momentum, attitude"),
    (lambda top: top.run([0, 0, 1]), "`run` takes arguments by their names, as `velocity=[0.5, 2, 12], until=10`"),
    (lambda top: top.for_accuracy(1e-8, [0, 0, 1]), "`for_accuracy` takes all but tolerance by their names, as `velocity="),
    (lambda top: ls.euler(0, 0.8, foo=1), "`euler` has no `foo`: it has precession, nutation, spin, degrees"),
])
def test_a_call_with_other_arguments_says_what_to_write(call, message):
    with pytest.raises(ls.CallError) as found:
        call(heavy_top())
    assert message in str(found.value) and isinstance(found.value, TypeError)


def test_an_ensemble_ends_in_its_run():
    with pytest.raises(ls.SetupError, match=r"`until` belongs into the run, as `term.ensemble\(100, …\).run\(folder, until=…\)`"):
        heavy_top().ensemble(10, velocity=[0, 0, 1], until=10)


@pytest.mark.parametrize("l,place", [
    ("1/2 * Omega.dot((J * Omega)", (1, 16)), ("1/2 * Omega.dot(J * Omega))", (1, 27)), ("1/2\n * Omega.dot(J * Omega]", (2, 23)),
])
def test_a_bracket_without_another_has_its_place(l, place):  # noqa: E741
    with pytest.raises(ls.DeclarationError) as found:
        declared(l)
    assert (found.value.line, found.value.column) == place and "bracket" in str(found.value)


def test_a_vector_in_the_place_of_a_matrix_is_said_to_be_a_diagonal():
    with pytest.raises(ls.DeclarationError, match=r"if `A` is the diagonal of a matrix, pass `A=np.diag\(A\)`$"):
        ls.lagrangian("SO3", l="1/2 * Omega.dot(A * Omega)", discretise="trapezoid(Cayley)", A=[1, 2, 5])
