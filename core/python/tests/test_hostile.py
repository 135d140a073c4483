"""Inputs that are wrong: an answer or an exception of the family, never a panic, a hang or a NaN that travels."""

from __future__ import annotations

import pickle
import signal
import threading
import time

import numpy as np
import pytest
from conftest import heavy_top

import liestep as ls

nan, inf = float("nan"), float("inf")


@pytest.mark.parametrize("text", [
    "((F - I) * J_d", "w.dot(", "std::fs::read(\"/etc/passwd\")", "panic!()", "", "F.unknown()", "x" * 100_000,
    "(" * 5000 + ")" * 5000, "0.5 * h * m * \x00", "m * g", "über * w",
])
def test_texts(text):
    with pytest.raises(ls.DeclarationError):
        ls.lagrangian("SO3", advected={"w": "up"}, l_d=text, J_d=[2, 2, 1], m=1, g=9.81, rho=[0, 0, 1], up=[0, 0, 1])


def test_a_mistake_has_its_line_and_column_and_advice():
    with pytest.raises(ls.DeclarationError) as found:
        ls.lagrangian("SO3", l_d="((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)\n  - h * gravty", J_d=[2, 2, 1], gravity=1)
    assert (found.value.line, found.value.column) == (2, 9)
    assert "gravity" in str(found.value)
    assert isinstance(found.value, ls.Error) and isinstance(found.value, ValueError)
    assert str(pickle.loads(pickle.dumps(found.value))).endswith(found.value.message)


@pytest.mark.parametrize("start", [
    {"velocity": [1, 2]}, {"velocity": [1, 2, 3, 4]}, {"velocity": "fast"}, {"velocity": [nan, 0, 0]},
    {"velocity": [inf, 0, 0]}, {"velocity": None}, {"velocity": [[1, 2, 3]] * 1000}, {"velocity": [1j, 0, 0]},
    {"velocity": [0, 0, 1], "attitude": [0, 0, 0, 0]}, {"velocity": [0, 0, 1], "attitude": [nan, 0, 0, 1]},
    {"velocity": [0, 0, 1], "attitude": np.ones((3, 3))}, {"velocity": [0, 0, 1], "attitude": np.eye(4)},
    {"velocity": [0, 0, 1], "attitude": object()}, {"velocity": [0, 0, 1], "attitude": np.diag([1, 1, -1])},
    {"velocity": np.array([1, 2, 3], dtype=object) * 10**400},
])
def test_starts(top, start):
    with pytest.raises(ls.Error):
        top.stepper(0.01).run(**start, until=1)


@pytest.mark.parametrize("course", [
    {"until": nan}, {"until": inf}, {"until": "long"}, {"until": 1, "every": 0}, {"until": 1, "every": -1},
    {"until": 1, "every": 2**70}, {"until": 1, "every": 1.5}, {"until": 1, "times": [nan]}, {"until": 1, "times": [[0.1]]},
    {"until": 1, "times": [0.5, 0.1]}, {"until": 1, "times": [0.5, 2]}, {"until": 1, "events": {"a": "tilt >"}}, {"until": 1, "events": {"a": "colour > 1"}},
    {"until": 1, "events": {"a": "tilt > 200 deg"}}, {"until": 1, "events": {"a": "tilt > -10 deg"}},
    {"until": 1, "events": {"a": 3}}, {"until": 1e12},
])
def test_courses(top, course):
    with pytest.raises(ls.Error):
        top.stepper(0.01).run(velocity=[0, 0, 1], **course)


@pytest.mark.parametrize("method", [
    {"composition": "none"}, {"collocation": 3}, {"splitting": "Strang", "composition": "Suzuki 4"}, {"substeps": 0},
    {"collocation": 4, "substeps": 2},
])
def test_methods(top, method):
    with pytest.raises(ls.Error):
        top.stepper(0.01, **method)


def test_a_step_of_a_composition_is_divided_where_it_has_no_solution(top):
    course = {"velocity": [0.5, 2, 12], "until": 1.5}
    with pytest.raises(ls.StepError, match="no solution"):
        top.stepper(0.15, composition="Suzuki 4").run(**course)
    divided = top.stepper(0.15, composition="Suzuki 4", substeps=2).run(**course)
    halves = top.stepper(0.075, composition="Suzuki 4").run(**course)
    assert abs(divided.momentum[-1] - halves.momentum[-1]).max() < 1e-12


