//! P8: the same cases in `f32`, with the thresholds of `f64` in units of its ε: what is 10⁻¹⁴ there is 45 ε, 10⁻¹³ is
//! 450 ε, 2·10⁻¹² is 9000 ε.

use declarations::Motion;
use liestep::groups::LieGroup as _;
use liestep::mechanics::{DiagonalNonstandardInertia, DiscreteLagrangian, Effect as _, InertiaError, Regular};
use liestep::numbers::Real;
use liestep::{NonstandardInertia, SO3, State, StepError, Stepper, lagrangian};
use nalgebra::{Matrix3, RealField, Vector3, convert};
use workbench::measure::{four_halvings, order, relative, steps_in};

/// (3.13) in principal axes.
#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - 0.5 * h * m * g * w.dot(&(rho + F * rho)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Top<T: Real> {
    J_d: DiagonalNonstandardInertia<T>,
    m: T,
    g: T,
    rho: Vector3<T>,
    up: Vector3<T>,
}

/// The kinetic term of (3.13) alone.
#[lagrangian(group = SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Body<T: Real> {
    J_d: NonstandardInertia<T>,
}

type TopState = State<SO3<f32>, Vector3<f32>>;

const EPSILON: f64 = f32::EPSILON as f64;

fn vector<T: RealField + Copy>(vector: &Vector3<f64>) -> Vector3<T> {
    vector.map(|entry| convert(entry))
}

fn double(vector: &Vector3<f32>) -> Vector3<f64> {
    vector.map(f64::from)
}

/// The top of a motion, and where it starts.
fn top<T: RealField + Copy>(motion: &Motion) -> Top<T> {
    Top {
        J_d: DiagonalNonstandardInertia::new(vector(motion.top.J_d.diagonal())).unwrap(),
        m: convert(motion.top.m),
        g: convert(motion.top.g),
        rho: vector(&motion.top.rho),
        up: vector(&motion.top.up),
    }
}

fn attitude<T: RealField + Copy>(motion: &Motion) -> SO3<T> {
    SO3::from_matrix_unchecked(motion.attitude.matrix().map(|entry| convert(entry)))
}

fn started(motion: &Motion, h: f64) -> (Stepper<Top<f32>>, TopState) {
    let stepper = Stepper::new(top(motion), convert(h)).unwrap();
    let state = stepper.start(attitude(motion), vector(&motion.velocity)).unwrap();
    (stepper, state)
}

/// T1: the errors of attitude and velocity after a second, above what `f32` loses by then.
#[test]
fn p8_order_two() {
    for name in ["looping A", "cuspidal A", "third A"] {
        let motion = Motion::read(name);
        let errors = four_halvings(1.0 / 100.0).map(|h| {
            let (stepper, mut state) = started(&motion, h);
            for _ in 0..steps_in(1.0, h) {
                stepper.step(&mut state).unwrap();
            }
            let (attitude, velocity) = motion.at(1.0);
            let found: Matrix3<f64> = state.attitude().matrix().map(f64::from);
            let velocities = relative(&double(&stepper.velocity(&state)), &velocity);
            (h, relative(&found, &attitude).hypot(velocities))
        });
        // A thousand roundings and their twist, well below the smallest error.
        let order = order(&errors, 200.0 * EPSILON);
        println!("{name}: order {order:.4}, {errors:?}");
        assert!((order - 2.0).abs() < 0.05, "{name}: order {order}, {errors:?}");
    }
}

