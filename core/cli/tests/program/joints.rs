//! Joints in files: bodies that joints place, kinds with their friction, springs and motors, and mistakes with their places.

use liestep::effects::joints::{
    Armature, DryFriction, JointDamping, JointSpring, JointTorque, SliderArmature, SliderDamping, SliderFriction,
    SliderSpring,
};
use liestep::mechanics::Effect as _;
use liestep_scene::{Run, Scene};
use nalgebra::Vector3;

pub(crate) fn system(text: &str) -> Scene {
    Scene::parse("joints.toml", text).unwrap_or_else(|mistake| panic!("{mistake}"))
}

pub(crate) fn run(text: &str) -> Run {
    system(text).run().unwrap_or_else(|mistake| panic!("{mistake}"))
}

pub(crate) fn end(run: &Run, body: usize) -> Vector3<f64> {
    run.samples().last().unwrap().bodies[body].position
}

pub(crate) fn message(text: &str) -> String {
    match Scene::parse("joints.toml", text) {
        Ok(_) => panic!("accepted"),
        Err(mistake) => mistake.to_string(),
    }
}

pub(crate) const SWING: &str = r#"title = "porch swing"
gravity = { g = 9.81, up = [0, 0, 1] }
[[body]]
name = "left"
m = 1
moments = [0.0833333, 0.0833333, 0.001]
[[body]]
name = "right"
m = 1
moments = [0.0833333, 0.0833333, 0.001]
[[body]]
name = "seat"
m = 1
moments = [0.001, 0.0833333, 0.0833333]
[[joint]]
kind = "pin"
bodies = ["space", "left"]
at = [[0, 0, 0], [0, 0, 0.5]]
axes = [[0, 1, 0], [0, 1, 0]]
rate = 2
[[joint]]
kind = "pin"
bodies = ["left", "seat"]
at = [[0, 0, -0.5], [-0.5, 0, 0]]
axes = [[0, 1, 0], [0, 1, 0]]
rate = -2
[[joint]]
kind = "pin"
bodies = ["right", "seat"]
at = [[0, 0, -0.5], [0.5, 0, 0]]
axes = [[0, 1, 0], [0, 1, 0]]
rate = -2
[[joint]]
kind = "pin"
bodies = ["right", "space"]
at = [[0, 0, 0.5], [1, 0, 0]]
axes = [[0, 1, 0], [0, 1, 0]]
[run]
step = "1 ms"
duration = 1
"#;

/// Four pins, as anyone would draw them: joints place the bodies, three functions are implied and left out, with a note. The
/// places are those of a solver of order eight.
#[test]
fn a_porch_swing() {
    let run = run(SWING);
    let notes: Vec<_> = run.notes().iter().map(ToString::to_string).collect();
    let note = "joints.toml:33:1: 3 functions of this joint are implied by the other joints, and left out; the motion is the same";
    assert_eq!(notes, [note]);
    let [left, seat] = [0, 2].map(|body| end(&run, body));
    assert!((left - Vector3::new(0.063_246, 0.0, -0.495_984)).amax() < 1.5e-6, "{left}");
    assert!((seat - Vector3::new(0.626_492, 0.0, -0.991_968)).amax() < 3e-6, "{seat}");
    assert!(run.samples().iter().all(|sample| sample.gap < 1e-13));
}

