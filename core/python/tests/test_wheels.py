"""Wheels of a file's scene in a loop: the run of the file, limits, momentum, and what is refused."""

import math
import pickle

import liestep as ls
import numpy as np
import pytest

WHEELS = [
    {"name": "roll", "axis": [1, 0, 0], "inertia": 2e-3, "speed": 50.0, "largest_torque": 0.05},
    {"name": "yaw", "axis": [0, 0, 1], "inertia": 1e-3, "largest_speed": 30.0},
]
TABLES = {
    "body": {"moments": [0.2, 0.25, 0.3]},
    "start": {"velocity": [0.01, 0.02, -0.01]},
    "run": {"step": 0.01, "duration": 2},
}


def scene(**torques):
    return ls.scene(TABLES | {"wheel": [wheel | ({"torque": torques[wheel["name"]]} if wheel["name"] in torques else {}) for wheel in WHEELS]})


def test_a_torque_in_a_loop_is_that_of_the_file():
    run = scene(roll=0.02, yaw=-0.01).run()
    state = scene(yaw=-0.004).start()
    for _ in range(200):
        state.step(torque={"roll": 0.02, "yaw": -0.006})
    assert state.velocity == pytest.approx([run[f"velocity_{axis}"][-1] for axis in "xyz"], abs=1e-14)
    assert state.wheels == pytest.approx({"roll": run["roll_speed"][-1], "yaw": run["yaw_speed"][-1]}, abs=1e-9)
    again = pickle.loads(pickle.dumps(state))
    for one in (state, again):
        one.step(10)
    assert again == state


def test_limits_and_momentum():
    state = scene().start()
    before = state.spatial_momentum
    # The torque is cut to .05 N m: the wheel's momentum changes by that, and the body's velocity takes it.
    state.step(100, torque={"roll": 1.0})
    momentum = 2e-3 * (state.wheels["roll"] + state.velocity[0])
    assert momentum == pytest.approx(2e-3 * (50 + 0.01) + 0.05, abs=1e-12)
    # A torque holds for its steps alone.
    state.step(10)
    assert 2e-3 * (state.wheels["roll"] + state.velocity[0]) == pytest.approx(momentum, abs=1e-13)
    state.step(500, torque={"yaw": 0.01})
    assert state.wheels["yaw"] == pytest.approx(30, abs=0.2)
    assert abs(state.spatial_momentum - before).max() < 1e-14


def test_three_wheels_turn_a_body_to_where_it_is_to_go():
    wheels = [{"name": axis, "axis": list(np.eye(3)[k]), "inertia": 1e-3, "largest_torque": 0.02} for k, axis in enumerate("xyz")]
    tables = TABLES | {"wheel": wheels, "start": {"euler": ["20 deg", "40 deg", "-30 deg"], "velocity": [0, 0, 0]}}
    state = ls.scene(tables).start()
    for _ in range(8000):
        R = state.attitude
        # The sine of half of the angle times its axis, and a damper.
        q = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (2 * math.sqrt(1 + np.trace(R)))
        torque = 0.02 * 2 * q + 0.12 * state.velocity
        state.step(torque=dict(zip("xyz", torque)))
    assert np.trace(state.attitude) == pytest.approx(3, abs=1e-6)
    assert abs(state.spatial_momentum).max() < 1e-14


def test_wheels_that_there_are_not():
    state = scene().start()
    with pytest.raises(ls.SetupError, match="inputs by names are those of wheels here: `roll`, `yaw`"):
        state.step(torque={"pitch": 1})
    with pytest.raises(ls.SetupError, match="the torque of the wheel `roll` is one number"):
        state.step(torque={"roll": [1, 2]})
    with pytest.raises(ls.SetupError, match="by its law"):
        scene(roll="-0.1 * speed").start().step(torque={"roll": 1})
    top = ls.body([3, 3, 4]).stepper(0.01).start(velocity=[0, 0, 1])
    assert top.wheels == {}
    with pytest.raises(ls.SetupError, match="those of several bodies and of wheels"):
        top.step(torque={"roll": 1})