@pytest.mark.parametrize("step", [0.0, nan, inf])
def test_steps(top, step):
    with pytest.raises(ls.Error):
        top.stepper(step).run(velocity=[0, 0, 1], until=1)


@pytest.mark.parametrize("parameters", [
    {"m": nan}, {"m": [1, 2]}, {"rho": [0, 1]}, {"J_d": [[1, 2, 3], [0, 1, 0], [0, 0, 1]]}, {"m": "heavy"}, {"m": np.zeros((2, 3))},
])
def test_parameters(parameters):
    with pytest.raises(ls.Error):
        heavy_top(**parameters).stepper(0.01).run(velocity=[0, 0, 1], until=1)


def test_a_scene_that_cant_be_split_is_refused(top):
    J = [3, 3, 4]
    turning = ls.lagrangian("SO3", l="Omega.dot(J * Omega) / 2 + a.dot(Omega) * w.dot(a)", discretise="trapezoid(Cayley)",
                            advected={"w": "up"}, J=J, a=[0, 0, 1], up=[0, 0, 1])
    for method in ({"splitting": "Strang"}, {"processed": ls.schemes()["processed"][0]}):
        with pytest.raises(ls.SetupError):
            turning.stepper(0.01, **method)
    # Collocation is of any Lagrangian.
    ends = [turning.stepper(0.01, **method).run(velocity=[0.3, 1, -0.5], until=1).momentum[-1]
            for method in ({"collocation": 4}, {"composition": "Suzuki 4"})]
    assert abs(ends[0] - ends[1]).max() < 1e-8
    with pytest.raises(ls.SetupError):
        (top + ls.drag(c=0.1, J=J)).stepper(0.01, splitting="Strang")
    with pytest.raises(ls.DeclarationError):
        ls.gravity(m=1, rho=[0, 0, 1]).stepper(0.01)


def test_a_step_without_a_solution_leaves_what_was_recorded():
    body = ls.body([1, 2, 2.5])
    with pytest.raises(ls.StepError) as found:
        body.stepper(0.1).run(velocity=[0, 25, 0.1], until=10)
    assert len(found.value.run) == 1 and found.value.run.velocity[0, 1] == 25
    assert body.stepper(0.1, substeps=64).run(velocity=[0, 25, 0.1], until=1).steps == 10


def test_columns_are_where_rust_wrote_them(top):
    run = top.stepper(0.01).run(velocity=[0, 0, 12], until=10)
    energy = run["energy"]
    assert energy.ctypes.data == run["energy"].ctypes.data == run.energy.ctypes.data
    assert run.velocity.ctypes.data == run["velocity_x"].ctypes.data and run.velocity.base is not None
    with pytest.raises(ValueError):
        energy[0] = 1.0
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow isn't there")
    table = run.table
    assert isinstance(table, pyarrow.Table) and table.num_rows == 1001
    assert table["energy"].chunk(0).buffers()[1].address == energy.ctypes.data
    assert table.schema.field("t").metadata == {b"unit": b"s"}


def test_columns_outlive_their_run(top):
    energy = top.stepper(0.01).run(velocity=[0, 0, 12], until=10)["energy"]
    others = [top.stepper(0.01).run(velocity=[0, 0, k], until=10) for k in range(20)]
    assert energy.shape == (1001,) and np.isfinite(energy).all() and abs(energy - energy[0]).max() < 1e-2
    assert len(others) == 20


def test_threads_run_at_once_and_have_the_same_bits(top):
    results: dict[int, np.ndarray] = {}

    def work(number: int) -> None:
        own = heavy_top(m=1.0 + number % 2)
        results[number] = own.stepper(0.01).run(velocity=[0.5, 2, 12], until=20).momentum

    threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all((results[number] == results[number % 2]).all() for number in range(8))


def test_ctrl_c_stops_a_run_and_loses_nothing(top):
    timer = threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,))
    timer.start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt) as found:
        top.stepper(0.01).run(velocity=[0.5, 2, 12], until=1e7, every=1000)
    assert time.monotonic() - begun < 20
    run = found.value.run
    assert len(run) > 2 and np.isfinite(run.energy).all() and run.steps >= 1000 * (len(run) - 2)


