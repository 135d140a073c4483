//! Kinetic terms other than that of (3.13), declared as they stand in the literature.

use declarations::motions::{matrix, number, read, vector};
use declarations::{CayleyTop, FourthOrderTop, LogTop, SixthOrderTop, Top};
use liestep::motion::DiscreteLiePoisson;
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::relative;

#[test]
fn golden_entries_of_the_cayley_top_are_reproduced() {
    golden::<CayleyTop>("cayley_trapezoid");
}

#[test]
fn golden_entries_of_the_log_top_are_reproduced() {
    golden::<LogTop>("log_trapezoid");
}

#[test]
fn golden_entries_of_the_fourth_order_top_are_reproduced() {
    golden::<FourthOrderTop>("L4_log");
}

#[test]
fn golden_entries_of_the_sixth_order_top_are_reproduced() {
    golden::<SixthOrderTop>("L6_log");
}

fn golden<L>(name: &str)
where
    L: Top + liestep::mechanics::Regular<Scalar = f64, Group = SO3, Advected = Vector3<f64>>,
{
    let data = read("golden steps");
    let steps = data["steps"].as_array().unwrap();
    let entries: Vec<_> = steps.iter().filter(|entry| entry["l_d"] == name).collect();
    assert_eq!(entries.len(), 4, "two bodies, two steps");
    for entry in entries {
        let J = Inertia::from_principal_moments(vector(&entry["J"])).unwrap();
        let (weight, rho, up) = (number(&entry["mg"]), vector(&entry["rho"]), Vector3::z());
        let flow = DiscreteLiePoisson::new(L::new(J, weight, rho, up), number(&entry["h"])).unwrap();
        let (mut momentum, mut w, mut guess) = (vector(&entry["Pi0"]), vector(&entry["w0"]), Vector3::zeros());
        for i in 1..=10 {
            let step = flow.step(&momentum, &w, &guess).unwrap();
            (momentum, w, guess) = (step.momentum, step.advected, step.coordinates);
            if i == 1 {
                assert!(relative(&step.element().matrix(), &matrix(&entry["F0"])) < 1e-12);
                assert!(relative(&momentum, &vector(&entry["Pi1"])) < 1e-12);
            }
        }
        let error = relative(&momentum, &vector(&entry["Pi10"]));
        assert!(error < 1e-12, "{error:e} after ten steps");
        assert!(relative(&w, &vector(&entry["w10"])) < 1e-12);
    }
}
