//! Gradients of motions beside central differences, by every number of a declaration's parameters and of the start.

use liestep::laws::samples::Random;
use liestep::motion::Propagator as _;
use liestep_derivation::ParameterKind;
use liestep_late::{Declaration, Derivatives, Direction, Gradient, Reading, Row, Whole};
use nalgebra::DMatrix;

/// A motion whose start and parameters are displaced.
struct Motion<'a> {
    declaration: &'static Declaration,
    numbers: &'a [f64],
    attitude: &'a [f64],
    velocity: &'a [f64],
    h: f64,
    method: &'a str,
    /// The length of the differences: less where derivatives are large, as near a collision.
    step: f64,
    rows: &'a [(Row, Reading)],
}

/// The scalar that readings are the derivatives of.
fn paired(by: &[f64], found: &[f64]) -> f64 {
    by.iter().zip(found).map(|(a, b)| a * b).sum()
}

impl Motion<'_> {
    fn whole(&self, numbers: &[f64]) -> Whole {
        Whole::of(self.declaration, numbers, self.h, self.method.parse().expect("a method")).expect("a stepper")
    }

    /// The scalar of a motion from this start.
    fn scalar(&self, numbers: &[f64], attitude: &[f64], velocity: &[f64]) -> f64 {
        let whole = self.whole(numbers);
        let mut state = whole.start(attitude, velocity).expect("a start");
        let (layout, n) = (whole.layout(), velocity.len());
        let (mut made, mut sum) = (0, 0.0);
        for (Row { steps, fraction }, by) in self.rows {
            whole.run(&mut state, steps - made).expect("steps");
            made = *steps;
            let state = if *fraction == 0.0 { state.clone() } else { whole.part(&state, *fraction).expect("a part") };
            let [mut own, mut spatial] = [vec![0.0; n], vec![0.0; n]];
            whole.velocity(&state, &mut own);
            whole.spatial_momentum(&state, &mut spatial);
            sum += paired(&by.velocity, &own) + paired(&by.spatial_momentum, &spatial);
            sum += paired(&by.energy, &[whole.energy(&state)]);
            sum += paired(&by.attitude, &state[layout.attitude()]) + paired(&by.momentum, &state[layout.momentum()]);
        }
        sum
    }

    /// The derivative of the scalar, by differences of sixth order.
    fn slope(&self, scalar: impl Fn(f64) -> f64) -> f64 {
        let step = self.step;
        let difference = |times: f64| (scalar(times * step) - scalar(-times * step)) / (2.0 * times * step);
        1.5 * difference(1.0) - 0.6 * difference(2.0) + 0.1 * difference(3.0)
    }

    /// The derivative by a turn about one axis of the body, or along a generator.
    fn by_turn(&self, component: usize) -> f64 {
        self.slope(|by| {
            let (mut attitude, mut first, mut entry) = (self.attitude.to_vec(), 0, 0);
            for factor in &self.declaration.factors {
                let size = factor.generators[0].len().isqrt();
                if let Some(e) = component.checked_sub(first).and_then(|own| factor.generators.get(own)) {
                    let g = DMatrix::from_row_slice(size, size, &attitude[entry..entry + size * size]);
                    let turned = g * (DMatrix::from_row_slice(size, size, e) * by).exp();
                    attitude[entry..entry + size * size].copy_from_slice(turned.transpose().as_slice());
                }
                (first, entry) = (first + factor.generators.len(), entry + size * size);
            }
            self.scalar(self.numbers, &attitude, self.velocity)
        })
    }

    fn by_velocity(&self, component: usize) -> f64 {
        self.slope(|by| {
            let mut velocity = self.velocity.to_vec();
            velocity[component] += by;
            self.scalar(self.numbers, self.attitude, &velocity)
        })
    }

    /// The derivative by numbers that are displaced together.
    fn by_numbers(&self, places: &[usize]) -> f64 {
        self.slope(|by| {
            let mut numbers = self.numbers.to_vec();
            for &place in places {
                numbers[place] += by;
            }
            self.scalar(&numbers, self.attitude, self.velocity)
        })
    }
}