def test_a_declaration_a_stepper_and_an_ensemble_pickle(top):
    again = pickle.loads(pickle.dumps(top.stepper(0.01, composition="Suzuki 4")))
    one, other = (stepper.run(velocity=[0.5, 2, 12], until=1).momentum for stepper in (top.stepper(0.01, composition="Suzuki 4"), again))
    assert (one == other).all()
    assert pickle.loads(pickle.dumps(top)) == top and hash(top) == hash(heavy_top())


def test_a_thousand_declarations():
    for number in range(300):
        ls.lagrangian("SO3", l_d=f"{number + 1} * ((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)", J_d=[2, 2, 1])


def test_names_that_are_keywords_of_python():
    term = ls.lagrangian("SO3", l_d="lambda * ((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)", J_d=[2, 2, 1],
                         **{"lambda": 2.0})
    assert term.stepper(0.01).run(velocity=[0, 0, 1], until=1).steps == 100


WRONG = ["a", None, [1, 2], nan, -1, inf, 1j, object(), {}, [[1]], True, 2**70, b"x", np.ma.masked, [None]]
BODY, TURN = ls.body([1, 2, 3]), {"velocity": [0, 0, 1]}
CALLS = [
    lambda v: BODY.stepper(v), lambda v: BODY.for_accuracy(v, **TURN, until=1), lambda v: BODY.run(**TURN, until=v),
    lambda v: BODY.stepper(0.1).run(**TURN, until=v), lambda v: BODY.stepper(0.1).run(**TURN, times=v),
    lambda v: BODY.stepper(0.1).run(**TURN, until=1, every=v), lambda v: BODY.stepper(0.1).run(**TURN, until=1, events=v),
    lambda v: BODY.stepper(0.1).run(**TURN, until=1, attitude=v), lambda v: BODY.stepper(0.1).run(velocity=v, until=1),
    lambda v: BODY.stepper(0.1, composition=v), lambda v: BODY.stepper(0.1, substeps=v), lambda v: BODY.stepper(0.1, density=v),
    lambda v: BODY.ensemble(v, **TURN), lambda v: BODY.ensemble(2, **TURN, seed=v), lambda v: BODY.ensemble(2, **TURN, J_d=v),
    lambda v: BODY.ensemble(2, **TURN, method=v), lambda v: ls.normal(v, [1, 2, 3]), lambda v: ls.uniform([1, 2, 3], v),
    lambda v: ls.translation(v), lambda v: ls.euler(v, 0), lambda v: ls.point(v), lambda v: ls.body(v),
    lambda v: ls.body([1, 2, 3], kinetic=v), lambda v: ls.gravity(m=1, rho=v), lambda v: ls.gravity(m=1, rho=[0, 0, 1], up=v),
    lambda v: BODY.with_(J_d=v), lambda v: BODY.control(step=v, steps=3), lambda v: BODY.control(step=0.1, steps=v),
    lambda v: BODY.control(step=0.1, steps=3, goal=v), lambda v: BODY.control(step=0.1, steps=3, keep_out=v),
    lambda v: BODY.control(step=0.1, steps=3).solve(tolerance=v, iterations=0), lambda v: ls.scene("x.toml", v),
    lambda v: ls.lagrangian(v, l_d="h"), lambda v: ls.lagrangian("SO3", l_d=v), lambda v: ls.force("SO3", work=v),
    lambda v: ls.lagrangian("SO3", l_d="h", advected=v), lambda v: ls.lagrangian("SO3", l="h", velocity=v, discretise="a"),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("call", CALLS)
def test_wrong_kinds_are_errors_of_the_family(call):
    for wrong in WRONG:
        try:
            call(wrong)
        except ls.Error as error:
            assert str(error)


@pytest.mark.parametrize("wrong", [
    {"threads": "a"}, {"threads": -1}, {"every": 0}, {"every": 1.5}, {"chunk": 2**70}, {"share": 2}, {"share": "a"}, {"until": None},
])
def test_hostile_runs_of_an_ensemble(wrong, tmp_path):
    with pytest.raises(ls.Error):
        BODY.ensemble(2, **TURN).run(tmp_path, **{"until": 0.1, "progress": False, **wrong})