/// A cart on a rail with a pole, both by joint coordinates; with the bodies of each joint exchanged, and what belongs to them, it
/// is the same motion.
#[test]
fn joints_from_either_end() {
    let scene = |slider: &str, pin: &str| {
        format!(
            "title = \"cart\"\ngravity = {{ g = 9.81, up = [0, 0, 1] }}\n\
             [[body]]\nname = \"cart\"\nm = 2\nmoments = [1, 1, 1]\n\
             [[body]]\nname = \"pole\"\nm = 0.5\nmoments = [0.03, 0.03, 0.001]\n\
             [[joint]]\nkind = \"slider\"\n{slider}\ndamping = \"0.7 N s/m\"\nstiffness = \"3 N/m\"\n\
             friction = {{ force = \"50 mN\", below = 0.02 }}\narmature = \"100 g\"\n\
             [[joint]]\nkind = \"pin\"\n{pin}\ndamping = \"0.01 N m s\"\nstiffness = \"0.2 N m/rad\"\n\
             friction = {{ torque = \"20 mN m\", below = 0.01 }}\narmature = \"20 kg cm²\"\n\
             [run]\nstep = 0.005\nduration = 2\n"
        )
    };
    let straight = scene(
        "bodies = [\"space\", \"cart\"]\nat = [[0.1, 0, 0], [0, 0, 0.2]]\naxes = [[1, 0, 0], [1, 0, 0]]\nshift = 0.4\nspeed = 0.1\nforce = 0.3\nrest = 0.1",
        "bodies = [\"cart\", \"pole\"]\nat = [[0, 0, 0.1], [0, 0, -0.4]]\naxes = [[0, 1, 0], [0, 1, 0]]\nangle = \"20 deg\"\nrate = 0.5\ntorque = 0.05\nrest = 0.2",
    );
    let turned = scene(
        "bodies = [\"cart\", \"space\"]\nat = [[0, 0, 0.2], [0.1, 0, 0]]\naxes = [[1, 0, 0], [1, 0, 0]]\nshift = -0.4\nspeed = -0.1\nforce = -0.3\nrest = -0.1",
        "bodies = [\"pole\", \"cart\"]\nat = [[0, 0, -0.4], [0, 0, 0.1]]\naxes = [[0, 1, 0], [0, 1, 0]]\nangle = \"-20 deg\"\nrate = -0.5\ntorque = -0.05\nrest = -0.2",
    );
    let [one, other] = [run(&straight), run(&turned)];
    let start = &one.samples()[0].bodies;
    let [sine, cosine] = [0.342_020_143_325_668_7, 0.939_692_620_785_908_4];
    let expected = [Vector3::new(0.5, 0.0, -0.2), Vector3::new(0.5 + 0.4 * sine, 0.0, -0.1 + 0.4 * cosine)];
    for body in 0..2 {
        assert!((start[body].position - expected[body]).amax() < 1e-15, "{}", start[body].position);
        // The pole falls over: e^(4.2 · 2) times the rounding errors of four hundred steps.
        let off = (end(&one, body) - end(&other, body)).amax();
        assert!(off < 5e-12, "{body}: {off:e}");
    }
    assert!((start[1].velocity - Vector3::y() * 0.5).amax() < 1e-15);
    assert!((end(&one, 0) - expected[0]).norm() > 0.05);
    let derivation = system(&straight).derivation();
    let terms = [
        JointSpring::DERIVATION,
        JointTorque::DERIVATION,
        JointDamping::DERIVATION,
        DryFriction::DERIVATION,
        Armature::DERIVATION,
        SliderSpring::DERIVATION,
        SliderDamping::DERIVATION,
        SliderFriction::DERIVATION,
        SliderArmature::DERIVATION,
    ];
    let parts = terms.into_iter().chain(["R_a e_1 · s", "R_a e_2 · R_b n_b"]);
    for part in parts {
        assert!(derivation.contains(part), "{part}");
    }
}

