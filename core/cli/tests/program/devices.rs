//! Laws and wheels, against integrations and formulas typed here.

use std::fs;

use nalgebra::{Matrix3, Quaternion, SVector, UnitQuaternion, Vector3};

use crate::called::{called, folder, printed, refused, refuses, rows};

/// Speeds of wheels, kg m² of each, axes, and torques of three wheels.
const MOMENTS: [f64; 3] = [0.02, 0.03, 0.05];
const SPEEDS: [f64; 3] = [100.0, -40.0, 10.0];
const TORQUES: [f64; 3] = [0.01, 0.02, -0.03];

fn axes() -> [Vector3<f64>; 3] {
    [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 0.6, 0.8), Vector3::new(0.36, 0.48, 0.8)]
}

fn three_wheels(step: f64) -> String {
    let wheel = |at: usize| {
        format!(
            "[[wheel]]\naxis = {:?}\ninertia = {}\nspeed = {:?}\ntorque = {:?}\n",
            axes()[at].as_slice(),
            MOMENTS[at],
            SPEEDS[at],
            TORQUES[at]
        )
    };
    format!(
        "title = \"Three wheels\"\n[body]\nJ = [[2, 0.1, -0.2], [0.1, 3, 0.3], [-0.2, 0.3, 4]]\nkinetic = \"geodesic\"\n\
         [start]\nquaternion = [0.8, 0.1, -0.5, 0.3]\nvelocity = [0.3, -0.2, 0.5]\n[run]\nduration = 20\nstep = {step:?}\n\
         [output]\ncolumns = [\"quaternion\", \"velocity\", \"spatial-momentum\", \"wheel-speeds\"]\nevery = 1\n{}",
        (0..3).map(wheel).collect::<String>()
    )
}

/// Euler's equations with the momenta of wheels: `J Ω' = −Ω × (J Ω + Σ s a) − Σ u a`, `s' = u`, by Runge–Kutta.
fn integrated() -> ([f64; 4], [f64; 3], [f64; 3]) {
    let J = Matrix3::new(2.0, 0.1, -0.2, 0.1, 3.0, 0.3, -0.2, 0.3, 4.0);
    let inverse = J.try_inverse().unwrap();
    let pushed: Vector3<f64> = axes().iter().zip(TORQUES).map(|(axis, torque)| axis * torque).sum();
    let start = Vector3::new(0.3, -0.2, 0.5);
    let spins: Vec<f64> = (0..3).map(|at| MOMENTS[at] * (SPEEDS[at] + axes()[at].dot(&start))).collect();
    let f = |y: &SVector<f64, 10>| {
        let q = Quaternion::new(y[0], y[1], y[2], y[3]);
        let turn = Vector3::new(y[4], y[5], y[6]);
        let spin: Vector3<f64> = (0..3).map(|at| axes()[at] * y[7 + at]).sum();
        let spun = inverse * (-turn.cross(&(J * turn + spin)) - pushed);
        let q = q * Quaternion::from_imag(turn) * 0.5;
        SVector::from_iterator([q.w, q.i, q.j, q.k].into_iter().chain(spun.iter().copied()).chain(TORQUES))
    };
    let q = UnitQuaternion::new_normalize(Quaternion::new(0.8, 0.1, -0.5, 0.3));
    let mut y: SVector<f64, 10> =
        SVector::from_iterator([q.w, q.i, q.j, q.k].into_iter().chain(start.iter().copied()).chain(spins));
    let h = 20.0 / 40_000.0;
    for _ in 0..40_000 {
        let a = f(&y);
        let b = f(&(y + a * (0.5 * h)));
        let c = f(&(y + b * (0.5 * h)));
        let d = f(&(y + c * h));
        y += (a + (b + c) * 2.0 + d) * (h / 6.0);
    }
    let turn = Vector3::new(y[4], y[5], y[6]);
    let speeds = [0, 1, 2].map(|at| y[7 + at] / MOMENTS[at] - axes()[at].dot(&turn));
    ([y[0], y[1], y[2], y[3]], [y[4], y[5], y[6]], speeds)
}

