//! Joints in files: bodies that joints place, kinds with their friction, springs and motors, and mistakes with their places.

use std::fmt::Write as _;

use liestep::effects::joints::{DryFriction, JointDamping, JointSpring, JointTorque, SliderDamping, SliderSpring};
use liestep::mechanics::Effect as _;
use liestep_scene::{Run, Scene, System};
use nalgebra::Vector3;

use crate::called::{folder, printed};

fn system(text: &str) -> System {
    match Scene::parse("joints.toml", text).unwrap_or_else(|mistake| panic!("{mistake}")) {
        Scene::System(system) => *system,
        Scene::Body(_) => panic!("one body"),
    }
}

fn run(text: &str) -> Run {
    system(text).run().unwrap_or_else(|mistake| panic!("{mistake}"))
}

fn end(run: &Run, body: usize) -> Vector3<f64> {
    run.samples().last().unwrap().bodies[body].position
}

fn message(text: &str) -> String {
    match Scene::parse("joints.toml", text) {
        Ok(_) => panic!("accepted"),
        Err(mistake) => mistake.to_string(),
    }
}

const SWING: &str = r#"title = "porch swing"
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
             [[joint]]\nkind = \"pin\"\n{pin}\ndamping = \"0.01 N m s\"\nstiffness = \"0.2 N m/rad\"\n\
             friction = {{ torque = \"20 mN m\", below = 0.01 }}\n\
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
        let off = (end(&one, body) - end(&other, body)).amax();
        assert!(off < 1e-12, "{body}: {off:e}");
    }
    assert!((start[1].velocity - Vector3::y() * 0.5).amax() < 1e-15);
    assert!((end(&one, 0) - expected[0]).norm() > 0.05);
    let derivation = system(&straight).derivation();
    let terms = [
        JointSpring::DERIVATION,
        JointTorque::DERIVATION,
        JointDamping::DERIVATION,
        DryFriction::DERIVATION,
        SliderSpring::DERIVATION,
        SliderDamping::DERIVATION,
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

/// A composition of the step is of its order with joints, too: a double pendulum on pins and a rod on a ball joint at the end of
/// it. Friction has no composition.
#[test]
fn a_composition_is_of_order_four() {
    let text = SWING.replacen(
        "[[joint]]\nkind = \"pin\"\nbodies = [\"right\", \"space\"]",
        "[[spring]]\nk = 30\nlength = 0.2\nbodies = [\"right\", \"space\"]",
        1,
    );
    let text = text
        .replace("at = [[0, 0, 0.5], [1, 0, 0]]\naxes = [[0, 1, 0], [0, 1, 0]]\n", "at = [[0, 0, 0.5], [1, 0.5, 0]]\n");
    let ball = "kind = \"ball\"\nbodies = [\"right\", \"seat\"]\nat = [[0, 0, -0.5], [0.5, 0, 0]]\n";
    let text = text.replace("kind = \"pin\"\nbodies = [\"right\", \"seat\"]\nat = [[0, 0, -0.5], [0.5, 0, 0]]\naxes = [[0, 1, 0], [0, 1, 0]]\nrate = -2\n", ball);
    let by = |method: &str, step: &str| {
        let text = text.replace("step = \"1 ms\"", &format!("step = {step}\n{method}"));
        let run = run(&text);
        assert!(run.samples().iter().all(|sample| sample.gap < 1e-13));
        let end = run.samples().last().unwrap();
        (end.bodies[1].position, *end.bodies[1].attitude.as_matrix())
    };
    let suzuki = "method = { composition = \"Suzuki 4\" }";
    let reference = by("method = { composition = \"Kahan-Li 8\" }", "0.0025");
    let off = |method: &str, step: &str| {
        let (place, attitude) = by(method, step);
        [(place - reference.0).norm(), (attitude - reference.1).norm()]
    };
    for (method, steps, order) in [("", ["0.004", "0.002"], 2.0), (suzuki, ["0.01", "0.005"], 4.0)] {
        let (coarse, fine) = (off(method, steps[0]), off(method, steps[1]));
        for (coarse, fine) in coarse.iter().zip(fine) {
            let found = (coarse / fine).log2();
            println!("{method}: {coarse:e}, {fine:e}, of order {found}");
            assert!((found - order).abs() < 0.05, "{method}: {coarse:e}, {fine:e}, of order {found}");
        }
    }
    let refused = |change: &dyn Fn(&str) -> String| {
        message(&change(&text.replace("step = \"1 ms\"", &format!("step = 0.01\n{suzuki}"))))
    };
    let friction = refused(&|text| text.replacen("rate = 2", "rate = 2\ndamping = 0.1", 1));
    assert!(
        friction.ends_with(
            "a composition has steps back, in which friction adds energy, and `joint-1` has some: leave one of both out"
        ),
        "{friction}"
    );
    let other = refused(&|text| text.replace("composition = \"Suzuki 4\"", "collocation = 4"));
    assert!(other.ends_with("several bodies have their own step, or a `composition` of it"), "{other}");
}

/// A row of a thousand bodies on pins with friction: read, placed by its joints, and closed after some steps.
#[test]
fn a_thousand_bodies() {
    let mut text = "title = \"row\"\ngravity = { g = 9.81, up = [0, 0, 1] }\n".to_owned();
    for k in 0..1000 {
        let _ = write!(text, "[[body]]\nname = \"b{k}\"\nm = 0.1\ncylinder = {{ radius = 0.01, length = 0.1 }}\n");
    }
    for k in 0..1000 {
        let (above, at) = if k == 0 { ("space".to_owned(), 0.0) } else { (format!("b{}", k - 1), -0.05) };
        let _ = write!(
            text,
            "[[joint]]\nkind = \"pin\"\nbodies = [\"{above}\", \"b{k}\"]\nat = [[0, 0, {at}], [0, 0, 0.05]]\n\
             axes = [[0, 1, 0], [0, 1, 0]]\nangle = 0.01\ndamping = 1e-4\n"
        );
    }
    let run = run(&(text + "[run]\nstep = 1e-3\nduration = 5e-3\n"));
    let energies: Vec<f64> = run.samples().iter().map(|sample| sample.energy).collect();
    assert_eq!((run.steps(), run.samples()[0].bodies.len()), (5, 1000));
    assert!(run.samples().iter().all(|sample| sample.gap < 1e-12), "{}", run.samples()[5].gap);
    // It falls from rest: the energy is lost by friction alone.
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9), "{energies:?}");
    assert!((end(&run, 999) - run.samples()[0].bodies[999].position).norm() > 1e-5);
}