/// A body on each kind of joint with space keeps what the kind keeps.
#[test]
fn each_kind_holds() {
    let scene = |kind: &str, keys: &str| {
        let text = format!(
            "title = \"a\"\ngravity = {{ g = 9.81, up = [0, 0, 1] }}\n[[body]]\nname = \"a\"\nm = 1\nmoments = [0.3, 0.4, 0.5]\n\
             [[joint]]\nkind = \"{kind}\"\nbodies = [\"space\", \"a\"]\nat = [[0, 0, 0], [0.2, 0, 0.1]]\n{keys}\n\
             [run]\nstep = 0.01\nduration = 0.5\n"
        );
        run(&text)
    };
    let welded = scene("weld", "zero = { rpy = [0.1, \"20 deg\", 0] }");
    assert!((end(&welded, 0) - welded.samples()[0].bodies[0].position).amax() < 1e-14);
    // A slider along the weight falls freely, and one across it stays.
    let falling = scene("slider", "axes = [[0, 0, 1], [0, 0, 1]]\nspeed = 1");
    assert!((end(&falling, 0).z - (-0.1 + 0.5 - 0.5 * 9.81 * 0.25)).abs() < 1e-12, "{}", end(&falling, 0));
    let across = scene("slider", "axes = [[1, 0, 0], [1, 0, 0]]");
    assert!((end(&across, 0) - Vector3::new(-0.2, 0.0, -0.1)).amax() < 1e-13);
    // In a plane, a body without velocity falls along it only.
    let plane = scene("plane", "axes = [[0, 1, 0], [0, 1, 0]]");
    assert!((end(&plane, 0) - Vector3::new(-0.2, 0.0, -0.1 - 0.5 * 9.81 * 0.25)).amax() < 1e-12);
    // A cylinder along the weight falls and turns on.
    let screw = scene("cylinder", "axes = [[0, 0, 1], [0, 0, 1]]\nrate = 2");
    assert!((screw.samples().last().unwrap().bodies[0].velocity.z - 2.0).abs() < 1e-12);
    assert!((end(&screw, 0).z - (-0.1 - 0.5 * 9.81 * 0.25)).abs() < 1e-12);
    let cross = scene("universal", "axes = [[0, 0, 1], [1, 0, 0]]\ndamping = 0.1");
    assert!(cross.samples().iter().all(|sample| sample.gap < 1e-14));
    let rod = "title = \"a\"\ngravity = { g = 9.81, up = [0, 0, 1] }\n[[body]]\nname = \"a\"\nm = 1\nmoments = [0.3, 0.4, 0.5]\n\
               position = [0.3, 0, 0.4]\nstart = { rpy = [0, 0, 0], velocity = [0, 0, 0] }\n\
               [[joint]]\nkind = \"distance\"\nbodies = [\"space\", \"a\"]\nat = [[0, 0, 0], [0, 0, 0]]\nlength = 0.5\n\
               [run]\nstep = 0.01\nduration = 0.5\n";
    assert!((end(&run(rod), 0).norm() - 0.5).abs() < 1e-14);
}

/// The message about the swing with a part of its text in the place of another.
fn change(from: &str, to: &str) -> String {
    message(&SWING.replacen(from, to, 1))
}

/// The message about the swing with a first joint of another kind, and these keys.
fn kind(kind: &str, keys: &str) -> String {
    let first = "kind = \"pin\"\nbodies = [\"space\", \"left\"]\nat = [[0, 0, 0], [0, 0, 0.5]]\n";
    change(&format!("{first}axes = [[0, 1, 0], [0, 1, 0]]\nrate = 2"), &format!("{}{keys}", first.replace("pin", kind)))
}

/// Mistakes of limits, shapes and events have one message each at their places.
#[test]
fn mistakes_of_limits_shapes_and_events() {
    let cases = [
        (
            kind("pin", "axes = [[0, 1, 0], [0, 1, 0]]\nlimits = { from = 1, to = -1 }"),
            "20:10: a joint moves `from` one place `to` a greater one",
        ),
        (
            kind("pin", "axes = [[0, 1, 0], [0, 1, 0]]\nlimits = { from = -4, to = 4 }"),
            "20:10: these limits are a turn apart or more, so that none is reached: leave them out",
        ),
        (
            kind("ball", "limits = { from = -1, to = 1 }"),
            "19:10: a ball joint has no `limits`: those of a pin and a slider are watched",
        ),
        (
            change("m = 1", "m = 1\ndensity = 1"),
            "3:1: a body has a mass `m`, or a `density` with one of `box`, `cylinder`, `capsule`, `sphere`",
        ),
        (
            change("m = 1", "m = 1\nsphere = { radius = 1 }\nbox = [1, 1, 1]"),
            "3:1: a body has one of `box`, `cylinder`, `capsule`, `sphere`",
        ),
        (
            change("[run]", "[[event]]\nname = \"a\"\ntilt = 0\n[run]"),
            "38:1: missing field `body`: the name of one of `left`, `right`, `seat`",
        ),
    ];
    for (found, expected) in &cases {
        assert_eq!(found, &format!("joints.toml:{expected}"));
    }
}

