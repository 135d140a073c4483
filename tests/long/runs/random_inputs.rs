//! Random inputs, valid and invalid, a million of them by `LIESTEP_CASES=1000000`: none panics, none leads to a state
//! that isn't finite, every error's cause is the one that it names, and every step satisfies its equation.

use std::collections::BTreeMap;

use checks::random::Random;
use declarations::HeavyTop;
use liestep::mechanics::{InertiaError, inertia};
use liestep::motion::Solvability;
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};

/// The number of cases; the environment may set another number.
fn inputs() -> u32 {
    let asked = std::env::var("LIESTEP_CASES").ok();
    asked.map_or(100_000, |count| count.parse().expect("LIESTEP_CASES is the number of cases"))
}

const STEPS: u32 = 3;

/// The number of occurrences of each outcome.
type Tally = BTreeMap<String, u32>;

struct Inputs {
    random: Random,
}

impl Inputs {
    /// A random number below `count`.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small positive numbers
    fn choice(&mut self, count: u32) -> u32 {
        ((self.random.signed() * 0.5 + 0.5) * f64::from(count)) as u32
    }

    /// An unusual number.
    fn odd(&mut self) -> f64 {
        let size = 1.0 + self.random.signed().abs();
        match self.choice(12) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::NEG_INFINITY,
            3 => f64::from_bits(1),
            4 => 1e-310 * size,
            5 => f64::MAX,
            6 => 1e150 * size,
            7 => 1e-150 * size,
            8 => -0.0,
            9 => -size,
            10 => f64::MIN_POSITIVE,
            _ => 10.0_f64.powf(300.0 * self.random.signed()),
        }
    }

    /// The usual number, or occasionally an unusual one.
    fn number(&mut self, usual: f64) -> f64 {
        if self.choice(60) == 0 { self.odd() } else { usual }
    }

    fn vector(&mut self, size: f64) -> Vector3<f64> {
        let usual = self.random.vector() * size;
        usual.map(|entry| self.number(entry))
    }

    /// A number uniform in the logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(0.5 + 0.5 * self.random.signed())
    }

    /// The diagonal of `J_d`, from needles to plates.
    fn diagonal(&mut self) -> Vector3<f64> {
        let size = self.between(1e-3, 1e3);
        let usual = self.random.vector().map(f64::abs) * size;
        let usual = match self.choice(8) {
            0 => usual.component_mul(&Vector3::new(1e-6, 1.0, 1.0)),
            1 => Vector3::new(0.0, usual.y, usual.z),
            2 => Vector3::repeat(size),
            _ => usual,
        };
        usual.map(|entry| self.number(entry))
    }

    fn matrix(&mut self) -> Matrix3<f64> {
        let axes = self.random.rotation().matrix();
        let body = axes * Matrix3::from_diagonal(&self.diagonal()) * axes.transpose();
        let off = if self.choice(4) == 0 { self.random.matrix() * self.between(1e-18, 1.0) } else { Matrix3::zeros() };
        body + off
    }

    fn attitude(&mut self) -> SO3 {
        let usual = self.random.rotation().matrix();
        let off = if self.choice(20) == 0 { self.random.matrix() * self.between(1e-17, 1.0) } else { Matrix3::zeros() };
        SO3::from_matrix_unchecked((usual + off).map(|entry| if self.choice(500) == 0 { self.odd() } else { entry }))
    }

    fn step_size(&mut self) -> f64 {
        let usual = self.between(1e-6, 1.0) * self.random.signed().signum();
        self.number(usual)
    }
}

fn finite(entries: &[f64]) -> bool {
    entries.iter().all(|entry| entry.is_finite())
}

/// The largest and the smallest absolute value of the nonzero numbers.
fn extremes(numbers: &[f64]) -> (f64, f64) {
    let sizes = numbers.iter().map(|number| number.abs()).filter(|size| *size > 0.0);
    sizes.fold((0.0, f64::INFINITY), |(largest, smallest), size| (largest.max(size), smallest.min(size)))
}

fn check_inertia_error(matrix: &Matrix3<f64>, error: InertiaError) -> &'static str {
    let size = matrix.amax();
    match error {
        InertiaError::NotFinite => {
            assert!(!finite(matrix.as_slice()));
            "inertia: not finite"
        }
        InertiaError::NotSymmetric { defect } => {
            assert!(finite(matrix.as_slice()) && defect > 1e-15 * size);
            assert!(((matrix - matrix.transpose()).amax() - defect).abs() <= 1e-15 * size);
            "inertia: not symmetric"
        }
        InertiaError::TriangleInequality { smallest } => {
            let least = (matrix.scale(0.5 / size) + matrix.transpose().scale(0.5 / size)).symmetric_eigenvalues().min();
            assert!(smallest < 0.0 && (least - smallest / size).abs() < 1e-12, "{smallest} of {matrix}");
            "inertia: triangle inequality"
        }
        InertiaError::Singular { smallest } => {
            let eigenvalues = matrix.symmetric_eigenvalues();
            assert!(smallest <= 1e-13 * size && eigenvalues.sum() - eigenvalues.max() <= 1e-12 * size);
            "inertia: singular"
        }
        InertiaError::OutOfRange { .. } => {
            assert!(finite(matrix.as_slice()) && !(1e-76..=1e76).contains(&size), "{size:e}");
            "inertia: out of range"
        }
        other => panic!("{other:?}"),
    }
}

