//! Ten million steps of the looping top at `h = 0.01`, on request a hundred million, keep the group, the Casimirs
//! `|w|²` and `p·w`, the energy's mean and extremes, and the momentum about the axis of symmetry. What rounding leaves
//! is a random walk, not a drift; with compensated sums it is the walk of what is added alone.

use declarations::HeavyTop;
use declarations::Motion;
use liestep::groups::LieGroup as _;
use liestep::{SO3, State, Stepper};
use nalgebra::{SVector, Vector3, Vector4};

type TopMotion = liestep::motion::Motion<SO3, Vector3<f64>>;
type TopState = State<SO3, Vector3<f64>>;

/// How often the invariants are looked at in a run.
const SAMPLES: u64 = 1000;

/// Mean and extremes of the energy over a window of the motion.
///
/// The mean is weighted by `sin²`, so that the oscillations which the two ends cut don't count: with equal weights they
/// alone make up most of what the criterion allows.
#[derive(Clone, Copy)]
struct Energies {
    window: u64,
    weighted: f64,
    weights: f64,
    lowest: f64,
    highest: f64,
}

impl Energies {
    fn new(window: u64) -> Self {
        Self { window, weighted: 0.0, weights: 0.0, lowest: f64::INFINITY, highest: f64::NEG_INFINITY }
    }

    #[allow(clippy::cast_precision_loss)] // a million
    fn add(&mut self, step: u64, energy: f64) {
        let weight = (core::f64::consts::PI * (step as f64 + 0.5) / self.window as f64).sin().powi(2);
        self.weights += weight;
        self.weighted += weight * energy;
        self.lowest = self.lowest.min(energy);
        self.highest = self.highest.max(energy);
    }

    fn mean(&self) -> f64 {
        self.weighted / self.weights
    }
}

/// `|w|² − 1`, `p·w` relative to its start, and the six entries of `RRᵀ − I`: those of `RᵀR − I` turn with
/// the body, and what turns doesn't walk.
type Defects = SVector<f64, 8>;

/// The looping top at a hundredth of a second, and its start.
fn looping_top() -> (Stepper<HeavyTop>, TopState) {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), 0.01).unwrap();
    let state = stepper.start(motion.attitude, motion.velocity).unwrap();
    (stepper, state)
}

/// What T3 asks for; `next` makes a step. Returns the largest defects of `RᵀR − I`, `|w|`, `p·w` and `p_3`.
fn assert_kept(
    stepper: &Stepper<HeavyTop>,
    start: &TopMotion,
    steps: u64,
    mut next: impl FnMut() -> TopMotion,
) -> Vector4<f64> {
    // The first and the last tenth are compared.
    let window = steps / 10;
    let state = start;
    let (axial, vertical) = (state.momentum().z, state.momentum().dot(&state.advected()));
    let start = stepper.energy(state);

    let mut windows = [Energies::new(window); 2];
    let mut defects = vec![Defects::zeros()];
    let mut worst = Vector4::<f64>::zeros();
    for step in 1..=steps {
        let state = next();
        worst.w = worst.w.max((state.momentum().z / axial - 1.0).abs());
        if step <= window {
            windows[0].add(step - 1, stepper.energy(&state) - start);
        } else if step > steps - window {
            windows[1].add(step - (steps - window) - 1, stepper.energy(&state) - start);
        }
        if step.is_multiple_of(steps / SAMPLES) {
            let w = state.advected();
            let gram = state.attitude().matrix() * state.attitude().matrix().transpose();
            let casimirs = [w.norm_squared() - 1.0, state.momentum().dot(&w) / vertical - 1.0];
            defects.push(Defects::from_column_slice(&[
                casimirs[0],
                casimirs[1],
                gram.m11 - 1.0,
                gram.m22 - 1.0,
                gram.m33 - 1.0,
                gram.m12,
                gram.m23,
                gram.m31,
            ]));
            worst =
                worst.sup(&Vector4::new(state.orthogonality_defect(), (w.norm() - 1.0).abs(), casimirs[1].abs(), 0.0));
        }
    }

    println!("{steps} steps: ‖RᵀR − I‖ {:.1e}, |w| {:.1e}, p·w {:.1e}, p_3 {:.1e}", worst.x, worst.y, worst.z, worst.w);
    assert!(worst.x <= 2e-12, "‖RᵀR − I‖ = {:e}", worst.x);
    assert!(worst.y <= 3e-12, "|w| is off by {:e}", worst.y);
    assert!(worst.z <= 3e-12, "p·w is off by {:e}", worst.z);

    let [first, last] = windows;
    println!("energy {start}: means +{:e} and +{:e}", first.mean(), last.mean());
    println!("extremes {:e} {:e} and {:e} {:e}", first.lowest, first.highest, last.lowest, last.highest);
    assert!((first.mean() - last.mean()).abs() <= 1e-10 * start);
    // Half a unit of the fourth digit.
    let allowed = 5e-4 * (first.highest - first.lowest);
    assert!((first.lowest - last.lowest).abs() < allowed && (first.highest - last.highest).abs() < allowed);

    assert_random_walk(&defects);
    worst
}

