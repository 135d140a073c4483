"""The numbers of (3.13): what is kept, references of many digits, orders, bits."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import heavy_top, numbers, read

import liestep as ls

START = {"attitude": ls.euler(0.0, 0.8), "velocity": [0.5, 2.0, 12.0]}


def test_the_top_of_the_readme_keeps_what_it_should(top):
    run = top.stepper(0.01).run(**START, until=100)
    assert run.steps == 10_000
    assert abs(run.spatial_momentum[:, 2] - run.spatial_momentum[0, 2]).max() < 1e-11
    assert abs(run.energy - run.energy[0]).max() < 1e-2
    assert run["defect"].max() < 1e-12


@pytest.mark.parametrize("entry", [e for e in read("golden_steps")["steps"] if e["l_d"] == "dmv_trapezoid_(3.13)"],
                         ids=lambda entry: f"{entry['case']}-{entry['h']}")
def test_golden_steps(entry):
    J_d, seen, before = (numbers(entry[key]) for key in ("J_d", "w0", "Pi0"))
    J = J_d.sum() - J_d
    # An attitude that sees the vertical so: its third row.
    first = np.cross(seen, [0.3, 1.0, 0.2])
    first /= np.linalg.norm(first)
    attitude = np.array([first, np.cross(seen, first), seen])
    top = heavy_top(J_d=J_d, g=float(entry["mg"]), rho=numbers(entry["rho"]))
    h = float(entry["h"])
    run = top.stepper(h).run(attitude=attitude, velocity=before / J, until=10 * h)
    for row, name in ((1, "1"), (10, "10")):
        expected = numbers(entry[f"Pi{name}"])
        assert np.linalg.norm(run.momentum[row] - expected) < 2e-13 * np.linalg.norm(expected)
        assert np.linalg.norm(run.matrix[row].T[:, 2] - numbers(entry[f"w{name}"])) < 2e-13
    step = run.matrix[0].T @ run.matrix[1]
    assert abs(step - numbers(entry["F0"]).reshape(3, 3)).max() < 2e-14


METHODS = [
    ({}, 2), ({"composition": "Suzuki 4"}, 4), ({"splitting": "Strang"}, 2), ({"collocation": 4}, 8),
]


@pytest.mark.parametrize(("method", "order"), METHODS, ids=lambda value: str(value))
def test_orders_against_a_reference_of_30_digits(method, order):
    data = read("thesis_looping_A_Jd221")
    state = data["states"][0]
    start = {"attitude": numbers(data["initial"]["R"]), "velocity": numbers(data["initial"]["Omega"])}
    until, momentum = float(state["t"]), numbers(state["Pi"])
    steps = {2: (100, 200), 4: (40, 80), 8: (8, 16)}[order]
    errors = [
        np.linalg.norm(heavy_top().stepper(until / n, **method).run(**start, until=until).momentum[-1] - momentum)
        for n in steps
    ]
    assert np.log2(errors[0] / errors[1]) > order - 0.35, errors


def test_an_accuracy_is_reached():
    data = read("thesis_looping_A_Jd221")
    state = data["states"][0]
    start = {"attitude": numbers(data["initial"]["R"]), "velocity": numbers(data["initial"]["Omega"])}
    run = heavy_top().for_accuracy(1e-9, **start, until=float(state["t"]))
    assert np.linalg.norm(run.momentum[-1] - numbers(state["Pi"])) < 1e-7
    assert run.error < 1e-9 and "method" in run.choice


def test_a_sum_of_the_library_is_the_declaration(top):
    summed = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])
    one, other = (term.stepper(0.01).run(**START, until=5) for term in (top, summed))
    assert abs(one.momentum - other.momentum).max() < 1e-11


def test_liberties_of_notation_change_no_bit(top):
    free = ls.lagrangian(
        "SO3", advected={"w": "up"},
        l_d="((F - I) * J_d * (F - I).transpose()).trace() / (2 * h) - 1/2 * h * m * g * w.dot(rho + F * rho)",
        J_d=[2, 2, 1], m=1, g=9.81, rho=[0, 0, 1], up=[0, 0, 1],
    )
    one, other = (term.stepper(0.01).run(**START, until=5) for term in (top, free))
    assert (one.momentum == other.momentum).all() and (one.quaternion == other.quaternion).all()


# `cargo run --release --example beside -- bits` prints these: the compiled declaration, a thousand steps.
BITS = [0xBFF12E55C25E2611, 0x40187028C937B1CA, 0x4048000000000000]


def test_steps_have_the_bits_of_the_compiled_declaration(top):
    run = top.stepper(0.01).run(velocity=[0.5, 2.0, 12.0], until=10, every=1000)
    assert run.momentum[-1].view(np.uint64).tolist() == BITS


def test_a_force_takes_energy_and_a_sum_of_forces_more():
    J = [1, 2, 2.5]
    once, twice = ls.body(J) + ls.drag(c=0.1, J=J), ls.body(J) + ls.drag(c=0.1, J=J) + ls.drag(c=0.1, J=J)
    ends = [term.stepper(0.01).run(velocity=[0.1, 1, 0.1], until=5).energy for term in (once, twice)]
    assert ends[0][0] > ends[0][-1] > ends[1][-1]
    # A drag of c turns momentum by exp(−c tr(J⁻¹)/2 … t) or so; it is written by hand for a spin about one axis.
    axis = ls.body(J) + ls.drag(c=0.1, J=J)
    run = axis.stepper(0.001).run(velocity=[0, 0, 1], until=5)
    assert abs(run.momentum[-1, 2] - 2.5 * np.exp(-0.1 * 5 / 2.5)) < 1e-6


def test_events_of_a_run_to_an_accuracy_are_not_lost_in_long_steps():
    # The exact motion takes one step of 10 s, in which this velocity passes zero twice.
    body, start = ls.body([1, 2, 2.5]), {"velocity": [0.1, 2, 0.2], "until": 10}
    run = body.run(**start, events={"turn": "velocity_x = 0"})
    assert run.events["turn"].times == pytest.approx([0.53733015, 8.30160865], abs=1e-7)
    assert len(run) == 1001 and run.time[-1] == 10 and run.error < 1e-6
    forced = body + ls.torque([1e-9, 0, 0])
    assert forced.run(**start, events={"turn": "velocity_x = 0"}).events["turn"].times == pytest.approx([0.53733015, 8.30160865], abs=1e-6)
    with pytest.raises(ls.SetupError, match=r"`term.stepper\(-0.01\).run\(until=-3, …\)`"):
        body.run(velocity=[0.1, 2, 0.2], until=-3)
    stopped = body.run(**start, events={"turn": "velocity_x = 0, stop"})
    assert stopped.ended_by == "turn" and stopped.time[-1] <= 0.54


def test_events_are_found_between_steps(top):
    run = top.stepper(0.01).run(**START, until=20, events={"low": "tilt > 40 deg", "turn": "velocity_x = 0"})
    assert len(run.events["low"]) > 3 and len(run.events["turn"]) > 10
    assert abs(np.degrees(np.arccos(ls_axis(run.events["low"]))) - 40).max() < 1e-9
    assert abs(run.events["turn"]["velocity_x"]).max() < 1e-9
    stopped = top.stepper(0.01).run(**START, until=20, events={"low": "tilt > 40 deg, stop"})
    assert stopped.ended_by == "low" and stopped.time[-1] < 20


def ls_axis(columns):
    """The cosine of the tilt, of the quaternions."""
    w, x, y, z = columns.group("q_").T
    return 1 - 2 * (x * x + y * y)


def test_dense_output_is_the_path_between(top):
    times = [0.0, 0.003, 0.01, 1.2345]
    run = top.stepper(0.01).run(**START, until=2, times=times)
    assert run.time.tolist() == times
    every = top.stepper(0.01).run(**START, until=2)
    assert (run.momentum[2] == every.momentum[1]).all()
    assert abs(run.momentum[1] - every.momentum[0]).max() < 0.2


def test_compensated_sums_lose_less():
    body = ls.body([1, 2, 2.5])
    runs = [body.stepper(1e-3, compensated=c).run(velocity=[0.1, 2, 0.2], until=100, every=1000) for c in (False, True)]
    plain, careful = (abs(run.spatial_momentum - run.spatial_momentum[0]).max() for run in runs)
    assert careful < 1e-14 and 3 * careful < plain < 1e-11


def test_a_particle_falls_on_a_parabola():
    particle = ls.lagrangian(
        "R2", advected={"w": "up"}, m=1.5, g=9.81, origin=[0, 0, 1], up=[0, 1, 0],
        l_d="m * (F - I).norm_squared() / (2 * h) - h/2 * m * g * w.dot(origin + F * origin)",
    )
    run = particle.stepper(0.1).run(velocity=[3, 4], until=1)
    assert abs(run["x"][-1] - 3) < 1e-13 and abs(run["y"][-1] - (4 - 9.81 / 2)) < 1e-13


def test_a_body_with_its_place():
    body = ls.lagrangian(
        "SE3", advected={"w": "up"}, J=np.diag([2, 2, 1, 1.0]), g=9.81, r=[0, 0, 0, 1], up=[0, 0, 1, 0],
        l_d="((F - I) * J * (F - I).transpose()).trace() / (2 * h) - h/2 * g * w.dot(r + F * r)",
    )
    run = body.stepper(0.01).run(velocity=[0.1, 0.2, 3, 1, 0, 0], until=1)
    assert run.velocity.shape == (101, 6)
    assert abs(run.energy - run.energy[0]).max() < 1e-2
    place = run.group("g_").reshape(-1, 4, 4)[-1, :3, 3]
    assert abs(place - [1, 0, -9.81 / 2]).max() < 0.2


def test_a_pace():
    gap = "(2.0 + d - 2.0 * {}.dot(rho)).sqrt()"
    kinetic = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)"
    numbers = {"J_d": [0.6, 1.0, 0.2], "a": [0, 0.6, 0.8], "rho": [0, 0, 1], "d": 0.0025}
    needle = ls.lagrangian(
        "SO3", advected={"w": "a"}, pace=gap.format("w"), **numbers,
        l_d=f"{kinetic} + 0.5 * h * (1.0 / {gap.format('w')} + 1.0 / {gap.format('(F.transpose() * w)')})",
    )
    run = needle.stepper(0.01).run(velocity=[0.9, 0.1, 0.15], until=12)
    steps = np.diff(run["t"])
    assert 12 <= run["t"][-1] < 12 + steps.max() and steps.max() > 2 * steps.min()
    assert abs(run["energy"] - run["energy"][0]).max() < 0.02
    with pytest.raises(ls.SetupError):
        needle.stepper(0.01, composition="Suzuki 4")
    # An accuracy took steps without the pace, of another motion.
    with pytest.raises(ls.SetupError, match="pace"):
        needle.for_accuracy(1e-6, velocity=[0.9, 0.1, 0.15], until=3)
    with pytest.raises(ls.SetupError):
        (needle + ls.force("SO3", work="-c * vee(F).dot(eta)", c=0.1)).stepper(0.01)


def test_a_start_by_a_momentum():
    top = ls.body([3, 3, 4]) + ls.gravity(m=1, rho=[0, 0, 1])
    stepper = top.stepper(0.01)
    by_velocity = stepper.run(velocity=[0.5, 2, 12], until=1)
    by_momentum = stepper.run(momentum=by_velocity.momentum[0], until=1)
    assert abs(by_momentum.velocity - by_velocity.velocity).max() < 1e-12
    assert (stepper.start(momentum=[1, 2, 3]).momentum == [1, 2, 3]).all()
    sought = [top.for_accuracy(1e-6, until=1, **start) for start in ({"momentum": [1.5, 6, 48]}, {"velocity": [0.5, 2, 12]})]
    assert abs(sought[0].velocity[-1] - sought[1].velocity[-1]).max() < 1e-5 and sought[0].error < 1e-6
    for wrong in ({}, {"velocity": [0, 0, 1], "momentum": [0, 0, 4]}, {"momentum": [1, 2]}, {"momentum": [0, 0, float("nan")]}):
        with pytest.raises(ls.SetupError, match="momentum"):
            stepper.run(**wrong, until=1)


def test_the_axes_of_a_plot_have_units(top):
    pytest.importorskip("matplotlib").use("Agg")
    axes = top.stepper(0.01).run(velocity=[0, 0, 12], until=0.1).plot().axes
    assert [one.get_ylabel() for one in axes] == ["velocity, rad/s", "energy from its start, J"] and axes[1].get_xlabel() == "time, s"


def test_an_accuracy_is_not_divided_by_the_motion_of_the_whole():
    """A drift of 7 km/s took digits from the rotation, whose error was divided by it."""
    term = ls.lagrangian(
        {"F": "SO3", "d": "R3"}, velocity="Omega, v", advected={"w": "up.seen_from(F)"}, discretise="trapezoid(Cayley)",
        l="Omega.dot(J * Omega) / 2 + m * v.dot(v) / 2 - k * w.dot(a)", J=[3, 2.8, 4], m=2, k=5, a=[0.3, 0.1, 0.2], up=[0, 0, 1],
    )
    for drift in (0, 100, 7000):
        start = {"velocity": [0.5, 1, 3, drift, 0.2, -0.3], "attitude": [np.eye(3), ls.translation([0, 0, 0])], "until": 5}
        exact = term.stepper(0.005, composition="Kahan-Li 8").run(**start)
        away = lambda run: np.linalg.norm(run.velocity[-1, :3] - exact.velocity[-1, :3]) / 3.2
        assert away(term.for_accuracy(1e-4, **start)) < 1e-4
        rough = term.stepper(0.1).run(**start)
        assert 0.5 < rough.error / away(rough) < 5


def test_an_accuracy_of_places_has_no_unit():
    """Motions of a micrometre were off by 10 %, as shares of a metre."""
    term = ls.lagrangian(
        "R1", velocity="v", advected={"p": "o"}, o=ls.point([0.0]), discretise="trapezoid(Cayley)", l="m*v[0].powi(2)/2 - k*p[0].powi(2)/2",
        m=1.0, k=100.0,
    )
    for until in (2 * np.pi, 10.0):
        for size in (1, 1e-6, 1e-9):
            start = {"attitude": ls.translation([size]), "velocity": [0.0], "until": until}
            away = lambda run: max(abs(run["x"][-1] / size - np.cos(10 * until)), abs(run.velocity[-1, 0] / size / 10 + np.sin(10 * until)))
            chosen = term.run(**start)
            assert away(chosen) < 1e-6 and chosen.error < 1e-6
            short = term.stepper(until / 1000).run(**start)
            assert 0.5 < short.error / away(short) < 3


def test_the_accuracy_of_a_system_is_not_divided_by_its_drift():
    """Two bodies on a spring, that fly together by 7 km/s, got fewer steps, and were off by .07 rad/s."""

    def flying(drift, **run):
        body = lambda name, place, velocity: {
            "name": name, "m": 1, "moments": [0.1, 0.12, 0.15], "position": [place, 0, 0], "moving": [drift, 0, 0],
            "start": {"velocity": velocity},
        }
        spring = {"bodies": ["p", "q"], "at": [[0.1, 0.2, 0.3], [0.2, 0.1, 0]], "k": 20, "length": 0.5}
        bodies = [body("p", 0, [1, 2, 3]), body("q", 1, [0, 0, 0])]
        scene = {"title": "drift", "body": bodies, "spring": [spring], "output": {"columns": ["velocity"]}}
        run = ls.scene(scene | {"run": {"duration": 2, **run}}).run()
        return run.steps, np.array([run[f"{name}_velocity_{axis}"][-1] for name in "pq" for axis in "xyz"])

    _, exact = flying(0, step=0.002, method={"composition": "Kahan-Li 8"})
    counts = set()
    for drift in (0, 100, 7000):
        steps, end = flying(drift, accuracy=1e-5)
        counts.add(steps)
        assert abs(end - exact).max() < 5e-5
    assert max(counts) <= 1.1 * min(counts)
