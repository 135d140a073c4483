//! One step and ten of each kinetic term compared with values in binary128: the momentum equation (2.7), its solution,
//! and the update (2.9) in the physical normalisation of the momentum.

use declarations::motions::{matrix, number, read, vector};
use declarations::{CayleyTop, FourthOrderTop, HeavyTop, LogTop, SixthOrderTop, Top};
use liestep::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Regular};
use liestep::motion::DiscreteLiePoisson;
use liestep::prelude::*;
use nalgebra::Vector3;
use serde_json::Value;
use workbench::measure::relative;

/// The tolerance admits a few roundings of each of ten steps; the reference itself is exact to 30 digits.
const TOLERANCE: f64 = 1e-13;

/// Checks ten steps of the top of each entry, to this tolerance.
fn assert_golden<L>(name: &str, tolerance: f64, top: impl Fn(&Value) -> L)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular,
{
    let data = read("golden steps");
    let steps = data["steps"].as_array().unwrap();
    let entries: Vec<_> = steps.iter().filter(|entry| entry["l_d"] == name).collect();
    assert_eq!(entries.len(), 4, "two bodies, two steps");
    for entry in entries {
        let flow = DiscreteLiePoisson::new(top(entry), number(&entry["h"])).unwrap();
        let (mut momentum, mut w, mut guess) = (vector(&entry["Pi0"]), vector(&entry["w0"]), Vector3::zeros());
        for i in 1..=10 {
            let step = flow.step(&momentum, &w, &guess).unwrap();
            (momentum, w, guess) = (step.momentum, step.advected, step.coordinates);
            if i == 1 {
                let errors = [
                    relative(&step.element().matrix(), &matrix(&entry["F0"])),
                    relative(&momentum, &vector(&entry["Pi1"])),
                    relative(&w, &vector(&entry["w1"])),
                ];
                println!("{name}, {} h = {}: {errors:?}", entry["case"], entry["h"]);
                assert!(errors.iter().all(|&error| error < tolerance), "{name}: {errors:?}");
            }
        }
        let errors = [relative(&momentum, &vector(&entry["Pi10"])), relative(&w, &vector(&entry["w10"]))];
        println!("after ten steps: {errors:?}");
        assert!(errors.iter().all(|&error| error < tolerance), "{name}: {errors:?}");
    }
}

#[test]
fn golden_entries_of_the_trapezoidal_top_are_reproduced() {
    assert_golden("dmv_trapezoid_(3.13)", TOLERANCE, |entry| HeavyTop {
        J_d: DiagonalNonstandardInertia::from_diagonal(vector(&entry["J_d"])).unwrap(),
        m: 1.0,
        g: number(&entry["mg"]),
        rho: vector(&entry["rho"]),
        up: Vector3::z(),
    });
}

fn body<L: Top>(entry: &Value) -> L {
    let J = Inertia::from_principal_moments(vector(&entry["J"])).unwrap();
    L::new(J, number(&entry["mg"]), vector(&entry["rho"]), Vector3::z())
}

/// The kinetic terms from the literature.
#[test]
fn golden_entries_of_other_kinetic_terms_are_reproduced() {
    assert_golden("cayley_trapezoid", 10.0 * TOLERANCE, body::<CayleyTop>);
    assert_golden("log_trapezoid", 10.0 * TOLERANCE, body::<LogTop>);
    assert_golden("L4_log", 10.0 * TOLERANCE, body::<FourthOrderTop>);
    assert_golden("L6_log", 10.0 * TOLERANCE, body::<SixthOrderTop>);
}
