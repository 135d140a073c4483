"""Steps in a loop: states, torques, copies."""

from __future__ import annotations

import copy
import pickle
import threading

import numpy as np
import pytest
from conftest import heavy_top

import liestep as ls

METHODS = [
    {}, {"composition": "Suzuki 4"}, {"splitting": "Strang"}, {"processed": "processed 3-6 a"}, {"collocation": 4},
    {"compensated": True}, {"substeps": 8}, {"density": {"turn": 1.0}},
]
START = {"velocity": [0.5, 2, 12], "attitude": ls.euler(0.3, 0.5, 0.1)}


def started(**method: object) -> ls.State:
    return heavy_top().stepper(0.01, **method).start(**START)


def last(run: ls.Run) -> list[float]:
    return [*run.velocity[-1], *run.momentum[-1], run["energy"][-1]]


def now(state: ls.State) -> list[float]:
    return [*state.velocity, *state.momentum, state.energy]


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_steps_of_a_loop_are_those_of_a_run(method):
    stepper = heavy_top().stepper(0.01, **method)
    state = stepper.start(**START)
    for _ in range(17):
        state.step()
    state.step(83)
    run = stepper.run(**START, until=state.time)
    assert state.steps == 100 and run.time[-1] == pytest.approx(state.time, abs=1e-15)
    if "density" not in method:
        # Splittings join the kicks of a stretch of steps.
        joins = method.keys() & {"splitting", "processed"}
        assert now(state) == (pytest.approx(last(run), rel=1e-12) if joins else last(run))
        matrix = run.matrix[-1]
        assert abs(state.attitude - matrix).max() < 1e-14
        assert abs(state.spatial_momentum - run.spatial_momentum[-1]).max() < 1e-13


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_a_copy_and_what_was_pickled_go_on_to_the_same_bits(method):
    state = started(**method)
    state.step(10)
    others = [state.copy(), copy.copy(state), copy.deepcopy(state), pickle.loads(pickle.dumps(state))]
    assert all(other == state for other in others)
    before = now(state)
    for other in others:
        other.step(25)
    assert all(other != state and now(other) != before for other in others)
    state.step(25)
    assert all(other == state and now(other) == now(state) for other in others)
    assert state != started(substeps=3) and state != 1


def test_states_of_other_groups_have_attitudes_that_start_a_motion():
    pair = ls.lagrangian({"F": "SO3", "d": "R3"}, m=2.0, J_d=[1, 2, 3],
                         l_d="((F - I) * J_d * (F - I).transpose()).trace() / (2 * h) + m * d.norm_squared() / (2 * h)")
    stepper = pair.stepper(0.01)
    state = stepper.start(velocity=[0.1, 0.2, 0.3, 1, 2, 3])
    state.step(50)
    turn, shift = state.attitude
    assert turn.shape == (3, 3) and shift.shape == (4, 4)
    assert shift[:3, 3] == pytest.approx([0.5, 1, 1.5], abs=1e-13)
    again = stepper.start(attitude=state.attitude, velocity=state.velocity)
    assert again.momentum == pytest.approx(state.momentum, abs=1e-14)


def test_what_is_advected_is_seen_from_the_body():
    for method in ({}, {"splitting": "Strang"}):
        state = started(**method)
        state.step(30)
        assert state.advected.keys() == {"up"}
        assert state.advected["up"] == pytest.approx(state.attitude.T @ [0, 0, 1], abs=1e-14)
    two = heavy_top() + ls.dipole(moment=[0, 0, 1], field=[1, 2, 3])
    state = two.stepper(0.01).start(**START)
    state.step(30)
    assert state.advected["field"] == pytest.approx(state.attitude.T @ [1, 2, 3], abs=1e-13)


def test_a_torque_that_is_held_is_the_effect_of_that_torque():
    push = [0.3, -0.2, 0.5]
    body = ls.body([1, 2, 2.5])
    run = (body + ls.torque(push)).stepper(0.01).run(velocity=[0.1, 2, 0.2], until=2)
    state = body.stepper(0.01).start(velocity=[0.1, 2, 0.2])
    state.step(200, torque=push)
    assert state.velocity == pytest.approx(run.velocity[-1], abs=1e-12)
    one_by_one = body.stepper(0.01).start(velocity=[0.1, 2, 0.2])
    for _ in range(200):
        one_by_one.step(torque=tuple(push))
    assert one_by_one == state


