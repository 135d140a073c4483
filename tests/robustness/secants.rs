//! If the Jacobian is expensive, a step is solved without it: for the same root, to rounding, and with a fallback to
//! Newton's iteration if convergence is in doubt.

use checks::any_scalar::Top;
use checks::random::Random;
use checks::solvers::{WithJacobian, WithoutJacobian, needs_jacobian};
use declarations::{self, FourthOrderTop, SixthOrderTop};
use liestep::groups::{CayleyRetraction, LieGroup as _};
use liestep::laws::samples::derivative;
use liestep::mechanics::{
    DiagonalNonstandardInertia, DiscreteLagrangian, Effect, Inertia, Regular, Residual, Term as _,
};
use liestep::motion::DiscreteLiePoisson;
use liestep::numbers::Lanes;
use liestep::{SO3, StepError, Stepper, lagrangian};
use nalgebra::{UnitQuaternion, Vector3};
use num_dual::Dual64;
use simba::simd::WideF64x4;
use workbench::measure::order;

fn top(moments: Vector3<f64>, weight: f64, rho: Vector3<f64>) -> Top<f64> {
    Top { J_d: DiagonalNonstandardInertia::from_principal_moments(moments).unwrap(), weight, rho, up: Vector3::z() }
}

fn asymmetric() -> Top<f64> {
    top(Vector3::new(2.0, 3.0, 4.5), 9.81, Vector3::new(0.3, 0.2, 0.4))
}

fn body<L: declarations::Top>() -> L {
    let J = Inertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.5)).unwrap();
    L::new(J, 9.81, Vector3::new(0.3, 0.2, 0.4), Vector3::z())
}

fn fourth() -> FourthOrderTop {
    body()
}

fn sixth() -> SixthOrderTop {
    body()
}

#[test]
fn the_macro_finds_out_which_jacobians_are_expensive() {
    const { assert!(SixthOrderTop::JACOBIAN_IS_EXPENSIVE && FourthOrderTop::JACOBIAN_IS_EXPENSIVE) };
    const { assert!(!Top::<f64>::JACOBIAN_IS_EXPENSIVE) };
}

/// The derivative of the residual for the sixth-order top without weight is nearly that of the free body's momentum.
#[test]
fn the_model_is_right_to_the_fourth_power_of_the_angle() {
    let top = SixthOrderTop { weight: 0.0, ..sixth() };
    let (h, axis) = (0.01, Vector3::new(0.4, -0.5, 0.7));
    let constants = top.constants(h);
    let terms = SixthOrderTop::step_terms(&constants, &Vector3::zeros(), &Vector3::z());
    let errors = [0.4, 0.2, 0.1, 0.05].map(|size| {
        let xi = axis * size;
        let (_, jacobian) = SixthOrderTop::newton_system(&constants, &terms, &(xi * 0.5));
        let model = <CayleyRetraction as liestep::groups::Retraction<SO3>>::free_momentum_tangent(
            &top.inertia(&top.advected()),
            &xi,
        );
        (model - jacobian).norm() / model.norm()
    });
    assert!(errors.iter().all(|error| *error > 0.0), "{errors:?}");
    let points: Vec<_> = [0.4, 0.2, 0.1, 0.05].into_iter().zip(errors).collect();
    assert!((order(&points, 0.0) - 4.0).abs() < 0.2, "{errors:?}");
}

