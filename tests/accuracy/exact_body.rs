//! The exact flow of a free body, compared with a solution without elliptic functions, to 32 digits.

use checks::order::{end, error};
use checks::random::Random;
use declarations::{FreeBody, HeavyTop, Motion};
use liestep::methods::{ExactBody, KineticFlow, SplittingScheme, Turn};
use liestep::numbers::{Lanes, Real};
use liestep::prelude::*;
use nalgebra::{Matrix3, RealField, Rotation3, Vector3};
use simba::simd::{AutoF64x8, WideF32x8, WideF64x4};
use workbench::measure::relative;

use crate::many_digits::{DoubleDouble, Matrix, Vector, free_body, long};

fn body(moments: [f64; 3]) -> Inertia {
    Inertia::from_principal_moments(moments.into()).unwrap()
}

fn exact(moments: [f64; 3]) -> ExactBody {
    ExactBody::new(&body(moments))
}

fn drifted<K: KineticFlow<T>, T: Real>(body: &K, h: T, momentum: &Vector3<T>) -> Turn<T> {
    K::advance(&body.drift(h).unwrap(), momentum).unwrap()
}

const SHAPES: [(&str, [f64; 3]); 16] = [
    ("asymmetric", [1.6, 2.6, 3.0]),
    ("in another order", [2.6, 3.0, 1.6]),
    ("in a third", [3.0, 1.6, 2.6]),
    ("in a left-handed one", [1.6, 3.0, 2.6]),
    ("flat", [1.0, 2.0, 3.0]),
    ("flat and symmetric", [1.0, 1.0, 2.0]),
    ("rod", [1.0, 1.000_001, 1e-6]),
    ("symmetric rod", [1.0, 1.0, 1e-6]),
    ("needle", [1e-9, 1.0, 1.0]),
    ("prolate", [2.0, 2.0, 1.0]),
    ("oblate", [3.0, 3.0, 4.0]),
    ("spherical", [2.5, 2.5, 2.5]),
    ("nearly spherical", [2.5, 2.5 + 1e-9, 2.5 + 2e-9]),
    ("nearly symmetric", [2.0, 2.0 + 1e-12, 3.0]),
    ("plate", [1.0, 1e-3, 1.001 - 1e-9]),
    ("large", [1.6e9, 2.6e9, 3e9]),
];

/// Spins about and near each axis, on and near the separatrix of some shapes, and in general position.
fn starts(moments: [f64; 3], random: &mut Random) -> Vec<Vector3<f64>> {
    let mut sorted = [0, 1, 2];
    sorted.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    let [low, middle, high] = sorted.map(|k| moments[k]);
    // The separatrix has 2 E = |p|²/J_c.
    let mut separatrix = Vector3::zeros();
    separatrix[sorted[0]] = (1.0 / middle - 1.0 / high).max(0.0).sqrt();
    separatrix[sorted[2]] = (1.0 / low - 1.0 / middle).max(0.0).sqrt();
    separatrix[sorted[1]] = 0.3 * separatrix.norm();
    let mut starts = vec![Vector3::x(), Vector3::y(), Vector3::z()];
    starts.extend([Vector3::new(1e-9, 1.0, 1e-9), Vector3::new(1.0, 1e-9, -1e-9), Vector3::new(-1e-9, 1e-9, 1.0)]);
    if separatrix.norm() > 0.0 {
        starts.extend([separatrix.normalize(), separatrix.normalize() + random.vector() * 1e-6]);
    }
    starts.extend((0..3).map(|_| random.direction()));
    starts
}

/// The tolerance in units in the last place of the largest entry; it is multiplied by the motion's own amplification of
/// such an error of the momentum.
const WITHIN: f64 = 8.0;

/// The amplification of a relative change of the momentum during the motion: about the angle, and exponential near the
/// separatrix.
fn growth(turn: impl Fn(&Vector3<f64>, f64) -> (Matrix, Vector), p: &Vector3<f64>) -> f64 {
    let size = p.norm();
    let grown = |part: f64| {
        let there = turn(p, part);
        let by = |k: usize| {
            let mut other = *p;
            other[k] += 1e-14 * size;
            let moved = turn(&other, part);
            let of_f = (moved.0 - there.0).map(DoubleDouble::rounded).amax();
            of_f.max((moved.1 - there.1).map(DoubleDouble::rounded).amax() / size) / 1e-14
        };
        by(0).max(by(1)).max(by(2))
    };
    [0.5, 1.0].into_iter().map(grown).fold(0.0, f64::max)
}

