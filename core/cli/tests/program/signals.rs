//! Parameters over time: exact impulses, own terms along an orbit, the order of compositions, and mistakes.

use std::fs;

use nalgebra::Vector3;

use crate::called::{apart, folder, printed, refused, rows};

const PULSE: &str = "{ times = [0, 0.7, 2.2], values = [[0, 0, 0], [0, 0, 2], [0, 0, 0]], between = \"steps\" }";

fn thruster(torque: &str, duration: &str) -> String {
    format!(
        "title = \"A torque for a while\"\n[body]\nmoments = [1, 2, 2.5]\n[torque]\ntorque = {torque}\n[start]\n\
         euler = [0, 0, 0]\nvelocity = [0, 0, 0]\n[run]\nstep = 0.4\nduration = {duration}\n[output]\n\
         columns = [\"momentum\"]\n"
    )
}

/// A torque from .7 s to 2.2 s has its impulse by steps of .4 s, and that of a line has the integral of the line.
#[test]
fn a_torque_has_its_impulse() {
    let folder = folder("a_torque_has_its_impulse");
    let end = |torque: &str| rows(&folder, &thruster(torque, "4")).pop().unwrap();
    let [_, x, y, z] = end(PULSE)[..] else { panic!("a row has four numbers") };
    assert!(x == 0.0 && y == 0.0 && (z - 3.0).abs() < 1e-14, "{z}");
    // Up to 1.5 N m at 1 s, and down to zero at 3.1 s: 3.1 · 1.5/2.
    let line = "{ times = [0, 1, 3.1, 5], values = [[0, 0, 0], [0, 0, 1500], [0, 0, 0], [0, 0, 0]], unit = \"mN m\", \
                between = \"lines\" }";
    assert!((end(line)[3] - 2.325).abs() < 1e-14, "{:?}", end(line));
    // Within the pulse: from .7 s to 1.6 s.
    let middle = &rows(&folder, &thruster(PULSE, "4"))[4];
    assert!((middle[0] - 1.6).abs() < 1e-14 && (middle[3] - 1.8).abs() < 1e-14, "{middle:?}");
    fs::write(folder.join("torque.csv"), "when, about z, nothing\n0, 0, 0\n0.7, 2, 0\n\n2.2, 0, 0\n").unwrap();
    let csv = "{ csv = \"torque.csv\", time = \"when\", columns = [\"nothing\", \"nothing\", \"about z\"], between = \"steps\" }";
    assert_eq!(end(csv), end(PULSE));
    printed(&folder, &["check", "scene.toml"]);
}

const ORBIT: &str = "[orbit]\nperiod = \"100 min\"\nnormal = [0, 0, 1]\neccentricity = 0.1\nphase = \"40 deg\"";

fn satellite(terms: &str, steps: u32, method: &str) -> String {
    format!(
        "title = \"A satellite\"\n[body]\nmoments = [100, 250, 300]\n[start]\neuler = [0.9, 0.2, 0]\n\
         velocity = [2e-4, 0, 1e-3]\n[run]\nduration = 6000\nstep = {:?}\n{method}\n[output]\n\
         columns = [\"quaternion\", \"velocity\", \"energy\"]\n{terms}\n",
        6000.0 / f64::from(steps)
    )
}

const GRADIENT: &str = "[gravity_gradient]\ndirection = \"nadir\"\n";

const DIPOLE: &str = "[dipole]\nmoment = [3, -2, 4]\n[dipole.field]\nequator = [\"2 µT\", \"5 µT\", \"25 µT\"]\n";

