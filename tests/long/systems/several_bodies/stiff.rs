//! Elastic rods whose potential is evaluated in the middle of a step: the bodies of a row are solved together.

use core::array::from_fn;

use checks::structure::momenta::assert_momenta;
use checks::structure::stages::assert_stages;
use declarations::{FloatingBody, PointSpring, RodElement};
use liestep::groups::{Advected as _, LieGroup as _, R3, SE3};
use liestep::mechanics::{Along, Coupling, DiscreteLagrangian as _, Each, Effect as _, Placement, Sum, Term as _};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, StepError, Stepper, lagrangian};
use nalgebra::{Matrix4, Vector3, Vector4, Vector6};

use super::{Body, six, started, whole};
use checks::limit::assert_limit;

const N: usize = 6;
type Rod = Sum<Placement<Each<N>, FloatingBody, 1>, Placement<Coupling<N>, RodElement, 1>>;
type Start = ([Body; N], Bodies<Vector6<f64>, N>);

/// Half the length of a body, m.
const HALF: Vector3<f64> = Vector3::new(0.5, 0.0, 0.0);

/// A row of uniform bodies of one metre and one kilogram.
fn bodies() -> Placement<Each<N>, FloatingBody, 1> {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0 / 12.0, 1e-3, 1e-3)).unwrap();
    Each::<N>::of([FloatingBody { m: 1.0, J_d }])
}

fn rod(k: f64, c: f64) -> Rod {
    bodies() + Coupling::<N>::of([RodElement { k, c, a: HALF, b: -HALF }])
}

/// An arc, each body turned against the one before, that rotates about itself and about a perpendicular axis.
fn arc() -> Start {
    let (mut corner, omega) = (Vector3::zeros(), Vector3::new(0.3, 0.2, 1.0));
    let bodies = from_fn(|k| {
        let attitude = SO3::exp(Vector3::new(0.1, 0.05, 0.2) * f64::from(u8::try_from(k).unwrap()));
        let half = attitude.as_matrix() * HALF;
        corner += half * 2.0;
        (attitude, R3::from(corner - half))
    });
    let moving = bodies
        .map(|(attitude, place): Body| six(&attitude.as_matrix().tr_mul(&omega), &omega.cross(&place.translation())));
    (bodies, Bodies(moving))
}

#[test]
fn what_is_derived_of_an_element() {
    let element = RodElement { k: 3.0, c: 2.0, a: Vector3::new(0.4, 0.1, -0.2), b: Vector3::new(-0.3, 0.2, 0.5) };
    const { assert!(RodElement::<f64>::FACTS.is_self_adjoint) };
    assert_momenta(&element, 12);
    assert_stages(&element, 12);
    assert_limit(&rod(40.0, 3.0), "a rod");
}

/// The momenta before and after a step are those of the Lagrangian, along the whole row.
#[test]
fn a_step_of_a_rod_is_that_of_the_momentum_maps() {
    let (l, h) = (rod(40.0, 3.0), 0.1);
    let (stepper, mut state) = started(l, h, arc());
    stepper.run(&mut state, 5).unwrap();
    let before = state;
    let report = stepper.step(&mut state).unwrap();
    let f = before.attitude().inverse().compose(&state.attitude()).matrix();
    let w = before.advected();
    let missed = |found: Bodies<Vector6<f64>, N>, expected: Bodies<Vector6<f64>, N>| {
        found.0.iter().zip(&expected.0).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max)
    };
    let errors =
        [missed(l.legendre_minus(&f, &w, h), before.momentum()), missed(l.legendre_plus(&f, &w, h), state.momentum())];
    println!("{errors:?}, {} iterations", report.iterations);
    assert!(errors.iter().all(|&error| error < 2e-13) && report.iterations < 8, "{errors:?}");
    // The advected parameters are those of the new configuration.
    let seen = l.advected().seen_from(&state.attitude());
    assert!((state.advected().1.0[4].2.0 - seen.1.0[4].2.0).amax() < 1e-13);
}

/// Richardson's ratio for a rod whose oscillations are resolved.
#[test]
fn steps_of_a_rod_are_of_order_two() {
    let ends = [400_u32, 800, 1600].map(|steps| {
        let (stepper, mut state) = started(rod(100.0, 5.0), 1.0 / f64::from(steps), arc());
        stepper.run(&mut state, steps.into()).unwrap();
        state.attitude().map(|body| body.1.translation())
    });
    let apart = |a: &[Vector3<f64>; N], b: &[Vector3<f64>; N]| {
        a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum::<f64>().sqrt()
    };
    let ratio = apart(&ends[0], &ends[1]) / apart(&ends[1], &ends[2]);
    println!("ratio {ratio}, off by {:.1e}", apart(&ends[1], &ends[2]));
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
}