/// A sweep over keys of bodies, joints and the run: its rows are the ends of the scenes with their values.
#[test]
fn a_sweep_of_several_bodies() {
    let folder = folder("sweep-of-several");
    let text = SWING.replacen("duration = 1", "duration = 0.1", 1).replacen(
        "[run]",
        "[[event]]\nname = \"low\"\ncolumn = \"left_x\"\nvalue = -0.05\n[run]",
        1,
    );
    let sweep = "[sweep]\njoint.joint-1.damping = [0.5, \"2 N m s\"]\nbody.seat.m = { from = 1, to = 3, count = 3 }\n[output]\ncolumns = [\"position\", \"energy\"]\n";
    std::fs::write(folder.join("swing.toml"), format!("{text}{sweep}")).unwrap();
    printed(&folder, &["sweep", "swing.toml", "--out", "."]);
    let table = std::fs::read_to_string(folder.join("swing.sweep.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..4], ["joint.joint-1.damping", "body.seat.m", "t", "left_x"]);
    assert_eq!(rows[0][12..], ["energy", "greatest_energy_error", "low_times", "low_first"]);
    let points: Vec<_> = rows[1..].iter().map(|row| row[..2].join(" ")).collect();
    assert_eq!(points, ["0.5 1.0", "0.5 2.0", "0.5 3.0", "2 N m s 1.0", "2 N m s 2.0", "2 N m s 3.0"]);
    let alone = text.replacen("rate = 2\n", "rate = 2\ndamping = 2\n", 1).replacen(
        "name = \"seat\"\nm = 1",
        "name = \"seat\"\nm = 3",
        1,
    );
    let run = run(&alone);
    let last = run.samples().last().unwrap();
    let found: Vec<f64> = rows[6][2..].iter().map(|cell| cell.parse().unwrap()).collect();
    let of_bodies = last.bodies.iter().flat_map(|body| &body.position).copied();
    let expected: Vec<f64> = std::iter::once(last.time).chain(of_bodies).chain([last.energy]).collect();
    assert_eq!(found[..11], expected[..]);
    let first_passing = run.happenings()[0].sample.time;
    assert_eq!(found[12..], [1.0, first_passing]);
    let wrong = message(&format!("{text}[sweep]\njoint.elbow.damping = [1, 2]\n"));
    assert_eq!(wrong, "joints.toml:46:7: no `joint` is called `elbow`");
}

fn free_pin(keys: &str, rest: &str) -> String {
    format!(
        "title = \"a\"\n[[body]]\nname = \"a\"\nm = 2\nmoments = [0.3, 0.4, 0.5]\n[[joint]]\nkind = \"pin\"\n\
         bodies = [\"space\", \"a\"]\nat = [[0, 0, 0], [-0.2, 0, 0]]\naxes = [[0, 0, 1], [0, 0, 1]]\n{keys}\n{rest}\n\
         [run]\nstep = 0.01\nduration = 4\n"
    )
}

/// Limits are events where the joint passes them outwards, at the times of a uniform motion, and stop the run if they are to;
/// columns pass values as on any group.
#[test]
fn limits_and_columns_are_events() {
    let limits = |stop: &str| format!("name = \"elbow\"\nrate = 2\nlimits = {{ from = \"-0.5 rad\", to = 1{stop} }}");
    let happened =
        |run: &Run| -> Vec<_> { run.happenings().iter().map(|one| (one.event, one.rising, one.sample.time)).collect() };
    let is_at = |found: &[(usize, bool, f64)], expected: &[(usize, bool, f64)]| {
        let near = |(one, other): (&(usize, bool, f64), &(usize, bool, f64))| {
            // The steps of 0.02 rad turn the body too far by 1e-5.
            (one.0, one.1) == (other.0, other.1) && (one.2 / other.2 - 1.0).abs() < 2e-5
        };
        found.len() == expected.len() && found.iter().zip(expected).all(near)
    };
    let half_turn = std::f64::consts::FRAC_PI_2;
    let event = "[[event]]\nname = \"across\"\ncolumn = \"a_x\"\nvalue = 0\n[[event]]\nname = \"elbow-right\"\n\
                 column = \"elbow_angle\"\nvalue = \"90 deg\"\ndirection = \"rising\"";
    let passing = run(&free_pin(&limits(""), event));
    let found = happened(&passing);
    // The angle is 2 t: a_x passes zero at odd quarters of a turn, the limit is passed at 1 and at 1 and a turn.
    let expected = [
        (2, true, 0.5),
        (0, false, half_turn * 0.5),
        (1, true, half_turn * 0.5),
        (0, true, half_turn * 1.5),
        (2, true, 0.5 + 2.0 * half_turn),
        (0, false, half_turn * 2.5),
        (1, true, half_turn * 2.5),
    ];
    let sorted = |mut all: Vec<(usize, bool, f64)>| {
        all.sort_by(|one, other| one.2.total_cmp(&other.2).then(one.0.cmp(&other.0)));
        all
    };
    assert!(is_at(&sorted(found.clone()), &sorted(expected.into())), "{found:?}");
    let scene = system(&free_pin(&limits(", stop = true"), event));
    let stopped = scene.run().unwrap();
    assert!((stopped.samples().last().unwrap().time - 0.5).abs() < 1e-5);
    let summary = scene.summary(&stopped);
    assert!(
        summary.contains("elbow: once, first at t = 0.49999") && summary.contains(", which ended the run"),
        "{summary}"
    );
    assert!(scene.event_table(&stopped).unwrap().starts_with("event,rising,t,a_x,a_y,a_z,a_q_w"));
    assert_eq!(scene.events().collect::<Vec<_>>(), ["across", "elbow-right", "elbow"]);
    // From the other end the angle has the other sign, and so have its limits.
    let turned = "kind = \"pin\"\nbodies = [\"a\", \"space\"]\nat = [[-0.2, 0, 0], [0, 0, 0]]";
    let straight = "kind = \"pin\"\nbodies = [\"space\", \"a\"]\nat = [[0, 0, 0], [-0.2, 0, 0]]";
    let text = free_pin("rate = -2\nlimits = { from = -1, to = 0.5 }", "").replacen(straight, turned, 1);
    assert!((run(&text).happenings()[0].sample.time - 0.5).abs() < 1e-5);
    let slider = free_pin("speed = -0.5\nlimits = { from = \"-30 cm\", to = 1, stop = true }", "");
    let slid = run(&slider.replacen("\"pin\"", "\"slider\"", 1));
    assert!((slid.samples().last().unwrap().time - 0.6).abs() < 1e-9);
}

/// Forces and torques of joints as columns: those of a weight on a weld, and of a turn about a pin.
#[test]
fn forces_of_joints_are_columns() {
    let output = "[output]\ncolumns = [\"force\", \"torque\", \"energy-error\", \"angle\"]";
    let heavy = free_pin("", output).replacen("title", "gravity = { g = 9.81, up = [0, 0, 1] }\ntitle", 1);
    let welded = heavy.replacen("\"pin\"", "\"weld\"", 1).replacen("axes = [[0, 0, 1], [0, 0, 1]]\n", "", 1);
    let row = |text: &str, at: usize| {
        let scene = system(text);
        let mut csv = liestep::recording::Csv::new(Vec::new());
        scene.run_with(&mut |_| (), Some(&mut csv)).unwrap();
        let text = String::from_utf8(csv.into_inner().unwrap()).unwrap();
        let line = text.lines().nth(at).unwrap();
        line.split(',').map(|cell| cell.parse::<f64>().unwrap()).collect::<Vec<_>>()
    };
    let is_near = |found: &[f64], expected: &[f64], most: f64| {
        found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < most)
    };
    // The weld lifts 2 kg at 0.2 m: its torque turns the body up, against the weight.
    let found = row(&welded, 100);
    assert!(is_near(&found[1..7], &[0.0, 0.0, 19.62, 0.0, -0.2 * 19.62, 0.0], 1e-11), "{found:?}");
    assert_eq!(found.len(), 8);
    // A turn with 3 rad/s pulls the body to the pin by 2·9·0.2 N, in the mean over a step from the angle zero.
    let found = row(&free_pin("rate = 3", output), 1);
    assert!(is_near(&found[1..7], &[-3.6, -0.054, 0.0, 0.0, 0.0, 0.0], 1e-3), "{found:?}");
    let found = row(&free_pin("rate = 3", output), 51);
    assert!((found[8] - 1.5).abs() < 5e-5 && found[7].abs() < 1e-13, "{found:?}");
}

/// Shapes have the moments of their formulas, and a point mass on a pin falls as a pendulum.
#[test]
fn bodies_by_their_shapes() {
    let of = |keys: &str| {
        let text = free_pin("rate = 1", "").replacen("m = 2\nmoments = [0.3, 0.4, 0.5]", keys, 1);
        let run = run(&text);
        let sample = &run.samples()[0];
        // With 1 rad/s about a pin the energy is half of the moment about it, J + 0.04 m.
        (2.0 * sample.energy, sample.momentum.y / 0.2)
    };
    let is = |(found, mass): (f64, f64), m: f64, J: f64| {
        assert!(
            (mass - m).abs() < 1e-13 * m && (found - (J + 0.04 * m)).abs() < 1e-13 * m,
            "{found}, {mass}: {J}, {m}"
        );
    };
    is(of("m = 3\nbox = [0.2, \"30 cm\", 0.7]"), 3.0, 3.0 * (0.04 + 0.09) / 12.0);
    is(of("density = \"2 g/cm³\"\nbox = [0.1, 0.2, 0.3]"), 12.0, 12.0 * (0.01 + 0.04) / 12.0);
    is(of("m = 3\nsphere = { radius = 0.5 }"), 3.0, 0.4 * 3.0 * 0.25);
    is(of("m = 3\ncylinder = { radius = 0.5, length = 2 }"), 3.0, 0.5 * 3.0 * 0.25);
    is(of("m = 3\ncylinder = { radius = 0.5, length = 2, axis = [1, 0, 0] }"), 3.0, 3.0 * (0.0625 + 4.0 / 12.0));
    let (r, l) = (0.1, 0.6);
    let [cylinder, ball] =
        [1000.0 * std::f64::consts::PI * r * r * l, 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * r * r * r];
    is(
        of("density = 1000\ncapsule = { radius = 0.1, length = 0.6 }"),
        cylinder + ball,
        (0.5 * cylinder + 0.4 * ball) * r * r,
    );
    is(of("m = 3\nmoments = [1, 1, 1]\nsphere = { radius = 0.5 }"), 3.0, 1.0);
    is(of("m = 3\nmoments = [0, 0, 0]"), 3.0, 0.0);
    // The place of an equation of one angle, by a solver of order eight.
    let point = "title = \"a\"\ngravity = { g = 9.81, up = [0, 0, 1] }\n[[body]]\nname = \"a\"\nm = 1\nmoments = [0, 0, 0]\n\
                 [[joint]]\nkind = \"pin\"\nbodies = [\"space\", \"a\"]\nat = [[0, 0, 0], [0, 0, 0.5]]\naxes = [[0, 1, 0], [0, 1, 0]]\n\
                 rate = -1\n[run]\nstep = 0.0005\nduration = 1\n";
    let place = end(&run(point), 0);
    assert!((place - Vector3::new(-0.107_334, 0.0, -0.488_344)).amax() < 1e-6, "{place}");
    let on_a_ball = point.replace("\"pin\"", "\"ball\"").replace("axes = [[0, 1, 0], [0, 1, 0]]\nrate = -1\n", "");
    let refused = system(&on_a_ball).run().unwrap_err().to_string();
    assert!(refused.contains("singular"), "{refused}");
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
            "38:1: only a single body has this quantity: of several an event has a `column` with a `value`, or an `energy`",
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
            kind("weld", "friction = { torque = 1, below = 1 }"),
            "19:12: a weld has no dry `friction`: it is for joints that turn",
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
