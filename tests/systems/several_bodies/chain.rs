//! Three links on ball joints from a fixed pivot, in the minimal form on SO(3)³.
//!
//! ```text
//! l_d = Σ tr((F_a − I) J_a (F_a − I)ᵀ)/2h + Σ_{a<b} x_a·Q_ab y_b/h − (h/2) g Σ w_a·(s_a + F_a s_a)
//! x_a = (F_a − I) ρ_a,  y_b = (F_b − I) s_b
//! ```

use checks::solvers::Badly;
use declarations::motions::{matrix, number, read, vector};
use liestep::groups::LieGroup as _;
use liestep::laws::samples::Random;
use liestep::mechanics::{DiscreteLagrangian as _, Term};
use liestep::methods::CompositionScheme;
use liestep::motion::Motion;
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper, lagrangian};
use nalgebra::{Matrix3, SVector, Vector3};

use super::links::chain3;
use super::{End, all, apart, assert_reference, attitudes_of, check_derived, momentum, part, stacked};

type Group = (SO3, SO3, SO3);
type Components = SVector<f64, 9>;

#[lagrangian(
    group(F_1 = SO3, F_2 = SO3, F_3 = SO3),
    advected(
        w_1 = up.seen_from(F_1),
        w_2 = up.seen_from(F_2),
        w_3 = up.seen_from(F_3),
        Q_12 = F_2.seen_from(F_1),
        Q_13 = F_3.seen_from(F_1),
        Q_23 = F_3.seen_from(F_2),
    ),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + ((F_3 - I) * J_3 * (F_3 - I).transpose()).trace() / (2.0 * h)
        + ((F_1 - I) * rho_1).dot(&(Q_12 * ((F_2 - I) * s_2))) / h
        + ((F_1 - I) * rho_1).dot(&(Q_13 * ((F_3 - I) * s_3))) / h
        + ((F_2 - I) * rho_2).dot(&(Q_23 * ((F_3 - I) * s_3))) / h
        - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2)) + w_3.dot(&(s_3 + F_3 * s_3))),
)]
#[derive(Clone, Copy)]
struct Chain {
    /// Nonstandard, about the upper joint, with the mass of what hangs below at the lower.
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    /// A matrix, as that of no mass is zero.
    J_3: Matrix3<f64>,
    /// The lower joint, from the upper.
    rho_1: Vector3<f64>,
    rho_2: Vector3<f64>,
    s_1: Vector3<f64>,
    s_2: Vector3<f64>,
    s_3: Vector3<f64>,
    g: f64,
    up: Vector3<f64>,
}

impl Chain {
    /// Of the reference.
    fn read() -> Self {
        let data = &read("several bodies")["chain3"]["parameters"];
        let bodies = data["bodies"].as_array().unwrap();
        let plain = |value: &serde_json::Value| Vector3::from_fn(|k, _| value[k].as_f64().unwrap());
        let (mut J, mut rho, mut s) = ([Matrix3::zeros(); 3], [Vector3::zeros(); 3], [Vector3::zeros(); 3]);
        for (k, body) in bodies.iter().enumerate() {
            let (m, c, moments) = (body["m"].as_f64().unwrap(), plain(&body["c"]), plain(&body["J_cm"]));
            let beyond: f64 = bodies[k + 1..].iter().map(|body| body["m"].as_f64().unwrap()).sum();
            rho[k] = plain(&body["rho"]);
            let own = Matrix3::from_diagonal_element(0.5 * moments.sum()) - Matrix3::from_diagonal(&moments);
            J[k] = own + c * c.transpose() * m + rho[k] * rho[k].transpose() * beyond;
            s[k] = c * m + rho[k] * beyond;
        }
        let ([rho_1, rho_2, _], [s_1, s_2, s_3]) = (rho, s);
        let [J_1, J_2] = [J[0], J[1]].map(|J| NonstandardInertia::new(J).unwrap());
        Self { J_1, J_2, J_3: J[2], rho_1, rho_2, s_1, s_2, s_3, g: data["g"].as_f64().unwrap(), up: Vector3::z() }
    }
}