#[test]
fn it_is_the_solution_to_the_last_digits() {
    let mut random = Random::new(61);
    let mut worst_of_all = [0.0_f64; 2];
    for (name, moments) in SHAPES {
        let (exact, moments) = (exact(moments), Vector3::from(moments));
        let inverse = moments.map(|moment| long(1.0) / long(moment));
        for angle in [1e-9, 1e-3, 0.1, 0.17, 0.3, 0.45, 0.6, 1.0, 2.0, 4.0, 12.0] {
            for p in starts(moments.into(), &mut random) {
                for sign in [1.0, -1.0].into_iter().skip(usize::from(angle > 1.0)) {
                    let h = sign * angle / p.component_div(&moments).norm();
                    let found = drifted(&exact, h, &p);
                    let reference = |p: &Vector3<f64>, part: f64| {
                        free_body::turn(&inverse, &p.map(DoubleDouble::from), long(h * part))
                    };
                    let (increment, change) = reference(&p, 1.0);
                    let grown = if angle > 1.0 { growth(reference, &p) } else { angle };
                    let apart = |a: f64, b: DoubleDouble| (long(a) - b).rounded().abs() / f64::EPSILON;
                    let of_f = found.increment.zip_map(&increment, apart).amax();
                    // The error is relative to F − I, or to F if that isn't near the identity.
                    let of_f = of_f / if angle > 1.0 { 1.0 } else { increment.map(DoubleDouble::rounded).amax() };
                    let of_p = found.change.zip_map(&change, apart).amax() / p.amax();
                    let off = of_f.max(of_p);
                    assert!(off <= WITHIN * (1.0 + grown), "{name}, {angle} rad: {off:.1}, {grown:.1}, {p}");
                    let of = &mut worst_of_all[usize::from(angle > 1.0)];
                    *of = of.max(if angle > 1.0 { off / grown } else { off });
                }
            }
        }
    }
    let [near, far] = worst_of_all;
    println!("{near:.1} units in the last place up to a radian, {far:.1} times the growth beyond");
}

/// Several steps and one long step lead to the same end.
#[test]
fn it_is_a_group() {
    let mut random = Random::new(62);
    for (name, moments) in SHAPES {
        for total in [0.1, 1.0, 5.0] {
            let (exact, p) = (exact(moments), random.direction());
            let h = total / p.component_div(&Vector3::from(moments)).norm();
            let whole = drifted(&exact, h, &p);
            let share = random.signed().abs();
            let first = drifted(&exact, h * share, &p);
            let second = drifted(&exact, h * (1.0 - share), &(p + first.change));
            let both = first.increment + second.increment + first.increment * second.increment;
            let (of_f, of_p) = ((both - whole.increment).amax(), (first.change + second.change - whole.change).amax());
            assert!(of_f.max(of_p) < 4e-15 * (1.0 + total), "{name}, {total} rad: {of_f:e}, {of_p:e}");
        }
    }
}

#[test]
fn s5_a_drift_back_undoes_a_drift() {
    let mut random = Random::new(63);
    let mut worst = 0.0_f64;
    for (name, moments) in SHAPES {
        for angle in [1e-3, 0.3, 0.6, 2.0] {
            let (exact, p) = (exact(moments), random.direction());
            let h = angle / p.component_div(&Vector3::from(moments)).norm();
            let there = drifted(&exact, h, &p);
            let back = drifted(&exact, -h, &(p + there.change));
            let both = there.increment + back.increment + there.increment * back.increment;
            let missed = both.amax().max((there.change + back.change).amax());
            worst = worst.max(missed);
            assert!(missed < 2e-15 * (1.0 + angle), "{name}, {angle} rad: {missed:e}");
        }
    }
    println!("{worst:.1e}");
    let none = drifted(&exact(SHAPES[0].1), 0.0, &Vector3::new(1.0, 2.0, 3.0));
    assert_eq!((none.increment, none.change), (Matrix3::zeros(), Vector3::zeros()));
}