/// The residual that is emitted alone equals that of the system.
#[test]
fn the_residual_alone_is_the_systems() {
    let (top, h) = (sixth(), 0.02);
    let constants = top.constants(h);
    let mut random = Random::new(1);
    for _ in 0..100 {
        let w = random.direction();
        let terms = SixthOrderTop::step_terms(&constants, &random.vector(), &w);
        let xi = random.vector();
        let Residual { momentum_defect, moving_kick } = SixthOrderTop::newton_residual(&constants, &terms, &xi);
        let (residual, jacobian) = SixthOrderTop::newton_system(&constants, &terms, &xi);
        assert!((momentum_defect - residual).norm() <= 1e-13 * residual.norm());
        let along = derivative(|s| {
            SixthOrderTop::newton_residual(&constants, &terms, &(xi + Vector3::x() * s)).momentum_defect
        });
        assert!((along - jacobian.column(0)).norm() < 1e-9 * jacobian.norm());
        let f = <CayleyRetraction as liestep::groups::Retraction<SO3>>::retract(&(xi + xi));
        let after = SixthOrderTop::kick_after(&constants, &f.increment(), &(f.matrix().transpose() * w));
        assert!((f.adjoint_transpose(&moving_kick.unwrap()) - after).norm() < 1e-13 * after.norm());
    }
}

/// The distance of a step's root from the limit of Newton's iteration from there, in roundings of `ξ`, and the
/// iterations.
fn missing<L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + Clone>(
    lagrangian: &L,
    h: f64,
    speed: f64,
) -> (Vec<f64>, u32) {
    let (stepper, constants) = (Stepper::new(lagrangian.clone(), h).unwrap(), lagrangian.constants(h));
    let mut state =
        stepper.start(UnitQuaternion::from_scaled_axis(Vector3::x() * 0.8), asymmetric_spin(speed)).unwrap();
    let mut guess = stepper.velocity(&state) * h;
    let (mut missing, mut iterations) = (Vec::new(), 0);
    for _ in 0..1000 {
        let (momentum, w) = (state.momentum(), state.advected());
        let step = stepper.flow().step(&momentum, &w, &guess).unwrap();
        let terms = L::step_terms(&constants, &(momentum + L::kick_before(&constants, &w)), &w);
        let (residual, jacobian) = L::newton_system(&constants, &terms, &(step.coordinates * 0.5));
        let update = jacobian.lu().solve(&residual).unwrap();
        missing.push(2.0 * update.norm() / step.coordinates.norm() / f64::EPSILON);
        iterations = iterations.max(step.iterations);
        guess = step.coordinates;
        stepper.step(&mut state).unwrap();
    }
    (missing, iterations)
}

fn asymmetric_spin(speed: f64) -> Vector3<f64> {
    Vector3::new(0.1, 0.3, 0.9) * speed
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / f64::from(u32::try_from(values.len()).unwrap())
}

/// The error is the residual's own rounding, as with the Jacobian; the guess is the last coordinates.
#[test]
fn solves_end_at_the_level_of_rounding() {
    for (h, speed) in [(0.01, 8.0), (0.02, 8.0), (0.05, 8.0), (0.05, 2.0), (1e-4, 8.0)] {
        let pairs = [
            (missing(&fourth(), h, speed), missing(&WithJacobian(fourth()), h, speed)),
            (missing(&sixth(), h, speed), missing(&WithJacobian(sixth()), h, speed)),
            (missing(&WithoutJacobian::new(asymmetric()), h, speed), missing(&asymmetric(), h, speed)),
        ];
        for ((without, iterations), (with, _)) in pairs {
            println!("h = {h}: {:.3} roundings without, {:.3} with; {iterations}", mean(&without), mean(&with));
            assert!(mean(&without) < 1.2 * mean(&with) + 0.1, "h = {h}: {} and {}", mean(&without), mean(&with));
        }
    }
}