/// By the scene's own step and by a composition, whose stages have the wheels' momenta of their own times.
#[test]
fn three_wheels_exchange_momentum_with_the_body() {
    let folder = folder("three_wheels_exchange_momentum_with_the_body");
    let (q, turn, speeds) = integrated();
    let error = |method: &str, step: f64| {
        let rows = rows(&folder, &three_wheels(step).replace("[output]", &format!("{method}\n[output]")));
        let first = Vector3::new(rows[0][8], rows[0][9], rows[0][10]);
        for row in &rows {
            // The momentum in space of body and wheels, to rounding.
            let off = (Vector3::new(row[8], row[9], row[10]) - first).norm() / first.norm();
            assert!(off < 1e-13, "{off:e}");
        }
        let end = &rows[rows.len() - 1];
        let own = UnitQuaternion::new_normalize(Quaternion::new(end[1], end[2], end[3], end[4]));
        let turned = own.angle_to(&UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3])));
        let apart = |from: usize, values: [f64; 3]| {
            values.iter().enumerate().map(|(at, value)| (end[from + at] - value).abs()).fold(0.0, f64::max)
        };
        [turned, apart(5, turn), apart(11, speeds)]
    };
    let of_order = |method: &str, order: f64, steps: [f64; 2]| {
        let [coarse, fine] = steps.map(|step| error(method, step));
        for (coarse, fine) in coarse.iter().zip(fine) {
            assert!(fine < 1e-3 && ((coarse / fine).log2() - order).abs() < 0.1, "{method}: {coarse:e} {fine:e}");
        }
    };
    of_order("", 2.0, [0.02, 0.01]);
    of_order("method = { composition = \"Suzuki 4\" }", 4.0, [0.2, 0.1]);
}

/// A Lagrangian of the file's own has laws, wheels and torques as a body of the library has.
#[test]
fn own_lagrangians_have_laws_and_wheels() {
    let folder = folder("own_lagrangians_have_laws_and_wheels");
    let scene = |body: &str, start: &str| {
        format!(
            "title = \"Own\"\n{body}\n[torque]\ntorque = [0.01, 0, -0.02]\n[start]\nquaternion = [0.8, 0.1, -0.5, \
             0.3]\n{start}\n[run]\nduration = 4\nstep = 0.1\n[output]\ncolumns = [\"quaternion\", \"velocity\", \
             \"control\", \"wheel-speeds\", \"energy\"]\nevery = 1\n[[control]]\ntorque = \"-0.3 * q - 0.5 * Omega\"\nevery \
             = 0.2\n[[wheel]]\naxis = [0, 0.6, 0.8]\ninertia = 0.02\nspeed = 30\ntorque = \"0.1 * Omega[1]\"\n"
        )
    };
    let lagrangian = |text: &str| format!("[lagrangian]\n{text}\n");
    for (kinetic, own) in [
        ("rigid", "l_d = \"((F - I) * J_d * (F - I).transpose()).trace() / (2 * h)\"\nJ_d = { moments = [1, 2, 2.5] }"),
        (
            "cayley",
            "velocity = \"Omega\"\ndiscretise = \"trapezoid(Cayley)\"\nl = \"Omega.dot(J * Omega) / 2\"\nJ = { moments \
             = [1, 2, 2.5] }",
        ),
    ] {
        let body = format!("[body]\nmoments = [1, 2, 2.5]\nkinetic = \"{kinetic}\"");
        // The momentum of that velocity: J Ω + I (Ω·a + speed) a, where J is without the wheel.
        let turn = Vector3::new(0.3, -0.2, 0.5);
        let along = axes()[1];
        let momentum = Vector3::new(1.0, 2.0, 2.5).component_mul(&turn) + along * (0.02 * (turn.dot(&along) + 30.0));
        let starts = ["velocity = [0.3, -0.2, 0.5]".to_owned(), format!("momentum = {:?}", momentum.as_slice())];
        let expected = rows(&folder, &scene(&body, &starts[0]));
        for start in &starts {
            let apart = crate::called::apart(&rows(&folder, &scene(&lagrangian(own), start)), &expected);
            assert!(apart < 1e-11, "{kinetic}, {start}: {apart:e}");
        }
    }
}