/// T3: a million steps.
#[test]
fn p8_a_million_steps_stay_on_the_group() {
    let (stepper, mut state) = started(&Motion::looping(), 0.01);
    let start = state;
    let vertical = state.momentum().dot(&state.advected());
    // In double precision, so that what is measured isn't the rounding of the measurement.
    let moments = stepper.scene().inertia().diagonal().map(f64::from);
    let energy = |state: &TopState| {
        let p = double(&state.momentum());
        0.5 * p.dot(&p.component_div(&moments)) + f64::from(stepper.scene().potential(&state.advected()))
    };
    let (mut worst, mut means, mut largest) = ([0.0_f64; 3], [0.0_f64; 2], [0.0_f64; 2]);
    let window = 100_000;
    for step in 0..10 * window {
        stepper.step(&mut state).unwrap();
        assert!(state.momentum().z.to_bits() == start.momentum().z.to_bits(), "p_3 changed in step {step}");
        let error = energy(&state) - energy(&start);
        if step < window {
            means[0] += error / f64::from(window);
            largest[0] = largest[0].max(error.abs());
        } else if step >= 9 * window {
            means[1] += error / f64::from(window);
            largest[1] = largest[1].max(error.abs());
        }
        if step % 1000 == 0 {
            let w = state.advected();
            let defects = [state.orthogonality_defect(), w.norm() - 1.0, state.momentum().dot(&w) / vertical - 1.0];
            for (worst, defect) in worst.iter_mut().zip(defects) {
                *worst = worst.max(f64::from(defect).abs());
            }
        }
    }
    let units = worst.map(|defect| defect / EPSILON);
    let drift = (means[1] - means[0]).abs() / energy(&start) / EPSILON;
    println!("‖RᵀR − I‖, |w|, p·w: {units:.0?} ε; energy: drift {drift:.0} ε, largest errors {largest:?} J");
    // A walk of 10⁶ roundings, as in `f64`, where 10⁻¹⁰ is allowed for ten times as many.
    assert!(drift <= 450.0, "the energy's mean has gone {drift} ε");
    assert!(units[0] <= 9000.0 && units[1] <= 13_500.0 && units[2] <= 13_500.0, "{units:?} ε");
}

/// S1: up to 0.999 of the fold a step is solved, in as many iterations as in `f64`, under 91°; above it is refused, and
/// the error names a step that would do.
#[test]
fn p8_step_scan() {
    let motion = Motion::looping();
    let (stepper, state) = started(&motion, 0.1);
    let StepError::BeyondSolvable { largest, .. } = stepper.step(&mut state.clone()).unwrap_err() else { panic!() };
    assert!((largest - 0.0815).abs() < 1e-4, "{largest}");
    for fraction in [0.1, 0.3, 0.6, 0.9, 0.99, 0.999] {
        let (stepper, mut state) = started(&motion, largest * fraction);
        let before = state.attitude();
        let iterations = stepper.step(&mut state).unwrap().iterations;
        let angle = before.inverse().compose(&state.attitude()).log().norm().to_degrees();
        println!("{fraction} of the fold: {iterations} iterations, {angle:.2}°");
        assert!(iterations <= 9 && angle < 91.0, "{iterations} iterations, {angle}°");
    }
    for fraction in [1.001, 1.1, 2.0, 100.0] {
        let (stepper, mut state) = started(&motion, largest * fraction);
        let before = state;
        let error = stepper.step(&mut state).unwrap_err();
        assert!(matches!(error, StepError::BeyondSolvable { .. }), "{error:?}");
        assert_eq!(state, before);
    }
}

/// S4: at rest, without gravity, and hanging.
#[test]
fn p8_at_rest() {
    let motion = Motion::looping();
    let top = top::<f32>(&motion);
    let hanging = Top { up: -top.rho, ..top };
    for (top, attitude) in [(Top { g: 0.0, ..top }, attitude(&motion)), (hanging, SO3::identity())] {
        let stepper = Stepper::new(top, 0.01).unwrap();
        let mut state = stepper.start(attitude, Vector3::zeros()).unwrap();
        let before = state;
        for _ in 0..1000 {
            stepper.step(&mut state).unwrap();
            assert_eq!(
                (state.attitude(), state.momentum(), state.advected()),
                (before.attitude(), before.momentum(), before.advected())
            );
        }
    }
}

/// How far from its start a motion is after a million steps there and back: attitude, momentum and vertical, in ε.
fn there_and_back(motion: &Motion, h: f64) -> [f64; 3] {
    let (there, mut state) = started(motion, h);
    let (back, before) = (Stepper::new(top::<f32>(motion), convert(-h)).unwrap(), state);
    for _ in 0..1_000_000 {
        there.step(&mut state).unwrap();
    }
    for _ in 0..1_000_000 {
        back.step(&mut state).unwrap();
    }
    let errors = [
        f64::from((state.attitude().matrix() - before.attitude().matrix()).norm()) / 3.0_f64.sqrt(),
        relative(&double(&state.momentum()), &double(&before.momentum())),
        relative(&double(&state.advected()), &double(&before.advected())),
    ];
    errors.map(|error| error / EPSILON)
}