fn check_setup_error(top: &HeavyTop, h: f64, error: &SetupError) -> &'static str {
    match *error {
        SetupError::Parameter { field, cause } => {
            let wrong = match field {
                "m" => !top.m.is_finite(),
                "g" => !top.g.is_finite(),
                "rho" => !finite(top.rho.as_slice()),
                "up" => !finite(top.up.as_slice()),
                _ => false,
            };
            assert!(wrong && cause == "is not finite", "{field} of {top:?}");
            "setup: parameter"
        }
        SetupError::InvalidStep { step } => {
            assert!(step.to_bits() == h.to_bits() || h.is_nan());
            // The determinant of the Newton system is of the third power of `J/h`.
            let size = top.J_d.diagonal().amax() / h.abs();
            assert!(!h.is_finite() || !(1e-90..1e90).contains(&size), "{h:e} for {top:?}");
            "setup: invalid step"
        }
        SetupError::NonFiniteConstant => {
            // The product of mass, gravitational acceleration and lever is a constant of the step, and may overflow.
            let numbers = [&[top.m, top.g], top.rho.as_slice()].concat();
            assert!(extremes(&numbers).0 > 1e90, "{top:?}");
            "setup: constant not finite"
        }
        ref other => panic!("{other:?} for {top:?} and {h:e}"),
    }
}

fn check_start_error(attitude: &SO3, [momentum, up]: [&Vector3<f64>; 2], error: &SetupError) -> &'static str {
    match *error {
        SetupError::NotInGroup { defect } => {
            let is_in_group = attitude.defect() < 2e-12;
            assert!(!is_in_group && (defect.to_bits() == attitude.defect().to_bits() || defect.is_nan()));
            "start: not in the group"
        }
        SetupError::NonFinite { what: "momentum" } => {
            assert!(!finite(momentum.as_slice()));
            "start: momentum not finite"
        }
        SetupError::NonFinite { what: "velocity of the momentum" } => {
            // Products of two of its components, or of one and of moments, occur in the computation of a velocity.
            assert!(finite(momentum.as_slice()) && extremes(momentum.as_slice()).0 > 1e90, "{momentum}");
            "start: velocity not finite"
        }
        SetupError::NonFinite { what: "view of what is advected" } => {
            assert!(finite(up.as_slice()) && !finite(attitude.as_matrix().tr_mul(up).as_slice()), "{up}");
            "start: view not finite"
        }
        ref other => panic!("{other:?}"),
    }
}

/// Checks `𝔽l_d⁻(F, w) = μ` and `𝔽l_d⁺(F, w) = μ⁺`, to the rounding of `F = RᵀR⁺` and of cancelling terms.
fn check_equations(stepper: &Stepper<HeavyTop>, before: &State<SO3, Vector3<f64>>, after: &State<SO3, Vector3<f64>>) {
    let (top, h) = (stepper.scene(), stepper.step_size());
    assert!(finite(after.attitude().as_matrix().as_slice()), "{after:?}");
    assert!(finite(after.momentum().as_slice()) && finite(after.advected().as_slice()), "{after:?}");
    if h == 0.0 {
        return;
    }
    let f = before.attitude().inverse().compose(&after.attitude()).matrix();
    let (w, size) = (before.advected(), top.J_d.diagonal().amax() / h.abs());
    let kick = 3.0 * (h * top.m * top.g).abs() * top.rho.amax() * w.amax();
    let scale = size + kick + before.momentum().norm() + after.momentum().norm();
    let minus = (top.legendre_minus(&f, &w, h) - before.momentum()).norm();
    let plus = (top.legendre_plus(&f, &w, h) - after.momentum()).norm();
    // An attitude may be as far from orthogonal as `start` allows.
    let allowed = (1e-14 + 4.0 * before.orthogonality_defect()) * scale;
    assert!(minus <= allowed && plus <= allowed, "{minus:e} and {plus:e} of {scale:e}: {top:?} {h:e} {before:?}");
}

