//! The asymmetric body by rotations about its axes.

use checks::random::Random;
use checks::structure::poisson::TOLERANCE;
use declarations::{HeavyTop, Motion};
use liestep::methods::{KineticFlow, PreprocessedOrder, SplitBody, SplittingScheme, SymmetricBody, Turn};
use liestep::numbers::{Lanes, Real};
use liestep::prelude::*;
use nalgebra::{Matrix3, RealField, Rotation3, Vector3};
use simba::simd::{AutoF64x8, WideF32x8, WideF64x4};
use workbench::measure::{order, relative};

use crate::convergence::{End, TOPS, assert_order, counts};
use crate::poisson::poisson_defect;

/// Each of three axes with the middle moment, and each of the others farther from it.
const MOMENTS: [[f64; 3]; 6] =
    [[1.6, 2.6, 3.0], [1.6, 3.0, 2.6], [2.6, 1.6, 3.0], [2.6, 3.0, 1.6], [3.0, 1.6, 2.6], [3.0, 2.6, 1.6]];

fn body(moments: [f64; 3]) -> Inertia {
    Inertia::from_principal_moments(moments.into()).unwrap()
}

fn split<const N: usize>(moments: [f64; 3]) -> SplitBody<N> {
    SplitBody::new(&body(moments)).unwrap()
}

fn drifted<K: KineticFlow<T>, T: Real>(body: &K, h: T, momentum: &Vector3<T>) -> Turn<T> {
    K::advance(&body.drift(h).unwrap(), momentum).unwrap()
}

fn end<const N: usize>(scheme: SplittingScheme, motion: &Motion, h: f64, steps: u32) -> End {
    let kinetic = SplitBody::<N>::new(&motion.top.ordinary_inertia()).unwrap();
    let splitting = Stepper::split(motion.top.clone(), h, kinetic, scheme).unwrap();
    let mut state = splitting.start(motion.attitude, motion.velocity).unwrap();
    splitting.run(&mut state, steps.into()).unwrap();
    (state.attitude(), splitting.velocity(&state))
}

#[test]
fn free_bodies_move_to_order_4() {
    for (motion, coarsest) in [("free", 100), ("free flip", 100)] {
        let counts = counts(coarsest, 2.0, 5);
        let strang = SplittingScheme::STRANG;
        assert_order(("seven rotations", 4), (motion, 10.0), &counts, |m, h, steps| end::<7>(strang, m, h, steps));
        assert_order(("nine rotations", 4), (motion, 10.0), &counts, |m, h, steps| end::<9>(strang, m, h, steps));
    }
}

#[test]
fn tops_move_to_order_4() {
    let (scheme, chaotic) = (SplittingScheme::NYSTROM_6, (TOPS[3], 10.0));
    let counts = counts(160, 1.5, 5);
    assert_order(("seven rotations", 4), chaotic, &counts, |m, h, steps| end::<7>(scheme, m, h, steps));
    assert_order(("nine rotations", 4), chaotic, &counts, |m, h, steps| end::<9>(scheme, m, h, steps));
}

/// Attitude and momentum of a free body after some time.
fn moved<K: KineticFlow<f64>>(body: &K, t: f64, steps: u32, momentum: &Vector3<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    let drift = body.drift(t / f64::from(steps)).unwrap();
    let (mut attitude, mut momentum) = (Matrix3::identity(), *momentum);
    for _ in 0..steps {
        let turn = K::advance(&drift, &momentum).unwrap();
        attitude += attitude * turn.increment;
        momentum += turn.change;
    }
    (attitude, momentum)
}

/// The same by another method, to rounding.
fn expected(moments: [f64; 3], t: f64, momentum: &Vector3<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    let nonstandard = liestep::mechanics::DiagonalNonstandardInertia::from_principal_moments(moments.into()).unwrap();
    let steps = 1000;
    let body = Stepper::preprocessed(PrincipalBody { J_d: nonstandard }, t / f64::from(steps), PreprocessedOrder::Ten)
        .unwrap();
    let mut state = body.start_with_momentum(SO3::identity(), *momentum).unwrap();
    for _ in 0..steps {
        body.step(&mut state).unwrap();
    }
    (state.attitude().matrix(), state.momentum())
}