/// S5: there and back. It is a walk of roundings, and of neighbouring step sizes one comes back ten times nearer than
/// another: so the median over an octave.
#[test]
fn p8_a_million_steps_there_and_back() {
    let motion = Motion::looping();
    for h in [1e-5, 1e-4] {
        let runs = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]
            .map(|k: f64| there_and_back(&motion, h / 2_f64.powf(k / 8.0)));
        let medians = [0, 1, 2].map(|part| {
            let mut units = runs.map(|units| units[part]);
            units.sort_by(f64::total_cmp);
            units[4]
        });
        println!("h = {h}: {medians:.0?} ε, of {runs:.0?}");
        assert!(medians.iter().all(|&units| units <= 4500.0), "h = {h}: {medians:?} ε");
    }
}

/// The largest relative errors of energy and spatial momentum, in ε.
fn errors<L>(body: L, velocity: [f32; 3], h: f32, steps: u32) -> [f64; 2]
where
    L: DiscreteLagrangian<Scalar = f32, Group = SO3<f32>, Advected = ()> + Regular,
{
    let stepper = Stepper::new(body, h).unwrap();
    let mut state = stepper.start(SO3::identity(), velocity.into()).unwrap();
    // In double precision, so that what is measured isn't the rounding of the measurement.
    let inverse = stepper.scene().inertia().map(f64::from).try_inverse().unwrap();
    let invariants = |state: &State<SO3<f32>, ()>| {
        let p = double(&state.momentum());
        (p.dot(&(inverse * p)), state.attitude().matrix().map(f64::from) * p)
    };
    let (energy, momentum) = invariants(&state);
    let mut worst = [0.0_f64; 2];
    for _ in 0..steps {
        stepper.step(&mut state).unwrap();
        let now = invariants(&state);
        worst[0] = worst[0].max((now.0 / energy - 1.0).abs() / EPSILON);
        worst[1] = worst[1].max(relative(&now.1, &momentum) / EPSILON);
    }
    println!("{velocity:?}: energy {:.1} ε, momentum {:.1} ε", worst[0], worst[1]);
    worst
}

fn body(nonstandard: [f32; 3]) -> Body<f32> {
    Body { J_d: NonstandardInertia::from_diagonal(nonstandard.into()).unwrap() }
}

/// B1 to B4: the box, its middle axis, its stable axis, rods, a plate, a sphere.
#[test]
fn p8_free_bodies_keep_their_energy() {
    let box_body = body([0.01 / 3.0, 0.04 / 3.0, 0.09 / 3.0]);
    let short = errors(box_body, [1.0, 2.0, 3.0], 0.01, 500);
    assert!(short.iter().all(|&error| error <= 45.0), "{short:?} ε");
    for velocity in [[0.05, 5.0, 0.05], [20.0, 0.05, 0.05]] {
        let long = errors(box_body, velocity, 0.005, 20_000);
        assert!(long.iter().all(|&error| error <= 450.0), "{velocity:?}: {long:?} ε");
    }
    for across in [1e-4 / 16.0, 1e-5 / 16.0] {
        let rod = errors(body([across, across, 1.0 / 12.0]), [1.0, 0.5, 3.0], 1.0 / 60.0, 10_000);
        assert!(rod.iter().all(|&error| error <= 450.0), "{across}: {rod:?} ε");
    }
    let plate = errors(body([2.0, 1.0, 0.0]), [1.0, 0.5, 0.3], 1.0 / 60.0, 10_000);
    assert!(plate.iter().all(|&error| error <= 450.0), "{plate:?} ε");
    // A ratio of the moments that `f32` doesn't tell from zero.
    let needle = NonstandardInertia::<f32>::from_diagonal([1e-8 / 16.0, 1e-8 / 16.0, 1.0 / 12.0].into());
    assert!(matches!(needle, Err(InertiaError::Singular { .. })), "{needle:?}");
    let sphere = errors(body([0.2; 3]), [1.0, 2.0, 3.0], 0.01, 10_000);
    assert!(sphere[0] == 0.0, "{sphere:?} ε");
}
