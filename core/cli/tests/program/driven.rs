//! Laws, wheels, pointings and orbits of several bodies, against one body, an integration with `SciPy` and closed forms.

use crate::called::{folder, refused, rows};
use crate::joints::system;

/// A hub with a wheel and a panel with a law and a dipole, on an orbit.
const SATELLITE: &str = r#"title = "A hub with a panel"
[orbit]
period = 60
normal = [0, 0, 1]
eccentricity = 0.1
phase = "40 deg"
[gravity_gradient]
direction = "nadir"
[[body]]
name = "hub"
m = 2
moments = [0.4, 0.5, 0.6]
position = [0, 0, 0]
start.euler = [0, 0, 0]
start.velocity = [0.1, -0.2, 0.3]
[[body]]
name = "panel"
m = 1
moments = [0.2, 0.3, 0.25]
position = [0.9, 0, 0]
moving = [0, 0.11, 0.06]
start.euler = [0, 0, 0]
start.velocity = [0.3, 0.1, -0.1]
dipole = { moment = [0.3, 0.1, -0.2], field = { equator = [0.2, 0.5, 1.0] } }
[[joint]]
kind = "ball"
bodies = ["hub", "panel"]
at = [[0.5, 0, 0], [-0.4, 0, 0]]
[[wheel]]
name = "w"
body = "hub"
axis = [0, 0.6, 0.8]
inertia = 0.02
speed = 30
torque = 0.01
[[control]]
body = "panel"
torque = "-k * Omega"
k = 0.2
at = "both ends"
[[pointing]]
name = "down"
body = "panel"
axis = [0, 0, 1]
to = "nadir"
[run]
duration = 4
step = 0.02
[output]
columns = ["position", "quaternion", "velocity", "wheel-speeds", "control", "pointing", "gap"]
"#;

/// The end of [`SATELLITE`] by `SciPy`'s DOP853 at a tolerance of 1e-13, with the force in the joint as an unknown of each
/// derivative: positions, quaternions, angular velocities, the speed of the wheel, the angle to the planet.
const END: [f64; 22] = [
    0.305_581_492_351,
    0.081_488_234_919,
    0.167_017_072_184,
    0.301_310_651_703,
    0.428_290_612_047,
    -0.102_256_309_882,
    0.930_417_028_018,
    0.116_793_748_095,
    0.242_510_838_993,
    0.248_740_562_332,
    0.137_698_591_962,
    0.039_430_507_674,
    0.818_970_461_921,
    0.555_672_312_309,
    -0.229_887_959_888,
    0.157_052_251_191,
    0.170_965_409_578,
    0.003_495_350_858,
    0.292_732_538_279,
    0.049_656_391_160,
    31.888_996_321_622,
    2.788_911_922_345,
];

/// The columns of [`END`] in a row.
fn seen(row: &[f64]) -> Vec<f64> {
    let sign = |first: usize, last: f64| if row[first + 3] * last < 0.0 { -1.0 } else { 1.0 };
    let turned = |first: usize, last: f64| row[first..first + 4].iter().map(move |part| part * sign(first, last));
    let quaternions = turned(7, END[9]).chain(turned(11, END[13]));
    row[1..7].iter().copied().chain(quaternions).chain(row[15..22].iter().copied()).chain([row[25]]).collect()
}

/// A hub with a wheel and a panel with a law move as the equations of both say: by the step with its order, and by a composition
/// with its own. Joints stay closed.
#[test]
fn bodies_with_devices_on_an_orbit_move_as_by_scipy() {
    let folder = folder("bodies_with_devices_on_an_orbit_move_as_by_scipy");
    let off = |method: &str, step: &str| {
        let text = SATELLITE.replace("step = 0.02", &format!("step = {step}\n{method}"));
        let rows = rows(&folder, &text);
        assert!(rows.iter().all(|row| row[26] < 1e-13), "{method}");
        let end = seen(rows.last().unwrap());
        end.iter().zip(END).map(|(own, exact)| (own - exact).abs()).fold(0.0, f64::max)
    };
    let suzuki = "method = { composition = \"Suzuki 4\" }";
    for (method, steps, order) in [("", ["0.02", "0.01"], 2.0), (suzuki, ["0.2", "0.1"], 4.0)] {
        let [coarse, fine] = steps.map(|step| off(method, step));
        let found = (coarse / fine).log2();
        println!("{method}: {coarse:e}, {fine:e}, of order {found}");
        assert!(fine < 1e-4 && (found - order).abs() < 0.3, "{method}: {coarse:e}, {fine:e}, of order {found}");
    }
}