/// A torque above the largest is cut, and a wheel at its largest speed isn't driven on.
#[test]
fn wheels_have_limits() {
    let folder = folder("wheels_have_limits");
    let text = "title = \"A wheel\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 0]\n[run]\n\
                duration = 10\nstep = 0.1\n[output]\ncolumns = [\"velocity\", \"wheel-speeds\", \"energy\"]\n[[wheel]]\nname = \
                \"yaw\"\naxis = [0, 0, 1]\ninertia = 0.01\ntorque = \"1 N m\"\nlargest_torque = \"20 mN m\"\nlargest_speed = \
                \"100 rpm\"\n";
    let rows = rows(&folder, text);
    let most = 100.0 * std::f64::consts::TAU / 60.0;
    // The momentum of the wheel about its axis is u t, and that of the body the opposite.
    for row in rows.iter().filter(|row| row[0] < 5.0) {
        let (momentum, turn) = (0.02 * row[0], -0.02 * row[0]);
        assert!((row[3] - turn).abs() < 1e-13 && (row[4] - (momentum / 0.01 - turn)).abs() < 1e-11, "{row:?}");
        let energy = 0.5 * turn * turn + 0.5 * momentum * momentum / 0.01;
        assert!((row[5] - energy).abs() < 1e-13, "{row:?}");
    }
    let end = &rows[rows.len() - 1];
    // The body turns back while the wheel speeds up, by its share of the momentum.
    assert!(rows.iter().all(|row| row[4] < most * 1.011) && end[4] > most * 0.999, "{end:?} {most}");
    assert!((rows[60][4] - end[4]).abs() < 1e-12, "{:?} {end:?}", rows[60]);
}

/// A law of quaternion and rate ends where its torque is that of a disturbance, and its limits hold on the way.
#[test]
fn a_law_with_limits_settles_at_torque_over_gain() {
    let folder = folder("a_law_with_limits_settles_at_torque_over_gain");
    let text = "title = \"Held\"\n[body]\nmoments = [1, 2, 3]\n[start]\neuler = [0.5, 0.9, -0.3]\nvelocity = [0.1, 0, 0.2]\n\
                [torque]\ntorque = [0.0005, -0.001, 0.001]\n[[control]]\ntorque = \"-kp * 2 * q - kd * Omega\"\nkp = 0.5\nkd = \
                2\nevery = \"0.1 s\"\nlargest = \"0.1 N m\"\n[run]\nduration = 300\nstep = 0.05\n[output]\ncolumns = \
                [\"quaternion\", \"velocity\", \"control\"]\nevery = 1\n";
    let rows = rows(&folder, text);
    let end = &rows[rows.len() - 1];
    for (at, expected) in [0.001, -0.002, 0.002].into_iter().enumerate() {
        assert!((end[2 + at] * 2.0 * end[1].signum() - expected).abs() < 1e-8, "{end:?}");
        assert!((end[8 + at] + [0.0005, -0.001, 0.001][at]).abs() < 1e-8 && end[5 + at].abs() < 1e-8, "{end:?}");
    }
    assert!(rows.iter().all(|row| row[8..11].iter().all(|torque| torque.abs() <= 0.1)));
    assert!(rows.iter().any(|row| row[8..11].iter().any(|torque| torque.abs() >= 0.1)));
    // Held over two steps: the rows 2k + 1 and 2k + 2 have one torque.
    for pair in rows[1..].chunks_exact(2) {
        assert_eq!(pair[0][8..11], pair[1][8..11]);
    }
}