/// Each mistake has one message at its place.
#[test]
fn mistakes() {
    let cases = [
        (kind("weld", "rate = 1"), "19:8: a weld has no `rate`"),
        (
            kind("slider", "axes = [[0, 1, 0], [0, 1, 0]]\nrate = 1"),
            "20:8: a slider has no `rate`; it starts at a `shift` with a `speed`",
        ),
        (
            kind("slider", "axes = [[0, 1, 0], [0, 1, 0]]\ntorque = 1"),
            "20:10: a slider has no `torque`; its motor has a `force`",
        ),
        (
            kind("slider", "axes = [[0, 1, 0], [0, 1, 0]]\ndamping = \"1 N m s\""),
            "20:11: a coefficient of friction isn't in `N m s` but in `N s/m`, `kg/s`",
        ),
        (kind("ball", "torque = 1"), "19:10: a ball joint has no `torque`"),
        (
            kind("ball", "axes = [[0, 1, 0], [0, 1, 0]]"),
            "19:8: a ball joint turns about any axis; leave `axes` out, or make it a `pin`",
        ),
        (kind("universal", ""), "16:8: a universal joint has `axes`: that of each of its bodies, in that body's frame"),
        (kind("distance", ""), "16:8: a distance has a `length`, m, that of a rod between both points"),
        (kind("ball", "length = 1"), "19:10: a ball joint has no `length`; a `distance` has"),
        (kind("ball", "rest = 1"), "19:8: a ball joint has no `rest`"),
        (
            kind("pin", "axes = [[0, 1, 0], [0, 1, 0]]\nrest = 1"),
            "20:8: a spring that is at `rest` somewhere has a `stiffness`",
        ),
        (kind("pin", "axes = [[0, 1, 0], [0, 1, 0]]\ndamping = 0"), "20:11: must be above zero"),
        (
            kind("slider", "axes = [[0, 1, 0], [0, 1, 0]]\nfriction = { torque = 1, below = 1 }"),
            "20:23: dry friction in a slider has a `force`, N, and the speed `below` which it is viscous, m/s",
        ),
        (
            kind("pin", "axes = [[0, 1, 0], [0, 1, 0]]\nfriction = { torque = 1 }"),
            "20:12: dry friction has a `torque`, N m, and the rate `below` which it is viscous, rad/s",
        ),
        (
            kind("weld", "friction = { torque = 1, below = 1 }"),
            "19:12: a weld has no dry `friction`: it is for joints that turn, and for sliders",
        ),
        (kind("weld", "armature = 1"), "19:12: a weld has no `armature`"),
        (
            kind("slider", "axes = [[0, 1, 0], [0, 1, 0]]\narmature = \"1 kg m²\""),
            "20:12: a mass isn't in `kg m²` but in `kg`, `g`, `t`",
        ),
        (
            kind("pin", "axes = [[0, 1, 0], [0, 1, 0]]\nzero = { rpy = [0.1, 0, 0] }"),
            "20:8: `zero` turns the second of `axes` away from the first, by 0.09983341665 in sine: in both frames they are one line",
        ),
        (
            kind("pin", "axes = [[0, 1, 0], [0, 1, 0]]\nzero = {}"),
            "20:8: an attitude is given by one of `euler`, `quaternion`, `yaw_pitch_roll`, `rpy`",
        ),
        (
            change("name = \"left\"", "name = \"left\"\nposition = [0, 0, 0]"),
            "4:8: a body with a `position` has a `start`, too: its attitude and angular velocity",
        ),
        (
            change("name = \"left\"", "name = \"left\"\nmoving = [0, 0, 0]"),
            "4:8: a body that is `moving` has a `position` and a `start`; joints have `rate` and `speed`",
        ),
        (
            change("rate = 2", "rate = 2\n[[body]]\nname = \"lost\"\nm = 1\nmoments = [1, 1, 1]"),
            "22:8: `lost` has no place: give its `position` and `start`, or a joint with a body that has one, or with `space`",
        ),
        (
            change("axes = [[0, 1, 0], [0, 1, 0]]\n[run]", "axes = [[0, 1, 0], [0, 1, 0]]\nangle = 0\n[run]"),
            "38:9: both bodies of this joint have places already, so that it doesn't give one: leave this out, or `position` and `start` of one of them",
        ),
    ];
    for (found, expected) in &cases {
        assert_eq!(found, &format!("joints.toml:{expected}"));
    }
}
