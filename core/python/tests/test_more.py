"""Files, ensembles, pictures, and what is there where other packages are."""

from __future__ import annotations

import pickle
import signal
from pathlib import Path

import numpy as np
import pytest
from conftest import heavy_top

import liestep as ls

SCENES = Path(__file__).resolve().parents[3] / "examples" / "scenes"


def many(top, members=200):
    return top.ensemble(members, step=0.02, velocity=ls.normal([0, 0, 12], 0.1), seed=7, m=ls.uniform(0.9, 1.1))


def test_a_scene_of_one_body():
    run = ls.scene(SCENES / "falling-top.toml").run()
    assert len(run) > 100 and "energy" in run.names
    assert run.svg().startswith("<svg") and "<html" in (run.html() or "")


def test_a_scene_of_several_bodies():
    paths = [path for path in sorted(SCENES.glob("*.toml")) if "[[joint]]" in path.read_text()]
    run = ls.scene(paths[0]).run()
    assert len(run) > 10 and "<html" in run.html() and run.svg().startswith("<svg")


def test_steps_of_a_density_are_those_of_a_file():
    text = """title = "a top"
[body]
moments = [3, 3, 4]
[gravity]
m = 1
g = 9.81
rho = [0, 0, 1]
up = [0, 0, 1]
[start]
euler = [0, 0.8, 0]
velocity = [0.1, 0, 6]
[run]
step = 0.01
duration = 4
density = { turn = 0.5 }
[output]
columns = ["velocity"]
"""
    filed = ls.scene("top.toml", text).run()
    stepper = pickle.loads(pickle.dumps(heavy_top().stepper(0.01, density={"turn": 0.5})))
    run = stepper.run(velocity=[0.1, 0, 6], attitude=ls.euler(0, 0.8), until=4)
    lengths = np.diff(run.time)
    assert len(run) == len(filed) and lengths.max() > 1.005 * lengths.min() and "density" in repr(stepper)
    assert abs(run.velocity - filed.group("velocity_")).max() < 1e-10
    with pytest.raises(ls.SetupError):
        heavy_top().ensemble(10, velocity=[0, 0, 1], method={"density": {"turn": 1}}).run("nowhere", until=1)
    for wrong in ({"turn": 0}, {"turn": "a"}, {"distance": 1}, 1.0, {}):
        with pytest.raises(ls.SetupError):
            heavy_top().stepper(0.01, density=wrong)
    with pytest.raises(ls.SetupError):
        heavy_top().stepper(0.01, density={"turn": 1}, compensated=True)
    with pytest.raises(ls.SetupError):
        (heavy_top() + ls.drag(c=1, J=[3, 3, 4])).stepper(0.01, density={"turn": 1})


def test_a_mistake_of_a_file_has_its_place():
    with pytest.raises(ls.SceneError) as found:
        ls.scene("top.toml", 'title = "x"\n[body]\nmomnts = [1, 2, 3]\n')
    assert found.value.line == 3


def test_members_are_those_of_their_seed_whoever_makes_them(top, tmp_path):
    told = []
    whole = many(top).run(tmp_path / "whole", until=1, threads=2, chunk=20, progress=lambda done, all: told.append((done, all)))
    assert (whole.finished, whole.failed, whole.missing) == (200, 0, 0) and told
    # Two shares, the second by an ensemble that was pickled.
    first = many(top).run(tmp_path / "shares", until=1, share="0/2", chunk=20, progress=False)
    assert first.missing > 0
    again = pickle.loads(pickle.dumps(many(top)))
    both = again.run(tmp_path / "shares", until=1, share="1/2", chunk=20, progress=False)
    assert both.missing == 0
    for name in whole.names:
        assert (whole[name] == both[name]).all(), name
    names = [sorted(path.name for path in (tmp_path / folder).rglob("*.arrow")) for folder in ("whole", "shares")]
    assert names[0] == names[1]


def files_of(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*.arrow")}


@pytest.mark.parametrize("chunk", [None, 20])
def test_more_members_extend_a_folder(top, tmp_path, chunk):
    def ends(members, folder):
        return many(top, members).run(tmp_path / folder, until=1, every=10, chunk=chunk, progress=False)

    fewer, whole = ends(130, "grown"), ends(200, "whole")
    grown = ends(200, "grown")
    assert (grown.finished, grown.missing) == (200, 0) and grown.chunks >= fewer.chunks
    assert files_of(tmp_path / "grown") == files_of(tmp_path / "whole")
    # A folder with more members tells of the first ones.
    again = ends(130, "whole")
    assert (again.finished, again.missing, len(again)) == (130, 0, len(fewer))
    for name in fewer.names:
        assert (again[name] == fewer[name]).all() and (grown[name] == whole[name]).all(), name


def test_an_interrupt_says_what_is_kept(top, tmp_path):
    told = []

    def interrupt(done, all):
        told.append(done)
        if done >= 3:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt, match=r"\d+ of 100 chunks are kept in .*; the same `run` goes on there") as raised:
        many(top, 100).run(tmp_path, until=1000, chunk=1, progress=interrupt)
    kept = int(str(raised.value).split()[0])
    assert kept == len(files_of(tmp_path)) and 3 <= kept < 100