/// Numbers of parameters that are displaced together: the entries of an inertia beside its diagonal in pairs.
fn places(declaration: &Declaration) -> Vec<Vec<usize>> {
    let (mut all, mut first) = (Vec::new(), 0);
    for parameter in &declaration.parameters {
        let count = parameter.kind.len();
        let is_inertia = parameter.kind == ParameterKind::Inertia;
        let own = (0..count).filter(|at| !is_inertia || at / 3 <= at % 3);
        all.extend(own.map(|at| {
            let mirrored = at % 3 * 3 + at / 3;
            if is_inertia && mirrored != at { vec![first + at, first + mirrored] } else { vec![first + at] }
        }));
        first += count;
    }
    all
}

/// Asserts that the changes along a direction, paired with the rows, are the gradient paired with the direction.
fn along(
    derivatives: &Derivatives,
    start: &[f64],
    rows: &[(Row, Reading)],
    (gradient, velocity, by_velocity): (&Gradient, &[f64], &[f64]),
) {
    let random = &mut Random::new(13);
    let mut list = |count: usize| -> Vec<f64> { (0..count).map(|_| random.signed()).collect() };
    let n = velocity.len();
    let (change, displacement) = (list(n), list(n));
    let mut direction = Direction { displacement, momentum: list(n), parameters: list(gradient.parameters.len()) };
    derivatives.with_velocity(start, velocity, &change, &mut direction);
    let places: Vec<Row> = rows.iter().map(|(row, _)| *row).collect();
    let changes = derivatives.along(start, &direction, &places).expect("changes");
    let found: f64 = changes
        .iter()
        .zip(rows)
        .map(|(found, (_, by))| {
            paired(&by.velocity, &found.velocity)
                + paired(&by.momentum, &found.momentum)
                + paired(&by.attitude, &found.attitude)
                + paired(&by.energy, &found.energy)
                + paired(&by.spatial_momentum, &found.spatial_momentum)
        })
        .sum();
    let expected = paired(by_velocity, &change)
        + paired(&gradient.displacement, &direction.displacement)
        + paired(&gradient.parameters, &direction.parameters);
    assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{found:e} along, {expected:e} back");
}

/// Asserts that the gradient of a scalar of all that is read of a motion, also between steps, is that of differences.
pub(crate) fn assert_gradient(declaration: &'static Declaration, numbers: &[f64], attitude: &[f64], velocity: &[f64]) {
    let random = &mut Random::new(11);
    let mut list = |count: usize| -> Vec<f64> { (0..count).map(|_| random.signed()).collect() };
    let n = velocity.len();
    let mut readings = || Reading {
        velocity: list(n),
        momentum: list(n),
        attitude: list(attitude.len()),
        energy: list(1),
        spatial_momentum: list(n),
    };
    let places_of = [(0, 0.0), (2, 0.0), (4, 0.3), (6, 0.0)];
    let rows = places_of.map(|(steps, fraction)| (Row { steps, fraction }, readings()));
    let methods = if declaration.is_self_adjoint { &["step", "composition Suzuki 4"][..] } else { &["step"] };
    for &method in methods {
        let what = format!("{} by {method}", declaration.name);
        let mut motion = Motion { declaration, numbers, attitude, velocity, h: 0.005, method, step: 2e-4, rows: &rows };
        let whole = motion.whole(numbers);
        let derivatives = whole.derivatives().expect("derivatives");
        let start = whole.start(attitude, velocity).expect("a start");
        let mut gradient = derivatives.gradient(&start, &rows, &mut |_, _| ()).expect("a gradient");
        let by_velocity = derivatives.at_velocity(&start, velocity, &mut gradient);
        let all = gradient.parameters.iter().chain(&gradient.displacement).chain(&by_velocity);
        let size = all.fold(1.0_f64, |most, slope| most.max(slope.abs()));
        motion.step /= (size / 1e3).max(1.0);
        // In a random motion near a collision differences themselves are no better.
        let tolerance = if size > 1e7 { 1e-6 } else { 1e-7 };
        let near = |found: f64, expected: f64, of: String| {
            assert!(
                (found - expected).abs() < tolerance * size,
                "{what}, by {of}: {found:e}, {expected:e} of {size:e}"
            );
        };
        for (k, slope) in by_velocity.iter().enumerate() {
            near(*slope, motion.by_velocity(k), format!("velocity {k}"));
            near(gradient.displacement[k], motion.by_turn(k), format!("turn {k}"));
        }
        along(&derivatives, &start, &rows, (&gradient, velocity, &by_velocity));
        for places in places(declaration) {
            let found = places.iter().map(|&place| gradient.parameters[place]).sum();
            near(found, motion.by_numbers(&places), format!("numbers {places:?}"));
        }
    }
}