/// A potential of the file's own follows an orbit as the library's does.
#[test]
fn own_terms_follow_an_orbit() {
    let folder = folder("own_terms_follow_an_orbit");
    let own = format!(
        "[lagrangian]\nl_d = \"{{ let after = F.transpose() * w; \
         -0.75 * h * n * n * (w.dot(&(J * w)) + after.dot(&(J * after))) }}\"\nadvected = {{ w = \"dir\" }}\n\
         n = {:?}\nJ = {{ moments = [100, 250, 300] }}\ndir = \"nadir\"\n{ORBIT}",
        std::f64::consts::TAU / 6000.0
    );
    let listed = format!("{GRADIENT}{ORBIT}");
    let [one, other] = [&own, &listed].map(|terms| rows(&folder, &satellite(terms, 600, "")));
    assert!(apart(&one, &other) < 1e-11, "{:e}", apart(&one, &other));
    let by_clock =
        |terms: &str| rows(&folder, &satellite(terms, 600, "").replace("step = 10.0", "steps_per_orbit = 300"));
    assert!(apart(&by_clock(&own), &by_clock(&listed)) < 1e-11);
}

/// Each stage of a composition has the direction and the field of its own time, also beside forces, whose ends change places
/// as those of a step do.
#[test]
fn compositions_along_an_orbit_have_their_order() {
    let folder = folder("compositions_along_an_orbit_have_their_order");
    let drag = "[drag]\nc = 0.05\n[air_drag]\nc = 0.03\nair = \"orbit\"\n";
    let damping = "[magnetic_damping]\nk = 1e7\n[magnetic_damping.field]\nequator = [\"2 µT\", \"5 µT\", \"25 µT\"]\n";
    let own = "[force]\nwork = \"h * c * tau.dot(eta + eta_next) / 2 - c * vee(F).dot(eta + eta_next) / 2\"\nc = 0.02\ntau = [1e-4, \
               2e-4, -1e-4]\n";
    for forces in [String::new(), drag.to_owned(), format!("{drag}{damping}{own}")] {
        let end = |steps: u32, method: &str| {
            let orbit = ORBIT.replace("eccentricity = 0.1", "eccentricity = 0.2");
            let text = satellite(&format!("{GRADIENT}{DIPOLE}{forces}{orbit}"), steps, method);
            rows(&folder, &text).pop().unwrap()[1..8].to_vec()
        };
        let exact = end(800, "method = { composition = \"Kahan-Li 8\" }");
        for (method, order, steps) in
            [("", 2.0, [400, 800]), ("method = { composition = \"Suzuki 4\" }", 4.0, [60, 120])]
        {
            let error = |steps: u32| {
                let end = end(steps, method);
                // The scale of velocities is that of the orbit.
                let scale = |at: usize| if at < 4 { 1.0 } else { 1e3 };
                let parts = end.iter().zip(&exact).enumerate();
                parts.map(|(at, (a, b))| ((a - b) * scale(at)).powi(2)).sum::<f64>().sqrt()
            };
            let measured = (error(steps[0]) / error(steps[1])).log2();
            assert!((measured - order).abs() < 0.05, "{method} beside {forces}: {measured}");
        }
    }
    // A force at one end has no step back.
    let one_sided = "[force]\nwork = \"h * tau.dot(eta)\"\ntau = [1e-4, 2e-4, -1e-4]\n";
    let text = satellite(&format!("{GRADIENT}{one_sided}{ORBIT}"), 60, "method = { composition = \"Suzuki 4\" }");
    let told = refused(&folder, &text);
    assert!(told.contains("those with this `force` don't"), "{told}");
}