#[test]
fn any_axis_may_have_the_middle_moment() {
    fn assert_near<const N: usize>(moments: [f64; 3]) {
        let momentum = Vector3::new(1.0, -2.0, 3.0);
        let (attitude, at_end) = expected(moments, 3.0, &momentum);
        let found = moved(&split::<N>(moments), 3.0, 600, &momentum);
        let error = relative(&found.0, &attitude).hypot(relative(&found.1, &at_end));
        println!("{N} rotations, {moments:?}: {error:.1e}");
        assert!(error < 2e-12, "{N} rotations, {moments:?}: {error:e}");
    }
    for moments in MOMENTS {
        assert_near::<7>(moments);
        assert_near::<9>(moments);
    }
}

/// Where one coefficient is a millionth of the other, only its first power is seen.
#[test]
fn nine_rotations_are_of_order_6_for_nearly_symmetric_bodies() {
    fn measured<const N: usize>() -> f64 {
        let (moments, momentum, t) = ([1.6, 3.0, 3.000_01], Vector3::new(2.0, -2.0, 3.0), 12.0);
        let (attitude, at_end) = expected(moments, t, &momentum);
        let errors = [12, 15, 18, 22].map(|steps| {
            let found = moved(&split::<N>(moments), t, steps, &momentum);
            (t / f64::from(steps), relative(&found.0, &attitude).hypot(relative(&found.1, &at_end)))
        });
        let order = order(&errors, 1e-13);
        println!("{N} rotations: order {order:.2}, {errors:?}");
        order
    }
    let (seven, nine) = (measured::<7>(), measured::<9>());
    assert!((seven - 4.0).abs() < 0.5 && (nine - 6.0).abs() < 0.5, "{seven}, {nine}");
}

/// The rotations one by one, with sines and cosines of the library, about axes found by sorting.
fn one_by_one(half: &[f64], moments: [f64; 3], h: f64, p: &Vector3<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    let mut sorted = [0, 1, 2];
    sorted.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    let [low, middle, high] = sorted;
    let coefficient = |axis: usize| 1.0 / moments[axis] - 1.0 / moments[middle];
    let low_is_smaller = coefficient(low).abs() < coefficient(high).abs();
    // The seven begin with the larger.
    let axes = if low_is_smaller == (half.len() == 5) { [low, high] } else { [high, low] };
    let mut f = Rotation3::new(p * (h / moments[middle]));
    let mut p = *p;
    for (k, share) in half.iter().chain(half.iter().rev().skip(1)).enumerate() {
        let axis = axes[k % 2];
        let mut angle = Vector3::zeros();
        angle[axis] = h * share * coefficient(axis) * p[axis];
        let turn = Rotation3::new(angle);
        (f, p) = (f * turn, turn.inverse() * p);
    }
    (f.into_inner(), p)
}

/// The shares of seven and of nine rotations, to the middle.
pub(crate) fn halves() -> ([f64; 4], [f64; 5]) {
    let root = 2.0_f64.cbrt();
    let (outer, inner) = (0.5 / (2.0 - root), 0.5 * (1.0 - root) / (2.0 - root));
    let nine = [
        0.095_364_558_526_318,
        0.627_486_550_465_929,
        1.096_765_141_814_988,
        -0.127_486_550_465_929,
        -1.384_259_400_682_613,
    ];
    ([outer, 2.0 * outer, inner, 1.0 - 4.0 * outer], nine)
}

/// From angles that are nothing beside one to those of several turns.
#[test]
fn they_are_the_rotations_one_after_another() {
    let (seven, nine) = halves();
    let mut random = Random::new(51);
    for moments in MOMENTS {
        for size in [1e-7, 0.01, 1.0, 4.0, 10.0, 30.0, 100.0] {
            let p = random.direction() * size;
            for h in [0.7, -0.7] {
                for (half, turn) in [
                    (&seven[..], drifted(&split::<7>(moments), h, &p)),
                    (&nine[..], drifted(&split::<9>(moments), h, &p)),
                ] {
                    let (f, after) = one_by_one(half, moments, h, &p);
                    // A rounding of an angle is in proportion to it, and changes all that come after.
                    let allowed = 1e-14 + 1e-14 * size * size;
                    let of_f = (turn.increment + Matrix3::identity() - f).norm();
                    let of_p = (p + turn.change - after).norm() / size;
                    assert!(of_f < allowed && of_p < allowed, "{moments:?}, {size}: {of_f:e}, {of_p:e}");
                }
            }
        }
    }
}