/// The result of `steps` random momenta of each size with both solvers: the largest difference relative to `ξ`, and the
/// numbers that were solved without the Jacobian, with it after all, and not at all.
fn compared<L>(without: &WithoutJacobian<L, f64>, h: f64, angle: f64) -> (f64, [u32; 3])
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>>
        + Regular
        + Copy
        + core::fmt::Debug
        + PartialEq,
{
    let with = DiscreteLiePoisson::new(without.0, h).unwrap();
    let without = DiscreteLiePoisson::new(*without, h).unwrap();
    let mut random = Random::new(3);
    let (mut largest, mut counts) = (0.0_f64, [0; 3]);
    for _ in 0..200 {
        let (velocity, w) = (random.direction() * (angle / h), random.direction());
        let momentum = with.scene().inertia(&with.scene().advected()) * velocity;
        let guess = velocity * h;
        let (outcome, is_expensive) = needs_jacobian(|| without.step(&momentum, &w, &guess));
        match (with.step(&momentum, &w, &guess), outcome) {
            (Ok(a), Ok(b)) => {
                largest = largest.max((a.coordinates - b.coordinates).norm() / a.coordinates.norm());
                counts[usize::from(is_expensive)] += 1;
            }
            (Err(a), Err(b)) => {
                assert_eq!(core::mem::discriminant(&a), core::mem::discriminant(&b), "{a} {b}");
                counts[2] += 1;
            }
            (a, b) => panic!("{a:?} with the Jacobian, {b:?} without, at {angle} rad"),
        }
    }
    (largest, counts)
}

/// The turns range from slow ones to those beyond the fold, where a root is as ill-conditioned as the Jacobian.
#[test]
fn the_same_root_or_the_same_refusal_up_to_the_fold() {
    let without = WithoutJacobian::new(asymmetric());
    let outcomes =
        [1e-3, 0.03, 0.1, 0.3, 0.6, 0.8, 0.95, 1.0, 1.2].map(|angle| (angle, compared(&without, 0.02, angle)));
    for (angle, (difference, counts)) in outcomes {
        println!("{angle} rad: {difference:e} apart, {counts:?}");
        assert!(difference < if angle < 0.7 { 4e-15 } else { 1e-12 }, "{difference:e} at {angle} rad");
    }
    let counts = outcomes.map(|(_, (_, counts))| counts);
    assert_eq!(counts[1], [200, 0, 0], "slow turns need no Jacobian");
    assert!(counts[5..8].iter().all(|counts| counts[1] > 50), "near the fold it is needed: {counts:?}");
    assert!(counts[8][2] > 50, "beyond there is nothing: {counts:?}");
}

/// A model with three times the inertia has no trusted ball, and the steps are those of Newton's iteration.
#[test]
fn a_wrong_model_is_not_used() {
    let mut wrong = WithoutJacobian::new(asymmetric());
    wrong.1 *= 3.0;
    let (difference, counts) = compared(&wrong, 0.02, 0.1);
    assert!(difference < 4e-15 && counts == [0, 200, 0], "{difference:e} {counts:?}");
}

/// Each lane agrees with a single body, also if one of the lanes needs the Jacobian.
#[test]
fn lanes_are_independent() {
    let h = 0.02;
    let bodies = [0.0, 0.5, 1.0, 1.5].map(|extra| top(Vector3::new(2.0 + extra, 3.0, 4.0), 9.81, Vector3::z()));
    let bodies_together = Top::<WideF64x4>::gathered(&bodies).unwrap();
    let together = DiscreteLiePoisson::new(WithoutJacobian::new(bodies_together), WideF64x4::from([h; 4])).unwrap();
    let alone = bodies.map(|body| DiscreteLiePoisson::new(WithoutJacobian::new(body), h).unwrap());
    let mut random = Random::new(4);
    let (mut unequal, mut with_jacobian) = (0, 0);
    for round in 0..300 {
        let angles = [0.01, 0.1, 0.3, if round % 2 == 0 { 0.5 } else { 0.85 }];
        let velocity = angles.map(|angle| random.direction() * (angle / h));
        let w = angles.map(|_| random.direction());
        let momentum = [0, 1, 2, 3].map(|k| alone[k].scene().inertia(&alone[k].scene().advected()) * velocity[k]);
        let guess = velocity.map(|velocity| velocity * h);
        let wide = together.step(&gathered(&momentum), &gathered(&w), &gathered(&guess)).unwrap();
        let outcomes = [0, 1, 2, 3].map(|k| needs_jacobian(|| alone[k].step(&momentum[k], &w[k], &guess[k]).unwrap()));
        let singles = outcomes.map(|(single, _)| single);
        for (k, single) in singles.iter().enumerate() {
            assert_eq!(wide.coordinates.lane(k), single.coordinates, "lane {k} in round {round}");
            assert_eq!(wide.momentum.lane(k), single.momentum, "lane {k} in round {round}");
        }
        unequal += u32::from(singles.iter().any(|single| single.iterations != singles[0].iterations));
        with_jacobian += u32::from(outcomes[3].1 && !outcomes[0].1);
    }
    assert!(unequal > 100 && with_jacobian > 50, "{unequal} {with_jacobian}");
}