#[test]
fn t3_ten_million_steps_neither_drift_nor_leave_the_group() {
    let (stepper, start) = looping_top();
    let mut state = start;
    let worst = assert_kept(&stepper, &start, 10_000_000, || {
        stepper.step(&mut state).unwrap();
        *state
    });
    assert!(worst.w == 0.0, "p_3 has changed by {:e}", worst.w);
}

#[test]
#[ignore = "a hundred million steps"]
fn t3_a_hundred_million_steps_neither_drift_nor_leave_the_group() {
    let (stepper, start) = looping_top();
    let mut state = start;
    let worst = assert_kept(&stepper, &start, 100_000_000, || {
        stepper.step(&mut state).unwrap();
        *state
    });
    assert!(worst.w == 0.0, "p_3 has changed by {:e}", worst.w);
}

/// The same, with compensated sums, and that they gain something. They carry even what plain ones drop of `p_3`: the
/// change of it is zero but for the roundings of its three products, some last digits in all these steps.
#[allow(clippy::cast_precision_loss)] // a hundred million
fn assert_kept_better(steps: u64) {
    let (stepper, start) = looping_top();
    let carrying = stepper.clone().compensated();
    let mut state = carrying.adopt(&start);
    let worst = assert_kept(&stepper, &start, steps, || {
        carrying.step(&mut state).unwrap();
        *state
    });
    // Of independent changes, each wrong by an ε of the angle of a step.
    assert!(worst.amax() <= 1e-16 * (steps as f64).sqrt(), "compensated: {worst}");
    assert!(worst.w <= 1e-13, "p_3 has changed by {:e}", worst.w);
}

#[test]
#[ignore = "ten million steps"]
fn t3_ten_million_compensated_steps() {
    assert_kept_better(10_000_000);
}

#[test]
#[ignore = "a hundred million steps"]
fn t3_a_hundred_million_compensated_steps() {
    assert_kept_better(100_000_000);
}

/// Growth like `√N`: nothing gets farther than four standard deviations of a walk whose steps are the changes from
/// sample to sample. Were these all alike, a drift, the end of a thousand would be at thirty-two.
fn assert_random_walk(defects: &[Defects]) {
    for k in 0..8 {
        let deviation = defects.windows(2).map(|pair| (pair[1][k] - pair[0][k]).powi(2)).sum::<f64>().sqrt();
        let farthest = defects.iter().map(|defect| defect[k].abs()).fold(0.0, f64::max);
        println!("defect {k}: {farthest:.1e}, {:.2} standard deviations", farthest / deviation);
        assert!(farthest < 4.0 * deviation, "defect {k} drifts: {farthest:e} against {deviation:e}");
    }
}