#[test]
fn symmetric_bodies_move_exactly() {
    fn assert_exact<const N: usize>(moments: [f64; 3], h: f64, p: &Vector3<f64>) {
        let exact = drifted(&SymmetricBody::new(&body(moments)).unwrap(), h, p);
        let found = drifted(&split::<N>(moments), h, p);
        assert!((found.increment - exact.increment).norm() < 4e-15, "{moments:?}: {found:?}, {exact:?}");
        assert!((found.change - exact.change).norm() < 4e-15 * p.norm(), "{moments:?}: {found:?}, {exact:?}");
    }
    for moments in [[3.0, 3.0, 4.0], [3.0, 3.0, 1.0], [3.0, 3.0, 3.0]] {
        for h in [-0.2, 0.01, 1.0] {
            let p = Vector3::new(1.0, -2.0, 3.0);
            assert_exact::<7>(moments, h, &p);
            assert_exact::<9>(moments, h, &p);
        }
    }
}

#[test]
fn p1_they_are_poisson_maps() {
    fn assert_poisson<const N: usize>(moments: [f64; 3], scheme: SplittingScheme, h: f64, random: &mut Random) {
        let nonstandard =
            liestep::mechanics::DiagonalNonstandardInertia::from_principal_moments(moments.into()).unwrap();
        let top = HeavyTop { J_d: nonstandard, ..HeavyTop::asymmetric() };
        let (momentum, w) = (random.vector() * 3.0, random.vector());
        let defect = poisson_defect(&top, || split::<N>(moments), (scheme, h), (&momentum, &w));
        println!("{N} rotations, {moments:?}, {}, h = {h}: {defect:.1e}", scheme.name());
        assert!(defect < TOLERANCE, "{N} rotations, {moments:?}, {}, h = {h}: {defect:e}", scheme.name());
    }
    let mut random = Random::new(52);
    for moments in MOMENTS {
        for scheme in [SplittingScheme::STRANG, SplittingScheme::NYSTROM_6] {
            for h in [0.1, 0.5] {
                assert_poisson::<7>(moments, scheme, h, &mut random);
                assert_poisson::<9>(moments, scheme, h, &mut random);
            }
        }
    }
}

/// A million steps: `R p` of the free body, the momentum about the vertical of a top, and rotations that stay rotations.
#[test]
fn momenta_are_kept() {
    fn assert_kept<const N: usize>(motion: &Motion, scheme: SplittingScheme, h: f64) {
        let kinetic = SplitBody::<N>::new(&motion.top.ordinary_inertia()).unwrap();
        let splitting = Stepper::split(motion.top.clone(), h, kinetic, scheme).unwrap();
        let mut state = splitting.start(motion.attitude, motion.velocity).unwrap();
        let before = state.spatial_momentum();
        splitting.run(&mut state, 1_000_000).unwrap();
        let after = state.spatial_momentum();
        let is_free = motion.top.m * motion.top.g == 0.0;
        let moved = if is_free { relative(&after, &before) } else { ((after.z - before.z) / before.z).abs() };
        let defect = state.orthogonality_defect();
        println!("{N} rotations, {}: momentum {moved:.1e}, orthogonality {defect:.1e}", scheme.name());
        assert!(moved < 1e-12 && defect < 1e-12, "{N} rotations: {moved:e}, {defect:e}");
    }
    for name in ["free", TOPS[3]] {
        let motion = Motion::read(name);
        assert_kept::<7>(&motion, SplittingScheme::STRANG, 0.05);
        assert_kept::<9>(&motion, SplittingScheme::STRANG, 0.05);
        assert_kept::<9>(&motion, SplittingScheme::NYSTROM_6, 0.2);
    }
}

#[test]
fn s5_a_drift_back_undoes_a_drift() {
    fn assert_undone<const N: usize>(moments: [f64; 3], p: &Vector3<f64>) {
        let there = drifted(&split::<N>(moments), 0.3, p);
        let back = drifted(&split::<N>(moments), -0.3, &(p + there.change));
        assert!((there.change + back.change).norm() < 1e-14 * p.norm(), "{moments:?}");
        let both = there.increment + back.increment + there.increment * back.increment;
        assert!(both.norm() < 1e-14, "{moments:?}: {both}");
    }
    let mut random = Random::new(53);
    for moments in MOMENTS {
        let p = random.vector() * 5.0;
        assert_undone::<7>(moments, &p);
        assert_undone::<9>(moments, &p);
    }
    let none = drifted(&split::<9>(MOMENTS[0]), 0.0, &Vector3::new(1.0, 2.0, 3.0));
    assert_eq!((none.increment, none.change), (Matrix3::zeros(), Vector3::zeros()));
}