/// Where it starts, and the first and the last link two seconds later.
fn motion() -> (Group, Components, [End; 2]) {
    let states = &read("several bodies")["chain3"]["states"];
    let (start, end) = (&states[0]["bodies"], &states[1]["bodies"]);
    let attitudes = all(start, |body| SO3::try_from(matrix(&body["R"])).unwrap());
    let velocity = stacked(&all(start, |body| vector(&body["Omega_body"])));
    let ends = [0, 2].map(|k| (matrix(&end[k]["R"]), vector(&end[k]["Omega_body"])));
    ((attitudes[0], attitudes[1], attitudes[2]), velocity, ends)
}

#[test]
fn what_is_derived_is_what_is_declared() {
    check_derived::<_, 9>(&Chain::read(), &mut Random::new(5));
}

/// To rounding, against a step of 30 digits.
#[test]
fn golden_step() {
    let golden = &read("several bodies")["golden steps"]["chain3"];
    let (start, mu): (_, Components) = (attitudes_of(&golden["R0"]), momentum(&golden["mu0"]));
    let after = |h: f64| {
        let stepper = Stepper::new(Chain::read(), h).unwrap();
        let mut state = stepper.start_with_momentum((start[0], start[1], start[2]), mu).unwrap();
        stepper.step(&mut state).unwrap();
        assert_eq!(state.momentum_of::<2>(), part(&state.momentum(), 2));
        state
    };
    let (end, expected): (_, Components) = (after(number(&golden["h"])), momentum(&golden["mu1"]));
    let attitudes = [end.attitude().0, end.attitude().1, end.attitude().2];
    let off = (end.momentum() - expected).norm() / expected.norm();
    let errors = [apart(&attitudes, &attitudes_of(&golden["R1"])), off];
    println!("{errors:?}");
    assert!(errors.iter().all(|&error| error < 1e-14), "{errors:?}");
    // What goes like 1/h in the diamond loses no digit where the step is small: against links that are solved one by one.
    for h in [1e-2, 1e-4, 1e-5] {
        let stepper = chain3().stepper(h).unwrap();
        let momenta = Bodies([0, 1, 2].map(|body| part(&mu, body)));
        let mut state = stepper.start_with_momentum([start[0], start[1], start[2]], momenta).unwrap();
        stepper.step(&mut state).unwrap();
        let error = (after(h).momentum() - stacked::<9>(&state.momentum().0)).norm() / mu.norm();
        println!("{error:e} at {h}");
        assert!(error < 1e-14, "{error:e} at {h}");
    }
}

/// The order, and the errors of unreduced steps.
#[test]
fn trajectory() {
    let (attitude, velocity, [first, last]) = motion();
    let errors = [(0.02, 100), (0.01, 200), (0.005, 400), (0.0025, 800)].map(|(h, steps)| {
        let stepper = Stepper::new(Chain::read(), h).unwrap();
        let mut state = stepper.start(attitude, velocity).unwrap();
        let before = (vertical(&state), stepper.energy(&state));
        stepper.run(&mut state, steps).unwrap();
        assert!((vertical(&state) - before.0).abs() < 1e-12, "{}", vertical(&state) - before.0);
        // Of second order, as the step is; steps of 0.01 s keep it within 0.04 J.
        let off = (stepper.energy(&state) - before.1).abs();
        println!("energy off by {off:.2e} at {h}");
        assert!(off < 0.04 * (h / 0.01).powi(2), "{off:e} {h}");
        let attitude = (state.attitude().0.as_matrix() - first.0).amax();
        (attitude, (part(&stepper.velocity(&state), 2) - last.1).amax())
    });
    assert_reference(&errors);
}

/// Along the vertical the momentum of all.
fn vertical(motion: &Motion<Group, <Chain as Term>::Advected>) -> f64 {
    let spatial = motion.spatial_momentum();
    (0..3).map(|body| part(&spatial, body).z).sum()
}

