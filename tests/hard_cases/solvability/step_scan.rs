//! The momentum equation (2.7) of (3.13) has a solution on the branch of the identity up to a fold: for `h|a| < J_min`
//! surely, for `h|a| > J_max` surely not, `a = p + (h/2) τ(w)`. Up to the fold a step is made, beyond it the error says
//! how far one could go.

use checks::random::Random;
use declarations::Motion;
use declarations::{FullTop, HeavyTop};
use liestep::groups::LieGroup as _;
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::motion::DiscreteLiePoisson;
use liestep::{SO3, StepError, Stepper};
use nalgebra::Vector3;

/// The largest solvable step of a symmetric top by the closed criterion: with `κ = h a_3/(2 J_3)`,
/// `(h|a_⊥|/2)² ≤ max over X of (1 − X − κ²/X)(J_1² X + (J_3 − J_1)² κ²/X)`, where `X = q_0²`.
fn fold_of_symmetric_top(motion: &Motion) -> f64 {
    let j = motion.top.moments();
    let momentum = j.component_mul(&motion.velocity);
    let w = motion.attitude.adjoint_transpose(&motion.top.up);
    let solvable = |h: f64| {
        let a = momentum + w.cross(&motion.top.rho) * (0.5 * h * motion.top.m * motion.top.g);
        let kappa_squared = (h * a.z / (2.0 * j.z)).powi(2);
        let bound =
            |x: f64| (1.0 - x - kappa_squared / x) * (j.x.powi(2) * x + (j.z - j.x).powi(2) * kappa_squared / x);
        let best = (1..200_000).map(|i| bound(f64::from(i) / 200_000.0)).fold(f64::NEG_INFINITY, f64::max);
        (0.5 * h * a.x.hypot(a.y)).powi(2) <= best
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if solvable(middle) { low = middle } else { high = middle }
    }
    low
}

fn first_step<L>(lagrangian: &L, motion: &Motion, h: f64) -> Result<(u32, f64), StepError>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3> + Regular + Clone,
{
    let stepper = Stepper::new(lagrangian.clone(), h).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    let before = state.attitude();
    let report = stepper.step(&mut state)?;
    let increment = before.inverse().compose(&state.attitude());
    Ok((report.iterations, increment.log().norm().to_degrees()))
}

#[test]
fn s1_looping_top_steps_up_to_the_fold() {
    let motion = Motion::looping();
    let fold = fold_of_symmetric_top(&motion);
    println!("fold {fold:.6}");
    assert!((fold - 0.0815).abs() < 5e-5, "four digits of the known fold: {fold}");
    for fraction in [0.01, 0.1, 0.3, 0.5, 0.6, 0.7, 0.754, 0.8, 0.85, 0.9, 0.95, 0.97, 0.98, 0.99, 0.995, 0.998, 0.999]
    {
        let (iterations, angle) = first_step(&motion.top, &motion, fraction * fold).unwrap();
        println!("{fraction} of the fold: {iterations} iterations, {angle:.2}°");
        assert!(iterations <= 9, "{iterations} iterations at {fraction} of the fold");
        // On a principal axis the fold is at 90°, for this body it is at most 91.6° in any direction.
        assert!(angle < 91.0, "{angle}° at {fraction} of the fold");
    }
}

#[test]
fn s1_the_error_beyond_the_fold_names_the_largest_step() {
    let motion = Motion::looping();
    let fold = fold_of_symmetric_top(&motion);
    for factor in [1.00001, 1.001, 1.006, 1.01, 1.1, 1.5, 2.0, 3.0, 10.0, 100.0, 1e6] {
        let h = factor * fold;
        let error = first_step(&motion.top, &motion, h).unwrap_err();
        let StepError::BeyondSolvable { step, largest } = error else { panic!("{factor} times the fold: {error:?}") };
        assert!(step.to_bits() == h.to_bits());
        // The bisection stops at six digits, which are what is told, the scan of X at five.
        assert!((largest / fold - 1.0).abs() < 1e-5, "{largest} against {fold} at {factor} times the fold");
        assert!(error.to_string().contains(&format!("{largest:e} s")), "{error}");
    }
}

/// Other bodies, other directions: near the fold nothing but a rotation on the branch of the identity comes out, and
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
    let moments = top.inertia().symmetric_eigenvalues();
    let size = fold * a.norm();
    // Six digits of the bisection.
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

#[test]
fn s2_the_published_setting_is_refused_and_leaves_the_state_alone() {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), 0.1).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    let before = state;
    let error = stepper.step(&mut state).unwrap_err();
    println!("{error}");
    let StepError::BeyondSolvable { step, largest } = error else { panic!("{error:?}") };
    assert!((step - 0.1).abs() < f64::EPSILON);
    assert!((largest / fold_of_symmetric_top(&motion) - 1.0).abs() < 1e-5);
    // The text of a float has all its digits and the sign of zero.
    assert_eq!(format!("{before:?}"), format!("{state:?}"));
}