/// The step is ten times the stability limit for halves of the potential at both ends, with which the energy grows
/// without bound; with the means it stays bounded.
#[test]
fn a_stiff_rod_is_stepped_over_its_fast_oscillations() {
    let (k, c) = (1e6, 20.0);
    // In a wave exp(iqn) of shifts u across the row and turns θ, springs are stretched by 2i sin(q/2) u − l cos(q/2) θ.
    // With J = m l²/12 this leads to ω² = 4 (k/m) (sin²(q/2) + 3 cos²(q/2)), 12 k/m at most; along the row it is 4 k/m.
    let omega = (12.0_f64 * k).sqrt();
    let h = 10.0 * 2.0 / omega;
    let (stepper, mut state) = started(rod(k, c), h, arc());
    let (energy, [p, l]) = (stepper.energy(&state), whole(&state.attitude(), &state.momentum()));
    let (mut means, mut most, mut open, mut iterations) = ([0.0; 4], 0.0_f64, 0.0_f64, 0);
    for mean in &mut means {
        for _ in 0..2500 {
            iterations += stepper.step(&mut state).unwrap().iterations;
            let off = stepper.energy(&state) - energy;
            *mean += off / 2500.0;
            most = most.max(off.abs());
            for pair in state.attitude().windows(2) {
                let end = |body: &Body, point: Vector3<f64>| body.1.translation() + body.0.as_matrix() * point;
                open = open.max((end(&pair[1], -HALF) - end(&pair[0], HALF)).norm());
            }
        }
    }
    let [p_now, l_now] = whole(&state.attitude(), &state.momentum());
    let moved = [(p_now - p).norm() / p.norm(), (l_now - l).norm() / l.norm()];
    println!("energy {energy:.3} within {most:.1e}, means {means:?}, ends apart by {open:.1e} m");
    println!("momenta moved by {moved:?}, {iterations} iterations");
    assert!(most < 0.02 * energy && open < 0.02, "{most:e} of {energy}, {open:e}");
    let apart = means.iter().fold(0.0_f64, |most, mean| most.max((mean - means[0]).abs()));
    assert!(apart < 0.005 * energy, "{means:?}");
    assert!(moved[0] < 1e-12 && moved[1] < 1e-10, "{moved:?}");

    let (explicit, mut state) = started(bodies() + Along::<N>::of([PointSpring { k, a: HALF, b: -HALF }]), h, arc());
    let stays = (0..200).all(|_| explicit.step(&mut state).is_ok() && explicit.energy(&state) < 100.0 * energy);
    assert!(!stays, "the step isn't too long for potentials of the ends");
}

/// A point mass.
#[lagrangian(group(d = R3), l_d = m * d.norm_squared() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mass {
    m: f64,
}

/// A spring between two of them, evaluated in the middle of a step.
#[lagrangian(
    group(d_1 = R3, d_2 = R3),
    advected(r = d_2.seen_from(d_1)),
    l_d = -0.5 * h * k * (r + 0.5 * (d_2 - d_1)).norm_squared(),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spring {
    k: f64,
}

/// A row of masses moves by the implicit midpoint rule, mode by mode: a phase of `2 atan(ω h/2)` a step. The order of
/// the terms doesn't matter.
#[test]
fn a_row_of_masses_moves_in_its_modes() {
    const M: usize = 4;
    let (h, k, m) = (0.3, 50.0, 0.8);
    let (masses, springs) = (Each::<M>::of([Mass { m }]), Coupling::<M>::of([Spring { k }]));
    let mode = |place: u8, number: f64| (number * core::f64::consts::PI * (f64::from(place) + 0.5) / 4.0).cos();
    let start = |number: f64| [0_u8, 1, 2, 3].map(|place| R3::from(Vector3::new(0.1, -0.2, 0.3) * mode(place, number)));
    let at_rest = Bodies([Vector3::zeros(); M]);
    for number in [1.0, 2.0, 3.0] {
        let omega = 2.0 * (k / m).sqrt() * (number * core::f64::consts::PI / 8.0).sin();
        let phase = 2.0 * (0.5 * omega * h).atan();
        let ends = [
            stepped(masses + springs, h, start(number), at_rest),
            stepped(springs + masses, h, start(number), at_rest),
        ];
        for (place, first) in start(number).iter().enumerate() {
            let expected = first.translation() * (25.0 * phase).cos();
            for end in &ends {
                let off = (end[place].translation() - expected).amax();
                assert!(off < 1e-13, "{number}: {off:e}");
            }
        }
    }
}

fn stepped<L, const M: usize>(l: L, h: f64, start: [R3; M], velocities: Bodies<Vector3<f64>, M>) -> [R3; M]
where
    L: liestep::mechanics::Regular<Scalar = f64, Group = [R3; M]>,
{
    let (stepper, mut state) = started(l, h, (start, velocities));
    stepper.run(&mut state, 25).unwrap();
    state.attitude()
}

