"""A newcomer's first lines: the listing of the page, ends of runs, conventions, errors of the family."""

from __future__ import annotations

import io
import pickle
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import heavy_top

import liestep as ls

PAGE = (Path(__file__).resolve().parents[1] / "README.md").read_text(encoding="utf-8")
SCENES = Path(__file__).resolve().parents[3] / "examples" / "scenes"
J = np.array([3.0, 3, 4])


def exact(start, until):
    """The top of the page by SciPy: attitude and velocity at the end."""
    integrate = pytest.importorskip("scipy.integrate", reason="SciPy isn't there")

    def rates(_, state):
        attitude, (x, y, z) = state[:9].reshape(3, 3), state[9:]
        torque = 9.81 * np.cross(attitude[2], [0, 0, 1])
        turned = attitude @ [[0, -z, y], [z, 0, -x], [-y, x, 0]]
        return np.concatenate([turned.ravel(), (np.cross(J * state[9:], state[9:]) + torque) / J])

    begin = np.concatenate([start.matrix[0].ravel(), start.velocity[0]])
    end = integrate.solve_ivp(rates, (0, until), begin, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    return end[:9].reshape(3, 3), end[9:]


def away(run, attitude, velocity):
    """The distance that `Run.error` means."""
    size = max(np.linalg.norm(run.velocity[0]), np.linalg.norm(velocity))
    return np.hypot(np.linalg.norm(run.matrix[-1] - attitude) / 3**0.5, np.linalg.norm(run.velocity[-1] - velocity) / size)


def test_the_first_listing_of_the_page_agrees_with_scipy():
    matplotlib = pytest.importorskip("matplotlib", reason="matplotlib isn't there")
    matplotlib.use("Agg")
    listing = re.search(r"```python\n(.*?)```", PAGE, re.DOTALL)[1]
    names: dict[str, object] = {}
    exec(listing, names)
    run = names["run"]
    attitude, velocity = exact(run, 20)
    assert abs(run.velocity[-1] - velocity).max() < 1e-5 and abs(run.matrix[-1] - attitude).max() < 1e-5
    assert run.error < 1e-6 and len(run) == 1001 and run.time[-1] == 20


@pytest.mark.parametrize(("step", "method", "factor"), [
    (0.01, {}, 1.1), (0.005, {}, 1.1), (0.01, {"splitting": "Strang"}, 1.2), (6 / 99, {"splitting": "Strang"}, 1.2),
    (0.01, {"composition": "Suzuki 4"}, 1.3), (0.05, {"collocation": 4}, 1.3),
])
def test_a_run_says_how_far_its_end_is_off(step, method, factor):
    top = ls.lagrangian("SO3", advected={"w": "up"}, discretise="trapezoid(Cayley)", J=J, m=1, g=9.81, rho=[0, 0, 1],
                        l="1/2 * Omega.dot(J * Omega) - m * g * w.dot(rho)", up=[0, 0, 1])
    run = top.stepper(step, **method).run(attitude=ls.euler(0, 30, degrees=True), velocity=[0, 0, 12], until=6)
    true = away(run, *exact(run, 6))
    assert true / factor < run.error < true * factor
    assert "off by" in repr(run) and "off by" in run.html()


def test_what_cant_be_estimated_isnt():
    body = ls.body([1, 2, 2.5])
    stopped = body.stepper(0.01).run(velocity=[0.1, 2, 0.2], until=10, events={"turn": "velocity_x = 0, stop"})
    assert stopped.ended_by == "turn" and stopped.error is None
    varied = heavy_top().stepper(0.01, density={"turn": 1}).run(velocity=[0.1, 0, 6], until=1)
    assert varied.error is None and "off by" not in repr(varied)
    # Chaotic, and for long: no two runs agree.
    chaotic = heavy_top(J_d=[2, 1, 0.5], rho=[0.3, 0, 1]).stepper(0.05).run(velocity=[2, 2, 3], until=80)
    assert chaotic.error is None and "off by" not in repr(chaotic)


def test_a_run_without_a_step_has_forces_and_times():
    damped = ls.body([1, 2, 2.5]) + ls.drag(c=0.1, J=[1, 2, 2.5])
    run = damped.run(velocity=[0, 0, 1], until=5)
    assert abs(run.momentum[-1, 2] - 2.5 * np.exp(-0.1 * 5 / 2.5)) < 1e-5
    assert damped.run(velocity=[0, 0, 1], times=[0, 1, 2.5]).time.tolist() == [0, 1, 2.5]
    assert len(damped.run(velocity=[0, 0, 1], until=5, every=1)) == run.steps + 1


@pytest.mark.parametrize(("step", "until", "words"), [
    (0.1, -40, "lead away"), (-0.1, 40, "lead away"), (0.1, 0, "no steps"), (0.1, 1.234, "take 1.2 or 1.3 s"),
    (-0.1, -1.234, "take -1.2 or -1.3 s"), (0.1, 0.05, "take 0.0 or 0.1 s|take 0 or 0.1 s"), (0.1, None, "give `until`"),
])
def test_a_run_that_has_no_such_end(step, until, words):
    with pytest.raises(ls.SetupError, match=words):
        ls.body([1, 2, 3]).stepper(step).run(velocity=[0, 0, 1], until=until)


def test_ends_of_runs(tmp_path):
    body = ls.body([1, 2, 3])
    back = body.stepper(-0.1).run(velocity=[0.1, 0.2, 1], until=-4)
    again = body.stepper(0.1).run(attitude=back.matrix[-1], velocity=back.velocity[-1], until=4)
    assert back.steps == 40 and abs(again.momentum[-1] - back.momentum[0]).max() < 1e-13
    # The end is a row in both directions, where `every` doesn't divide the number of steps.
    for step in [0.1, -0.1]:
        thinned = body.stepper(step).run(velocity=[0.1, 0.2, 1], until=40 * step, every=7)
        assert len(thinned.time) == 7 and thinned.time[-1] == 40 * step
    assert body.stepper(0.1).run(velocity=[0, 0, 1], until=0.1 * 3).steps == 3
    by_times = body.stepper(0.1).run(velocity=[0, 0, 1], times=[0, 0.55])
    assert by_times.steps == 6 and by_times.time.tolist() == [0, 0.55]
    with pytest.raises(ls.SetupError, match="beyond the end"):
        body.stepper(0.1).run(velocity=[0, 0, 1], until=1, times=[0, 5])
    with pytest.raises(ls.SetupError, match="lead away"):
        body.stepper(0.1, density={"turn": 1}).run(velocity=[0, 0, 1], until=-1)
    with pytest.raises(ls.SetupError, match="whole number"):
        body.ensemble(3, step=0.1, velocity=[0, 0, 1]).run(tmp_path, until=0.25, progress=False)


def test_conventions():
    with pytest.raises(ls.SetupError, match=re.escape("ls.euler(0, 30, 0, degrees=True)")):
        ls.euler(0, 30)
    assert ls.euler(0, 400, degrees=True) != ls.euler(0, 2 * np.pi)
    # Its scalar is first: this is a half turn about the third axis.
    run = ls.body([1, 2, 3]).stepper(0.1).run(velocity=[0, 0, 1], attitude=[0, 0, 0, 1], until=0.1)
    assert np.allclose(run.matrix[0], np.diag([-1, -1, 1]))
    # A plate with mass at (1, 1, 0) and (−1, −1, 0): its product of inertia is 2, its matrix has −2.
    plate = ls.body([[2.0, -2, 0], [-2, 2, 0], [0, 0, 4]] + 0.1 * np.eye(3))
    momentum = plate.stepper(0.1).run(velocity=[1, 0, 0], until=0.1).momentum[0]
    assert np.allclose(momentum, [2.1, -2, 0])


def test_directions_are_of_length_one():
    for wrong in ({"up": [0, 0, 2]}, {"up": [0, 0, 0]}, {"up": [0, 0, np.nan]}):
        with pytest.raises(ls.DeclarationError, match="isn't of length one"):
            ls.gravity(m=1, rho=[0, 0, 1], **wrong)
    with pytest.raises(ls.DeclarationError, match=re.escape("write [0.6, 0.8, 0]")):
        ls.gravity_gradient(GM=1, r=1, J=[1, 2, 3], direction=[3, 4, 0])
    near = ls.gravity(m=1, rho=[0, 0, 1], up=[0, 0, 1.0005])
    assert near.parameters["up"].tolist() == [0, 0, 1]
    with pytest.raises(ls.DeclarationError, match="isn't of length one"):
        (ls.body([1, 2, 3]) + near).with_(up=[0, 0, 2])
    with pytest.raises(ls.SetupError, match="is a direction"):
        (ls.body([1, 2, 3]) + near).ensemble(3, velocity=[0, 0, 1], up=ls.normal([0, 0, 1], 0.1))




def test_columns_that_arent_side_by_side_are_copied(top):
    text = (SCENES / "double-pendulum.toml").read_text(encoding="utf-8").replace("duration = 5", "duration = 0.02")
    pendulum = ls.scene(SCENES / "double-pendulum.toml", text).run()
    assert pendulum.group("upper_").shape == (11, 7)
    again = pickle.loads(pickle.dumps(pendulum))
    assert repr(again) == repr(pendulum) and again.svg() == pendulum.svg() and again.steps == pendulum.steps
    for run in (pendulum, top.stepper(0.01).run(velocity=[0.5, 2, 12], until=0.1)):
        # Any letters that columns share begin a group.
        for start in {name[:length] for name in run.names for length in range(1, 7)}:
            expected = np.stack([run[name] for name in run.names if name.startswith(start)], axis=1)
            assert (run.group(start) == expected).all(), start


def test_errors_are_of_the_family(top):
    run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=0.1)
    line = ls.lagrangian("R1", l_d="m * (F - I).norm_squared() / (2 * h)", m=1).stepper(0.1).run(velocity=[1], until=1)
    assert abs(line.spatial_momentum - 1).max() < 1e-15
    assert line.attitude.shape == (11, 1) and line.attitude[-1, 0] == pytest.approx(1)
    for wrong in (lambda: run["colour"], lambda: run.group("colour"), lambda: line.matrix):
        with pytest.raises(ls.ColumnError):
            wrong()
    for wrong in ({"events": ["tilt > 1"]}, {"velocity": [[0, 0, 1]]}, {"velocity": [0, 0, 1 + 2j]},
                  {"velocity": np.ma.masked_array([0, 0, 1], [True, False, False])}):
        with pytest.raises(ls.Error):
            top.stepper(0.01).run(**{"velocity": [0, 0, 1], "until": 1, **wrong})
    with pytest.raises(ls.Error):
        top.with_(rho=[0, 1j, 0])


def test_a_run_pickles(top):
    run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=1, events={"low": "tilt > 1 deg"})
    again = pickle.loads(pickle.dumps(run))
    assert again.names == run.names and again.units == run.units and (again.momentum == run.momentum).all()
    assert len(again.events["low"]) == len(run.events["low"]) and again.error == run.error and repr(again) == repr(run)


def test_a_bar_is_for_a_terminal(top, tmp_path, monkeypatch):
    written = io.StringIO()
    monkeypatch.setattr(sys, "stderr", written)
    top.ensemble(3, velocity=[0, 0, 1]).run(tmp_path, until=0.1)
    assert written.getvalue() == ""
