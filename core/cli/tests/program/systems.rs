//! Several bodies in files as one body: compositions, rows of a thousand, sweeps, events, forces of joints and shapes.

use std::fmt::Write as _;

use liestep_scene::Run;
use nalgebra::Vector3;

use crate::called::{folder, printed};
use crate::ensembles::shards;
use crate::joints::{SWING, end, message, run, system};

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
    // A fall from rest: friction alone takes energy.
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
    assert_eq!(wrong, "joints.toml:46:7: no `joint` is called `elbow`, but joint-1, joint-2, joint-3, joint-4");
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
    let columns = "[[event]]\nname = \"right\"\ncolumn = \"joint-1_angle\"\nvalue = -0.5\n";
    let text = free_pin("rate = -2\nlimits = { from = -1, to = 0.5 }", columns).replacen(straight, turned, 1);
    let [right, limit] = [0, 1].map(|at| {
        let run = run(&text);
        (run.happenings()[at].event, run.happenings()[at].rising, run.happenings()[at].sample.time)
    });
    assert!(is_at(&[right, limit], &[(0, false, 0.25), (1, true, 0.5)]), "{right:?} {limit:?}");
    let slider = free_pin("speed = -0.5\nlimits = { from = \"-30 cm\", to = 1, stop = true }", "");
    let slid = run(&slider.replacen("\"pin\"", "\"slider\"", 1));
    assert!((slid.samples().last().unwrap().time - 0.6).abs() < 1e-9);
}