def test_a_member_is_the_run_of_its_numbers(top, tmp_path):
    fixed = top.ensemble(3, step=0.02, velocity=ls.normal([0, 0, 12], 0), seed=1)
    ends = fixed.run(tmp_path, until=1, progress=False)
    run = top.stepper(0.02).run(velocity=[0, 0, 12], until=1)
    assert (ends["momentum_z"] == run.momentum[-1, 2]).all()


def test_draws_are_those_of_their_distribution(top, tmp_path):
    ends = top.ensemble(2000, step=0.02, velocity=ls.normal([0, 0, 12], [0, 0, 0.1]), seed=3).run(tmp_path, until=0, progress=False)
    assert abs(ends["velocity_z"].mean() - 12) < 0.01 and abs(ends["velocity_z"].std() - 0.1) < 0.01
    turned = top.ensemble(2000, velocity=[0, 0, 1], attitude=ls.rotation(), seed=3)
    quaternions = turned.run(tmp_path / "turned", until=0, progress=False).group("q_")
    assert abs((quaternions**2).mean(axis=0) - 0.25).max() < 0.02


def test_a_folder_of_another_plan_is_refused(top, tmp_path):
    many(top).run(tmp_path, until=1, progress=False)
    with pytest.raises(ls.StoreError):
        many(top).run(tmp_path, until=2, progress=False)


def test_members_that_fail_are_told(tmp_path):
    fast = ls.body([1, 2, 2.5]).ensemble(20, step=0.1, velocity=ls.uniform([0, 20, 0], [1, 30, 1]), seed=1)
    ends = fast.run(tmp_path, until=1, progress=False)
    assert ends.failed == 20 and ends.failures[0][0] == 0 and "step" in ends.failures[0][2]


@pytest.mark.parametrize("wrong", [
    {"attitude": ls.normal([[1, 0, 0], [0, 1, 0], [0, 0, 1]], 0.1)},
    {"members": 0}, {"members": 2.5}, {"seed": -1}, {"m": 3}, {"x": ls.normal(0, 1)}, {"m": ls.normal([1, 2], 1)},
])
def test_hostile_ensembles(top, wrong):
    with pytest.raises(ls.Error):
        top.ensemble(**{"members": 10, "velocity": [0, 0, 1], **wrong})
    with pytest.raises(ls.Error):
        ls.uniform(1, 0)
    with pytest.raises(ls.Error):
        ls.normal(0, -1)


def test_what_a_notebook_shows(top):
    assert "align*" in top._repr_latex_() and top.derivation.strip() in top._repr_markdown_()
    assert "97 operations" in top.derivation and "kept = h(μ, w)" in top.derivation
    run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=5)
    assert run._repr_svg_().startswith("<svg") and "Path of the body" in run.svg()
    assert "<html" in run.html() and "500 steps of 0.01 s" in repr(run)
    assert repr(top).startswith("<lagrangian Lagrangian on SO3: J_d=")


def test_the_rate_of_a_letter_is_one_in_latex():
    text = "{ let U = |x: Vector3<f64>| x.norm_squared(); U(Omega) / 2 + Omega.dot(J * Omega) / 2 }"
    term = ls.lagrangian("SO3", l=text, discretise="trapezoid(Cayley)", J=[3, 3, 4])
    assert "dOmega/dt" in term.derivation and r"\mathrm{d}\Omega" in term.latex


def test_matplotlib_scipy_and_pandas_where_they_are(top, tmp_path):
    run = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=5, attitude=ls.euler(0.1, 0.4))
    scipy = pytest.importorskip("scipy.spatial.transform", reason="SciPy isn't there")
    assert abs(run.attitude.as_matrix() - run.matrix).max() < 1e-14
    again = top.stepper(0.01).run(velocity=[0.5, 2, 12], until=5, attitude=scipy.Rotation.from_quat(ls.euler(0.1, 0.4), scalar_first=True))
    assert (again.momentum == run.momentum).all()
    pandas = pytest.importorskip("pandas", reason="pandas isn't there")
    assert isinstance(run.to_pandas(), pandas.DataFrame)
    matplotlib = pytest.importorskip("matplotlib", reason="matplotlib isn't there")
    matplotlib.use("Agg")
    figure = run.plot()
    figure.savefig(tmp_path / "run.png")
    assert len(figure.axes) == 2 and (tmp_path / "run.png").stat().st_size > 1000
    assert run.plot(axes=matplotlib.pyplot.subplots(2)[1]) is not figure
    # The start is off by nothing, which is no reason for an axis of ten decades.
    least, most = figure.axes[1].get_ylim()
    assert most / least < 1e8 and most > abs(run.energy - run.energy[0]).max()
    still = ls.body([1, 2, 2.5]).stepper(0.01).run(velocity=[0, 0, 1], until=1).plot()
    assert 0 < still.axes[1].get_ylim()[0] < 1e-15