/// A body alone in a file of several has the numbers that it has in a file of its own: with laws, sampled or at both ends, a wheel
/// with a law, an orbit with its field, and angles.
#[test]
fn a_body_among_several_has_the_numbers_of_one() {
    let folder = folder("a_body_among_several_has_the_numbers_of_one");
    let beside = |control: &str, method: &str| {
        format!(
            "orbit = {{ period = 60, normal = [0, 0, 1], eccentricity = 0.1, phase = \"40 deg\" }}\n\
             gravity_gradient.direction = \"nadir\"\n\
             [[control]]\ntorque = \"-0.3 * q - 0.5 * Omega + 0.01 * b\"\n{control}\nrelative_to = \"local vertical\"\n\
             advected = {{ b = \"B\" }}\nB = {{ equator = [0.2, 0.5, 1] }}\nlargest = 0.2\n\
             [[wheel]]\naxis = [0, 0.6, 0.8]\ninertia = 0.02\nspeed = 30\ntorque = \"0.1 * Omega[1] - 0.001 * speed\"\n\
             [[pointing]]\nname = \"down\"\naxis = [0, 0.6, 0.8]\nto = \"nadir\"\n\
             [run]\nduration = 2\nstep = 0.05\n{method}\n[output]\nevery = 1\ncolumns = [\"quaternion\", \"velocity\", \"energy\", \"pointing\", \
             \"roll-pitch-yaw\", \"wheel-speeds\", \"control\"]\n"
        )
    };
    let effects = |prefix: &str| {
        format!(
            "{prefix}dipole = {{ moment = [0.3, 0.1, -0.2], field = {{ equator = [0.2, 0.5, 1] }} }}\n\
             {prefix}air_drag = {{ c = 0.02, air = \"orbit\" }}\n"
        )
    };
    let composed = "method = { composition = \"Suzuki 4\" }";
    for (control, method, frame) in [
        ("every = 0.1", "", ""),
        ("at = \"both ends\"", "", "start.relative_to = \"local vertical\"\n"),
        ("every = 0.1", composed, ""),
    ] {
        let start = format!("start.quaternion = [0.8, 0.1, -0.5, 0.3]\nstart.velocity = [0.3, -0.2, 0.5]\n{frame}");
        let (drag, method) = (method.is_empty(), method);
        let kept = |text: String| {
            if drag {
                text
            } else {
                text.lines().filter(|line| !line.contains("drag")).map(|line| line.to_owned() + "\n").collect()
            }
        };
        let one = kept(format!(
            "title = \"One\"\n{start}body = {{ moments = [1, 2, 2.5], kinetic = \"geodesic\" }}\n{}{}",
            effects(""),
            beside(control, method)
        ));
        let body = format!(
            "[[body]]\nname = \"a\"\nm = 3\nmoments = [1, 2, 2.5]\nposition = [0, 0, 0]\n{start}{}",
            effects("")
        );
        let rest = beside(control, method);
        let (head, tables) = rest.split_once("[[control]]").unwrap();
        let several = kept(format!("title = \"Several\"\n{head}{body}[[control]]{tables}"));
        let [one, several] = [one, several].map(|text| rows(&folder, &text));
        assert_eq!((one.len(), one[0].len()), (41, 17));
        let apart = crate::called::apart(&one, &several);
        println!("{control} {method}: {apart:e}");
        assert!(apart < 1e-11, "{control} {method}: {apart:e}");
    }
}

