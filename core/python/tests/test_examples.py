"""The examples."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.fixture(scope="module")
def gymnasium():
    found = pytest.importorskip("gymnasium", reason="there is no gymnasium here (pip install gymnasium)")
    runpy.run_path(str(EXAMPLES / "raised.py"))
    return found


def test_gymnasium_takes_the_environment(gymnasium):
    from gymnasium.utils.env_checker import check_env

    env = gymnasium.make("Raised-v0")
    check_env(env.unwrapped, skip_render_check=True)
    begins = [env.reset(seed=7)[0] for _ in range(2)]
    assert (begins[0] == begins[1]).all() and (begins[0] != env.reset(seed=8)[0]).any()
    ends = []
    for _ in range(2):
        env.reset(seed=7)
        env.action_space.seed(3)
        for count in range(1, 501):
            seen, reward, terminated, truncated, _ = env.step(env.action_space.sample())
            assert np.isfinite(reward) and terminated is False and truncated is (count == 500)
        ends.append(seen)
    assert (ends[0] == ends[1]).all()


def test_without_torques_the_energy_stays(gymnasium):
    env = gymnasium.make("Raised-v0")
    env.reset(seed=1, options={"tilt": 2.0})
    energies = [env.step(np.zeros(3))[4]["energy"] for _ in range(500)]
    assert np.ptp(energies) < 0.02 and env.unwrapped.state.time == pytest.approx(10)


def test_a_law_holds_the_body_up(gymnasium):
    # The weight's torque is m g ρ × w for the tilt, 9.81 a rad.
    env = gymnasium.make("Raised-v0", most=20.0)
    seen, _ = env.reset(seed=2, options={"tilt": 0.5})
    for _ in range(500):
        up, velocity = seen[:3], seen[3:]
        seen, *_ = env.step(np.cross([0, 0, 1], up) - velocity / 4)
    assert seen[2] == pytest.approx(1, abs=1e-9) and abs(seen[3:]).max() < 1e-4


def test_pointing_from_two_lines_and_a_table(tmp_path):
    histogram = runpy.run_path(str(EXAMPLES / "pointing.py"))["histogram"]
    table = tmp_path / "torques.csv"
    table.write_text("t,x,y,z\n0,0,0,0\n")
    still = histogram(table)
    assert still[0] == 1 and still.sum() == pytest.approx(1)
    # A push of 1e-4 N m s about the normal, 1e-3 rad/s, is about the rate of the orbit: the axis swings by some 40 degrees.
    table.write_text("t,x,y,z\n0,0,0,0\n1000.7,0,1e-5,0\n1010.7,0,0,0\n")
    pushed = histogram(table)
    assert pushed[0] < 0.3 and pushed[2:5].sum() > 0.5 and pushed.sum() == pytest.approx(1)
