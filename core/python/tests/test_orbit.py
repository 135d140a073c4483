"""Motions along an orbit."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import liestep as ls

#: Of the mean motion one: times are mean anomalies, lengths semi-major axes.
UNIT = {"period": 2 * np.pi, "normal": [0, 0, 1], "eccentricity": 0.2}
J = [1.0, 1.3, 0.6]


def test_places_obey_newtons_law():
    orbit = ls.orbit(period=2 * np.pi, inclination="50 deg", ascending_node="20 deg", argument_of_periapsis="70 deg", eccentricity=0.6)
    times, h = np.linspace(0, 6, 200), 1e-3
    here = orbit.place(times)
    pull = -here / np.linalg.norm(here, axis=1)[:, None] ** 3
    found = (orbit.place(times + h) - 2 * here + orbit.place(times - h)) / h**2
    assert found == pytest.approx(pull, abs=2e-4)
    assert np.linalg.norm(orbit.place(0.0)) == pytest.approx(0.4) and orbit.place([[0, 1]]).shape == (1, 2, 3)
    assert orbit.nadir.at(times) == pytest.approx(-here / np.linalg.norm(here, axis=1)[:, None])
    assert orbit.distance.at(times) == pytest.approx(np.linalg.norm(here, axis=1))
    moving = (orbit.place(times + h) - orbit.place(times - h)) / (2 * h)
    turning = np.cross(here, moving) / (here**2).sum(axis=1)[:, None]
    assert orbit.turning.at(times) == pytest.approx(turning, abs=1e-4)


def test_a_state_and_elements_are_one_orbit():
    # The vis-viva equation at 7000 km about the Earth.
    GM, place, velocity = 3.986004418e14, np.array([7e6, 0, 0]), np.array([0, 5000.0, 6000.0])
    orbit = ls.orbit(position=place, velocity=velocity, GM=GM)
    axis = 1 / (2 / 7e6 - velocity @ velocity / GM)
    assert orbit.period == pytest.approx(2 * np.pi * (axis**3 / GM) ** 0.5, rel=1e-12)
    assert orbit.place(0.0) * axis == pytest.approx(place, rel=1e-12, abs=1e-3)
    assert (orbit.place(1e-2) - orbit.place(-1e-2)) * axis / 2e-2 == pytest.approx(velocity, rel=1e-6, abs=1e-2)


def test_axes_of_the_local_vertical():
    orbit = ls.orbit(**UNIT)
    for time in (0.0, 1.0, 4.0):
        x, y, z = orbit.local_vertical(time).T
        assert z == pytest.approx(orbit.nadir.at(time)) and y == pytest.approx([0, 0, -1])
        assert np.cross(y, z) == pytest.approx(x)


#: Velocity after a turn of an orbit of e = .2, of a body (1, 1.3, .6) from (.3, .2, 1.1) and the axes of space, the place from
#: pericentre along the first; place and motion by DOP853 to 1e-13.
TURNED = [-1.29664167676331, 0.4201650710981504, 0.4083024309177909]


@pytest.mark.parametrize("method,order", [({}, 2), ({"composition": "Suzuki 4"}, 4), ({"composition": "Kahan-Li 6"}, 6)], ids=str)
def test_a_gradient_of_gravity_along_an_ellipse(method, order):
    term = ls.body(J, kinetic="cayley") + ls.gravity_gradient(J=J, orbit=ls.orbit(**UNIT))
    errors = []
    for steps in (100, 200, 400):
        run = term.stepper(2 * np.pi / steps, **method).run(velocity=[0.3, 0.2, 1.1], until=2 * np.pi)
        errors.append(np.linalg.norm(run.velocity[-1] - TURNED))
    assert np.log2(errors[1] / errors[2]) == pytest.approx(order, abs=0.03 * order)


#: That motion with a dipole, drag, and drag of air that turns with the orbit, by DOP853 to 1e-13.
BRAKED = [0.5674382877371827, 0.031661661190069364, 0.38965012826116413]


@pytest.mark.parametrize("method,order", [({}, 2), ({"composition": "Suzuki 4"}, 4), ({"composition": "Kahan-Li 6"}, 6)], ids=str)
def test_forces_beside_a_composition_along_an_ellipse(method, order):
    orbit = ls.orbit(**UNIT)
    term = ls.body(J, kinetic="cayley") + ls.gravity_gradient(J=J, orbit=orbit)
    term += ls.dipole(moment=[0.3, -0.2, 0.5], field=orbit.field([0.2, 0.1, -1]))
    term += ls.drag(c=0.1, J=J) + ls.air_drag(c=0.05, air=orbit.turning, J=J)
    errors = []
    for steps in (100, 200, 400):
        run = term.stepper(2 * np.pi / steps, **method).run(velocity=[0.3, 0.2, 1.1], until=2 * np.pi)
        errors.append(np.linalg.norm(run.velocity[-1] - BRAKED))
    assert np.log2(errors[1] / errors[2]) == pytest.approx(order, abs=0.03 * order)


def test_a_long_body_librates():
    # In the plane by n √(3 (J_t - J_s) / J_t).
    orbit, moments = ls.orbit(period=2 * np.pi, normal=[0, 0, 1]), [1, 1, 0.25]
    term = ls.body(moments, kinetic="cayley") + ls.gravity_gradient(J=moments, orbit=orbit)
    # About the normal, which is against the second axis of the local vertical.
    turn = 1e-3
    tilted = orbit.local_vertical() @ np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])

    def ahead(now):
        return orbit.local_vertical(now.time)[:, 0] @ now.attitude[:, 2]

    run = term.stepper(0.02, composition="Suzuki 4").run(attitude=tilted, velocity=[0, -1, 0], until=20, events={"ahead": ahead})
    times = run.events["ahead"].times
    assert np.diff(times) == pytest.approx(np.pi / np.sqrt(3 * 0.75), rel=1e-6) and len(times) > 8


def test_what_a_file_has_along_an_orbit_is_that_of_python():
    keys = {"period": "95 min", "inclination": "51.6 deg", "ascending_node": "30 deg", "eccentricity": 0.1, "phase": "40 deg"}
    moments, equator, gain = [0.09, 0.1, 0.03], [0, 0, -3e-5], 2e4
    tables = {
        "title": "CubeSat", "body": {"moments": moments, "kinetic": "cayley"}, "orbit": keys,
        "gravity_gradient": {"direction": "nadir"}, "magnetic_damping": {"k": gain, "field": {"equator": equator}},
        "air_drag": {"c": 1e-5, "air": "orbit"},
        "start": {"euler": [0, 0.3, 0], "velocity": [0.01, 0.02, 0.03]}, "run": {"step": 5, "duration": 2000},
    }
    filed, orbit = ls.scene(tables).run(), ls.orbit(**keys)
    term = ls.body(moments, kinetic="cayley") + ls.gravity_gradient(J=moments, orbit=orbit)
    term = term + ls.magnetic_damping(k=gain, field=orbit.field(equator), J=moments)
    term = term + ls.air_drag(c=1e-5, air=orbit.turning, J=moments)
    run = term.stepper(5).run(velocity=[0.01, 0.02, 0.03], attitude=ls.euler(0, 0.3), until=2000)
    assert abs(run.velocity - filed.velocity).max() < 1e-13 < abs(run.velocity[-1] - run.velocity[0]).max()


def test_a_dipoles_field():
    orbit, equator = ls.orbit(**UNIT), np.array([1e-6, 2e-6, -3e-5])
    for time in (0.0, 1.0, 4.0):
        place = orbit.place(time)
        r = np.linalg.norm(place)
        expected = (equator - 3 * (equator @ place) * place / r**2) / r**3
        assert orbit.field(equator).at(time) == pytest.approx(expected, rel=1e-13)


def test_members_follow_an_orbit(tmp_path):
    orbit = ls.orbit(**UNIT)
    term = ls.body(J, kinetic="cayley") + ls.gravity_gradient(J=J, orbit=orbit)
    many = term.ensemble(20, velocity=ls.normal([0.3, 0.2, 1.1], 0.01), step=0.01).run(tmp_path, until=1, every=100, progress=False)
    own = many["member"] == 3
    run = term.stepper(0.01).run(velocity=many.group("velocity_")[own][0], until=1)
    assert many.group("velocity_")[own][-1] == pytest.approx(run.velocity[-1], abs=1e-12)
    elsewhere = ls.body(J, kinetic="cayley") + ls.gravity_gradient(J=J, orbit=ls.orbit(**UNIT | {"phase": 1.0}))
    with pytest.raises(ls.StoreError, match="another plan"):
        elsewhere.ensemble(20, velocity=ls.normal([0.3, 0.2, 1.1], 0.01), step=0.01).run(tmp_path, until=1, every=100, progress=False)


def test_orbits_are_values():
    orbit = ls.orbit(**UNIT)
    again = pickle.loads(pickle.dumps(orbit))
    assert again == orbit and hash(again) == hash(orbit) and orbit != ls.orbit(**UNIT | {"phase": 1})
    signals = [orbit.nadir, orbit.distance, orbit.turning, orbit.field([0, 0, 1e-5])]
    assert pickle.loads(pickle.dumps(signals)) == signals and len(set(signals)) == 4
    assert "nadir along" in repr(orbit.nadir) and orbit.nadir.ends == (-np.inf, np.inf)
    term = ls.body(J) + ls.gravity_gradient(J=J, orbit=orbit)
    assert pickle.loads(pickle.dumps(term)) == term and term.parameters["direction"] == orbit.nadir


@pytest.mark.parametrize("keys", [
    {}, {"period": 0}, {"period": -1, "normal": [0, 0, 1]}, UNIT | {"eccentricity": 1.0}, UNIT | {"eccentricity": "x"},
    UNIT | {"inclination": 1}, {"tle": "nothing"}, UNIT | {"colour": 1}, {"period": 1, "normal": [0, 0, 0]},
    UNIT | {"period": float("nan")}, UNIT | {"normal": [0, 0, 1j]},
    {"position": [7e6, 0, 0], "velocity": [0, 2e4, 0], "GM": 3.986e14}, UNIT | {"period": None},
], ids=str)
def test_what_is_no_orbit_is_said(keys):
    with pytest.raises(ls.SceneError):
        ls.orbit(**keys)


def test_what_follows_no_orbit_is_said():
    orbit = ls.orbit(**UNIT)
    for wrong in ({"orbit": orbit, "r": 1.0}, {"orbit": UNIT}, {"GM": 1.0}, {}):
        with pytest.raises(ls.DeclarationError):
            ls.gravity_gradient(J=J, **wrong)
    with pytest.raises(ls.DeclarationError, match="length one"):
        ls.gravity(m=1, rho=[0, 0, 1], up=orbit.turning)
    for wrong in ([1, 2], [[1, 2, 3]], "x", [1j, 2, 3]):
        with pytest.raises(ls.SetupError):
            orbit.field(wrong)
    with pytest.raises(ls.SetupError):
        ls.body(orbit.nadir)
    with pytest.raises(ls.SetupError):
        orbit.local_vertical([1, 2])
    with pytest.raises(ls.SceneError):
        ls.scene({"title": "x", "torque": {"torque": orbit.nadir}})


#: Speed at 600 s, deg/s, of a body (.9, .9, .3) that turns by 20 deg/s about each axis on a circle over the poles, under the torque
#: m × b by m = -k db/dt, as the body sees the field; by DOP853 to 1e-11.
DETUMBLED = 34.27672311168684


def test_two_readings_of_a_field_brake_a_body():
    orbit, errors = ls.orbit(period=5801.23, normal=[0, -1, 0]), []
    for steps in (3000, 6000):
        h = 600 / steps
        state = ls.body([0.9, 0.9, 0.3], kinetic="geodesic").stepper(h).start(velocity=np.radians([20, 20, 20]))
        before = orbit.field([0, 0, 3.1e-5]).at(0.0) @ state.attitude
        for field in orbit.field([0, 0, 3.1e-5]).at(h * np.arange(steps)):
            seen = field @ state.attitude
            moment, before = -1e4 * (seen - before) / h, seen
            state.step(torque=np.cross(moment, seen))
        errors.append(np.degrees(np.linalg.norm(state.velocity)) - DETUMBLED)
    # A delay turns the torque about the axis of the spin, so that the speed is of second order.
    assert abs(errors[1]) < 1e-3 and errors[0] / errors[1] == pytest.approx(4, abs=0.2)
