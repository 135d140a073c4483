"""Parameters that change with time."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from conftest import heavy_top

import liestep as ls

SWITCHED = {"times": [0, 0.7, 2.2], "values": [[0, 0, 0], [0, 0, 2], [0, 0, 0]], "between": "steps"}
START = {"velocity": [0.1, 2, 0.2]}


def pushed(**signal: object) -> ls.Term:
    return ls.body([3, 3, 4]) + ls.torque(ls.signal(**(signal or SWITCHED)))


def grown(t: np.ndarray) -> np.ndarray:
    return np.exp(0.2 * t)


def turning(t: np.ndarray) -> np.ndarray:
    return np.stack([np.sin(t), np.cos(2 * t), np.full_like(t, 0.5)], axis=1)


def test_rows_between_steps_up_to_the_end_of_a_signal():
    # The last rows stand where half a step ahead has no value.
    times = np.linspace(0, 4, 17)
    torque = ls.signal(times, np.stack([np.sin(3 * times), np.cos(times), 0.3 + 0 * times], 1), between="lines")
    body = ls.body([2, 2.6, 4.1]) + ls.torque(torque)
    run = body.run(velocity=[0.4, -1.1, 0.8], until=4)
    every = body.stepper(0.001).run(velocity=[0.4, -1.1, 0.8], until=4)
    assert len(run) == 1001 and run.time[-1] == 4 and abs(run.velocity - every.velocity[::4]).max() < 1e-5
    rows = body.stepper(0.25, composition="Suzuki 4").run(times=[3.9, 4], until=4, velocity=[0.4, -1.1, 0.8])
    assert abs(rows.velocity[-1] - every.velocity[-1]).max() < 1e-3


@pytest.mark.parametrize("substeps", [1, 4])
@pytest.mark.parametrize("step", [0.4, 0.25, 0.5, 0.05])
def test_an_impulse_is_exact_where_corners_lie_between_steps(step, substeps):
    run = pushed().stepper(step, substeps=substeps).run(velocity=[0, 0, 1], until=4)
    assert run.momentum[-1] == pytest.approx([0, 0, 4 + 2 * 1.5], abs=1e-13)


@pytest.mark.parametrize("scheme", ["Suzuki 4", "Kahan-Li 6", "Kahan-Li 8"])
@pytest.mark.parametrize("step", [0.4, 0.25, 0.05])
def test_stages_of_a_composition_share_an_impulse(step, scheme):
    # A potential -s x, whose stages go back in time, too.
    term = ls.lagrangian(
        "R1", velocity="v", advected={"p": "fixed"}, discretise="trapezoid(Cayley)", fixed=ls.point([0.0]), m=4.0,
        s=ls.signal([-1, 0.7, 2.2], [0, 2, 0], between="steps"), l="m * v[0].powi(2) / 2.0 - s * p[0]")
    run = term.stepper(step, composition=scheme).run(velocity=[1], until=4)
    assert run["momentum_1"][-1] == pytest.approx(7, abs=1e-12)


def test_an_impulse_of_lines_is_exact():
    # Triangles of 1.1 s and 2 N m, and of 0.4 s and -1 N m.
    term = pushed(times=[0, 0.3, 0.9, 1.4, 1.5, 1.8, 3], values=np.outer([0, 0, 2, 0, -1, 0, 0], [0, 0, 1]), between="lines")
    state = term.stepper(0.4).start(velocity=[0, 0, 1])
    state.step(6)
    assert state.momentum == pytest.approx([0, 0, 4 + 1.1 - 0.2], abs=1e-13)


def test_an_impulse_in_the_text_of_ones_own_force_is_exact():
    work = "h * s * (a.dot(eta) + a.dot(eta_next)) / 2"
    push = ls.force("SO3", work=work, a=[0, 0, 1], s=ls.signal([0, 0.7, 2.2], [0, 2, 0], between="steps"))
    run = (ls.body([3, 3, 4]) + push).stepper(0.4).run(velocity=[0, 0, 1], until=4)
    assert run.momentum[-1] == pytest.approx([0, 0, 7], abs=1e-13)


def test_steps_back_take_impulses_back():
    there = pushed().stepper(0.25).run(velocity=[0, 0, 1], until=4)
    late = ls.signal([-9, -3.3, -1.8], SWITCHED["values"], between="steps")
    # The end at 4 s is the start, so that a time is 4 s earlier.
    back = (ls.body([3, 3, 4]) + ls.torque(late)).stepper(-0.25).run(
        velocity=there.velocity[-1], attitude=there.quaternion[-1], until=-4)
    assert back.velocity[-1] == pytest.approx([0, 0, 1], abs=1e-13)


#: Caldirola's and Kanai's oscillator at 5 s: x'' + 0.2 x' + 4 x = 0 from x = 1 at rest.
RATE = 3.99**0.5
DAMPED = np.exp(-0.5) * (np.cos(5 * RATE) + 0.1 / RATE * np.sin(5 * RATE))


def oscillator(growth: object) -> ls.Term:
    return ls.lagrangian(
        "R1", velocity="v", advected={"p": "fixed"}, discretise="trapezoid(Cayley)", c=growth, k=4.0, fixed=ls.point([0.0]),
        l="c * (v[0].powi(2) - k * p[0].powi(2)) / 2.0")


@pytest.mark.parametrize("method,order", [({}, 2), ({"composition": "Suzuki 4"}, 4), ({"composition": "Kahan-Li 6"}, 6)], ids=str)
def test_orders_stay_beside_a_function_of_time(method, order):
    errors = []
    for steps in (25, 50, 100) if order == 6 else (50, 100, 200):
        run = oscillator(ls.signal(grown)).stepper(5 / steps, **method).run(
            attitude=ls.translation([1.0]), velocity=[0], until=5)
        errors.append(abs(run["x"][-1] - DAMPED))
    assert np.log2(errors[-2] / errors[-1]) == pytest.approx(order, abs=0.01 * order)


#: Velocity at 2 s of a body (1, 2, 2.5) from (.1, 2, .2), with the moment (.3, -.2, .5) in the field (sin t, cos 2t, .5); by
#: DOP853 to 1e-13.
TURNED = [-0.4236669955064099, 1.504298520951623, 0.5750416656399004]


@pytest.mark.parametrize("as_table", [False, True])
def test_a_field_that_turns_is_that_of_each_time(as_table):
    field = ls.signal(np.linspace(0, 2, 4001), turning, between="lines") if as_table else ls.signal(turning)
    term = ls.body([1, 2, 2.5], kinetic="cayley") + ls.dipole(moment=[0.3, -0.2, 0.5], field=field)
    errors = [
        np.linalg.norm(term.stepper(2 / steps).run(**START, until=2).velocity[-1] - TURNED) for steps in (100, 200, 400)]
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.1)
    assert errors[1] / errors[2] == pytest.approx(4, abs=0.1)


def test_a_state_has_the_values_of_its_own_time():
    field = ls.signal(turning)
    term = ls.body([1, 2, 2.5]) + ls.dipole(moment=[0.3, -0.2, 0.5], field=field)
    run = term.stepper(0.01).run(**START, until=1)
    state = term.stepper(0.01).start(**START)
    for _ in range(100):
        state.step()
    assert [*state.velocity, state.energy] == [*run.velocity[-1], run["energy"][-1]]
    now = turning(np.array([1.0]))[0]
    assert state.advected["field"] == pytest.approx(state.attitude.T @ now, abs=1e-14)
    kinetic = state.momentum @ state.velocity / 2
    assert state.energy == pytest.approx(kinetic - np.array([0.3, -0.2, 0.5]) @ state.attitude.T @ now, abs=1e-12)


def test_states_beside_signals_are_copied_and_pickle():
    for signal in (ls.signal(turning), ls.signal(np.linspace(0, 2, 9), turning, between="lines")):
        state = (ls.body([1, 2, 2.5]) + ls.dipole(moment=[0.3, -0.2, 0.5], field=signal)).stepper(0.01).start(**START)
        state.step(10, torque=[0.1, 0, 0])
        others = [copy.copy(state), pickle.loads(pickle.dumps(state))]
        for one in (state, *others):
            one.step(25)
        assert all(other == state for other in others)


@pytest.mark.parametrize("function", [grown, lambda t: grown(t)], ids=["by name", "without"])
def test_a_run_beside_a_function_pickles(function):
    run = heavy_top().with_(g=ls.signal(function)).stepper(0.01).run(velocity=[0.5, 2, 12], until=1)
    again = pickle.loads(pickle.dumps(run))
    assert (again.velocity == run.velocity).all() and again.error == run.error and 0 < run.error < 1


def test_the_momentum_of_a_body_that_grows_stays():
    # Moments of 4 kg m² about the axis, and 0.5 more a second.
    moments = ls.signal([0, 10], [[3, 3, 4], [3, 3, 9]], between="lines")
    for kinetic in ("rigid", "geodesic"):
        run = ls.body(moments, kinetic=kinetic).stepper(0.1).run(velocity=[0, 0, 1], until=8)
        assert run.momentum[:, 2] == pytest.approx(4, abs=1e-13)
        assert run.velocity[:, 2] == pytest.approx(4 / (4 + 0.5 * run.time), abs=1e-13)


def test_a_pivot_that_is_shaken_holds_a_pendulum_upright():
    # A point of 1 kg at 1 m stands where the pivot's speed is above √(2 g l), 4.43 m/s.
    rate, tilts = 100.0, []
    for speed in (4.75, 3.0):
        weight = ls.signal(lambda t, speed=speed: 9.81 - speed * rate * np.cos(rate * t))
        pendulum = ls.body([1, 1, 1e-2], kinetic="cayley") + ls.gravity(m=1, rho=[0, 0, 1], g=weight)
        run = pendulum.stepper(0.004).run(attitude=ls.euler(0, 0.1), velocity=[-speed / rate * 0.1, 0, 0], until=5)
        tilts.append(run.tilt.max())
    assert tilts[0] < 0.3 and tilts[1] > 3


def test_runs_to_an_accuracy_choose_a_method():
    run = pushed().for_accuracy(1e-5, velocity=[0.1, 0, 1], until=4)
    fine = pushed().stepper(2e-4).run(velocity=[0.1, 0, 1], until=4)
    assert run.error < 1e-5 and "composition" in run.method
    assert abs(run.matrix[-1] - fine.matrix[-1]).max() < 1e-5
    assert run.momentum[-1, 2] == pytest.approx(7, abs=1e-12)


def test_times_and_events_between_steps_have_their_values():
    run = pushed().stepper(0.4).run(velocity=[0, 0, 1], times=[0, 1, 3], until=3.2, events={"fast": "velocity_z > 1.5"})
    assert run.momentum[:, 2] == pytest.approx([4, 4.6, 7], abs=1e-12)
    # From rest at 4 of 6 kg m²/s; within a step the mean of its part acts.
    assert run.events["fast"].times == pytest.approx([1.7], abs=1e-9)


def test_signals_are_parameters():
    term = pushed()
    signal = term.parameters["torque"]
    assert signal == ls.signal(**SWITCHED) and signal != ls.signal([0], [[0, 0, 2]], between="steps")
    assert hash(signal) == hash(ls.signal(**SWITCHED))
    assert pickle.loads(pickle.dumps(term)) == term
    assert pickle.loads(pickle.dumps(ls.signal(turning))) == ls.signal(turning)
    still = term.with_(torque=[0, 0, 0])
    assert still.stepper(0.4).run(velocity=[0, 0, 1], until=4).momentum[-1, 2] == pytest.approx(4)
    again = still.with_(torque=signal)
    assert again == term and "3 values by steps" in repr(again)
    assert signal.at([0.5, 0.7, 5]).tolist() == [[0, 0, 0], [0, 0, 2], [0, 0, 0]]
    assert signal.at(1.0).shape == (3,) and np.isnan(signal.at(-1.0)).all()
    assert signal.ends == (0, np.inf) and signal.shape == (3,)
    # Two summands with one name have one signal, or each its own.
    mass = ls.signal([0, 1], [1, 2], between="lines")
    two = ls.gravity(m=mass, rho=[0, 0, 1]) + ls.gravity(m=mass, rho=[0, 1, 0])
    assert two.parameters["m"] == mass and two.with_(m_2=3).parameters["m_1"] == mass


def test_a_scene_of_tables_has_signals():
    tables = {
        "title": "Pushed", "body": {"moments": [3, 3, 4]}, "torque": {"torque": ls.signal(**SWITCHED)},
        "start": {"euler": [0, 0, 0], "velocity": [0, 0, 1]}, "run": {"step": 0.4, "duration": 4},
    }
    assert ls.scene(tables).run()["spatial_momentum_z"][-1] == pytest.approx(7, abs=1e-13)
    with pytest.raises(ls.SceneError, match="by values"):
        ls.scene(tables | {"torque": {"torque": ls.signal(turning)}})


def test_members_have_signals_by_values(tmp_path):
    draws = {"velocity": ls.normal([0.1, 0, 1], 0.1), "seed": 3, "step": 0.4}
    term = pushed()
    many = term.ensemble(20, **draws).run(tmp_path, until=4, every=1, progress=False)
    assert many.finished == 20
    first = many["member"] == 7
    alone = term.stepper(0.4).run(velocity=many.group("velocity_")[first][0], until=4)
    assert many.group("momentum_")[first][-1] == pytest.approx(alone.momentum[-1], abs=1e-12)
    other = pushed(**(SWITCHED | {"times": [0, 0.6, 2.2]})).ensemble(20, **draws)
    with pytest.raises(ls.StoreError, match="another plan"):
        other.run(tmp_path, until=4, every=1, progress=False)
    other = other.run(tmp_path / "other", until=4, progress=False)
    assert other["momentum_z"][7] == pytest.approx(alone.momentum[-1, 2] + 0.2, abs=1e-12)
    with pytest.raises(ls.SetupError, match="signals by values"):
        (ls.body([3, 3, 4]) + ls.torque(ls.signal(turning))).ensemble(20, **draws)
    with pytest.raises(ls.SetupError, match="isn't drawn"):
        term.ensemble(20, **draws, torque=ls.normal([0, 0, 1], 0.1))


@pytest.mark.parametrize("method", [
    {"splitting": "Strang"}, {"processed": "processed 3-6 a"}, {"collocation": 4}, {"compensated": True},
    {"density": {"turn": 1.0}},
], ids=str)
def test_other_methods_say_what_is_beside_a_signal(method):
    top = heavy_top().with_(g=ls.signal(grown))
    with pytest.raises(ls.SetupError, match="composition"):
        top.stepper(0.01, **method)


def test_a_plan_and_given_values_take_no_signals():
    with pytest.raises(ls.SetupError, match="signal"):
        ls.body(ls.signal([0], [[1, 2, 2.5]], between="steps")).control(step=0.1, steps=10)
    state = heavy_top().stepper(0.01).start(velocity=[0, 0, 1])
    with pytest.raises(ls.SetupError, match="signal"):
        state.step(given={"m": ls.signal(grown)})
    with pytest.raises(ls.SetupError, match="signal"):
        heavy_top().with_(g=ls.signal(grown)).stepper(0.01).start(velocity=[0, 0, 1]).step(given={"m": 2})


@pytest.mark.parametrize("times,values,between,message", [
    ([0, 1, 1], [1, 2, 3], "steps", "increase"), ([1, 0], [1, 2], "lines", "increase"), ([], [], "steps", "a time"),
    ([0], [1], "lines", "two"), ([0, 1], [1, 2, 3], "steps", "each of 2"), ([0, 1], 3, "steps", "each of 2"),
    ([0, float("nan")], [1, 2], "steps", "finite"), ([0, 1], [1, float("inf")], "steps", "finite"),
    ([0, 1], [1, 2j], "steps", "real"), ([0, 1], np.ma.array([1.0, 2], mask=[0, 1]), "steps", "masked"),
    ([[0, 1]], [1], "steps", "list of times"), ([0, 1], [1, 2], "spline", "between"), ([0, 1], [1, 2], None, "between"),
    ([0, 1], ["a", "b"], "steps", "numbers"), ([0, 1], [[], []], "steps", "a value"), ("x", [1], "steps", "numbers"),
    (grown, [1, 2], "steps", "alone"), (grown, None, "steps", "alone"), ([0, 1], lambda t: t[:1], "steps", "each of 2"),
    ([0, 1], None, "steps", "numbers"),
], ids=str)
def test_what_is_no_signal_is_said(times, values, between, message):
    with pytest.raises(ls.SetupError, match=message):
        ls.signal(times, values, between=between)


def test_runs_beyond_a_signal_are_refused():
    short = pushed(times=[0, 2], values=[[0, 0, 1], [0, 0, 2]], between="lines")
    stepper = short.stepper(0.1)
    assert len(stepper.run(velocity=[0, 0, 1], until=2)) == 21
    with pytest.raises(ls.SetupError, match="`torque` has values from 0 s to 2 s"):
        stepper.run(velocity=[0, 0, 1], until=3)
    with pytest.raises(ls.SetupError, match="from 0 s"):
        stepper.term.stepper(-0.1).run(velocity=[0, 0, 1], until=-1)
    late = pushed(times=[1, 2], values=[[0, 0, 1], [0, 0, 2]], between="steps")
    with pytest.raises(ls.Error, match="`torque` has no value about 0 s: its signal has values from 1 s on"):
        late.stepper(0.1)
    state = stepper.start(velocity=[0, 0, 1])
    state.step(20)
    before = state.copy()
    with pytest.raises(ls.StepError, match="`torque` has no value about 2.05 s: its signal has values from 0 to 2 s"):
        state.step()
    assert state == before


def test_mistakes_of_a_function_are_raised():
    def wrong(t):
        return np.full(t.shape, float("nan")) if t[0] > 0.5 else np.ones(t.shape)

    def broken(t):
        if t[0] > 0.5:
            raise ZeroDivisionError("mine")
        return np.ones(t.shape)

    start = {"velocity": [0, 0, 1]}
    for function, error, message in [(wrong, ls.SetupError, "finite"), (broken, ZeroDivisionError, "mine")]:
        stepper = heavy_top().with_(g=ls.signal(function)).stepper(0.1)
        with pytest.raises(error, match=message) as raised:
            stepper.run(**start, until=1)
        assert len(raised.value.run) == 6
        state = stepper.start(**start)
        with pytest.raises(error, match=message):
            state.step(10)
        assert state.steps == 0
        state.step(5)
        assert state.steps == 5
    for function in (lambda t: 1.0, lambda t: np.ones((len(t) + 1,)), lambda t: t * 1j, lambda t: None, lambda t: np.ones((1, 0))):
        with pytest.raises(ls.Error):
            heavy_top().with_(g=ls.signal(function))
    with pytest.raises(TypeError):
        ls.signal(lambda: 1.0)


def test_directions_over_time_are_of_length_one():
    def up(t):
        return np.stack([np.sin(t), 0 * t, np.cos(t)], axis=1)

    top = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1], up=ls.signal(up))
    table = top.with_(up=ls.signal(np.linspace(0, 1, 1001), up, between="lines"))
    runs = [one.stepper(0.01).run(velocity=[0, 1, 5], until=1) for one in (top, table)]
    assert runs[0].velocity[-1] == pytest.approx(runs[1].velocity[-1], abs=1e-5)
    with pytest.raises(ls.DeclarationError, match="other lengths"):
        top.with_(up=ls.signal([0, 1], [[0, 0, 1], [0, 0, 2]], between="lines"))
    long = top.with_(up=ls.signal(lambda t: up(t) * (1 + (t[0] > 0.5))))
    with pytest.raises(ls.SetupError, match="length one"):
        long.stepper(0.01).run(velocity=[0, 1, 5], until=1)


def test_a_function_may_step_another_state():
    other = heavy_top().stepper(0.01).start(velocity=[0, 0, 1])

    def weight(t):
        other.step()
        return 9.81 + 0 * t

    state = heavy_top().with_(g=ls.signal(weight)).stepper(0.01).start(velocity=[0, 0.1, 1])
    state.step(10)
    plain = heavy_top().stepper(0.01).start(velocity=[0, 0.1, 1])
    plain.step(10)
    assert state.velocity == pytest.approx(plain.velocity, abs=1e-12) and other.steps > 10


def pair(torque: object, **run: object) -> dict[str, object]:
    """Two bodies that turn about one axis against each other."""
    body = {"m": 2, "position": [0, 0, 0], "start": {"euler": [0, 0, 0], "velocity": [0, 0, 0]}}
    return {
        "body": [{"name": "a", "moments": [1, 2, 2.5], **body}, {"name": "b", "moments": [3, 3, 4], **body}],
        "joint": [{"name": "hinge", "kind": "pin", "bodies": ["a", "b"], "at": np.zeros((2, 3)), "axes": [[0, 0, 1], [0, 0, 1]], "torque": torque}],
        "run": {"step": 0.4, "duration": 4} | run, "output": {"columns": ["velocity"]},
    }


@pytest.mark.parametrize(("torque", "impulse", "within"), [
    (ls.signal([0, 0.7, 2.2], [0, 2, 0], between="steps"), 3, 1e-13), (ls.signal([0, 1, 3.1, 5], [0, 1.5, 0, 0], between="lines"), 2.325, 1e-13),
    (ls.signal(np.linspace(0, 4, 4001), lambda t: t**2 / 10, between="lines"), 6.4 / 3, 1e-6),
    ({"formula": "t / 4"}, 2, 1e-13), (0.5, 2, 1e-13)])
def test_a_motor_between_bodies_has_its_impulse(torque, impulse, within):
    run = ls.scene(pair(torque)).run()
    assert [2.5 * run["a_velocity_z"][-1], 4 * run["b_velocity_z"][-1]] == pytest.approx([-impulse, impulse], rel=within)


def test_a_loop_takes_a_motor_over_time_and_a_torque():
    state = ls.scene(pair(ls.signal([0, 0.7, 2.2], [0, 2, 0], between="steps"))).start()
    for _ in range(10):
        state.step(torque={"hinge": 0.5})
    assert 4 * state.velocity[8] == pytest.approx(3 + 0.5 * 4, abs=1e-12)


def test_a_function_of_python_is_no_part_of_a_file():
    with pytest.raises(ls.SceneError, match=r"a file has signals by values: write `ls.signal\(times, function"):
        ls.scene(pair(ls.signal(np.sin)))
    with pytest.raises(ls.SceneError, match="this has no value at the start"):
        ls.scene(pair({"formula": "1 / t"}))
