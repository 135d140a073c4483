//! Estimates of motions from readings.

use liestep::effects::Gravity;
use liestep::groups::R1;
use liestep::motion::Motion;
use liestep_control::Estimate;
use nalgebra::{DMatrix, DVector, Vector1};

use super::*;

/// A particle on a line.
#[lagrangian(group = R1, gradients, l_d = m * F[(0, 1)].powi(2) / (2.0 * h))]
#[derive(Clone, Copy, Debug)]
struct Particle {
    m: f64,
}

const DEVIATIONS: [f64; 3] = [0.1, 0.05, 0.3];

/// Places and velocities of a particle that is pushed at random, read with an offset of the velocity: the task is
/// linear, and the fit is that of the normal equations, written out.
#[test]
fn a_line_has_the_normal_equations() {
    let (h, m, steps) = (0.5, 2.0, 8);
    let mut random = Random::new(3);
    let read: Vec<[f64; 2]> = (0..=steps).map(|_| [random.signed(), random.signed()]).collect();
    let known = DMatrix::from_diagonal(&DVector::from_column_slice(&[4.0, 1.0, 9.0]));
    let guess = [0.3, 0.4, 0.2];

    // The rows of all squares, by start, momentum, offset and forces.
    let count = 3 + steps;
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    let unit = |k: usize| DVector::from_fn(count, |i, _| if i == k { 1.0 } else { 0.0 });
    let (mut x, mut p) = (unit(0), unit(1));
    for (k, [place, velocity]) in read.iter().enumerate() {
        rows.push(&x / DEVIATIONS[0]);
        right.push(place / DEVIATIONS[0]);
        rows.push((&p / m + unit(2)) / DEVIATIONS[1]);
        right.push(velocity / DEVIATIONS[1]);
        if k < steps {
            rows.push(unit(3 + k) / DEVIATIONS[2]);
            right.push(0.1 / DEVIATIONS[2]);
            x += (&p + unit(3 + k) * (0.5 * h)) * (h / m);
            p += unit(3 + k) * h;
        }
    }
    for k in 0..3 {
        rows.push(unit(k) * f64::sqrt(known[(k, k)]));
        right.push(guess[k] * f64::sqrt(known[(k, k)]));
    }
    let (rows, right) = (DMatrix::from_columns(&rows).transpose(), DVector::from_vec(right));
    let inverse = (rows.transpose() * &rows).try_inverse().expect("a regular matrix");
    let expected = &inverse * rows.transpose() * &right;

    let stepper = Stepper::new(Particle { m }, h).expect("a stepper");
    let start = stepper.start_with_momentum(R1::from(Vector1::new(guess[0])), Vector1::new(guess[1])).expect("a start");
    let of = |step: usize, motion: &Motion<R1, ()>, constants: &[f64]| {
        let place = motion.attitude().matrix()[(0, 1)];
        let velocity = motion.momentum().x / m + constants[0];
        vec![(place - read[step][0]) / DEVIATIONS[0], (velocity - read[step][1]) / DEVIATIONS[1]]
    };
    let fit = Estimate::new(&stepper, start, steps, of)
        .unknowns(vec![guess[2]], vec![1.0])
        .inputs(Input::Force(Vector1::new(0.1)), vec![0], vec![DEVIATIONS[2]])
        .known(known)
        .solve()
        .expect("a task");
    assert_eq!(fit.verdict, Verdict::Converged);
    assert!(fit.iterations <= 2, "{}", fit.iterations);
    let first = &fit.states[0];
    let mut found = vec![first.attitude().matrix()[(0, 1)], first.momentum().x, fit.constants[0]];
    found.extend(fit.inputs.iter().flat_map(Input::scalars::<f64>));
    assert!((DVector::from_vec(found) - &expected).amax() < 1e-9);
    assert!((fit.covariance - inverse.view((0, 0), (3, 3))).amax() < 1e-9);
    assert!((fit.squares - (rows * expected - right).norm_squared()).abs() < 1e-9);
}

type Top = Sum<RigidBody, Gravity>;