/// A law at both ends of each step has the order of the method: a spin against `−k Ω` falls as `e^{−kt/J}`, and a tumbling body is
/// turned to its target as by short steps of order eight.
#[test]
fn a_law_at_both_ends_has_the_order_of_the_method() {
    let folder = folder("a_law_at_both_ends_has_the_order_of_the_method");
    let end = |start: &str, law: &str, step: f64, method: &str| {
        let text = format!(
            "title = \"Ends\"\n[body]\nmoments = [1, 2, 3]\nkinetic = \"geodesic\"\n[start]\neuler = [0, 0, 0]\nvelocity = \
             {start}\n[run]\nduration = 4\nstep = {step:?}\n{method}\n[output]\ncolumns = [\"velocity\", \"quaternion\"]\n\
             [[control]]\ntorque = \"{law}\"\nat = \"both ends\"\n"
        );
        rows(&folder, &text).pop().unwrap()[1..].to_vec()
    };
    let composed = |name: &str| format!("method = {{ composition = \"{name}\" }}");
    let (spin, tumbling) = ("[0, 0, 1.5]", "[1.2, -0.8, 0.5]");
    let (brake, turn) = ("-0.9 * Omega", "-1.5 * q - 0.8 * Omega - 0.2 * [q[0] * q[1], 0, t / 4]");
    let exact = end(tumbling, turn, 0.02, &composed("Kahan-Li 8"));
    for (method, order) in [(String::new(), 2.0), (composed("Suzuki 4"), 4.0)] {
        let spun = |step| (end(spin, brake, step, &method)[2] - 1.5 * (-0.9_f64 * 4.0 / 3.0).exp()).abs();
        let turned = |step| {
            let apart = end(tumbling, turn, step, &method);
            apart.iter().zip(&exact).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        for error in [&spun as &dyn Fn(f64) -> f64, &turned] {
            let [coarse, fine] = [0.1, 0.05].map(error);
            assert!(((coarse / fine).log2() - order).abs() < 0.15, "{method}: {coarse:e} {fine:e}");
        }
    }
}

/// A law of a wheel reads the body: it turns a body to the local vertical, and takes its momentum over.
#[test]
fn a_wheel_holds_a_body_at_the_local_vertical() {
    let folder = folder("a_wheel_holds_a_body_at_the_local_vertical");
    let wheel = |axis: usize| {
        let mut direction = [0, 0, 0];
        direction[axis] = 1;
        format!(
            "[[wheel]]\naxis = {direction:?}\ninertia = 0.01\nrelative_to = \"local vertical\"\ntorque = \"kp * q[{axis}] + kd * \
             Omega[{axis}]\"\nkp = 0.02\nkd = 0.2\nevery = 0.5\n"
        )
    };
    let text = format!(
        "title = \"Nadir\"\n[body]\nmoments = [1, 1.2, 0.8]\n[orbit]\nperiod = 6000\nnormal = [0, 0.6, 0.8]\neccentricity = \
         0.1\n[start]\nrelative_to = \"local vertical\"\nrpy = [\"20 deg\", \"-30 deg\", \"10 deg\"]\nvelocity = [0.01, 0, \
         0]\n[run]\nduration = 1500\nstep = 0.5\n[output]\ncolumns = [\"roll-pitch-yaw\", \"spatial-momentum\"]\n{}",
        (0..3).map(wheel).collect::<String>()
    );
    let rows = rows(&folder, &text);
    let (first, end) = (&rows[0], &rows[rows.len() - 1]);
    assert!((first[1] - 20_f64.to_radians()).abs() < 1e-12, "{first:?}");
    // The nadir's rate changes along the orbit, which a law without an integral follows at a small distance.
    assert!(end[1..4].iter().all(|angle| angle.abs() < 2e-3), "{end:?}");
    for row in &rows {
        let off = (0..3).map(|at| (row[4 + at] - first[4 + at]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-14, "{off:e}");
    }
}

/// Mistakes have their place.
#[test]
fn mistakes_of_laws_and_wheels_have_their_place() {
    let folder = folder("mistakes_of_laws_and_wheels_have_their_place");
    let law = |torque: &str, more: &str| format!("[[control]]\ntorque = \"{torque}\"\n{more}");
    let wheel = |more: &str| format!("[[wheel]]\naxis = [0, 0, 1]\ninertia = 0.01\n{more}");
    for (device, message) in [
        (law("-kd * Omega", ""), "11:10: unknown name `kd`"),
        (law("-2 * omega", ""), "did you mean `Omega`?"),
        (law("-2 * Omega[3]", ""), "the components of a vector are `v[0]`"),
        (law("Omega.dot(q)", ""), "a torque is a vector"),
        (law("Omega * q", ""), "the product of two vectors is"),
        (law("Omega + 1", ""), "a vector and a number have no sum"),
        (law("Omega / q", ""), "nothing is divided by a vector"),
        (law("-(Omega", ""), "`)` is missing"),
        (law("-Omega)", ""), "isn't expected behind"),
        (law("", ""), "an expression is missing"),
        (law(&"-(".repeat(200), ""), "at most 64 brackets"),
        (law("Omega # 2", ""), "has no meaning"),
        (law("curl(Omega)", ""), "`curl` is none of `abs`"),
        (law("Omega.cross()", ""), "are of vectors"),
        (law("-Omega", "every = 0.25"), "a whole number of steps"),
        (law("-Omega", "Omega = 1"), "has another meaning"),
        (law("-b", "advected = { b = \"B\" }"), "has no vector `B`"),
        (law("-b", "advected = { b = \"B\" }\nB = { equator = [0, 0, 1] }"), "no table `[orbit]`"),
        (law("-Omega", "relative_to = \"local vertical\""), "no table `[orbit]`"),
        (law("-Omega", "largest = -1"), "a torque above zero for all axes"),
        (law("-Omega", "at = \"the end\""), "12:6: a law is held from sample to sample"),
        (law("-Omega", "at = \"both ends\"\nevery = 0.1"), "13:9: a law at both ends of each step has no samples"),
        (law("-every * Omega", "at = \"both ends\""), "unknown name `every`"),
        (wheel("torque = \"Omega[2]\"\nat = \"both ends\""), "the law of a wheel is held"),
        ("[[control]]\ntorque = [0, 0, 1]\n".to_owned(), "is a text"),
        (wheel("torque = \"Omega\""), "the torque of a wheel is a number"),
        (wheel("spin = 1"), "13:1: unknown field `spin`"),
        (wheel("inertia_ = 1"), "unknown field `inertia_`"),
        ("[[wheel]]\naxis = [0, 0, 2]\ninertia = 1\n".to_owned(), "a direction has the length 1"),
        ("[[wheel]]\naxis = [0, 0, 1]\n".to_owned(), "missing field `inertia`"),
        ("[wheel]\naxis = [0, 0, 1]\n".to_owned(), "is a list of tables"),
        (wheel("name = \"a b\""), "letters, digits"),
        (wheel("torque = { times = [0, 0.5], values = [0, 1], between = \"lines\" }"), "no value after the last of"),
        (
            wheel("torque = { times = [0, 2], values = [[0, 1], [1, 1]], between = \"lines\" }"),
            "one number at each time",
        ),
        (format!("{}{}", wheel("name = \"a\"\n"), wheel("name = \"a\"\n")), "two wheels have the name `a`"),
    ] {
        let text = format!(
            "title = \"A law\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 1]\n\
             run = {{ duration = 1, step = 0.1 }}\n{device}\n"
        );
        let text = text.replace("run = { duration = 1, step = 0.1 }", "[run]\nduration = 1\nstep = 0.1");
        fs::write(folder.join("scene.toml"), &text).unwrap();
        let output = called(&folder, &["check", "scene.toml"]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && told.contains(message), "{device}: {told}");
    }
    for (run, message) in [
        ("accuracy = 1e-3", "beside a `step`"),
        ("step = 0.1\nmethod = { splitting = \"Strang\" }", "the scene's own step or a composition of it"),
    ] {
        let text = format!(
            "title = \"A law\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 1]\n[run]\nduration = \
             1\n{run}\n[[control]]\ntorque = \"-Omega\"\n"
        );
        fs::write(folder.join("scene.toml"), &text).unwrap();
        let told = String::from_utf8(called(&folder, &["check", "scene.toml"]).stderr).unwrap();
        assert!(told.contains(message), "{run}: {told}");
    }
}

/// Laws with times of their own are held each by itself, and added.
#[test]
fn several_laws_are_added() {
    let folder = folder("several_laws_are_added");
    let text = "title = \"Two laws\"\n[body]\nmoments = [1, 1, 2]\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 0]\n[run]\n\
                duration = 2\nstep = 0.1\n[output]\ncolumns = [\"control\", \"velocity\"]\nevery = 1\n[[control]]\ntorque = \
                \"[0, 0, 1]\"\n[[control]]\ntorque = \"[0, 0, 2 * t]\"\nevery = 0.5\n[[control]]\ntorque = \"[0, 0, 5]\"\n\
                largest = [1, 1, 3]\nevery = 1\n";
    let rows = rows(&folder, text);
    let mut momentum = 0.0;
    for (step, row) in rows.iter().enumerate().skip(1) {
        let sampled = 0.5 * f64::from(u32::try_from((step - 1) / 5).unwrap());
        let torque = 1.0 + 2.0 * sampled + 3.0;
        momentum += 0.1 * torque;
        assert!((row[3] - torque).abs() < 1e-12 && (row[6] * 2.0 - momentum).abs() < 1e-12, "{row:?}");
    }
}

/// A law without a value ends the run, also within limits, which would hide it; a signal turns a wheel by its impulse.
#[test]
fn laws_without_values_and_signals_of_wheels() {
    let folder = folder("laws_without_values_and_signals_of_wheels");
    let scene = |device: &str| {
        format!(
            "title = \"A law\"\n[body]\nmoments = [1, 1, 1]\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 0]\n[run]\nduration = \
             2\nstep = 0.4\n[output]\ncolumns = [\"wheel-speeds\", \"velocity\"]\n{device}\n"
        )
    };
    for torque in ["[0, 0, sqrt(0.5 - t)]", "[0, clamp(sqrt(0.5 - t), 0, 1), 0]", "[max(sqrt(0.5 - t), 0), 0, 0]"] {
        let text =
            scene(&format!("[[control]]\ntorque = \"{torque}\"\nlargest = 0.1")).replace("\"wheel-speeds\", ", "");
        fs::write(folder.join("scene.toml"), text).unwrap();
        let output = called(&folder, &["run", "scene.toml", "--out", "."]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(3) && told.contains("stopped at t = 0.8 s"), "{torque}: {told}");
    }
    let wheel = "[[wheel]]\naxis = [0, 1, 0]\ninertia = 0.5\nspeed = 3\ntorque = { times = [0, 0.7, 1.5], values = [0, 0.2, 0], \
                 between = \"steps\" }";
    let end = rows(&folder, &scene(wheel)).pop().unwrap();
    // 0.2 N m from .7 s to 1.5 s, between the ends of steps.
    assert!((end[3] + 0.16).abs() < 1e-14 && (end[1] - (3.0 + 0.16 / 0.5 + 0.16)).abs() < 1e-13, "{end:?}");
}

/// Events between steps, an ensemble of starts and the summary have laws, too.
#[test]
fn events_and_ensembles_have_laws() {
    let folder = folder("events_and_ensembles_have_laws");
    let text = "title = \"Braked\"\n[body]\nmoments = [1, 1, 1]\nkinetic = \"geodesic\"\n[start]\neuler = [0, 0, 0]\nvelocity = \
                [0, 0, 1]\n[run]\nduration = 4\nstep = 0.5\n[[control]]\ntorque = \"[0, 0, -0.25 * sign(Omega[2])]\"\n\
                [[event]]\nname = \"half\"\nvelocity_z = 0.45\n[ensemble]\nmembers = 2\ndraw.start.velocity = [0, 0, { from = \
                1, to = 1.000000001 }]\n";
    fs::write(folder.join("scene.toml"), text).unwrap();
    let told = printed(&folder, &["run", "scene.toml", "--csv", "--out", "."]);
    let events = fs::read_to_string(folder.join("scene.events.csv")).unwrap();
    let time: f64 = events.lines().nth(1).unwrap().split(',').nth(2).unwrap().parse().unwrap();
    // 1 − t/4 = .45
    assert!((time - 2.2).abs() < 1e-9 && told.contains("body + a law, 8 steps"), "{time} {told}");
    printed(&folder, &["ensemble", "scene.toml", "--out", "."]);
    let store = liestep_ensemble::Store::folder(folder.join("scene.ensemble")).unwrap();
    for (_, path) in store.files().unwrap() {
        let columns = liestep_ensemble::Store::read(&path).unwrap().rows.columns;
        assert!(columns[2].iter().all(|rate| rate.abs() < 1e-8), "{:?}", columns[2]);
    }
}

/// The table of a scene on an orbit with wheels, a law and an angle, and lines in the place of some of it.
fn held(changes: &[(&str, &str)], more: &str) -> String {
    let text = "title = \"Held\"\n[body]\nmoments = [1, 2, 3]\n[orbit]\nperiod = \"100 min\"\nnormal = [0, 0, 1]\n[start]\nrpy = [0.1, \
                0.2, 0.3]\nvelocity = [0.01, 0, 0]\n[torque]\ntorque = { csv = \"push.csv\", columns = [\"x\", \"y\", \"z\"], between \
                = \"steps\" }\n[[wheel]]\nname = \"roll\"\naxis = [1, 0, 0]\ninertia = 0.01\ntorque = \"k * q[0] + Omega[0]\"\nk = \
                0.1\n[[wheel]]\naxis = [0, 1, 0]\ninertia = 0.02\nspeed = 30\n[[control]]\ntorque = \"-d * Omega\"\nd = 0.2\n\
                [[pointing]]\nname = \"lens\"\naxis = [0, 0, 1]\nto = \"nadir\"\n[run]\nduration = 4\nstep = 0.5\n[output]\ncolumns = \
                [\"quaternion\", \"velocity\", \"wheel-speeds\", \"pointing\"]\n";
    changes.iter().fold(text.to_owned(), |text, (old, new)| {
        assert!(text.contains(old), "{old}");
        text.replace(old, new)
    }) + more
}

/// The values of the listed tables and of the orbit, with lines of a file that has them by itself.
const VARIED: [(&str, &str, &str, &str); 7] = [
    ("wheel.roll.k", "0.3", "k = 0.1", "k = 0.3"),
    ("wheel.roll.inertia", "0.04", "inertia = 0.01", "inertia = 0.04"),
    ("wheel.wheel_2.speed", "-20", "speed = 30", "speed = -20"),
    ("control.control_1.d", "0.7", "d = 0.2", "d = 0.7"),
    ("pointing.lens.axis", "[0.6, 0, 0.8]", "lens\"\naxis = [0, 0, 1]", "lens\"\naxis = [0.6, 0, 0.8]"),
    ("orbit.period", "\"50 min\"", "100 min", "50 min"),
    (
        "torque.torque",
        "[0.1, 0, 0]",
        "{ csv = \"push.csv\", columns = [\"x\", \"y\", \"z\"], between = \"steps\" }",
        "[0.1, 0, 0]",
    ),
];

/// A point of a sweep over laws, wheels, angles and orbits is the file with its values.
#[test]
fn laws_wheels_angles_and_orbits_are_swept() {
    let folder = folder("laws_wheels_angles_and_orbits_are_swept");
    fs::write(folder.join("push.csv"), "t,x,y,z\n0,0.01,0.02,-0.01\n1.7,0,0.1,0\n").unwrap();
    let before = rows(&folder, &held(&[], "")).pop().unwrap();
    for (key, value, old, new) in VARIED {
        let text = held(&[], &format!("[sweep]\n{key} = [{value}]\n"));
        fs::write(folder.join("swept.toml"), text).unwrap();
        printed(&folder, &["sweep", "swept.toml", "--out", "."]);
        let table = fs::read_to_string(folder.join("swept.sweep.csv")).unwrap();
        let line = table.lines().nth(1).unwrap();
        let expected = rows(&folder, &held(&[(old, new)], "")).pop().unwrap();
        assert_ne!(before, expected, "{key}");
        let numbers: Vec<f64> = line.split(',').filter_map(|cell| cell.parse().ok()).collect();
        let ends = numbers.windows(expected.len()).any(|part| part == expected);
        assert!(ends, "{key}: {line}\n{expected:?}");
    }
}

/// Members draw values of laws, wheels, angles and orbits, beside a torque of a table; another table makes another ensemble.
#[test]
fn laws_wheels_angles_and_orbits_are_drawn() {
    let folder = folder("laws_wheels_angles_and_orbits_are_drawn");
    let push = "t,x,y,z\n0,0.01,0.02,-0.01\n1.7,0,0.1,0\n";
    fs::write(folder.join("push.csv"), push).unwrap();
    for (key, value, old, new) in VARIED {
        let drawn = match value.parse::<f64>() {
            Ok(number) => format!("{{ mean = {number}, deviation = 0 }}"),
            Err(_) if value.starts_with('"') => format!("{{ mean = {value}, deviation = 0 }}"),
            Err(_) => {
                let (first, rest) = value[1..].split_once(',').unwrap();
                format!("[{{ mean = {first}, deviation = 0 }}, {rest}")
            }
        };
        let ensemble = format!("[ensemble]\nmembers = 2\ndraw.{key} = {drawn}\n");
        let (file, name) = (format!("{key}.toml"), format!("{key}.ensemble"));
        fs::write(folder.join(&file), held(&[], &ensemble)).unwrap();
        printed(&folder, &["ensemble", &file, "--out", "."]);
        let expected = rows(&folder, &held(&[(old, new)], "")).pop().unwrap();
        let store = liestep_ensemble::Store::folder(folder.join(name)).unwrap();
        let (_, path) = store.files().unwrap().pop().unwrap();
        let columns = liestep_ensemble::Store::read(&path).unwrap().rows.columns;
        // The columns of the file follow the time in a table, and are the first of a member.
        let numbers: Vec<f64> = columns.iter().take(expected.len() - 1).map(|column| column[0]).collect();
        assert_eq!(numbers, expected[1..], "{key}");
    }
    // Other numbers in the table make another ensemble.
    fs::write(folder.join("push.csv"), push.replace("0.02", "0.03")).unwrap();
    refuses(&folder, &["ensemble", "wheel.roll.k.toml", "--out", "."], 4, "is of another plan");
}

/// A name that no table has, or a table without a key, is a mistake of a sweep and of a draw.
#[test]
fn mistakes_of_listed_tables_have_their_place() {
    let folder = folder("mistakes_of_listed_tables_have_their_place");
    fs::write(folder.join("push.csv"), "t,x,y,z\n0,0.01,0.02,-0.01\n").unwrap();
    for (more, message) in [
        ("[sweep]\nwheel.pitch.k = [1]\n", "no `wheel` is called `pitch`, but roll, wheel-2"),
        ("[sweep]\nwheel.roll = [1]\n", "a key is missing behind `roll`"),
        (
            "[ensemble]\nmembers = 2\ndraw.wheel.pitch.k = { from = 1, to = 2 }\n",
            "no `wheel` is called `pitch`, but roll, wheel-2",
        ),
        ("[ensemble]\nmembers = 2\ndraw.pointing.lens = { from = 1, to = 2 }\n", "a key is missing behind `lens`"),
        ("[ensemble]\nmembers = 2\ndraw.wheel.roll.inertia = { from = -1, to = 2 }\n", "above zero"),
        (
            "[ensemble]\nmembers = 2\ndraw.start.velocity = [{ from = 0, to = 1 }, 0, 0]\nhistogram.len = { from = 0, to = 1, count = \
             2 }\n",
            "the `columns` of the file have no `len`, but q_w",
        ),
        (
            "[ensemble]\nmembers = 2\ndraw.start.velocity = [{ from = 0, to = 1 }, 0, 0]\nhistogram.lens = { from = 1, to = 1, count = \
             2 }\n",
            "a histogram is `{ from",
        ),
        (
            "[ensemble]\nmembers = 2\ndraw.orbit.period = { from = 6000, to = 7000 }\n[[event]]\nname = \"low\"\ncolumn = \
             \"lens\"\nvalue = 1\n",
            "an event knows the orbit",
        ),
    ] {
        let told = refused(&folder, &held(&[], more));
        assert!(told.contains(message), "{more}: {told}");
    }
}