@pytest.mark.parametrize("method", METHODS[1:-1], ids=str)
def test_a_torque_acts_on_each_method(method):
    push = [3.0, -2, 5]
    state, finer = started(**method), heavy_top().stepper(0.001, composition="Suzuki 4").start(**START)
    free = state.copy()
    state.step(100, torque=push)
    finer.step(1000, torque=push)
    free.step(100)
    # Half of each impulse stands at either end of a step.
    # (3.13) itself is farther off.
    is_plain = method.keys() & {"compensated", "substeps"}
    assert state.velocity == pytest.approx(finer.velocity, abs=3e-2 if is_plain else 6e-3)
    assert abs(free.velocity - finer.velocity).max() > 1


def test_a_torque_about_an_axis_of_symmetry_has_its_impulse():
    state = ls.body([3, 3, 4]).stepper(0.1).start(velocity=[0, 0, 1])
    total = 4.0
    for step in range(40):
        torque = np.sin(step)
        state.step(torque=[0, 0, torque])
        total += 0.1 * torque
    assert state.momentum == pytest.approx([0, 0, total], abs=1e-14)


#: Velocity at 2 s of a body (1, 2, 2.5) from (.1, 2, .2) under the torque (.3 sin 3t, .2 cos 2t, -.4 t); by DOP853 to 1e-13.
DRIVEN = [0.10086979247257968, 1.9627683846704775, -0.30712779302194776]


def test_torques_of_the_middle_of_each_step_are_of_second_order():
    errors = []
    for steps in (100, 200, 400):
        step = 2 / steps
        state = ls.body([1, 2, 2.5]).stepper(step).start(velocity=[0.1, 2, 0.2])
        for _ in range(steps):
            t = state.time + step / 2
            state.step(torque=[0.3 * np.sin(3 * t), 0.2 * np.cos(2 * t), -0.4 * t])
        errors.append(np.linalg.norm(state.velocity - DRIVEN))
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.1)
    assert errors[1] / errors[2] == pytest.approx(4, abs=0.1)


def test_a_law_with_limits_holds_an_attitude_beside_a_disturbance():
    # The offset of a proportional law is the disturbance over its gain: half the sine of the axis is a quaternion's part.
    inertia, disturbance = np.array([0.02, 0.02, 0.01]), np.array([1e-4, -2e-4, 2e-4])
    gain, damping, most = 0.1, 0.05, 0.01
    state = ls.body(inertia).stepper(0.01).start(velocity=np.radians([-53, 78, 82]) / 10)
    for _ in range(6000):
        error = np.array([state.attitude[2, 1] - state.attitude[1, 2], state.attitude[0, 2] - state.attitude[2, 0],
                          state.attitude[1, 0] - state.attitude[0, 1]]) / (2 * np.sqrt(1 + np.trace(state.attitude)))
        state.step(torque=np.clip(-gain * error - damping * state.velocity, -most, most) + disturbance)
    assert error == pytest.approx([0.001, -0.002, 0.002], abs=1e-8)
    assert abs(state.velocity).max() < 1e-8


@pytest.mark.parametrize("method", METHODS[:-1], ids=str)
def test_given_values_act_in_their_steps_alone(method):
    state, other = started(**method), heavy_top(m=2.0).stepper(0.01, **method).start(**START)
    momentum = state.momentum
    state.step(20, given={"m": 2})
    other.step(20)
    # Guesses for the increments differ, and so do roundings.
    assert state.momentum == pytest.approx(other.momentum, abs=1e-9 if "processed" in method else 1e-11)
    assert state.steps == 20 and state.time == pytest.approx(0.2)
    assert abs(state.momentum - momentum).max() > 0.1
    assert state.energy == pytest.approx(other.energy - 9.81 * state.attitude[2, 2], abs=1e-9)
    free = started(**method)
    free.step(20)
    assert abs(state.momentum - free.momentum).max() > 0.1


