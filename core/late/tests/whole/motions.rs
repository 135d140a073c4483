//! Derivatives of whole motions: of signals by their values, along many steps, of long motions that are made twice, and exponents.

use liestep::motion::Propagator as _;
use liestep_late::{Between, Course, Declaration, Reading, Row, Signal, Whole};

/// A spring on a line whose stiffness changes with time, and the places of its numbers.
fn oscillator(method: &str) -> Whole {
    let text = "#[lagrangian(group = R1, velocity = v, advected(p = fixed), discretise = trapezoid(Cayley),
        l = m * v[0].powi(2) / 2.0 - k * p[0].powi(2) / 2.0)]
        struct Oscillator { m: f64, k: f64, fixed: Point1<f64> }";
    let declaration = Declaration::parse(text).expect("a declaration");
    let numbers = declaration.numbers(&[("m", &[1.0]), ("k", &[4.0]), ("fixed", &[0.0])]).expect("numbers");
    Whole::of(declaration, &numbers, 0.1, method.parse().expect("a method")).expect("a stepper")
}

#[derive(Clone)]
struct Stiffness(Signal);

impl Course for Stiffness {
    fn at(&self, time: f64, numbers: &mut [f64]) {
        self.0.at(time, &mut numbers[1..2]);
    }

    fn over(&self, span: [f64; 2], numbers: &mut [f64]) {
        self.0.mean(span, &mut numbers[1..2]);
    }
}

fn signal(values: &[f64], between: Between) -> Stiffness {
    Stiffness(Signal::new(vec![0.0, 0.33, 0.47, 1.2], values.to_vec(), between).expect("a signal"))
}

/// Corners of the signal lie within steps, and one row between two.
#[test]
fn by_the_values_of_a_signal() {
    let read = |energy: f64, place: f64| Reading {
        energy: vec![energy],
        attitude: vec![0.0, place, 0.0, 0.0],
        ..Reading::default()
    };
    let at = |steps, fraction| Row { steps, fraction };
    let rows = [(at(3, 0.0), read(0.3, 1.0)), (at(6, 0.4), read(-0.2, 0.5)), (at(10, 0.0), read(1.0, -0.7))];
    for (method, between) in [("step", Between::Steps), ("composition Suzuki 4", Between::Lines)] {
        let values = [4.0, 5.0, 3.0, 6.0];
        let scalar = |values: &[f64]| {
            let driven = oscillator(method).driven(signal(values, between)).expect("a stepper");
            let mut state = driven.start(&[1.0, 1.0, 0.0, 1.0], &[0.3]).expect("a start");
            let (mut made, mut sum) = (0, 0.0);
            for (row, by) in &rows {
                driven.run(&mut state, row.steps - made).expect("steps");
                made = row.steps;
                let part = driven.part(&state, row.fraction).expect("a part");
                sum += by.energy[0] * driven.energy(&part) + by.attitude[1] * part[1];
            }
            sum
        };
        let driven = oscillator(method).driven(signal(&values, between)).expect("a stepper");
        let start = driven.start(&[1.0, 1.0, 0.0, 1.0], &[0.3]).expect("a start");
        let mut found = vec![0.0; 4];
        let mut add = |span: [f64; 2], by: &[f64]| signal(&values, between).0.slopes(span, &by[1..2], &mut found);
        let derivatives = driven.derivatives().expect("derivatives");
        let mut gradient = derivatives.gradient(&start, &rows, &mut add).expect("a gradient");
        derivatives.at_velocity(&start, &[0.3], &mut gradient);
        for k in 0..4 {
            let beside = |by: f64| {
                let mut values = values;
                values[k] += by;
                scalar(&values)
            };
            let difference = (beside(1e-5) - beside(-1e-5)) / 2e-5;
            assert!((found[k] - difference).abs() < 1e-9, "{method}, value {k}: {} {difference}", found[k]);
        }
    }
}

/// The transition over many steps is the product of those of each.
#[test]
fn transitions_are_products() {
    let whole = oscillator("composition Suzuki 4");
    let start = whole.start(&[1.0, 1.0, 0.0, 1.0], &[0.3]).expect("a start");
    let found = whole.derivatives().expect("derivatives").transition(&start, 30).expect("a matrix");
    let (mut state, mut product) = (start.clone(), nalgebra::Matrix2::identity());
    for _ in 0..30 {
        let made = whole.transition(&mut state, &[0.0]).expect("a step");
        product = nalgebra::Matrix2::from_column_slice(&made.by_state) * product;
    }
    let apart = found.iter().zip(product.as_slice()).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(apart < 1e-13, "{apart:e}");
    assert!((product.determinant() - 1.0).abs() < 1e-13, "areas are conserved");
}

/// A spring whose stiffness is below zero leaves rest by `±√(k/m)`, to the second order of the step.
#[test]
fn exponents_of_a_saddle() {
    let whole = oscillator("step").with(&[1.0, -4.0, 0.0], 0.01).expect("a stepper");
    let start = whole.start(&[1.0, 0.0, 0.0, 1.0], &[0.0]).expect("a start");
    let found = whole.derivatives().expect("derivatives").exponents(&start, 2000, 10).expect("exponents");
    // Trapezoids have `cosh λh = 1 + k h²/2m`.
    let expected = (1.0 + 0.5 * 4.0 * 1e-4_f64).acosh() / 0.01;
    assert!((found[0] - expected).abs() < 0.05 && (found[0] + found[1]).abs() < 1e-12, "{found:?} {expected}");
}

#[test]
fn what_has_no_derivatives() {
    let whole = oscillator("step");
    let clock = liestep::with::Clock::of_lengths([1.0, 0.5]).expect("a clock");
    assert!(whole.with_clock(clock).derivatives().is_err());
    let derivatives = whole.derivatives().expect("derivatives");
    let start = whole.start(&[1.0, 1.0, 0.0, 1.0], &[0.3]).expect("a start");
    let short = Reading { velocity: vec![1.0; 2], ..Reading::default() };
    let row = Row { steps: 1, fraction: 0.0 };
    assert!(derivatives.gradient(&start, &[(row, short)], &mut |_, _| ()).is_err());
    assert!(derivatives.gradient(&start[1..], &[], &mut |_, _| ()).is_err());
    assert!(derivatives.exponents(&start, 0, 1).is_err());
}