fn check_step_error(
    stepper: &Stepper<HeavyTop>,
    state: &State<SO3, Vector3<f64>>,
    inertia: &Matrix3<f64>,
    error: &StepError,
) -> &'static str {
    let (top, h) = (stepper.scene(), stepper.step_size());
    let (momentum, w) = (state.momentum(), state.advected());
    let turn = (momentum + w.cross(&top.rho) * (0.5 * h * top.m * top.g)) * h;
    match *error {
        StepError::BeyondSolvable { step, largest, .. } => {
            let smallest = inertia.symmetric_eigenvalues().min();
            assert!(step.to_bits() == h.to_bits() && largest.abs() < h.abs() && largest * h >= 0.0);
            let is_small = turn.norm() < smallest * (1.0 - 1e-9);
            assert!(!is_small, "{:e} and {smallest:e}", turn.norm());
            assert_ne!(stepper.solvability(state), Solvability::Certain);
            "step: beyond solvable"
        }
        // The sizes are those whose products leave the range of the scalar.
        StepError::NonFinite { .. }
        | StepError::Singular
        | StepError::NotConverged { .. }
        | StepError::WrongBranch { .. } => {
            let numbers = [momentum.as_slice(), w.as_slice(), top.rho.as_slice(), &[top.m, top.g, h]].concat();
            let (largest, smallest) = extremes(&numbers);
            assert!(largest > 1e60 || smallest < 1e-60, "{error:?}: {top:?} {h:e} {state:?}");
            "step: out of range"
        }
        ref other => panic!("{other:?}"),
    }
}

/// One input, and its outcome.
fn outcome(inputs: &mut Inputs) -> &'static str {
    let diagonal = inputs.diagonal();
    let J_d = match DiagonalNonstandardInertia::from_diagonal(diagonal) {
        Ok(inertia) => inertia,
        Err(error) => return check_inertia_error(&Matrix3::from_diagonal(&diagonal), error),
    };
    let (m, g) = (inputs.between(0.01, 100.0), inputs.between(0.1, 30.0));
    let (m, g) = (inputs.number(m), inputs.number(g));
    let top = HeavyTop { J_d, m, g, rho: inputs.vector(1.0), up: inputs.vector(1.0) };
    let h = inputs.step_size();
    let stepper = match Stepper::new(top.clone(), h) {
        Ok(stepper) => stepper,
        Err(error) => return check_setup_error(&top, h, &error),
    };
    assert!(h.is_finite() && finite(&[m, g]) && finite(top.rho.as_slice()) && finite(top.up.as_slice()));

    let inertia = inertia(&top, &top.advected());
    let attitude = inputs.attitude();
    // The turns are a thousandth to ten times the largest solvable one.
    let size = inertia.amax() / h.abs().max(1e-6) * inputs.between(1e-3, 10.0);
    let momentum = inputs.vector(size);
    let mut state = match stepper.start_with_momentum(attitude, momentum) {
        Ok(state) => state,
        Err(error) => return check_start_error(&attitude, [&momentum, &top.up], &error),
    };
    assert!(attitude.defect() < 1e-11 && finite(momentum.as_slice()));
    for _ in 0..STEPS {
        let before = state;
        if let Err(error) = stepper.step(&mut state) {
            assert_eq!(format!("{before:?}"), format!("{state:?}"));
            return check_step_error(&stepper, &state, &inertia, &error);
        }
        check_equations(&stepper, &before, &state);
    }
    "steps made"
}

#[test]
fn b6_random_inputs_give_a_motion_or_the_error_of_their_cause() {
    let count = inputs();
    let mut inputs = Inputs { random: Random::new(2024) };
    let mut tally = Tally::new();
    for _ in 0..count {
        *tally.entry(outcome(&mut inputs).to_owned()).or_default() += 1;
    }
    for (name, found) in &tally {
        println!("{found:>8} {name}");
    }
    // Each outcome has occurred; most inputs are usual ones.
    for name in [
        "inertia: not finite",
        "setup: parameter",
        "setup: invalid step",
        "start: not in the group",
        "step: beyond solvable",
    ] {
        assert!(tally.get(name).is_some_and(|found| *found > count / 2000), "{name}: {tally:?}");
    }
    assert!(tally["steps made"] > count / 4, "{tally:?}");
}

#[test]
fn b6_random_matrices_are_inertias_or_errors_of_their_cause() {
    let count = inputs();
    let mut inputs = Inputs { random: Random::new(2025) };
    let mut tally = Tally::new();
    for _ in 0..count / 10 {
        let matrix = inputs.matrix();
        let name = match NonstandardInertia::new(matrix) {
            Ok(inertia) => {
                assert!(finite(inertia.as_matrix().as_slice()) && inertia.to_inertia().as_matrix().determinant() > 0.0);
                "a body"
            }
            Err(error) => check_inertia_error(&matrix, error),
        };
        *tally.entry(name.to_owned()).or_default() += 1;
    }
    println!("{tally:?}");
    for name in ["inertia: not finite", "inertia: not symmetric", "a body"] {
        assert!(tally.get(name).is_some_and(|found| *found > count / 1000), "{name}: {tally:?}");
    }
}