def test_a_force_of_ones_own_has_its_input():
    # A damper whose coefficient is steered, about the axis of symmetry: (4 - c h / 2) / (4 + c h / 2) a step.
    damper = ls.force("SO3", work="-c * vee(F - F.transpose()).dot(eta) / 4 - c * vee(F - F.transpose()).dot(eta_next) / 4", c=0.0)
    step, moment = 1e-4, 4.0
    state = (ls.body([3, 3, 4]) + damper).stepper(step).start(velocity=[0, 0, 1])
    for number in range(100):
        state.step(given={"c": float(number % 2)})
    expected = ((1 - step / moment / 2) / (1 + step / moment / 2)) ** 50
    assert state.momentum[2] / moment == pytest.approx(expected, abs=1e-9)


def test_given_directions_are_of_length_one():
    state = (ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])).stepper(0.01).start(**START)
    before = state.copy()
    for given, error in [({"up": [0, 0, 2]}, "length one"), ({"mass": 1}, "no parameter"), ({"rho": [1, 2]}, "numbers"),
                         (5, "by the names"), ({"m": float("nan")}, "m")]:
        with pytest.raises(ls.Error, match=error):
            state.step(given=given)
    with pytest.raises(ls.SetupError, match="lengths of their own"):
        started(density={"turn": 1.0}).step(given={"m": 2})
    assert state == before
    state.step(given={"up": [1, 0, 0]})
    assert state.advected["up"] == pytest.approx(state.attitude.T @ [0, 0, 1], abs=1e-14)


@pytest.mark.parametrize("torque", [
    [1, 2], [1, 2, 3, 4], [1, 2, float("nan")], [1, 2, float("inf")], [[1, 2, 3]], "x", [1j, 2, 3], ["a", "b", "c"], 5, {},
    np.array([1j, 2, 3]), [np.complex128(1j), 2, 3], np.ma.array([1.0, 2, 3], mask=[0, 1, 0]), [None, 1, 2], [],
], ids=repr)
def test_what_is_no_torque_leaves_the_state(torque):
    state = started()
    state.step(3)
    before = state.copy()
    with pytest.raises(ls.SetupError):
        state.step(torque=torque)
    assert state == before


@pytest.mark.parametrize("steps", [0, -1, 1.0, True, "1", None, 2**52 + 1], ids=repr)
def test_what_is_no_number_of_steps_leaves_the_state(steps):
    state = started()
    before = state.copy()
    with pytest.raises(ls.SetupError):
        state.step(steps)
    assert state == before


def test_a_step_without_a_solution_leaves_the_state():
    # Twice the inertia's largest turn of (3.13) is beyond its step.
    state = ls.body([1, 2, 2.5]).stepper(0.1).start(velocity=[0.1, 2, 0.2])
    before = state.copy()
    with pytest.raises(ls.StepError, match="no solution"):
        state.step(torque=[0, 0, 5e3])
    with pytest.raises(ls.StepError):
        state.step(1000, torque=[0, 0, 10])
    assert state == before and state.steps == 0
    state.step()
    assert state.steps == 1


def test_steps_of_lengths_of_their_own_take_no_torque():
    with pytest.raises(ls.SetupError, match="lengths of their own"):
        started(density={"turn": 1.0}).step(torque=[0, 0, 1])


def test_tampered_numbers_are_no_state():
    state = started()
    _, (stepper, numbers) = state.__reduce__()
    for wrong in (numbers[:-1], [*numbers, 0.0], [], [float("nan"), *numbers[1:]], [*numbers[:-1], -1.0], [*numbers[:-1], 0.5]):
        with pytest.raises(ls.SetupError, match="no state"):
            stepper._resumed(wrong)


def test_threads_step_copies():
    state = started()
    copies = [state.copy() for _ in range(4)]
    threads = [threading.Thread(target=one.step, args=(2000,)) for one in copies]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    state.step(2000)
    assert all(one == state for one in copies)


def test_many_states_in_turns():
    # More than a thread keeps steppers of.
    states = [ls.body([1, 2, 2.5]).stepper(0.01).start(velocity=[0.1, 2, speed]) for speed in np.linspace(0, 1, 100)]
    for _ in range(3):
        for state in states:
            state.step()
    for speed, state in zip(np.linspace(0, 1, 100), states, strict=True):
        alone = ls.body([1, 2, 2.5]).stepper(0.01).start(velocity=[0.1, 2, speed])
        alone.step(3)
        assert alone == state