/// A free body whose moments change while it burns fuel moves by Euler's equations `μ' = μ × J(t)⁻¹ μ`, and keeps its momentum in
/// space.
#[test]
fn moments_over_time_are_those_of_eulers_equations() {
    let folder = folder("moments_over_time_are_those_of_eulers_equations");
    let J = |t: f64| Vector3::new(2.0 - 0.3 * t, 2.5 - 0.3 * t, 1.4 + 0.1 * (2.0 * t).sin());
    let rate = |t: f64, mu: &Vector3<f64>| mu.cross(&mu.component_div(&J(t)));
    let (mut mu, h) = (Vector3::new(0.6, 2.0, 0.3).component_mul(&J(0.0)), 1e-3);
    for step in 0..2000 {
        let t = f64::from(step) * h;
        let a = rate(t, &mu);
        let b = rate(t + h / 2.0, &(mu + a * (h / 2.0)));
        let c = rate(t + h / 2.0, &(mu + b * (h / 2.0)));
        let d = rate(t + h, &(mu + c * h));
        mu += (a + (b + c) * 2.0 + d) * (h / 6.0);
    }
    let expected = mu.component_div(&J(2.0));
    let moments = "{ formula = \"[2 - 0.3 * t, 2.5 - 0.3 * t, 1.4 + 0.1 * sin(2 * t)]\" }";
    let off = |kinetic: &str, method: &str, step: f64| {
        let text = format!(
            "title = \"Fuel burns\"\n[body]\nmoments = {moments}\nkinetic = \"{kinetic}\"\n[start]\n\
             velocity = [0.6, 2, 0.3]\n[run]\nduration = 2\nstep = {step}\n{method}\n[output]\n\
             columns = [\"velocity\", \"spatial-momentum\"]\n"
        );
        let rows = rows(&folder, &text);
        let of = |row: &[f64], at: usize| Vector3::new(row[at], row[at + 1], row[at + 2]);
        let [first, last] = [&rows[0], rows.last().unwrap()];
        let lost = (of(last, 4) - of(first, 4)).norm();
        assert!(lost < 1e-13, "{kinetic}: {lost:e}");
        (of(last, 1) - expected).norm()
    };
    let composed = "method = { composition = \"Suzuki 4\" }";
    for (kinetic, method, order) in
        [("rigid", "", 2.0), ("cayley", "", 2.0), ("geodesic", "", 2.0), ("geodesic", composed, 4.0)]
    {
        let [coarse, fine] = [0.04, 0.02].map(|step| off(kinetic, method, step));
        let found = (coarse / fine).log2();
        println!("{kinetic} {method}: {coarse:e}, {fine:e}, of order {found}");
        assert!(fine < 3e-3 && (found - order).abs() < 0.1, "{kinetic} {method}: {coarse:e}, {fine:e}");
    }
}

/// Moments over time that don't change are those of a body, also beside a wheel, a law and effects that read the inertia.
#[test]
fn constant_moments_over_time_are_those_of_the_body() {
    let folder = folder("constant_moments_over_time_are_those_of_the_body");
    let text = |inertia: &str, terms: &str| {
        format!(
            "title = \"A satellite\"\n[body]\n{inertia}\n[start]\nvelocity = [0.1, -0.2, 0.3]\n[drag]\nc = 0.05\n\
             [gravity_gradient]\ndirection = \"nadir\"\n[orbit]\nperiod = 60\nnormal = [0, 0, 1]\n[run]\nduration = 4\n\
             step = 0.02\n[output]\ncolumns = [\"quaternion\", \"velocity\", \"energy\"]\n{terms}"
        )
    };
    let devices = "[[wheel]]\naxis = [0, 0.6, 0.8]\ninertia = 0.02\nspeed = 30\ntorque = 0.01\n\
                   [[control]]\ntorque = \"-0.1 * Omega\"\n";
    let signal = "{ times = [0, 4], values = [[2, 2.5, 1.5], [2, 2.5, 1.5]], between = \"lines\" }";
    for (constant, over_time) in [
        ("moments = [2, 2.5, 1.5]", format!("moments = {signal}")),
        ("J_d = [2, 2.5, 1.5]", format!("J_d = {signal}")),
        ("moments.effective = [2, 2.5, 1.5]", format!("moments = {{ effective = {signal} }}")),
    ] {
        for terms in ["", devices] {
            let [one, other] = [constant, over_time.as_str()].map(|inertia| rows(&folder, &text(inertia, terms)));
            let apart = apart(&one, &other);
            assert!(one.len() == 201 && apart < 1e-13, "{constant} {terms}: {apart:e}");
        }
    }
    for (over_time, message) in [
        (format!("J = {signal}"), "3:5: an inertia over time is that of principal `moments`, or of `J_d`"),
        (
            "moments = { times = [0, 4], values = [[2, 2.5, 1.5], [2, 2.5, 0.1]], between = \"lines\" }".to_owned(),
            "3:11: `moments` of `body` can't be [2.0, 2.5, 0.1]",
        ),
    ] {
        let found = refused(&folder, &text(&over_time, ""));
        assert!(found.contains(message), "{found}");
    }
}