fn top(m: f64, rho: Vector3<f64>) -> Stepper<Top> {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(1.2, 1.0, 0.6)).expect("a body");
    Stepper::new(RigidBody { J_d } + Gravity { m, g: 9.81, rho, up: Vector3::z() }, 0.01).expect("a stepper")
}

/// A gyroscope determines a top's centre of mass and start, but for a turn about the vertical, as the verdict says.
#[test]
fn a_gyroscope_in_a_top() {
    let rho = Vector3::new(0.3, 0.2, 0.4);
    let truth = top(1.0, rho);
    let mut state = truth.start(turned([0.8, 0.1, 0.0]), Vector3::new(0.5, 1.0, 4.0)).expect("a start");
    let (first, mut read) = (state, Vec::new());
    for _ in 0..=200 {
        read.push(truth.velocity(&state));
        truth.step(&mut state).expect("a step");
    }
    let guess = top(1.0, rho * 0.8);
    let start = guess.start(turned([0.7, 0.2, 0.0]), Vector3::new(0.4, 1.1, 3.9)).expect("a start");
    let readings = |step: usize, motion: &Motion<SO3, _>, _: &[f64]| {
        // The inertia is known, so that the stepper of any inertia returns this velocity.
        ((truth.velocity(motion) - read[step]) / 1e-3).as_slice().to_vec()
    };
    let task = |steps| {
        Estimate::new(&guess, start, steps, readings)
            .unknowns((rho * 0.8).as_slice().to_vec(), vec![0.1; 3])
            .steppers(|rho| Some(top(1.0, Vector3::from_column_slice(rho))))
    };
    let fit = task(200).solve().expect("a task");
    assert!((Vector3::from_vec(fit.constants) - rho).norm() < 1e-8);
    assert!(fit.squares < 1e-9, "{}", fit.squares);
    let Verdict::Unseen { direction } = fit.verdict else { panic!("{:?} after {}", fit.verdict, fit.iterations) };
    let vertical = fit.states[0].attitude().matrix().transpose() * Vector3::z();
    let along = vertical.cross(&Vector3::from_column_slice(&direction[..3]));
    assert!(along.norm() < 1e-6 && direction[3..].iter().all(|entry| entry.abs() < 1e-6), "{direction:?}");
    let seen = |state: &liestep::StateOf<Top>| state.attitude().matrix().transpose() * Vector3::z();
    assert!((seen(&fit.states[0]) - seen(&first)).norm() < 1e-8);
    assert!(fit.iterations <= 15, "{}", fit.iterations);
    assert_eq!(task(200).until(1e-8, 1).solve().expect("a task").verdict, Verdict::Exhausted);
}

#[test]
fn estimates_that_are_none() {
    let stepper = body([1.0, 2.0, 2.5], 0.1);
    let start = stepper.start(SO3::identity(), Vector3::zeros()).expect("a start");
    let nothing = |_: usize, _: &Motion<SO3, ()>, _: &[f64]| Vec::new();
    let task = |steps| Estimate::new(&stepper, start, steps, nothing);
    let unusable = |what| Some(ControlError::Unusable(what));
    let force = Input::Force(Vector3::zeros());
    assert_eq!(task(0).solve().err(), unusable("number of steps"));
    assert_eq!(task(3).unknowns(vec![1.0], Vec::new()).solve().err(), unusable("unknown"));
    assert_eq!(task(3).unknowns(vec![1.0], vec![0.0]).solve().err(), unusable("unknown"));
    assert_eq!(task(3).inputs(force, vec![3], vec![1.0]).solve().err(), unusable("input"));
    assert_eq!(task(3).inputs(force, vec![0, 1], vec![1.0]).solve().err(), unusable("input"));
    assert_eq!(task(3).known(DMatrix::zeros(5, 5)).solve().err(), unusable("prior knowledge"));
    let wrong = |_: usize, _: &Motion<SO3, ()>, _: &[f64]| vec![f64::NAN];
    assert_eq!(Estimate::new(&stepper, start, 3, wrong).solve().err(), unusable("reading"));
    // There are no readings and no prior information.
    let fit = task(3).solve().expect("a task");
    assert!(matches!(fit.verdict, Verdict::Unseen { .. }) && fit.covariance.amax() == 0.0, "{:?}", fit.verdict);
}
