"""Several bodies of a file in a loop: torques in joints, forces on bodies."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import liestep as ls


def two_bodies(name: str, bodies: str, joints: str, step: float) -> ls.Scene:
    return ls.scene(f"{name}.toml", f"""
    title = "{name}"
    gravity = {{ g = 9.81, up = [0, 0, 1] }}
    body = [{bodies}]
    joint = [{joints}]
    run = {{ step = {step}, duration = 1 }}
    """)


def rod(name: str) -> str:
    return f'{{ name = "{name}", m = 1, moments = [0.1, 0.1, 0.001] }},'


def acrobot(step: float, elbow: str = "") -> ls.Scene:
    return two_bodies("acrobot", rod("upper") + rod("fore"), f"""
        {{ name = "shoulder", kind = "pin", bodies = ["space", "upper"], at = [[0, 0, 0], [0, 0, 0.5]],
          axes = [[0, 1, 0], [0, 1, 0]] }},
        {{ name = "elbow", kind = "pin", bodies = ["upper", "fore"], at = [[0, 0, -0.5], [0, 0, 0.5]],
          axes = [[0, 1, 0], [0, 1, 0]]{elbow} }},
    """, step)


def cart(step: float, bodies: str = '["space", "cart"]') -> ls.Scene:
    return two_bodies("cart", '{ name = "cart", m = 1, moments = [1, 1, 1] },' + rod("pole"), f"""
        {{ name = "rail", kind = "slider", bodies = {bodies}, at = [[0, 0, 0], [0, 0, 0]], axes = [[1, 0, 0], [1, 0, 0]] }},
        {{ name = "hinge", kind = "pin", bodies = ["cart", "pole"], at = [[0, 0, 0], [0, 0, 0.5]],
          axes = [[0, 1, 0], [0, 1, 0]], angle = 0.5 }},
    """, step)


#: Shoulder and elbow, rad and rad/s, after 1 s from rest under 2 sin 3t in the elbow, by DOP853 in joint coordinates.
ACROBOT = {"shoulder": (-0.09048150325879273, 1.2683179717423207), "elbow": (0.5082411774421574, -3.7175847520640852)}
#: Rail, m and m/s, and hinge after 1 s from .5 rad at rest under 3 cos 2t along the rail, by DOP853.
CART = {"rail": (0.37928626, 0.95128312), "hinge": (-0.12799891, 1.08612545)}


@pytest.mark.parametrize(("scene", "name", "effort", "expected", "rounding"), [
    (acrobot, "elbow", lambda t: 2 * np.sin(3 * t), ACROBOT, 1e-9),
    (cart, "rail", lambda t: 3 * np.cos(2 * t), CART, 1e-7),
], ids=["acrobot", "cart"])
def test_efforts_in_joints_are_of_second_order(scene, name, effort, expected, rounding):
    errors = []
    for steps in (50, 100, 200):
        state = scene(1 / steps).start()
        for _ in range(steps):
            state.step(torque={name: effort(state.time + 0.5 / steps)})
        joints = state.joints
        assert joints.keys() == expected.keys()
        errors.append(max(abs(np.subtract(joints[joint], expected[joint])).max() for joint in expected))
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.3)
    assert errors[1] / errors[2] == pytest.approx(4, abs=0.2)
    assert rounding < errors[2] < 5e-3


def test_a_held_torque_is_that_of_the_file():
    held = acrobot(0.01, ", torque = 0.7").start()
    state = acrobot(0.01).start()
    held.step(100)
    state.step(100, torque={"elbow": 0.7})
    for name, coordinate in held.joints.items():
        assert state.joints[name] == pytest.approx(coordinate, abs=1e-9)


def test_a_joint_in_the_other_order_has_the_other_sign():
    one, other = cart(0.01).start(), cart(0.01, '["cart", "space"]').start()
    one.step(20, torque={"rail": 1.0})
    other.step(20, torque={"rail": -1.0})
    assert other.joints["rail"] == pytest.approx([-part for part in one.joints["rail"]], abs=1e-13)
    assert other.joints["hinge"] == pytest.approx(one.joints["hinge"], abs=1e-13)


def test_forces_and_torques_on_bodies_have_their_impulses():
    text = """
    title = "Two free bodies"
    body = [
        { name = "one", m = 2, moments = [1, 1, 1], position = [0, 0, 0], start = { euler = [0, 0, 0], velocity = [0, 0, 0] } },
        { name = "two", m = 3, moments = [1, 2, 2.5], position = [1, 0, 0], start = { euler = [0, 0, 0], velocity = [0, 0, 0] } },
    ]
    run = { step = 0.01, duration = 1 }
    """
    state = ls.scene("two.toml", text).start()
    state.step(100, torque={"two": [0, 0, 0.5]}, force={"one": [1, 2, 3], "two": [0, 0, 3]})
    one, two = state.bodies["one"], state.bodies["two"]
    assert one.moving == pytest.approx([0.5, 1, 1.5], abs=1e-13)
    assert one.position == pytest.approx([0.25, 0.5, 0.75], abs=1e-13)
    assert one.velocity == pytest.approx([0, 0, 0], abs=1e-15)
    assert two.velocity == pytest.approx([0, 0, 0.2], abs=1e-13)
    assert two.position == pytest.approx([1, 0, 0.5], abs=1e-13)
    assert two.attitude[1, 0] == pytest.approx(np.sin(0.1), abs=1e-5)


def test_a_loop_without_inputs_is_the_run_of_the_file():
    scene = acrobot(0.01, ", damping = 0.1, torque = 0.3")
    state, run = scene.start(), scene.run()
    for _ in range(100):
        state.step()
    assert state.bodies["fore"].position == pytest.approx([run[f"fore_{axis}"][-1] for axis in "xyz"], abs=1e-12)
    assert state.energy == pytest.approx(run["energy"][-1], abs=1e-12)


def test_states_of_files_are_copied_and_pickled():
    state = acrobot(0.01).start()
    state.step(10, torque={"elbow": 1})
    again, other = pickle.loads(pickle.dumps(state)), state.copy()
    assert again == state == other
    for one in (state, again, other):
        one.step(10, torque={"elbow": -1})
    assert again == state == other
    assert state != acrobot(0.02).start()


def test_one_body_of_a_file_goes_in_a_loop():
    text = """
    title = "A top"
    body = { moments = [3, 3, 4] }
    gravity = { m = 1, g = 9.81, rho = [0, 0, 1], up = [0, 0, 1] }
    start = { euler = ["0 deg", "30 deg", "0 deg"], velocity = [0, 0, 12] }
    run = { step = 0.01, duration = 1 }
    """
    scene = ls.scene("top.toml", text)
    state, run = scene.start(), scene.run()
    state.step(100)
    assert state.velocity == pytest.approx(run.velocity[-1], abs=1e-13)
    state.step(torque=[0, 0, 1])
    assert state.bodies == {} and state.joints == {}
    with pytest.raises(ls.SetupError, match="several bodies"):
        state.step(torque={"body": 1})
    with pytest.raises(ls.SetupError, match="of the file"):
        state.step(given={"m": 2})
    with pytest.raises(ls.SetupError, match="no names"):
        _ = state.advected


@pytest.mark.parametrize(("inputs", "message"), [
    ({"torque": {"knee": 1}}, "there is no `knee`: there are the bodies `upper`, `fore`, and joints `shoulder`, `elbow`"),
    ({"torque": {"elbow": [1, 2]}}, "is one number"),
    ({"torque": {"fore": 1}}, "three components"),
    ({"force": {"elbow": [1, 2, 3]}}, "there is no `elbow`"),
    ({"force": [1, 2, 3]}, "by names"),
    ({"torque": {"elbow": float("nan")}}, "finite"),
    ({"torque": {"elbow": 1j}}, "real numbers"),
    ({"torque": {3: 1}}, "text"),
    ({"torque": [1, 2, 3]}, "12 components"),
    ({"given": {"m": 1}}, "of the file"),
], ids=str)
def test_what_is_no_input_leaves_the_state(inputs, message):
    state = acrobot(0.01).start()
    before = state.copy()
    with pytest.raises(ls.Error, match=message):
        state.step(**inputs)
    assert state == before


TABLES = {
    "title": 'A "cart" \x7f with a pole\n', "gravity": {"g": 9.81, "up": np.array([0, 0, 1])},
    "body": [
        {"name": "cart", "m": "1 kg", "J": np.eye(3)},
        {"name": "pole", "m": np.float64(1), "moments": (0.1, 0.1, 0.001)},
    ],
    "joint": [
        {"name": "rail", "kind": "slider", "bodies": ["space", "cart"], "at": np.zeros((2, 3)), "axes": [[1, 0, 0], [1, 0, 0]]},
        {"name": "hinge", "kind": "pin", "bodies": ["cart", "pole"], "at": [[0, 0, 0], [0, 0, 0.5]],
         "axes": [[0, 1, 0], [0, 1, 0]], "angle": 0.5},
    ],
    "run": {"step": 0.01, "duration": np.int64(1), "nearest": False},
}


def test_a_rail_with_friction_and_a_rotor():
    m, rotor, pull = 2, 0.5, 2 * 9.81 * 0.6
    rail = {"name": "rail", "kind": "slider", "bodies": ["space", "cart"], "at": np.zeros((2, 3)), "axes": [[1, 0, 0], [1, 0, 0]]}

    def end(**terms):
        state = ls.scene({
            "title": "incline", "gravity": {"g": 9.81, "up": [-0.6, 0, 0.8]},
            "body": [{"name": "cart", "m": m, "moments": [1, 1, 1]}],
            "joint": [{**rail, "armature": rotor, **terms}], "run": {"step": 0.01, "duration": 1},
        }).start()
        state.step(400)
        return state.joints["rail"][1]

    friction = {"force": 0.5 * pull, "below": 1e-4}
    assert end(friction=friction, speed=1) == pytest.approx(1 + 4 * 0.5 * pull / (m + rotor), abs=1e-5)
    # It creeps where f v/√(v² + u²) is the pull.
    assert end(friction={"force": f"{2 * pull} N", "below": "0.02 m/s"}) == pytest.approx(0.02 / np.sqrt(3), abs=1e-9)
    with pytest.raises(ls.Error, match="a `force`, N"):
        end(friction={"torque": 1, "below": 1})


def test_tables_are_the_scene_of_the_file():
    scene, file = ls.scene(TABLES), cart(0.01)
    assert scene.title == 'A "cart" \\u{7f} with a pole\\n'
    run, other = scene.run(), file.run()
    for name in other.names:
        assert (run[name] == other[name]).all()
    state = pickle.loads(pickle.dumps(scene)).start()
    state.step(10)
    begun = file.start()
    begun.step(10)
    assert state.joints == begun.joints


@pytest.mark.parametrize(("tables", "message"), [
    ({}, "missing field"),
    ({**TABLES, "title": 3}, "string"),
    ({**TABLES, 3: 3}, "texts"),
    ({**TABLES, "wind": 3}, "unknown field `wind`"),
    ({**TABLES, "gravity": {"g": 1j, "up": [0, 0, 1]}}, "real numbers"),
    ({**TABLES, "gravity": {"g": None, "up": [0, 0, 1]}}, "gravity.g"),
    ({**TABLES, "gravity": {"g": float("nan"), "up": [0, 0, 1]}}, "finite"),
    ({**TABLES, "gravity": {"g": 10**30, "up": [0, 0, 1]}}, "is a number"),
    ({**TABLES, "gravity": {"g": 1, "up": b"001"}}, "gravity.up"),
    ({**TABLES, "title": "\ud800"}, "no text"),
], ids=str)
def test_what_are_no_tables(tables, message):
    with pytest.raises(ls.SceneError, match=message):
        ls.scene(tables)


def test_mistakes_of_tables_have_lines_of_their_text():
    tables = {**TABLES, "joint": [*TABLES["joint"], {"kind": "hinge", "bodies": ["cart", "pole"], "at": np.zeros((2, 3))}]}
    with pytest.raises(ls.SceneError, match="hinge") as caught:
        ls.scene(tables)
    assert caught.value.line == 10
    endless: dict[str, object] = {}
    endless["gravity"] = endless
    with pytest.raises(ls.SceneError, match="without an end"):
        ls.scene(endless)
    with pytest.raises(ls.SceneError, match="both"):
        ls.scene(TABLES, "title = 3")
    assert "moments" in ls.scene(TABLES).text


def test_an_accuracy_of_several_bodies() -> None:
    """Without a step two bodies run to an accuracy of 1e-6, and a loop, which needs a step, is refused."""
    text = acrobot(0.001, ", angle = 0.5").text
    assert text is not None
    scene = ls.scene("acrobot.toml", text.replace("step = 0.001, ", ""))
    run = scene.run()
    assert "the end is off by at most about" in run.summary
    assert run.steps >= 1000
    fine = ls.scene("fine.toml", text.replace("step = 0.001", "step = 0.01, method = { composition = 'Kahan-Li 8' }")).run()
    for name in ("upper_x", "fore_x", "fore_z"):
        assert abs(run[name][-1] - fine[name][-1]) < 5e-6
    with pytest.raises(ls.Error, match="chosen for an accuracy by trial runs"):
        scene.start()


def test_an_effective_inertia_is_that_of_no_rigid_body():
    """Moments of a space agency's demonstration, beside Euler's equations."""
    moments, start = np.array([5174, 3593, 245.4]), np.array([0.02, 0.5, 0.03])
    for J in (moments, np.diag(moments)):
        for kinetic in ("rigid", "geodesic"):
            with pytest.raises(ls.DeclarationError, match="effective=True"):
                ls.body(J, kinetic=kinetic)
    w, h = start.copy(), 0.005
    rate = lambda w: np.cross(moments * w, w) / moments  # noqa: E731
    for _ in range(2000):
        a = rate(w)
        b = rate(w + h / 2 * a)
        c = rate(w + h / 2 * b)
        w = w + h / 6 * (a + 2 * (b + c) + rate(w + h * c))
    run = ls.body(moments, effective=True).run(velocity=start, until=10)
    assert abs(run.velocity[-1] - w).max() < 1e-6