#[test]
fn mistakes_of_signals_have_their_place() {
    let folder = folder("mistakes_of_signals_have_their_place");
    fs::write(folder.join("short.csv"), "t,z\n0,1\n1,one\n").unwrap();
    fs::write(folder.join("back.csv"), "t,z\n0,1\n2,1\n1,1\n").unwrap();
    let scalar = "between = \"steps\" }";
    for (torque, message) in [
        ("{ times = [0, 2, 1], values = [[0, 0, 0], [0, 0, 1], [0, 0, 2]], between = \"steps\" }", "that of number 3"),
        ("{ times = [0, 2], values = [[0, 0, 0]], between = \"steps\" }", "2 times have as many `values`, found 1"),
        ("{ times = [0, 9], values = [[0, 0, 0], [0, 1]], between = \"lines\" }", "vectors of one length"),
        ("{ times = [0, 9], values = [[0, 0, 0], [0, 0, inf]], between = \"lines\" }", "finite"),
        ("{ times = [0, 2], values = [[0, 0, 0], [0, 0, 1]], between = \"lines\" }", "the run ends at 4 s"),
        ("{ times = [1, 5], values = [[0, 0, 0], [0, 0, 1]], between = \"lines\" }", "a run starts at the time 0"),
        ("{ times = [0], values = [[0, 0, 0]], between = \"curves\" }", "curves"),
        ("{ times = [0], values = [[0, 0, 0]] }", "between"),
        ("{ times = [0], between = \"steps\" }", "a signal has `times`"),
        (&format!("{{ csv = \"none.csv\", columns = [\"z\"], {scalar}"), "`none.csv` beside the scene can't be read"),
        (&format!("{{ csv = \"short.csv\", columns = [\"z\"], {scalar}"), "line 3 has no number `z`: `one`"),
        (&format!("{{ csv = \"short.csv\", columns = [\"w\"], {scalar}"), "there is no column `w`, but t, z"),
        (&format!("{{ csv = \"back.csv\", columns = [\"z\", \"z\", \"z\"], {scalar}"), "that of number 3"),
        ("{ times = [0], values = [[0, 0, 0]], between = \"steps\", unit = \"furlong\" }", "`furlong` isn't a unit"),
    ] {
        let found = refused(&folder, &thruster(torque, "4"));
        assert!(found.contains(message) && found.contains("top.toml:5:"), "{torque}: {found}");
    }
    let scene = thruster("[0, 0, 1]", "4");
    let mass = "[drag]\nc = { times = [0, 1], values = [1, -1], between = \"steps\" }\n";
    assert!(refused(&folder, &format!("{scene}{mass}")).contains("`c` of `drag` can't be [-1.0]"));
    let up = "[gravity]\nm = 1\ng = 9.81\nrho = [0, 0, 1]\n\
              up = { times = [0], values = [[0, 0, 1]], between = \"steps\" }\n";
    assert!(refused(&folder, &format!("{scene}{up}")).contains("`up` of `gravity` can't change with time"));
    let pulse = thruster(PULSE, "4");
    assert!(refused(&folder, &pulse.replace("[output]", "density = { turn = 1 }\n[output]")).contains("density"));
}

