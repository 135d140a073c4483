//! Readings of laws along an orbit: two readings of a field, and the nadir.

use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3};

use crate::called::{folder, rows};

/// A torque `m × b` with `m = −k ḃ` by two readings of the field, whose change along the orbit is in them.
#[test]
fn two_readings_of_a_field_are_its_rate() {
    let folder = folder("two_readings_of_a_field_are_its_rate");
    let (period, k, J) = (5801.23, 1e4, Vector3::new(0.9, 0.9, 0.3));
    let rate = std::f64::consts::TAU / period;
    let equator = Vector3::new(0.0, 0.0, 3.1e-5);
    // A circle through the poles, in the plane of x and z.
    let place = |t: f64| Vector3::new((rate * t).cos(), 0.0, (rate * t).sin());
    let field = |t: f64| equator - place(t) * (3.0 * equator.dot(&place(t)));
    let changed = |t: f64| (field(t + 1e-2) - field(t - 1e-2)) / 2e-2;
    let f = |t: f64, y: &SVector<f64, 7>| {
        let q = Quaternion::new(y[0], y[1], y[2], y[3]);
        let R = UnitQuaternion::new_normalize(q).to_rotation_matrix();
        let turn = Vector3::new(y[4], y[5], y[6]);
        let b = R.inverse() * field(t);
        let rate = R.inverse() * changed(t) - turn.cross(&b);
        let torque = (-k * rate).cross(&b);
        let spun = (torque - turn.cross(&J.component_mul(&turn))).component_div(&J);
        let q = q * Quaternion::from_imag(turn) * 0.5;
        SVector::from_iterator([q.w, q.i, q.j, q.k].into_iter().chain(spun.iter().copied()))
    };
    let start = 20_f64.to_radians();
    let mut y = SVector::<f64, 7>::from_column_slice(&[1.0, 0.0, 0.0, 0.0, start, start, start]);
    let h = 0.02;
    for step in 0..30_000 {
        let t = f64::from(step) * h;
        let a = f(t, &y);
        let b = f(t + h / 2.0, &(y + a * (0.5 * h)));
        let c = f(t + h / 2.0, &(y + b * (0.5 * h)));
        let d = f(t + h, &(y + c * h));
        y += (a + (b + c) * 2.0 + d) * (h / 6.0);
    }
    let expected = Vector3::new(y[4], y[5], y[6]).norm();
    let text = |every: f64| {
        format!(
            "title = \"Detumbling\"\n[body]\nmoments = [0.9, 0.9, 0.3]\nkinetic = \"geodesic\"\n[start]\neuler = [0, 0, \
             0]\nvelocity = [\"20 deg/s\", \"20 deg/s\", \"20 deg/s\"]\n[orbit]\nperiod = {period}\nnormal = [0, -1, 0]\n\
             [run]\nduration = 600\nstep = {every}\n[output]\ncolumns = [\"velocity\"]\n[[control]]\ntorque = \
             \"(-k / every * (b - b_before)).cross(b)\"\nk = {k:?}\nB = {{ equator = [0, 0, \"31 µT\"] }}\nadvected = {{ b = \
             \"B\" }}\n"
        )
    };
    let error = |every: f64| {
        let end = rows(&folder, &text(every)).pop().unwrap();
        Vector3::new(end[1], end[2], end[3]).norm() - expected
    };
    // A difference of readings is late by half the time between them. The torque is across the field, and a delay turns it
    // about the axis of the spin, so that the speed is of second order.
    let [coarse, fine] = [error(0.1), error(0.05)];
    assert!(fine.abs() < 0.01 * expected && (3.8..4.2).contains(&(coarse / fine)), "{coarse:e} {fine:e} {expected}");
}

/// Readings contain the change of the field along the orbit: by `m = −k ḃ` a small satellite, with 2 deg/s about each axis,
/// ends half an orbit at 1.454613 deg/s, and by `m = −k b × Ω`, as the effect `magnetic_damping` has it, at 1.491817 deg/s. Both are
/// Euler's equations by DOP853 to 1e-11.
#[test]
fn readings_contain_the_change_of_the_field_along_the_orbit() {
    let folder = folder("readings_contain_the_change_of_the_field_along_the_orbit");
    let law = "[[control]]\ntorque = \"(-k / every * (b - b_before)).cross(b)\"\nk = 1e4\nB = { equator = [0, 0, \"12 \
               µT\"] }\nadvected = { b = \"B\" }\n";
    let effect = "[magnetic_damping]\nk = 1e4\nfield = { equator = [0, 0, \"12 µT\"] }\n";
    let speed = |terms: &str, step: f64| {
        let text = format!(
            "title = \"An orbit\"\n[body]\nmoments = [0.0108, 0.0108, 0.0043]\nkinetic = \"geodesic\"\n[start]\neuler = [0, 0, \
             0]\nvelocity = [\"2 deg/s\", \"2 deg/s\", \"2 deg/s\"]\n[orbit]\nperiod = 5801.23\nnormal = [0, -1, 0]\n[run]\n\
             duration = 2900\nstep = {step}\n[output]\ncolumns = [\"velocity\"]\n{terms}"
        );
        let end = rows(&folder, &text).pop().unwrap();
        Vector3::new(end[1], end[2], end[3]).norm().to_degrees()
    };
    // A difference of readings is late by half the time between them.
    let [coarse, fine] = [speed(law, 0.2), speed(law, 0.1)];
    let limit = 2.0 * fine - coarse;
    assert!((limit - 1.454_613).abs() < 2e-5 && (fine - limit).abs() < 2e-4, "{coarse} {fine} {limit}");
    let damped = speed(effect, 0.2);
    assert!((damped - 1.491_817).abs() < 1e-4, "{damped}");
}

/// The nadir that a law reads has the length one wherever the planet is, and is its direction: at rest in space, after half a
/// turn from pericentre to apocentre, the opposite one.
#[test]
fn a_law_reads_a_unit_vector_of_the_nadir() {
    let folder = folder("a_law_reads_a_unit_vector_of_the_nadir");
    let text = "title = \"Nadir\"\n[body]\nmoments = [1e9, 1e9, 1e9]\n[orbit]\nperiod = 6000\nnormal = [0, 0, 1]\n\
                eccentricity = 0.6\n[start]\neuler = [0, 0, 0]\nvelocity = [0, 0, 0]\n[run]\nduration = 3010\nstep = \
                10\n[output]\ncolumns = [\"control\"]\nevery = 1\n[[control]]\ntorque = \"1e-6 * n\"\nadvected = { n = \
                \"planet\" }\nplanet = \"nadir\"\n";
    let rows = rows(&folder, text);
    for (row, direction) in [(&rows[1], -1.0), (&rows[301], 1.0)] {
        assert!((row[1] * 1e6 - direction).abs() < 1e-5 && row[2].abs() < 1e-10 && row[3].abs() < 1e-13, "{row:?}");
    }
    for row in &rows[1..] {
        assert!((row[1].hypot(row[2]).hypot(row[3]) * 1e6 - 1.0).abs() < 1e-12, "{row:?}");
    }
}