/// It is kept by increments that miss their equation by far, over a hundred thousand steps.
#[test]
fn vertical_momentum_of_steps_solved_badly() {
    let ((attitude, velocity, _), chain) = (motion(), Chain::read());
    let stepper = Stepper::new(Badly(chain), 0.01).unwrap();
    let mut state = stepper.start(attitude, velocity).unwrap();
    let (before, mut most, mut least) = (vertical(&state), 0.0_f64, f64::INFINITY);
    for _ in 0..100_000 {
        let last = state;
        stepper.step(&mut state).unwrap();
        let f = last.attitude().inverse().compose(&state.attitude()).matrix();
        let missed = chain.legendre_minus(&f, &last.advected(), 0.01) - last.momentum();
        least = least.min(missed.norm() / last.momentum().norm());
        most = most.max((vertical(&state) - before).abs());
    }
    println!("momentum {most:.1e}, (2.7) missed by {least:.1e} at least");
    assert!(most < 2e-12 && least > 1e-6, "{most:e} {least:e}");
}

/// Compositions, compensated sums and checkpoints go around a product as around a group.
#[test]
fn what_goes_around_a_step_goes_around_a_product() {
    let (attitude, velocity, [end, _]) = motion();
    let composed = Stepper::composed(Chain::read(), 0.02, CompositionScheme::KAHAN_LI_8).unwrap();
    let mut precise = composed.start(attitude, velocity).unwrap();
    composed.run(&mut precise, 100).unwrap();
    let error = (precise.attitude().0.as_matrix() - end.0).norm();
    println!("of order 8: {error:.1e}");
    assert!(error < 1e-6, "{error:e}");

    let plain = Stepper::new(Chain::read(), 0.01).unwrap();
    let compensated = plain.clone().compensated();
    let mut state = plain.start(attitude, velocity).unwrap();
    let mut carried = compensated.start(attitude, velocity).unwrap();
    for _ in 0..100 {
        compensated.step(&mut carried).unwrap();
        plain.step(&mut state).unwrap();
    }
    assert!((carried.momentum() - state.momentum()).norm() < 1e-12);

    let saved = serde_json::to_string(&plain.checkpoint(&state)).unwrap();
    let mut resumed = plain.resume(&serde_json::from_str(&saved).unwrap()).unwrap();
    plain.run(&mut resumed, 10).unwrap();
    plain.run(&mut state, 10).unwrap();
    assert_eq!(resumed, state);

    let back = plain.inverse().unwrap();
    let mut there = plain.start(attitude, velocity).unwrap();
    let before = *there;
    plain.run(&mut there, 20).unwrap();
    let mut returned = back.adopt(&there);
    back.run(&mut returned, 20).unwrap();
    assert!((returned.momentum() - before.momentum()).norm() < 1e-12);
}

/// What a step can't do leaves the state, and says why; where the chain starts with a velocity that isn't a number it
/// doesn't start.
#[test]
fn a_step_that_is_too_long() {
    let (attitude, velocity, _) = motion();
    let stepper = Stepper::new(Chain::read(), 1.0).unwrap();
    let mut state = stepper.start(attitude, velocity * 3.0).unwrap();
    let before = state;
    let error = stepper.step(&mut state).unwrap_err();
    println!("{error}");
    assert!(matches!(error, StepError::BeyondSolvable { largest, .. } if largest > 1e-3 && largest < 1.0));
    assert_eq!(state, before);
}

/// A link without mass: no momentum determines its velocity. It is the last of the three, and all of its axes are lost.
#[test]
fn a_singular_inertia_is_seen_at_the_start() {
    let mut chain = Chain::read();
    (chain.J_3, chain.s_3) = (Matrix3::zeros(), Vector3::zeros());
    let stepper = Stepper::new(chain, 0.01).unwrap();
    let (attitude, velocity, _) = motion();
    let error = stepper.start(attitude, velocity).unwrap_err();
    assert!(matches!(error, SetupError::SingularKinetic { body: Some(2), .. }), "{error}");
}