/// A crank that turns uniformly passes an angle once a turn, in the direction in which it turns, and nothing where the angle
/// jumps from π to −π.
#[test]
fn a_crank_passes_an_angle_once_a_turn() {
    for value in [-100.0_f64, 45.0, 90.0, 179.9, -179.9, 360.0] {
        for direction in ["either", "rising", "falling"] {
            for rate in [2.0, -2.0] {
                let event = format!(
                    "[[event]]\nname = \"there\"\ncolumn = \"elbow_angle\"\nvalue = \"{value} deg\"\ndirection = \
                     \"{direction}\""
                );
                let run = run(&free_pin(&format!("name = \"elbow\"\nrate = {rate}"), &event));
                // The angle is rate t, up to 8.
                let turns = (-2..=2).map(|turn| (value.to_radians() + f64::from(turn) * std::f64::consts::TAU) / rate);
                let mut expected: Vec<_> = turns.filter(|time| *time > 1e-9 && *time < 4.0).collect();
                expected.sort_by(f64::total_cmp);
                if direction == if rate > 0.0 { "falling" } else { "rising" } {
                    expected.clear();
                }
                let found: Vec<_> = run.happenings().iter().map(|one| (one.rising, one.sample.time)).collect();
                assert_eq!(found.len(), expected.len(), "{value} {direction} {rate}: {found:?} for {expected:?}");
                for ((rising, time), expected) in found.iter().zip(expected) {
                    assert!(*rising == (rate > 0.0) && (time / expected - 1.0).abs() < 4e-5, "{time} for {expected}");
                }
            }
        }
    }
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
        // The energy at 1 rad/s is half of the moment about the pin, J + 0.04 m.
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
    // Across, each half ball is 83/320 m r² about its own centre of mass.
    let halves = ball * (83.0 / 320.0 * r * r + (0.5 * l + 0.375 * r) * (0.5 * l + 0.375 * r));
    is(
        of("density = 1000\ncapsule = { radius = 0.1, length = 0.6, axis = [1, 0, 0] }"),
        cylinder + ball,
        cylinder * (3.0 * r * r + l * l) / 12.0 + halves,
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
    assert!(refused.contains("joints.toml:3:1: the joints of `a` let this point mass turn on the spot"), "{refused}");
}

/// Numbers in whose sums no digit is left end a run with one message at the place of their joint, and never with a table of NaN.
#[test]
fn numbers_without_digits_have_their_place() {
    let text = free_pin("rate = 1", "").replacen("[[body]]", "gravity = { g = 9.81, up = [0, 1, 0] }\n[[body]]", 1);
    assert!(system(&text).run().is_ok());
    for (from, to, expected) in [
        ("g = 9.81", "g = 1e300", "the energy is beyond all numbers at t = "),
        ("[-0.2, 0, 0]", "[-1e300, 0, 0]", "joints.toml:7:1: numbers of this joint, or of its bodies, are so large"),
    ] {
        let message = system(&text.replace(from, to)).run().unwrap_err().to_string();
        assert!(message.contains(expected) && !message.contains("NaN"), "{to}: {message}");
    }
}

/// Two bodies of 1 kg and 0.5 kg with 0.1 kg m² about their centres, on arms of a metre, one below the other.
fn double_pendulum(friction: &str, run: &str) -> String {
    format!(
        "title = \"double\"\ngravity = {{ g = 9.81, up = [0, 0, 1] }}\n[[body]]\nname = \"a\"\nm = 1\nmoments = [0.1, 0.1, 0.1]\n\
         [[body]]\nname = \"b\"\nm = 0.5\nmoments = [0.1, 0.1, 0.1]\n[[joint]]\nkind = \"pin\"\nbodies = [\"space\", \"a\"]\n\
         at = [[0, 0, 0], [0, 0, 1]]\naxes = [[0, 1, 0], [0, 1, 0]]\nangle = 1.2\nrate = 0.3\n{friction}[[joint]]\nkind = \"pin\"\n\
         bodies = [\"a\", \"b\"]\nat = [[0, 0, 0], [0, 0, 1]]\naxes = [[0, 1, 0], [0, 1, 0]]\nangle = -0.5\nrate = 1\n{friction}\
         [run]\nduration = 0.5\n{run}\n"
    )
}

/// The places of both centres after half a second, x and z, by Runge and Kutta of the textbook's equations for the angles.
fn double_pendulum_by_hand(c: f64) -> [f64; 4] {
    let (m, n, J, g) = (1.0, 0.5, 0.1, 9.81);
    let rates = |[one, two, u, v]: [f64; 4]| {
        let (sine, cosine) = f64::sin_cos(one - two);
        let first = -n * sine * v * v - (m + n) * g * one.sin() - c * u + c * (v - u);
        let second = n * sine * u * u - n * g * two.sin() - c * (v - u);
        let (of_one, of_two, both) = (m + n + J, n + J, n * cosine);
        let determinant = of_one * of_two - both * both;
        [u, v, (of_two * first - both * second) / determinant, (of_one * second - both * first) / determinant]
    };
    let along = |state: [f64; 4], rate: [f64; 4], h: f64| [0, 1, 2, 3].map(|k| state[k] + h * rate[k]);
    let (mut state, h) = ([1.2, 0.7, 0.3, 1.3], 1e-4);
    for _ in 0..5000 {
        let a = rates(state);
        let b = rates(along(state, a, 0.5 * h));
        let c = rates(along(state, b, 0.5 * h));
        let d = rates(along(state, c, h));
        state = [0, 1, 2, 3].map(|k| state[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
    }
    let [one, two, ..] = state;
    [-one.sin(), -one.cos(), -one.sin() - two.sin(), -one.cos() - two.cos()]
}

/// An accuracy of several bodies is kept: their ends are those of the textbook's equations, with and without friction. Without a
/// step it is 1e-6.
#[test]
fn an_accuracy_of_several_bodies() {
    let off = |run: &Run, c: f64| {
        let found: Vec<f64> = (0..2).flat_map(|body| [end(run, body).x, end(run, body).z]).collect();
        let pairs = found.iter().zip(double_pendulum_by_hand(c));
        pairs.map(|(found, right)| (found - right).powi(2)).sum::<f64>().sqrt()
    };
    for tolerance in [1e-4, 1e-8] {
        let run = run(&double_pendulum("", &format!("accuracy = {tolerance:e}")));
        let choice = run.choice().unwrap();
        println!("{choice}off by {:e}", off(&run, 0.0));
        // The error is relative to all attitudes and places, whose norm is about 4.
        assert!(choice.error <= tolerance && off(&run, 0.0) < 5.0 * tolerance, "{choice}{:e}", off(&run, 0.0));
        assert!(choice.offers().len() == 5 && choice.steps == run.steps());
        assert!(tolerance > 1e-6 || choice.chosen().order > 2, "{choice}");
    }
    let text = double_pendulum("", "");
    let (scene, open) = (system(&text), run(&text));
    let choice = open.choice().unwrap();
    assert!((choice.accuracy.tolerance, open.steps() >= 1000) == (1e-6, true) && off(&open, 0.0) < 5e-6, "{choice}");
    assert!(scene.asks_for_accuracy() && scene.stepper().is_err());
    let told = scene.summary(&open) + &scene.end_error(&open);
    assert!(told.contains("the end is off by at most about") && !told.contains("as steps of"), "{told}");
    // Friction has no step back: the own step alone is tried.
    let damped = run(&double_pendulum("damping = 0.4\n", "accuracy = 1e-4"));
    let choice = damped.choice().unwrap();
    println!("{choice}off by {:e}", off(&damped, 0.4));
    assert!(choice.offers().len() == 1 && off(&damped, 0.4) < 5e-4, "{choice}{:e}", off(&damped, 0.4));
}

/// The members of an ensemble of several bodies are the scenes with their values, to the bit, with events and columns of joints.
#[test]
fn an_ensemble_of_several_bodies() {
    let folder = folder("ensemble-of-several");
    let text = SWING.replacen("duration = 1", "duration = 0.1", 1).replacen(
        "[run]",
        "[[event]]\nname = \"low\"\ncolumn = \"left_x\"\nvalue = -0.05\n[output]\n\
         columns = [\"position\", \"energy\", \"angle\", \"force\"]\n[run]",
        1,
    );
    let ensemble = "[ensemble]\nmembers = 6\nseed = 3\ndraw.body.seat.m = { from = 1, to = 3 }\n\
                    draw.gravity.g = { mean = 9, deviation = 0.1 }\nhistogram.left_x = { from = -1, to = 1, count = 2 }\n";
    std::fs::write(folder.join("swing.toml"), format!("{text}{ensemble}")).unwrap();
    let told = printed(&folder, &["ensemble", "swing.toml", "--out", "."]);
    assert!(
        told.contains("6 finished, 0 broke down, 0 can't exist") && told.contains("low: in 6 of 6 members"),
        "{told}"
    );
    let mut members = 0;
    for shard in shards(&folder.join("swing.ensemble")) {
        for row in 0..shard.rows.status.len() {
            let kept: Vec<f64> = shard.rows.columns.iter().map(|column| column[row]).collect();
            let [columns @ .., m, g, time] = kept.as_slice() else { panic!("{kept:?}") };
            assert!((1.0..3.0).contains(m) && (8.5..9.5).contains(g));
            let own = text.replacen("name = \"seat\"\nm = 1", &format!("name = \"seat\"\nm = {m:?}"), 1).replacen(
                "g = 9.81",
                &format!("g = {g:?}"),
                1,
            );
            let run = run(&own);
            let last = run.samples().last().unwrap();
            let numbers = system(&own).end(&run);
            assert_eq!((time, &numbers[1..=columns.len()]), (&last.time, columns));
            members += 1;
        }
    }
    assert_eq!(members, 6);
    let passages =
        shards(&folder.join("swing.ensemble")).iter().map(|shard| shard.rows.crossings[0].row.len()).sum::<usize>();
    assert_eq!(passages, 6);
    let wrong = |draw: &str| message(&format!("{text}[ensemble]\nmembers = 2\n{draw}\n"));
    let limited = text.replacen("rate = 2\n", "rate = 2\nlimits = { from = -1, to = 1 }\n", 1);
    let zero = "draw.joint.joint-1.zero.euler = [0, { from = 0, to = 1 }, 0]";
    let of_limits = message(&format!("{limited}[ensemble]\nmembers = 2\n{zero}\n"));
    let knows = "an event knows the orbit, the angles, the wheels and the joints of the file";
    assert!(of_limits.contains(knows), "{of_limits}");
    assert!(wrong("draw.joint.elbow.rate = { from = 1, to = 2 }").contains("no `joint` is called `elbow`"));
    assert!(wrong("draw.start.velocity = [1, { from = 1, to = 2 }, 0]").contains("the file has no `start`"));
}

/// Effects turn a body among several as they turn a single one; a torque and drag about a principal axis as by hand.
#[test]
fn effects_turn_one_of_several_bodies() {
    let ends = |effect: &str, velocity: &str, rest: &str| {
        let body = "moments = [0.2, 0.3, 0.4]\nkinetic = \"geodesic\"\n";
        let start = format!("euler = [0.1, 0.4, 0.2]\nvelocity = {velocity}\n");
        let run_of = format!("[run]\nduration = 1\nstep = 0.005\n{rest}");
        let other = "[[body]]\nname = \"b\"\nm = 1\nmoments = [1, 1, 1]\nposition = [3, 0, 0]\nstart.euler = [0, 0, 0]\n\
                     start.velocity = [0, 1, 0]\n";
        let (key, values) = effect.split_once(' ').unwrap();
        let alone = format!("title = \"a\"\n[body]\n{body}[{key}]\n{values}\n[start]\n{start}{run_of}");
        let of_start = start.replace("euler", "start.euler").replace("velocity", "start.velocity");
        let among = format!(
            "title = \"a\"\n[[body]]\nname = \"a\"\nm = 2\n{body}position = [0, 0, 1]\n{of_start}[body.{key}]\n{values}\n{other}{run_of}"
        );
        [alone, among].map(|text| run(&text).samples().last().unwrap().clone())
    };
    let effects = [
        "torque torque = [0.1, -0.2, 0.3]",
        "drag c = 0.05",
        "rotor spin = [0.1, 0.3, -0.2]",
        "dipole moment = [1, 2, 0]\nfield = [0, 0.3, 0.4]",
        "magnetic_damping k = 0.5\nfield = [0, 0.3, 0.4]",
    ];
    for effect in effects {
        let [alone, among] = ends(effect, "[1, 2, 3]", "").map(|sample| sample.bodies[0]);
        let apart = (alone.attitude.as_matrix() - among.attitude.as_matrix())
            .amax()
            .max((alone.velocity - among.velocity).amax());
        assert!(apart < 1e-11, "{effect}: {apart:e}");
        assert_eq!(among.position, Vector3::new(0.0, 0.0, 1.0));
    }
    let [_, torque] = ends(effects[0].replace("[0.1, -0.2, 0.3]", "[0, 0, 0.3]").as_str(), "[0, 0, 0]", "");
    assert!((torque.bodies[0].velocity - Vector3::new(0.0, 0.0, 0.3 / 0.4)).amax() < 1e-13);
    let [_, drag] = ends(effects[1], "[0, 2, 0]", "");
    let expected = 2.0 * f64::exp(-0.05 / 0.3);
    assert!((drag.bodies[0].velocity.y / expected - 1.0).abs() < 1e-5, "{} {expected}", drag.bodies[0].velocity.y);
    assert_eq!(drag.bodies[1].velocity, Vector3::y());

    let text = |body: &str, rest: &str| {
        format!(
            "title = \"a\"\n[[body]]\nname = \"a\"\nm = 1\nposition = [0, 0, 0]\nstart.euler = [0, 0, 0]\nstart.velocity = [0, 0, 1]\n{body}\n\
                 [run]\nduration = 1\n{rest}\n"
        )
    };
    let whole = text("moments = [1, 1, 1]\ndrag.c = 0.1", "accuracy = 1e-4");
    assert_eq!(
        (run(&whole).choice().unwrap().offers().len() > 1, system(&whole).about().as_str()),
        (true, "1 body + drag, 1 s to 1e-4")
    );
    assert!(system(&whole).derivation().contains(liestep_scene::derivation("drag").unwrap()));
    let refused = [
        (
            text("moments = [0, 0, 0]\ntorque.torque = [0, 0, 1]", "step = 0.1"),
            "`torque` turns a body, and a point mass has no inertia",
        ),
        (
            text("moments = [1, 1, 1]\nmagnetic_damping = { k = 1, field = { equator = [0, 0, 1] } }", "step = 0.1"),
            "`field` of `magnetic_damping` follows the orbit, and the file has no table `[orbit]`",
        ),
    ];
    for (text, expected) in refused {
        let found = message(&text);
        assert!(found.contains(expected), "{found}");
    }
}