def _share(arguments):
    ensemble, folder, share = arguments
    return ensemble.run(folder, until=1, share=share, threads=1, progress=False).missing


def test_dask_takes_shares(top, tmp_path):
    distributed = pytest.importorskip("dask.distributed", reason="Dask isn't there")
    whole = many(top).run(tmp_path / "whole", until=1, progress=False)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True) as cluster:
        with distributed.Client(cluster) as client:
            work = [(many(top), str(tmp_path / "dask"), f"{share}/4") for share in range(4)]
            client.gather(client.map(_share, work, pure=False))
    both = many(top).run(tmp_path / "dask", until=1, progress=False)
    assert both.missing == 0 and (both["momentum_x"] == whole["momentum_x"]).all()


def test_ray_takes_shares(top, tmp_path):
    ray = pytest.importorskip("ray", reason="Ray isn't there")
    whole = many(top).run(tmp_path / "whole", until=1, progress=False)
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        # Ray's processes don't find this file: they are sent the function itself.
        task = ray.remote(lambda ensemble, folder, share: ensemble.run(folder, until=1, share=share, threads=1, progress=False).missing)
        ray.get([task.remote(many(top), str(tmp_path / "ray"), f"{share}/4") for share in range(4)])
    finally:
        ray.shutdown()
    both = many(top).run(tmp_path / "ray", until=1, progress=False)
    assert both.missing == 0 and (both["momentum_x"] == whole["momentum_x"]).all()


def test_events_by_functions(top):
    def low(now):
        return now.attitude[2, 2] - 0.5

    def stops(now):
        assert isinstance(now, ls.Moment) and now.velocity.shape == now.momentum.shape == (3,)
        return now.time - 0.777

    stops.terminal, stops.direction = True, 1
    start = {"velocity": [0.1, 0, 0.5], "attitude": ls.euler(0, 0.3)}
    stepper = top.stepper(0.01)
    run = stepper.run(**start, until=5, events={"low": low, "text": "tilt = 60 deg"})
    assert len(run.events["low"]) > 2
    assert run.events["low"].times == pytest.approx(run.events["text"].times, abs=1e-12)
    # A cosine that falls is a tilt that rises.
    assert (run.events["low"].rising == ~run.events["text"].rising).all()
    low.direction = -1
    fallen = stepper.run(**start, until=5, events={"low": low})
    assert fallen.events["low"].times.tolist() == run.events["low"].times[~run.events["low"].rising].tolist()
    ended = stepper.run(**start, until=5, events={"end": stops})
    assert ended.ended_by == "end" and ended.time[-1] == pytest.approx(0.78)
    assert ended.events["end"].times == pytest.approx([0.777], abs=1e-12)
    texts = {"deg/s": "velocity_z > 20 deg/s", "rpm": "velocity_z > 3.3333333333333333 rpm", "SI": "velocity_z > 0.3490658503988659"}
    units = ls.body([1, 2, 3]).stepper(0.01).run(velocity=[0.3, 0.6, 0.2], until=20, events=texts).events
    assert len(units["SI"]) > 0
    assert all(units[name].times == pytest.approx(units["SI"].times, abs=1e-9) for name in texts)
    with pytest.raises(ls.SetupError, match="`tilt` isn't in `kg` but in `rad`"):
        stepper.run(**start, until=1, events={"wrong": "tilt > 60 kg"})
    with pytest.raises(ls.SetupError, match="no event"):
        stepper.run(**start, until=1, events={"wrong": "tilt > 1.2.3"})
    energy = stepper.run(**start, until=1, events={"energy": lambda now: now.energy - 100})
    assert len(energy.events["energy"]) == 0


@pytest.mark.parametrize("answer,error", [
    (float("nan"), ls.StepError), ("x", ls.SetupError), (None, ls.SetupError), ([1, 2], ls.SetupError), (1j, ls.SetupError),
    (ZeroDivisionError("mine"), ZeroDivisionError),
], ids=repr)
def test_what_a_function_of_an_event_may_not_return_is_said(top, answer, error):
    def event(now):
        if now.time < 0.5:
            return 1.0
        if isinstance(answer, Exception):
            raise answer
        return answer

    with pytest.raises(error) as raised:
        top.stepper(0.01).run(velocity=[0.1, 0, 3], until=1, events={"event": event})
    assert len(raised.value.run) == pytest.approx(51, abs=1)


def test_times_are_in_their_order(top):
    with pytest.raises(ls.SetupError, match="order"):
        top.stepper(0.01).run(velocity=[0.1, 0, 3], times=[0, 0.7, 0.5])
    assert top.stepper(-0.01).run(velocity=[0.1, 0, 3], times=[0, -0.5, -0.7]).time.tolist() == [0, -0.5, -0.7]
    assert len(top.stepper(0.01).run(velocity=[0.1, 0, 3], times=[0, 0.5, 0.5])) == 3
