//! One step and ten of (3.13) against values computed in binary128: the momentum equation (2.7), its solution, and the
//! update (2.9) in the physical normalisation of the momentum.

use declarations::HeavyTop;
use declarations::motions::{matrix, number, read, vector};
use liestep::groups::LieGroup as _;
use liestep::mechanics::DiagonalNonstandardInertia;
use liestep::motion::DiscreteLiePoisson;
use nalgebra::Vector3;
use workbench::measure::relative;

/// Ten steps lose a few roundings each; the reference itself is exact to 30 digits.
const TOLERANCE: f64 = 1e-13;

#[test]
fn golden_entries_of_the_trapezoidal_top_are_reproduced() {
    let data = read("golden steps");
    let steps = data["steps"].as_array().unwrap();
    let entries: Vec<_> = steps.iter().filter(|entry| entry["l_d"] == "dmv_trapezoid_(3.13)").collect();
    assert_eq!(entries.len(), 4, "two bodies, two steps");
    for entry in entries {
        let top = HeavyTop {
            J_d: DiagonalNonstandardInertia::from_diagonal(vector(&entry["J_d"])).unwrap(),
            m: 1.0,
            g: number(&entry["mg"]),
            rho: vector(&entry["rho"]),
            up: Vector3::z(),
        };
        let flow = DiscreteLiePoisson::new(top, number(&entry["h"])).unwrap();
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
                println!("{} h = {}: {errors:?}", entry["case"], entry["h"]);
                assert!(errors.iter().all(|&error| error < TOLERANCE), "{errors:?}");
            }
        }
        let errors = [relative(&momentum, &vector(&entry["Pi10"])), relative(&w, &vector(&entry["w10"]))];
        println!("after ten steps: {errors:?}");
        assert!(errors.iter().all(|&error| error < TOLERANCE), "{errors:?}");
    }
}