#[test]
fn single_precision_is_as_good_as_it_can_be() {
    let mut random = Random::new(54);
    // The last is a needle, some powers of whose rates a single hasn't.
    for moments in MOMENTS.into_iter().chain([[1e-5, 1.0, 1.000_005]]) {
        let p = random.vector();
        let single = body(moments).as_matrix().map(nalgebra::convert::<f64, f32>);
        let single = SplitBody::<9, f32>::new(&Inertia::new(single).unwrap()).unwrap();
        for h in [1e-3, 1e-6] {
            let exact = drifted(&split::<9>(moments), h, &p);
            let found = drifted(&single, nalgebra::convert(h), &p.map(nalgebra::convert::<f64, f32>));
            let angle = h * (p.x / moments[0]).abs();
            let error = (found.increment.map(f64::from) - exact.increment).norm();
            assert!(error < 1e-6 * (h + angle), "{moments:?}, h = {h}: {error:e}");
        }
    }
}

/// Some lanes turn by more than the polynomials are for, and some don't.
#[test]
fn each_lane_moves_as_alone() {
    fn assert_independent<T, const LANES: usize>()
    where
        T: Real<Element: Real + RealField>,
    {
        let mut random = Random::new(55);
        let converted = |v: Vector3<f64>| v.map(nalgebra::convert::<f64, T::Element>);
        for fastest in [1.0, 40.0] {
            let bodies: [Inertia<T::Element>; LANES] = core::array::from_fn(|_| {
                let moments = Vector3::new(2.0, 4.0, 3.0) + random.vector() * 0.2;
                Inertia::from_principal_moments(converted(moments)).unwrap()
            });
            let mut size = fastest;
            let momenta = [(); LANES].map(|()| {
                size *= 0.5;
                converted(random.direction() * size)
            });
            let together = SplitBody::<9, T>::new(&Lanes::gathered(&bodies).unwrap()).unwrap();
            let momentum = Vector3::gathered(&momenta).unwrap();
            let turn = drifted(&together, nalgebra::convert(0.3), &momentum);
            for k in 0..LANES {
                let alone = SplitBody::<9, T::Element>::new(&bodies[k]).unwrap();
                let single = drifted(&alone, nalgebra::convert(0.3), &momenta[k]);
                assert_eq!(turn.increment.lane(k), single.increment, "{fastest}, lane {k}");
                assert_eq!(turn.change.lane(k), single.change, "{fastest}, lane {k}");
            }
        }
    }
    assert_independent::<WideF64x4, 4>();
    assert_independent::<AutoF64x8, 8>();
    assert_independent::<WideF32x8, 8>();
}

#[test]
fn other_axes_are_refused() {
    let turned = Rotation3::new(Vector3::new(0.0, 0.0, 1e-3));
    let tilted = turned.matrix() * body([2.0, 3.0, 4.0]).as_matrix() * turned.matrix().transpose();
    let inertia = Inertia::new((tilted + tilted.transpose()) * 0.5).unwrap();
    assert_eq!(
        SplitBody::<7>::new(&inertia).unwrap_err(),
        SetupError::Parameter { field: "inertia", cause: "is not along the principal axes" },
    );
    let lanes = [MOMENTS[0], MOMENTS[0], MOMENTS[1], MOMENTS[0]].map(body);
    assert_eq!(
        SplitBody::<9, WideF64x4>::new(&Lanes::gathered(&lanes).unwrap()).unwrap_err(),
        SetupError::Parameter { field: "inertia", cause: "has its moments in another order in other lanes" },
    );
}

#[test]
fn what_is_not_finite_is_refused() {
    assert!(matches!(split::<7>(MOMENTS[0]).drift(f64::NAN), Err(SetupError::InvalidStep { .. })));
    let top = HeavyTop::asymmetric();
    let kinetic = SplitBody::<7>::new(&top.ordinary_inertia()).unwrap();
    let splitting = Stepper::split(top, 0.1, kinetic, SplittingScheme::STRANG).unwrap();
    let mut state = splitting.start_with_momentum(SO3::identity(), Vector3::repeat(1e200)).unwrap();
    let before = state;
    let error = splitting.step(&mut state).unwrap_err();
    assert!(matches!(error, StepError::NonFinite { .. }), "{error}");
    assert_eq!(state, before);
}
