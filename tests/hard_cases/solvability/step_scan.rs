//! The momentum equation (2.7) of (3.13) has a solution on the branch of the identity up to a fold: for `h|a| < J_min`
//! surely, for `h|a| > J_max` surely not, `a = p + (h/2) τ(w)`. Up to the fold a step is made, beyond it the error says
//! how far one could go.

use checks::random::Random;
use declarations::{FullTop, HeavyTop};
use liestep::mechanics::{DiscreteLagrangian, Regular, inertia};
use liestep::motion::DiscreteLiePoisson;
use liestep::prelude::*;
use nalgebra::Vector3;

/// Random bodies and directions near the fold: a step returns a rotation on the branch of the identity or an error, and
/// `J_min ≤ h|a| ≤ J_max` at the fold.
#[test]
fn s1_random_momenta_step_up_to_the_fold() {
    let mut random = Random::new(1);
    let thesis = HeavyTop::thesis();
    for top in [thesis, HeavyTop::asymmetric(), HeavyTop::symmetric(Vector3::new(2.0, 1.0, 0.0))] {
        for _ in 0..20 {
            let axes = random.rotation().matrix();
            scan_random_momentum(&top, &random.direction(), &random.direction());
            scan_random_momentum(&FullTop::in_axes(&top, &axes), &random.direction(), &random.direction());
        }
    }
}

fn scan_random_momentum<L>(top: &L, direction: &Vector3<f64>, w: &Vector3<f64>)
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + Clone,
{
    let momentum = direction * 30.0;
    let fold = DiscreteLiePoisson::new(top.clone(), 1.0).unwrap().max_step(&momentum, w);
    let a = momentum + L::kick_before(&top.constants(fold), w);
    let moments = inertia(top, &top.advected()).symmetric_eigenvalues();
    let size = fold * a.norm();
    // The bisection has six digits.
    assert!(size > moments.min() * 0.999_99 && size < moments.max() * 1.000_01, "{size} is outside {moments}");
    let mut last = 0.0;
    for fraction in [0.1, 0.5, 0.9, 0.99, 0.999] {
        let flow = DiscreteLiePoisson::new(top.clone(), fraction * fold).unwrap();
        let step = flow.step(&momentum, w, &Vector3::zeros()).unwrap();
        let angle = step.element().log().norm();
        assert!(step.iterations <= 9, "{} iterations at {fraction} of the fold", step.iterations);
        assert!(angle > last && angle.is_finite(), "on the branch of the identity the angle grows with the step");
        last = angle;
    }
    for factor in [1.001, 1.1, 2.0, 10.0] {
        let flow = DiscreteLiePoisson::new(top.clone(), factor * fold).unwrap();
        match flow.step(&momentum, w, &Vector3::zeros()) {
            Err(StepError::BeyondSolvable { largest, .. }) => assert!((largest / fold - 1.0).abs() < 1e-5),
            other => panic!("{factor} times the fold: {:?}", other.map(|step| step.element().log().norm())),
        }
    }
}