/// Each stage of a composition has the mean of a motor's signal over its own time; the impulse of the whole step is cut to the motor's
/// largest torque.
#[test]
fn wheels_with_signals_have_the_order_of_a_composition() {
    let folder = folder("wheels_with_signals_have_the_order_of_a_composition");
    let end = |step: f64, method: &str, limit: &str| {
        let text = format!(
            "title = \"A wheel\"\n[body]\nmoments = [2, 3, 4]\n[start]\neuler = [0.1, 0.5, 0.2]\nvelocity = [0.3, -0.2, \
             0.5]\n[run]\nduration = 4\nstep = {step}\n{method}\n[output]\ncolumns = [\"quaternion\", \"velocity\", \
             \"wheel-speeds\"]\n[[wheel]]\naxis = [0, 0.6, 0.8]\ninertia = 0.05\nspeed = 30\n{limit}torque = {{ times = \
             [0, 4], values = [-0.4, 0.6], between = \"lines\" }}\n"
        );
        rows(&folder, &text).pop().unwrap()
    };
    let exact = end(0.0125, "method = { composition = \"Kahan-Li 8\" }", "");
    for (method, order, steps) in
        [("", 2.0, [0.05, 0.025]), ("method = { composition = \"Suzuki 4\" }", 4.0, [0.2, 0.1])]
    {
        let [coarse, fine] = steps.map(|step| apart(&[end(step, method, "")], std::slice::from_ref(&exact)));
        assert!(((coarse / fine).log2() - order).abs() < 0.1, "{method}: {coarse:e} {fine:e}");
    }
    // The momentum of the wheel about its axis, I (speed + Ω·a), changes by the impulse: no motor passes its largest torque.
    let momentum = |row: &[f64]| 0.05 * (row[8] + 0.6 * row[6] + 0.8 * row[7]);
    let spun = 0.05 * (30.0 + 0.6 * -0.2 + 0.8 * 0.5);
    let ended = momentum(&end(0.1, "method = { composition = \"Suzuki 4\" }", ""));
    assert!((ended - spun - 0.4).abs() < 1e-13, "{ended}");
    let limited = momentum(&end(0.1, "method = { composition = \"Suzuki 4\" }", "largest_torque = 0.2\n"));
    let cut: f64 = (0..40).map(|step| (-0.4 + 0.025 * (f64::from(step) + 0.5)).clamp(-0.2, 0.2) * 0.1).sum();
    assert!((limited - spun - cut).abs() < 1e-13, "{limited} {cut}");
}

/// Forces of joints in the last row, which has no step ahead where a signal ends with the run, are those of the signal's end.
#[test]
fn forces_of_joints_end_with_a_signal() {
    let folder = folder("forces_of_joints_end_with_a_signal");
    let scene = |times: &str, values: &str| {
        format!(
            "title = \"A cart\"\ngravity = {{ g = 9.81, up = [0, 0, 1] }}\n[[body]]\nname = \"cart\"\nm = 2\nmoments = [1, 1, \
             1]\n[[joint]]\nname = \"rail\"\nkind = \"slider\"\nbodies = [\"cart\", \"space\"]\nat = [[0, 0, 0.1], [0, 0, \
             0]]\naxes = [[1, 0, 0], [1, 0, 0]]\nforce = {{ times = {times}, values = {values}, between = \"lines\" }}\n[run]\n\
             step = 0.05\nduration = 1\n[output]\ncolumns = [\"force\", \"torque\"]\nevery = 1\n"
        )
    };
    let ended = rows(&folder, &scene("[0, 0.5, 1]", "[1, 2, 0.5]"));
    let goes_on = rows(&folder, &scene("[0, 0.5, 1, 2]", "[1, 2, 0.5, 0.5]"));
    assert!(ended.iter().flatten().all(|number| number.is_finite()), "{:?}", ended.last());
    assert!(apart(&ended, &goes_on) < 1e-12);
    assert!((ended[20][3].abs() - 19.62).abs() < 1e-9 && (ended[20][5].abs() - 0.05).abs() < 1e-9, "{:?}", ended[20]);
}