/// A potential in space that grows with a body's turn, and bends the next body against it.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R = F_1.seen_from(space), Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1)),
    l_d = -h * c * (I - 0.5 * (R + R * F_1)).trace().powi(2)
        - 0.5 * h * c * (0.5 * (vee(Q) + vee(F_1.transpose() * Q * F_2))).norm_squared()
        - 0.5 * h * c * (r + 0.5 * (d_2 - d_1)).norm_squared(),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct TurnPotential {
    c: f64,
}

/// Beyond a right angle a test would need the whole Jacobian, which isn't available for a row: such steps are refused,
/// although the determinant is positive there.
#[test]
fn steps_of_a_row_beyond_a_right_angle_are_refused() {
    let J_d = NonstandardInertia::from_diagonal(Vector3::new(1.0, 1.0, 1.0)).unwrap();
    let l = Each::<2>::of([FloatingBody { m: 1.0, J_d }]) + Coupling::<2>::of([TurnPotential { c: 1.0 }]);
    let stepper = Stepper::new(l, 1.0).unwrap();
    let turned = |angles: [f64; 2]| angles.map(|angle| (SO3::exp(Vector3::z() * angle), R3::identity()));
    let stepped = |angles: [f64; 2]| {
        let w = l.advected().seen_from(&turned([1.0; 2]));
        let momentum = l.legendre_minus(&turned(angles).matrix(), &w, 1.0);
        let mut state = stepper.start(turned([1.0; 2]), momentum * 0.5).unwrap();
        stepper.step(&mut state).map(|_| state.attitude())
    };
    for angle in [0.5, 1.2, 1.55] {
        let [first, second] = stepped([angle; 2]).unwrap();
        for attitude in [first, second] {
            assert!((attitude.0.as_matrix() - turned([1.0 + angle; 2])[0].0.as_matrix()).amax() < 1e-12, "{angle}");
        }
    }
    for (angles, farthest) in [([1.6, 1.5], 0), ([1.65, 0.3], 0), ([0.3, 1.6], 1)] {
        let refused = stepped(angles);
        assert!(
            matches!(refused, Err(StepError::BeyondSolvable { body: Some(body), .. }) if body == farthest),
            "{refused:?}"
        );
    }
}

/// Springs that push their ends apart, so that beyond `2/ω` of the fastest mode no step is on the branch of the
/// identity. The error doesn't report metres as an angle.
#[test]
fn masses_that_cannot_turn_are_not_said_to() {
    const M: usize = 4;
    let (k, m) = (50.0_f64, 0.8);
    let fastest = 2.0 * (k / m).sqrt() * (3.0 * core::f64::consts::PI / 8.0).sin();
    let row = Each::<M>::of([Mass { m }]) + Coupling::<M>::of([Spring { k: -k }]);
    let stepper = Stepper::new(row, 3.0 / fastest).unwrap();
    let start = [0.0, 1.0, 2.1, 2.9].map(|x| R3::from(Vector3::x() * x));
    let mut state = stepper.start(start, Bodies([Vector3::y(); M])).unwrap();
    let error = stepper.step(&mut state).unwrap_err();
    println!("{error}");
    let StepError::BeyondSolvable { largest, turn, body, .. } = error else { panic!("{error:?}") };
    assert!((largest * fastest / 2.0 - 1.0).abs() < 1e-5, "{largest:e}");
    assert_eq!((turn, body), (0.0, None));
    assert!(!error.to_string().contains("rad"), "{error}");
}

/// A rigid body on SE(3).
#[lagrangian(group = SE3, l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy, Debug, PartialEq)]
struct SE3Body {
    K: Matrix4<f64>,
}

/// For bodies on SE(3) the error names the one that turns, by its angle, not the one with the larger shift.
#[test]
fn bodies_that_are_only_shifted_are_not_blamed() {
    let K = Matrix4::from_diagonal(&Vector4::new(0.5, 0.5, 0.5, 2.0));
    let stepper = Stepper::new(Each::<3>::of([SE3Body { K }]), 1.0).unwrap();
    let velocities =
        [Vector6::x() * 0.2, Vector6::z() * 3.0, Vector6::y() * 0.1 + Vector6::new(0.0, 0.0, 0.0, 7.0, 0.0, 0.0)];
    let mut state = stepper.start([SE3::identity(); 3], Bodies(velocities)).unwrap();
    let error = stepper.step(&mut state).unwrap_err();
    println!("{error}");
    let StepError::BeyondSolvable { largest, turn, body, .. } = error else { panic!("{error:?}") };
    // A sphere has `sin θ = h ω`.
    assert!((3.0 * largest - 1.0).abs() < 1e-5 && (turn - 3.0).abs() < 1e-12, "{largest:e}, {turn:e}");
    assert_eq!(body, Some(1));
}