/// A body beside the place whose circular orbit the frame follows moves by the formula of Clohessy and Wiltshire, of which the step
/// is off by the second order; the body at that place stays there.
#[test]
fn the_tide_is_that_of_clohessy_and_wiltshire() {
    let folder = folder("the_tide_is_that_of_clohessy_and_wiltshire");
    let n = std::f64::consts::TAU / 100.0;
    let ([x, y, z], [u, v, w]) = ([1.0, -2.0, 0.5], [0.03, 0.01, -0.02]);
    let text = |step: f64| {
        format!(
            "title = \"Beside\"\norbit = {{ period = 100, normal = [0, 0, 1] }}\ngravity_gradient.direction = \"nadir\"\n\
             [[body]]\nname = \"here\"\nm = 5\nmoments = [1, 1, 1]\nposition = [0, 0, 0]\nstart.euler = [0, 0, 0]\nstart.velocity \
             = [0, 0, 0]\n[[body]]\nname = \"beside\"\nm = 2\nmoments = [1, 2, 2.5]\nposition = [{x:?}, {y:?}, {z:?}]\nmoving = \
             [{:?}, {:?}, {w:?}]\nstart.euler = [0, 0, 0]\nstart.velocity = [0, 0, 0]\n\
             [run]\nduration = 80\nstep = {step:?}\n[output]\ncolumns = [\"position\"]\n",
            u - n * y,
            v + n * x
        )
    };
    let exact = |t: f64| {
        let (s, c) = (n * t).sin_cos();
        let radial = (4.0 - 3.0 * c) * x + s / n * u + 2.0 / n * (1.0 - c) * v;
        let along = 6.0 * (s - n * t) * x + y - 2.0 / n * (1.0 - c) * u + (4.0 * s - 3.0 * n * t) / n * v;
        [c * radial - s * along, s * radial + c * along, c * z + s / n * w]
    };
    let off = |step: f64| {
        let end = rows(&folder, &text(step)).pop().unwrap();
        assert_eq!(end[1..4], [0.0; 3]);
        (0..3).map(|k| (end[4 + k] - exact(80.0)[k]).abs()).fold(0.0, f64::max)
    };
    let [coarse, fine] = [off(0.1), off(0.05)];
    println!("{coarse:e} {fine:e}");
    assert!(fine < 2e-3 && ((coarse / fine).log2() - 2.0).abs() < 0.02, "{coarse:e} {fine:e}");
}