/// The invariants `|Π|`, energy, `R Π` and `RᵀR` over a million steps.
#[test]
fn what_a_free_body_keeps_is_kept() {
    for (name, moments) in SHAPES {
        let J_d = NonstandardInertia::from_principal_moments(moments.into()).unwrap();
        let velocity = Vector3::new(0.3, 0.7, -0.5).component_div(&Vector3::from(moments)).normalize();
        // In steps of three radians the increments are as large as the sums; if each is the same turn, the rounding
        // errors are the same, too, one for each step.
        let mut sorted = moments;
        sorted.sort_by(f64::total_cmp);
        let [low, middle, high] = sorted;
        let of_one_turn = 1e6 * f64::EPSILON;
        let turns_alike = low < 0.01 * high || (middle - low).min(high - middle) < 1e-3 * high;
        let usual = if turns_alike { of_one_turn } else { 5e-12 };
        for (h, allowed) in [(0.1, usual), (0.5, usual), (3.0, of_one_turn)] {
            let stepper = Stepper::split(FreeBody { J_d }, h, exact(moments), SplittingScheme::STRANG).unwrap();
            let mut state = stepper.start(SO3::identity(), velocity).unwrap();
            let (energy, momentum) = (stepper.energy(&state), state.spatial_momentum());
            stepper.run(&mut state, 1_000_000).unwrap();
            let of_energy = (stepper.energy(&state) / energy - 1.0).abs();
            let of_size = (state.momentum().norm() / momentum.norm() - 1.0).abs();
            let of_momentum = relative(&state.spatial_momentum(), &momentum);
            let defect = state.orthogonality_defect();
            println!("{name}, {h}: {of_energy:.1e}, {of_size:.1e}, {of_momentum:.1e}, {defect:.1e}");
            let worst = of_energy.max(of_size).max(of_momentum).max(defect);
            assert!(worst < allowed, "{name}, {h}: {of_energy:e}, {of_size:e}, {of_momentum:e}, {defect:e}");
        }
    }
}

/// The middle axis is an equilibrium for any time, also as the limit of a motion on the separatrix.
#[test]
fn it_stays_where_it_is_at_rest() {
    let exact = exact([1.6, 2.6, 3.0]);
    for h in [1.0, 1e3, 1e6, 1e9] {
        let turn = drifted(&exact, h, &Vector3::y());
        assert!(turn.change.amax() < 1e-15, "{h}: {}", turn.change);
        let about = turn.increment + Matrix3::identity();
        let defect = (about.transpose() * about - Matrix3::identity()).norm();
        assert!(defect < 1e-14 && (about.m22 - 1.0).abs() < 1e-14, "{h}: {about}");
    }
    for h in [1e2, 1e5, 1e8] {
        for p in starts([1.6, 2.6, 3.0], &mut Random::new(64)) {
            let turn = drifted(&exact, h, &p);
            let f = turn.increment + Matrix3::identity();
            let defect = (f.transpose() * f - Matrix3::identity()).norm();
            assert!(defect < 1e-14, "{h}, {p}: {defect:e}");
        }
    }
}

/// A body described in other axes than the principal ones has the same motion.
#[test]
fn any_axes_will_do() {
    let mut random = Random::new(65);
    for (name, moments) in SHAPES {
        let axes = random.rotation().matrix();
        let turned = axes * body(moments).as_matrix() * axes.transpose();
        let turned = ExactBody::new(&Inertia::new((turned + turned.transpose()) * 0.5).unwrap());
        let p = random.direction();
        // A rounding of the tensor is one of its smallest moment, too.
        let smallest = moments.into_iter().fold(f64::INFINITY, f64::min);
        let lost = moments.into_iter().fold(0.0, f64::max) / smallest;
        for angle in [1e-3, 0.3, 3.0] {
            let h = angle / p.component_div(&Vector3::from(moments)).norm();
            let (own, found) = (drifted(&exact(moments), h, &p), drifted(&turned, h, &(axes * p)));
            let expected = axes * own.increment * axes.transpose();
            let error = (found.increment - expected).amax().max((found.change - axes * own.change).amax());
            assert!(error < 1e-15 * angle.max(1e-1) * (10.0 + lost), "{name}, {angle}: {error:e}");
        }
    }
}

/// The reference motions of free bodies, in one step.
#[test]
fn free_bodies_move_exactly_in_one_step() {
    for name in ["free", "free flip", "free symmetric"] {
        let motion = Motion::read(name);
        for (t, expected) in motion.states() {
            let flow = ExactBody::new(&motion.top.ordinary_inertia());
            let stepper = Stepper::split(motion.top.clone(), *t, flow, SplittingScheme::STRANG).unwrap();
            let error = error(&end(&stepper, &motion, 1), expected);
            println!("{name}, {t} s: {error:.1e}");
            assert!(error < 1e-14 * (10.0 + t), "{name}, {t} s: {error:e}");
        }
    }
}