fn gathered(lanes: &[Vector3<f64>; 4]) -> Vector3<WideF64x4> {
    Lanes::gathered(lanes).unwrap()
}

/// The derivatives of dual numbers are solved to rounding too, as Newton's iteration solves them.
#[test]
fn dual_numbers_are_solved_with_the_jacobian() {
    let dual = |v: Vector3<f64>| v.map(Dual64::from);
    let moments = Vector3::new(Dual64::from(2.0), Dual64::from(3.0).derivative(), Dual64::from(4.5));
    let J_d = DiagonalNonstandardInertia::from_principal_moments(moments).unwrap();
    let top = Top { J_d, weight: Dual64::from(9.81), rho: dual(Vector3::new(0.3, 0.2, 0.4)), up: dual(Vector3::z()) };
    let h = Dual64::from(0.02);
    let velocity = dual(asymmetric_spin(8.0));
    let momentum = top.inertia(&top.advected()) * velocity;
    let w = dual(Vector3::new(0.0, 0.6, 0.8));
    let with = DiscreteLiePoisson::new(top, h).unwrap().step(&momentum, &w, &(velocity * h)).unwrap();
    let without = WithoutJacobian::new(top);
    let without = DiscreteLiePoisson::new(without, h).unwrap().step(&momentum, &w, &(velocity * h)).unwrap();
    let difference = (with.coordinates - without.coordinates).map(|component| component.eps);
    assert!(difference.norm() < 1e-15 * with.coordinates.map(|component| component.re).norm(), "{difference}");
}

/// A body with a term that resists or assists turns across `w`, independent of turns about it.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * stiffness * w.dot(&(F * w)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stiff {
    J_d: DiagonalNonstandardInertia,
    stiffness: f64,
    up: Vector3<f64>,
}

/// For a turn about `w` updates are along it, and carry no information on the directions across.
#[test]
fn updates_along_a_symmetry_do_not_decide_the_branch() {
    let mut refused = 0;
    for stiffness in [-10.0, 10.0] {
        for h in [0.01, 0.1, 0.3, 0.5, 0.7, 0.8, 1.0, 1.5] {
            let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 4.0, 5.0)).unwrap();
            let plain = Stiff { J_d, stiffness, up: Vector3::z() };
            let [with, without] =
                [first(&plain, h, Vector3::z() * 0.1), first(&WithoutJacobian::new(plain), h, Vector3::z() * 0.1)];
            assert_eq!(with.is_ok(), without.is_ok(), "stiffness {stiffness}, h = {h}: {with:?} {without:?}");
            refused += u32::from(with.is_err());
        }
    }
    assert!(refused > 0, "{refused}");
}

fn first<L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + Clone>(
    lagrangian: &L,
    h: f64,
    velocity: Vector3<f64>,
) -> Result<Vector3<f64>, StepError> {
    let momentum = lagrangian.inertia(&lagrangian.advected()) * velocity;
    let flow = DiscreteLiePoisson::new(lagrangian.clone(), h).unwrap();
    flow.step(&momentum, &Vector3::z(), &(velocity * h)).map(|step| step.coordinates)
}