/// Motors of wheels exchange momentum with jointed bodies, whose total about the origin is conserved to rounding, whatever they do.
#[test]
fn wheels_conserve_the_momentum_of_jointed_bodies() {
    let folder = folder("wheels_conserve_the_momentum_of_jointed_bodies");
    let orbit = SATELLITE.split_once("[[body]]").unwrap().0;
    let text = SATELLITE.replace(orbit, "title = \"Free\"\n").replace("dipole = { moment", "# {");
    let control = text.split_once("[[control]]").unwrap().1.split_once("[run]").unwrap().0.to_owned();
    let text = text
        .replace(&format!("[[control]]{control}"), "")
        .replace("torque = 0.01", "torque = \"-0.5 * Omega[2] - 0.01 * speed\"\nlargest_torque = 0.05");
    let text = text
        .replace("\"wheel-speeds\", \"control\", \"pointing\"", "\"wheel-speeds\", \"momentum\", \"angular-momentum\"");
    let rows = rows(&folder, &text);
    let speeds: Vec<f64> = rows.iter().map(|row| row[21]).collect();
    assert!((speeds[speeds.len() - 1] - speeds[0]).abs() > 5.0);
    for row in &rows {
        let off = (22..28).map(|k| (row[k] - rows[0][k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{off:e}");
    }
}

/// Keys of one body among several, with their places.
#[test]
fn devices_of_several_bodies_name_their_bodies() {
    let folder = folder("devices_of_several_bodies_name_their_bodies");
    let cases = [
        ("body = \"hub\"\naxis", "axis", "29:1: missing field `body`: the name of one of `hub`, `panel`"),
        ("body = \"hub\"\naxis", "body = \"hab\"\naxis", "31:8: unknown body `hab`, expected one of `hub`, `panel`"),
        (
            "m = 1\nmoments = [0.2, 0.3, 0.25]",
            "m = 1\nmoments = [0, 0, 0]",
            "`dipole` turns a body, and a point mass has no inertia",
        ),
        ("step = 0.02", "accuracy = 1e-6", "laws and wheels are beside a `step`, and neither an accuracy"),
        (
            "[orbit]\nperiod = 60\nnormal = [0, 0, 1]\neccentricity = 0.1\nphase = \"40 deg\"\n",
            "",
            "`field` of `dipole` follows the orbit, and the file has no table `[orbit]`",
        ),
        (
            "start.euler = [0, 0, 0]\nstart.velocity = [0.1",
            "start.relative_to = \"the planet\"\nstart.velocity = [0.1",
            "14:21: a start is relative to space, or to the \"local vertical\"",
        ),
        (
            "[run]",
            "[[event]]\nname = \"e\"\nbody = \"hub\"\nenergy = 1\n[run]",
            "this quantity is that of all bodies: leave `body` out",
        ),
        (
            "[run]",
            "[[event]]\nname = \"e\"\ntilt = 1\n[run]",
            "missing field `body`: the name of one of `hub`, `panel`",
        ),
    ];
    for (old, new, message) in cases {
        assert!(SATELLITE.contains(old), "{old}");
        let found = refused(&folder, &SATELLITE.replace(old, new));
        assert!(found.contains(message), "{found}");
    }
    let (_, bodies) = SATELLITE.split_once("[[body]]").unwrap();
    let (body, _) = bodies.split_once("[[body]]").unwrap();
    let start = "start.relative_to = \"local vertical\"";
    let found = refused(&folder, &format!("title = \"A hub\"\n[[body]]{body}{start}\n[run]\nstep = 1\nduration = 2\n"));
    assert!(found.contains("9:21: the local vertical is that of an orbit, and the file has no table"), "{found}");
    let one = "title = \"One\"\nstart = { euler = [0, 0, 0], velocity = [0, 0, 1] }\nbody.moments = [1, 2, 2.5]\n\
               [[wheel]]\nbody = \"a\"\naxis = [0, 0, 1]\ninertia = 1\n[run]\nstep = 0.1\nduration = 1\n";
    let found = refused(&folder, one);
    assert!(found.contains("5:8: the only body of a scene has no name: leave `body` out"), "{found}");
}

/// Events of several bodies have the quantities of one by the body's name, and the columns of angles.
#[test]
fn events_name_their_bodies() {
    let folder = folder("events_name_their_bodies");
    let event = |name: &str, what: &str| format!("[[event]]\nname = \"{name}\"\n{what}\n");
    let events = event("slow", "body = \"panel\"\nvelocity_x = 0.2")
        + &event("fast", "body = \"hub\"\nspeed = 0.3")
        + &event("tilted", "body = \"panel\"\ntilt = 0.5")
        + &event("angle", "column = \"down\"\nvalue = 2");
    rows(&folder, &SATELLITE.replace("[run]", &(events + "[run]")));
    let text = std::fs::read_to_string(folder.join("scene.events.csv")).unwrap();
    let happened: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let of = |name: &str| happened.iter().find(|row| row[0] == name).unwrap_or_else(|| panic!("{name}: {text}"));
    let number = |row: &[&str], at: usize| row[2 + at].parse::<f64>().unwrap();
    assert!((number(of("slow"), 18) - 0.2).abs() < 1e-9);
    let fast = of("fast");
    let speed = (15..18).map(|k| number(fast, k).powi(2)).sum::<f64>().sqrt();
    assert!((speed - 0.3).abs() < 1e-9, "{speed}");
    // The third axis of space in the body: R_33 of the quaternion.
    let tilted = of("tilted");
    let cosine = 1.0 - 2.0 * (number(tilted, 12).powi(2) + number(tilted, 13).powi(2));
    assert!((cosine - 0.5_f64.cos()).abs() < 1e-9, "{cosine}");
    assert!((number(of("angle"), 25) - 2.0).abs() < 1e-9);
}

/// A constant law, held by the term of a torque, moves jointed bodies as forces from outside do that are pushed upon the momenta.
#[test]
fn a_held_law_is_a_force_from_outside() {
    let law = |text: &str| SATELLITE.replace("-k * Omega", text).replace("at = \"both ends\"", "every = 0.04");
    let [(held, mut one), (free, mut other)] =
        ["[0.1, -0.2 * k, 0.05]", "[0, 0, 0 * k]"].map(|text| system(&law(text)).stepper().unwrap());
    let force = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1, -0.04, 0.05, 0.0, 0.0, 0.0];
    for _ in 0..100 {
        held.step(&mut one).unwrap();
        free.step_forced(&mut other, &force).unwrap();
    }
    let apart = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let off = apart(one.attitude(), other.attitude()).max(apart(&held.velocity(&one), &free.velocity(&other)));
    assert!(off < 1e-12, "{off:e}");
    let still = system(&law("[0, 0, 0 * k]")).stepper().unwrap();
    let mut unforced = still.1;
    still.0.run(&mut unforced, 100).unwrap();
    assert!(apart(one.attitude(), unforced.attitude()) > 0.1);
    assert!(
        free.step_forced(&mut other, &force[..6]).is_err() && free.step_forced(&mut other, &[f64::NAN; 12]).is_err()
    );
}

/// The momentum of a start with wheels starts the same motion, with the wheels at their speeds relative to their bodies.
#[test]
fn a_momentum_with_wheels_has_its_velocity() {
    let second = "[[wheel]]\nname = \"v\"\nbody = \"panel\"\naxis = [1, 0, 0]\ninertia = 0.3\nspeed = -7\n[[control]]";
    let (stepper, start) = system(&SATELLITE.replace("[[control]]", second)).stepper().unwrap();
    let again = stepper.start_with_momentum(start.attitude(), start.momentum()).unwrap();
    let [one, other] = [&start, &again].map(|state| stepper.velocity(state));
    let off = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-13 && (one[8] + 0.1).abs() < 1e-13, "{off:e} {one:?}");
    assert!((stepper.energy(&start) - stepper.energy(&again)).abs() < 1e-12);
}

/// A picture of several bodies has the panels of one, with a curve for each body, and the default of its own.
#[test]
fn a_picture_has_any_panels() {
    let picture = |panels: &str| {
        let scene = system(&(SATELLITE.to_owned() + panels));
        scene.picture(&scene.run().unwrap()).unwrap()
    };
    let own =
        picture("[picture]\naxis = [1, 0, 0]\npanels = [\"rates\", \"tilt\", \"momentum\", \"momentum-error\"]\n");
    for title in ["Angular velocities", "Tilt of the axis", "Angular momentum in space", "Ways of the centres of mass"]
    {
        assert!(own.contains(title), "{title}");
    }
    let default = picture("");
    assert!(default.contains("Turned from the start by") && default.contains("Energy: how far from its start"));
    let wrong = crate::joints::message(&(SATELLITE.to_owned() + "[picture]\npanels = [\"attitude\"]\n"));
    assert!(
        wrong.ends_with("the `attitude` of several bodies has no panel: `turns` has how far each is turned"),
        "{wrong}"
    );
}

/// A weld takes up what laws and motors do to a body at rest, and its weight.
#[test]
fn a_weld_takes_up_laws_and_motors() {
    let folder = folder("a_weld_takes_up_laws_and_motors");
    for held in ["every = 0.02", "at = \"both ends\""] {
        let text = format!(
            "title = \"Held\"\ngravity = {{ g = 9.81, up = [0, 0, 1] }}\n[[body]]\nname = \"a\"\nm = 2\nmoments = [1, 2, 2.5]\n\
             [[joint]]\nkind = \"weld\"\nbodies = [\"space\", \"a\"]\nat = [[0, 0, 0], [0, 0, 0]]\n\
             [[control]]\ntorque = \"[0.1, -0.2, 0.3] - Omega\"\n{held}\n\
             [[wheel]]\naxis = [0, 0.6, 0.8]\ninertia = 0.02\nspeed = 30\ntorque = 0.05\n\
             [run]\nduration = 0.1\nstep = 0.01\n[output]\nevery = 1\ncolumns = [\"velocity\", \"force\", \"torque\"]\n"
        );
        for row in rows(&folder, &text) {
            let expected = [0.0, 0.0, 0.0, 0.0, 0.0, 19.62, -0.1, 0.2 + 0.03, -0.3 + 0.04];
            let off = row[1..].iter().zip(expected).map(|(own, exact)| (own - exact).abs()).fold(0.0, f64::max);
            assert!(off < 1e-11, "{held}: {row:?}");
        }
    }
}