#[test]
fn single_precision_is_as_good_as_it_can_be() {
    let mut random = Random::new(67);
    for (name, moments) in SHAPES {
        let single = body(moments).as_matrix().map(nalgebra::convert::<f64, f32>);
        // The thinnest shapes are singular in single precision, and are left out.
        let Ok(single) = Inertia::new(single) else { continue };
        let rounded = single.as_matrix().diagonal().map(f64::from);
        let Ok(double) = Inertia::from_principal_moments(rounded) else { continue };
        let (single, double) = (ExactBody::new(&single), ExactBody::new(&double));
        for angle in [1e-3, 0.3, 3.0] {
            let p = random.direction().map(nalgebra::convert::<f64, f32>);
            let h: f32 = nalgebra::convert(angle / p.map(f64::from).component_div(&rounded).norm());
            let (expected, found) = (drifted(&double, f64::from(h), &p.map(f64::from)), drifted(&single, h, &p));
            let error = (found.increment.map(f64::from) - expected.increment).amax() / expected.increment.amax();
            assert!(error < 1e-6 * (1.0 + angle), "{name}, {angle}: {error:e}");
        }
    }
}

/// Some lanes are short, some need the longer polynomials and some are doubled; some have axes of their own.
#[test]
fn each_lane_moves_as_alone() {
    fn assert_independent<T, const LANES: usize>()
    where
        T: Real<Element: Real + RealField>,
    {
        let mut random = Random::new(68);
        let converted = |v: Vector3<f64>| v.map(nalgebra::convert::<f64, T::Element>);
        for fastest in [0.5, 4.0, 100.0] {
            for turned in [0.0, 0.1] {
                let axes = Rotation3::new(Vector3::new(0.3, -0.2, 0.4) * turned).into_inner();
                let bodies: [Inertia<T::Element>; LANES] = core::array::from_fn(|_| {
                    let moments = Matrix3::from_diagonal(&(Vector3::new(2.0, 4.0, 3.0) + random.vector() * 0.2));
                    let tensor = axes * moments * axes.transpose();
                    Inertia::new(((tensor + tensor.transpose()) * 0.5).map(nalgebra::convert)).unwrap()
                });
                let mut size = fastest;
                let momenta = [(); LANES].map(|()| {
                    size *= 0.5;
                    converted(random.direction() * size)
                });
                let together = ExactBody::<T>::new(&Lanes::gathered(&bodies).unwrap());
                let momentum = Vector3::gathered(&momenta).unwrap();
                let turn = drifted(&together, nalgebra::convert(0.3), &momentum);
                for k in 0..LANES {
                    let alone = ExactBody::<T::Element>::new(&bodies[k]);
                    let single = drifted(&alone, nalgebra::convert(0.3), &momenta[k]);
                    assert_eq!(turn.increment.lane(k), single.increment, "{fastest}, lane {k}");
                    assert_eq!(turn.change.lane(k), single.change, "{fastest}, lane {k}");
                }
            }
        }
    }
    assert_independent::<WideF64x4, 4>();
    assert_independent::<AutoF64x8, 8>();
    assert_independent::<WideF32x8, 8>();
}

/// Lanes whose middle moments belong to different axes.
#[test]
fn lanes_may_have_their_moments_in_any_order() {
    let moments = [[1.6, 2.6, 3.0], [2.6, 1.6, 3.0], [3.0, 1.6, 2.6], [2.0, 2.0, 2.0]];
    let together = ExactBody::<WideF64x4>::new(&Lanes::gathered(&moments.map(body)).unwrap());
    let p = Vector3::new(1.0, -2.0, 3.0);
    let turn = drifted(&together, nalgebra::convert(0.3), &p.map(nalgebra::convert::<f64, WideF64x4>));
    for (k, moments) in moments.into_iter().enumerate() {
        let alone = drifted(&exact(moments), 0.3, &p);
        assert!((turn.increment.lane(k) - alone.increment).norm() < 1e-15, "{moments:?}");
    }
}

#[test]
fn what_is_not_finite_is_refused() {
    let top = HeavyTop::asymmetric();
    let kinetic = ExactBody::new(&top.ordinary_inertia());
    assert!(matches!(kinetic.drift(f64::NAN), Err(SetupError::InvalidStep { .. })));
    let splitting = Stepper::split(top, 0.1, kinetic, SplittingScheme::STRANG).unwrap();
    let mut state = splitting.start_with_momentum(SO3::identity(), Vector3::repeat(1e200)).unwrap();
    let before = state;
    let error = splitting.step(&mut state).unwrap_err();
    assert!(matches!(error, StepError::NonFinite { .. }), "{error}");
    assert_eq!(state, before);
}
