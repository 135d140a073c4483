//! Systems as propagators, their places, and threads that share a stepper.

use alloc::vec::Vec;

use liestep::{force, lagrangian};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, SVector, Vector3, Vector6};

use super::couplings::Coefficients;
use super::equations::Equations;
use super::{Body, Multibody, MultibodyStepper};
use crate::effects::Drag;
use crate::error::{SetupError, StepError};
use crate::groups::{R3, SO3};
use crate::laws::samples::{Random, derivative};
use crate::mechanics::NonstandardInertia;
use crate::methods::Joint;
use crate::motion::Propagator;

/// A body with its weight.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space), w = e.seen_from(F)),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        - 0.5 * h * m * g * (x + x + d).dot(&up) - 0.5 * h * c * (w[0] + (F.transpose() * w)[0]),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rod {
    J_d: NonstandardInertia,
    m: f64,
    g: f64,
    c: f64,
    up: Vector3<f64>,
    e: Vector3<f64>,
}

/// A spring between points of two bodies.
#[lagrangian(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(R_1 = F_1.seen_from(space), R_2 = F_2.seen_from(space), r = d_2.seen_from(d_1)),
    l_d = -0.25 * h * k * ((r + R_2 * at_2 - R_1 * at_1).norm_squared()
        + (r + d_2 - d_1 + R_2 * F_2 * at_2 - R_1 * F_1 * at_1).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cord {
    k: f64,
    at_1: Vector3<f64>,
    at_2: Vector3<f64>,
}

const LEFT: Vector3<f64> = Vector3::new(-0.5, 0.0, 0.0);
const RIGHT: Vector3<f64> = Vector3::new(0.5, 0.0, 0.0);

fn rod(m: f64, c: f64) -> Rod {
    let J_d = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1) * m).unwrap();
    Rod { J_d, m, g: 9.81, c, up: Vector3::z(), e: Vector3::x() }
}

fn ball(above: Vector3<f64>, below: Vector3<f64>) -> Joint {
    Joint::ball([above, below])
}

/// Links of one metre in a row from the origin, and the end of the last.
fn row<const N: usize>(tilts: [f64; N]) -> ([Body; N], Vector3<f64>) {
    let mut corner = Vector3::zeros();
    let places = tilts.map(|tilt| {
        let attitude = SO3::exp(Vector3::y() * tilt);
        let along = attitude.as_matrix() * Vector3::x();
        corner += along;
        (attitude, R3::from(corner - along * 0.5))
    });
    (places, corner)
}

/// A system as a propagator: reading and continuing a state, a part of a step, and slices of a wrong length.
#[test]
fn a_system_is_a_propagator() {
    let mut system = Multibody::new();
    let first = system.body(rod(1.0, 0.5));
    let second = system.body(rod(0.5, -0.2));
    system.join(ball(Vector3::zeros(), LEFT), None, first);
    system.join(ball(RIGHT, LEFT), Some(first), second);
    let stepper = system.stepper(0.01).unwrap();
    let (places, _) = row([0.4, 1.1]);
    let propagator: &dyn Propagator = &stepper;
    let mut attitude = Vec::new();
    for (turn, place) in &places {
        attitude.extend(turn.as_matrix().transpose().iter());
        attitude.extend(place.as_matrix().transpose().iter());
    }
    let mut state = propagator.start(&attitude, &[0.0; 12]).unwrap();
    assert_eq!(state, stepper.start(&places, &[Vector6::zeros(); 2]).unwrap());
    assert_eq!(state.len(), propagator.layout().state());
    let start = state.clone();
    propagator.run(&mut state, 200).unwrap();
    let mut other = start.clone();
    for _ in 0..200 {
        propagator.step(&mut other).unwrap();
    }
    assert_eq!(state, other);
    assert!((propagator.time(&state) - 2.0).abs() < 1e-12);
    // Two halves of a step backwards end near the state before it, to the order of the method.
    let next = propagator.part(&state, 1.0).unwrap();
    let back = propagator.part(&next, -1.0).unwrap();
    let off = back.iter().zip(&state).take(62).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-13 && next[..50] != state[..50], "{off:e}");
    assert_eq!(next.last(), state.last());
    assert!(propagator.defect(&state) < 1e-13);
    let (mut momentum, mut velocity) = ([0.0; 12], [0.0; 12]);
    propagator.spatial_momentum(&state, &mut momentum);
    propagator.velocity(&state, &mut velocity);
    assert!((momentum[3] - velocity[3]).abs() < 1e-13 && (momentum[9] - 0.5 * velocity[9]).abs() < 1e-13);

    let short = &mut state[1..];
    assert!(matches!(propagator.step(short), Err(StepError::NonFinite { .. })));
    assert!(matches!(propagator.part(short, 0.5), Err(StepError::NonFinite { .. })));
    assert!(propagator.energy(short).is_nan() && propagator.defect(short).is_nan());
    assert!(propagator.adopt(&short[..10]).iter().all(|number| number.is_nan()));
    assert!(propagator.start(&attitude[1..], &[0.0; 12]).is_err());
}

#[test]
fn terms_and_joints_have_places() {
    let refused = |make: &dyn Fn(&mut Multibody)| {
        let mut system = Multibody::new();
        make(&mut system);
        system.stepper(0.01).unwrap_err()
    };
    assert!(matches!(refused(&|_| ()), SetupError::Place { .. }));
    assert!(matches!(refused(&|system| system.on(0, rod(1.0, 0.0))), SetupError::Place { .. }));
    let cord = Cord { k: 1.0, at_1: LEFT, at_2: RIGHT };
    for bodies in [[Some(0), Some(1)], [Some(0), Some(0)], [None, None]] {
        let error = refused(&|system| {
            system.body(rod(1.0, 0.0));
            system.between(bodies, cord);
        });
        assert!(matches!(error, SetupError::Place { .. }), "{error}");
    }
    let error = refused(&|system| {
        system.body(rod(1.0, 0.0));
        system.body(Rod { g: f64::NAN, ..rod(1.0, 0.0) });
    });
    assert!(matches!(error, SetupError::BodyParameter { body: 1, .. }), "{error}");
    let error = refused(&|system| {
        system.body(rod(1.0, 0.0));
        let J_d = NonstandardInertia::from_principal_moments(Vector3::repeat(1.0)).unwrap();
        system.body(Rod { J_d, m: 0.0, ..rod(1.0, 0.0) });
    });
    assert!(matches!(error, SetupError::SingularKinetic { body: Some(1), .. }), "{error}");
}

/// Threads share a stepper, and systems of several shapes a thread.
#[test]
fn steps_have_the_same_bits_on_every_thread() {
    let of = |links: usize, closed: bool| {
        let mut system = Multibody::new();
        for k in 0..links {
            system.body(rod(1.0, 0.0));
            match k.checked_sub(1) {
                None => system.join(ball(Vector3::zeros(), LEFT), None, 0),
                Some(before) => system.join(ball(RIGHT, LEFT), Some(before), k),
            }
        }
        if closed {
            system.join(ball(Vector3::new(1.5, 0.0, 0.0), RIGHT), None, links - 1);
        }
        let stepper = system.stepper(0.01).unwrap();
        let about: Vec<Body> = (0..links).map(|k| row([0.9, -0.2, -1.3]).0[k % 3]).collect();
        let state = stepper.start_nearest(&about, &alloc::vec![Vector6::repeat(0.1); links]).unwrap();
        (stepper, state)
    };
    let systems = [of(2, false), of(3, true), of(2, false), of(3, false)];
    let run = || {
        let mut states: Vec<_> = systems.iter().map(|(_, state)| state.clone()).collect();
        for _ in 0..50 {
            for ((stepper, _), state) in systems.iter().zip(&mut states) {
                stepper.step(state).unwrap();
            }
        }
        states
    };
    let alone: Vec<_> = systems
        .iter()
        .map(|(stepper, state)| {
            let mut state = state.clone();
            stepper.run(&mut state, 50).unwrap();
            state
        })
        .collect();
    let all = std::thread::scope(|scope| {
        let threads = [(); 3].map(|()| scope.spawn(run));
        threads.map(|thread| thread.join().unwrap())
    });
    for states in all {
        assert_eq!(states, alone);
    }
    assert!(systems[1].0.attitude(&alone[1], 0).0 != SO3::identity());
}

/// Momenta are projected at the end of a run, and the next run starts from those before; written ones count. A chain returns to its
/// start with the opposite momenta.
#[test]
fn momenta_that_are_written_are_those_of_the_next_step() {
    let mut system = Multibody::new();
    for k in 0..3 {
        system.body(rod(1.0, 0.3));
        let above = usize::checked_sub(k, 1);
        system.join(ball(above.map_or_else(Vector3::zeros, |_| RIGHT), LEFT), above, k);
    }
    let stepper = system.stepper(0.01).unwrap();
    let (places, _) = row([0.9, -0.2, -1.3]);
    let start = stepper.start_nearest(&places, &[Vector6::repeat(0.3); 3]).unwrap();
    let mut state = start.clone();
    stepper.run(&mut state, 20).unwrap();
    let places: Vec<_> = stepper.attitudes(&state).iter().map(super::place).collect();
    let velocities = stepper.velocities_of(&stepper.attitudes(&state), &stepper.momenta(&state));
    let parting = Equations::widest_parting((stepper.joints(), &places), &velocities, &stepper.lengths, 0.0);
    assert!(parting.relative < 1e-14, "{:e}", parting.relative);
    let momenta = stepper.layout().momentum();
    state[momenta.clone()].iter_mut().for_each(|part| *part = -*part);
    stepper.run(&mut state, 20).unwrap();
    let off = |of: core::ops::Range<usize>, sign: f64| {
        state[of.clone()].iter().zip(&start[of]).map(|(a, b)| (a - b * sign).abs()).fold(0.0, f64::max)
    };
    let (of_places, of_momenta) = (off(0..momenta.start, 1.0), off(momenta, -1.0));
    assert!(of_places < 1e-12 && of_momenta < 1e-12, "{of_places:e} {of_momenta:e}");
}

/// A term without a physical meaning that couples turns and shifts of two bodies within a step.
#[force(
    group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3),
    advected(Q = F_2.seen_from(F_1), r = d_2.seen_from(d_1), R_1 = F_1.seen_from(space)),
    displacement(eta_1, s_1, eta_2, s_2),
    work = -c * (Q * vee(F_2) - vee(F_1)).dot(&(Q * eta_2 - eta_1))
        - h * c * (r + d_2 * 2.0).dot(&(R_1 * (F_1 * eta_1))) - c * (d_2 - d_1).dot(&(s_2_next - s_1 * 2.0))
        + c * (R_1 * (Q * vee(F_2))).dot(&s_2) - 0.5 * c * (R_1 * (F_1 * eta_1_next)).dot(&d_2),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct CrossTerm {
    c: f64,
}

/// A kinetic coupling of rotations alone: light balls on bars between points of two bodies.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = {
        let apart = (F_1 - I) * A - Q * (F_2 - I) * B;
        (apart * apart.transpose()).trace() / (2.0 * h)
            - 0.5 * h * k * (a.dot(&(Q * a)) + (F_1 * a).dot(&(Q * F_2 * a)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bars {
    A: Matrix3<f64>,
    B: Matrix3<f64>,
    a: Vector3<f64>,
    k: f64,
}

impl Bars {
    const OURS: Self = Self {
        A: Matrix3::new(0.1, 0.2, 0.05, 0.0, 0.1, -0.1, 0.2, 0.0, 0.1),
        B: Matrix3::new(-0.1, 0.1, 0.2, 0.1, 0.05, 0.0, 0.0, 0.2, 0.1),
        a: Vector3::new(0.1, 0.2, 0.05),
        k: 3.0,
    };
}

/// A term that is linear in the velocities of both bodies, and depends on their attitudes.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    l_d = c * (vee(F_1).dot(&(Q * e)) + 2.0 * vee(F_2).dot(&(Q.transpose() * e))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Magnet {
    c: f64,
    e: Vector3<f64>,
}

/// A damper between a body and a point of space or of another body.
#[force(
    group(d_1 = R3, d_2 = R3),
    displacement(s_1, s_2),
    work = -0.5 * c * (d_2 - d_1).dot(&(s_2 + s_2_next - s_1 - s_1_next)),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dashpot {
    c: f64,
}

/// A chain of four with terms between neighbours, across joints, to space and between the same bodies in both orders.
fn coupled(h: f64) -> MultibodyStepper {
    let mut system = Multibody::new();
    for k in 0..4 {
        system.body(rod(1.0 + 0.3 * f64::from(u8::try_from(k).unwrap()), 0.4));
        match usize::checked_sub(k, 1) {
            None => system.join(ball(Vector3::zeros(), LEFT), None, 0),
            Some(before) => system.join(ball(RIGHT, LEFT), Some(before), k),
        }
    }
    system.between([Some(0), Some(1)], CrossTerm { c: 0.7 });
    system.between([Some(2), Some(1)], CrossTerm { c: 0.4 });
    system.between([Some(1), Some(2)], Bars::OURS);
    system.between([Some(0), Some(3)], Bars::OURS);
    system.between([None, Some(3)], CrossTerm { c: 0.3 });
    system.between([Some(3), Some(2)], Magnet { c: 0.6, e: Vector3::new(0.3, -0.2, 0.5) });
    system.between([Some(2), None], Dashpot { c: 0.2 });
    system.on(2, Drag { c: 0.1, J: rod(1.0, 0.0).J_d.to_inertia() });
    system.stepper(h).unwrap()
}

/// Configurations, and half increments, of some bodies.
fn somewhere<const N: usize>(seed: u32) -> ([Body; N], [Vector6<f64>; N], [Vector6<f64>; N]) {
    let mut random = Random::new(seed.into());
    let bodies = [(); N].map(|()| {
        let (turn, shift): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        (SO3::exp(turn), R3::from(shift))
    });
    (bodies, [(); N].map(|()| random.sample::<Vector6<f64>>() * 0.3), [(); N].map(|()| random.sample()))
}

/// The Newton matrix of the bodies as one matrix.
fn assembled(stepper: &MultibodyStepper, coefficients: &Coefficients) -> DMatrix<f64> {
    let all = 6 * stepper.bodies();
    let mut all = DMatrix::zeros(all, all);
    for (body, matrix) in coefficients.matrices.iter().enumerate() {
        all.view_mut((6 * body, 6 * body), (6, 6)).copy_from(matrix);
    }
    for (&[one, other], [upper, lower]) in stepper.tree.couplings.iter().zip(&coefficients.blocks) {
        all.view_mut((6 * one, 6 * other), (6, 6)).copy_from(upper);
        all.view_mut((6 * other, 6 * one), (6, 6)).copy_from(lower);
    }
    all
}

/// The columns of the Newton matrix are the differences of the residual, in blocks between bodies, too.
#[test]
fn the_newton_matrix_is_the_derivative_of_the_residual() {
    let stepper = coupled(0.1);
    let mut coefficients = Coefficients::default();
    coefficients.fit(4, stepper.tree.couplings.len());
    for seed in 1..4 {
        let (now, half, a) = somewhere::<4>(seed);
        stepper.set_newton(&now, &a, &half, &mut coefficients);
        let matrix = assembled(&stepper, &coefficients);
        let mut residuals = coefficients.vectors.clone();
        stepper.set_residuals(&now, &a, &half, &mut residuals);
        assert!(residuals.iter().zip(&coefficients.vectors).all(|(a, b)| (a - b).amax() < 1e-14));
        for column in 0..24 {
            let slope = derivative(|s| {
                let (mut moved, mut residuals) = (half, residuals.clone());
                moved[column / 6][column % 6] += s;
                stepper.set_residuals(&now, &a, &moved, &mut residuals);
                SVector::<f64, 24>::from_fn(|row, _| residuals[row / 6][row % 6])
            });
            let off = (matrix.column(column) - slope).amax();
            assert!(off < 1e-9 && slope.amax() > 1e-3, "column {column} is off by {off:e}");
        }
    }
}

/// Elimination along the tree solves the equations of bodies and joints as a dense matrix does.
#[test]
fn elimination_along_the_tree_is_that_of_the_whole_matrix() {
    for stepper in [coupled(0.1), branched(0.1, &[]), branched(0.1, &[[0, 1], [1, 2], [3, 1], [5, 3], [6, 0], [4, 3]])]
    {
        compare_with_the_whole_matrix(&stepper);
    }
}

/// Joints that hold points in a tree that branches, two of them from the body below to that above, and terms between these bodies.
fn branched(h: f64, terms: &[[usize; 2]]) -> MultibodyStepper {
    let mut system = Multibody::new();
    for mass in [1.0, 1.3, 1.6, 1.9, 0.7, 1.2, 0.8] {
        system.body(rod(mass, 0.4));
    }
    let (aside, turn) = (Vector3::new(0.3, 0.2, -0.1), SO3::exp(Vector3::new(0.3, -0.5, 0.2)));
    system.join(ball(aside, LEFT), None, 0);
    system.join(Joint::universal([RIGHT, aside], [aside, LEFT + aside]), Some(0), 1);
    system.join(Joint::pin([LEFT, RIGHT + aside], [aside, LEFT + aside]), Some(2), 1);
    system.join(ball(aside, LEFT), Some(1), 3);
    system.join(ball(aside, LEFT), Some(4), 3);
    system.join(Joint::weld([RIGHT, LEFT], *turn.as_matrix()), Some(3), 5);
    system.join(Joint::slider([RIGHT, LEFT], aside, *turn.as_matrix()), Some(0), 6);
    for &bodies in terms {
        system.between(bodies.map(Some), CrossTerm { c: 0.4 });
    }
    system.stepper(h).unwrap()
}

fn compare_with_the_whole_matrix(stepper: &MultibodyStepper) {
    let bodies = stepper.bodies();
    let (now, half, a) = somewhere::<7>(5);
    let (now, half, a) = (&now[..bodies], &half[..bodies], &a[..bodies]);
    let mut coefficients = stepper.limit(now);
    stepper.set_newton(now, a, half, &mut coefficients);
    let places: Vec<_> = now.iter().map(super::place).collect();
    let turns: Vec<_> = half.iter().map(|half| super::place(&now[0]).attitude * (1.0 + half[0])).collect();
    let mut equations = Equations::default();
    equations.fit(stepper.joints(), &stepper.tree);
    equations.set_before(stepper.joints(), &stepper.tree, &places);
    equations.set_after(stepper.joints(), &stepper.tree, &places, &turns);
    equations.factorise(&stepper.tree, &coefficients);
    let number = |k: usize| f64::from(u8::try_from(k).unwrap());
    let gaps = |joint: usize| {
        let rows = stepper.joints()[joint].rows;
        Vector6::from_fn(|row, _| if row < rows { number(joint + row) * 0.1 - 0.2 } else { 0.0 })
    };
    equations.solve(&stepper.tree, &coefficients.vectors, |joint, _| gaps(joint));
    let mut first = alloc::vec![6 * bodies];
    first.extend(stepper.joints().iter().scan(6 * bodies, |last, joined| {
        *last += joined.rows;
        Some(*last)
    }));
    let all = first[first.len() - 1];
    let mut whole = DMatrix::zeros(all, all);
    whole.view_mut((0, 0), (6 * bodies, 6 * bodies)).copy_from(&assembled(stepper, &coefficients));
    let mut right = DVector::zeros(all);
    for body in 0..bodies {
        right.rows_mut(6 * body, 6).copy_from(&-coefficients.vectors[body]);
    }
    for (joint, joined) in stepper.joints().iter().enumerate() {
        let at = [super::place_of(&places, joined.above), &places[joined.below]];
        let turn_of = |body: usize, before: bool| if before { places[body].attitude } else { turns[body] };
        for before in [true, false] {
            let [above, below] = [joined.above, Some(joined.below)].map(|body| body.map(|body| turn_of(body, before)));
            let (mut of_above, mut of_below) = (Matrix6::zeros(), Matrix6::zeros());
            joined.functions.slopes(at, [above.as_ref(), below.as_ref()], [&mut of_above, &mut of_below]);
            for (body, slope) in [(joined.above, of_above), (Some(joined.below), of_below)] {
                let Some(body) = body else { continue };
                for (row, column) in (0..6).flat_map(|row| (0..joined.rows).map(move |column| (row, column))) {
                    let place = if before {
                        (6 * body + row, first[joint] + column)
                    } else {
                        (first[joint] + column, 6 * body + row)
                    };
                    whole[place] = slope[(row, column)];
                }
            }
        }
        right.rows_mut(first[joint], joined.rows).copy_from(&-gaps(joint).rows(0, joined.rows));
    }
    let expected = whole.lu().solve(&right).unwrap();
    for body in 0..bodies {
        let off = (equations.unknowns.bodies[body] - expected.rows(6 * body, 6)).amax();
        assert!(off < 1e-11 * expected.amax(), "body {body}: {off:e}");
    }
    for (body, member) in stepper.tree.members.iter().enumerate() {
        let joint = member.joint.unwrap();
        let rows = stepper.joints()[joint].rows;
        let of_joint = equations.unknowns.joints[body].rows(0, rows).into_owned();
        let off = (of_joint - expected.rows(first[joint], rows)).amax();
        assert!(off < 1e-11 * expected.amax(), "joint of body {body}: {off:e}");
    }
}

/// Velocities of momenta invert the inertia of all bodies, of which terms between them are a part.
#[test]
fn velocities_are_those_of_the_coupled_inertia() {
    let stepper = coupled(0.1);
    let (now, velocities, _) = somewhere::<4>(6);
    let momenta = stepper.momenta_of(&now, &velocities);
    let back = stepper.velocities_of(&now, &momenta);
    assert!(back.iter().zip(&velocities).all(|(a, b)| (a - b).amax() < 1e-13));
    let still = stepper.momenta_of(&now, &[Vector6::zeros(); 4]);
    let [second, third] = [2, 3].map(|body: usize| *now[body].0.as_matrix());
    let e = Vector3::new(0.3, -0.2, 0.5);
    let expected = [second.tr_mul(&(third * e)) * 1.2, third.tr_mul(&(second * e)) * 0.6];
    let off = [2, 3].map(|body| (still[body].fixed_rows::<3>(0) - expected[body - 2]).amax());
    assert!(off.iter().all(|&off| off < 1e-14) && still[0].amax() < 1e-14, "{off:?}");
    // The kinetic energy of the bars is half the sum of the squares of their ends' relative velocities.
    let Bars { A, B, .. } = Bars::OURS;
    let of_bars = |[one, other]: [usize; 2]| {
        let [first, second] = [one, other].map(|body| velocities[body].fixed_rows::<3>(0).into_owned());
        let [turn, next] = [one, other].map(|body| *now[body].0.as_matrix());
        0.5 * (turn * first.cross_matrix() * A - next * second.cross_matrix() * B).norm_squared()
    };
    let alone = |body: usize| 0.5 * velocities[body].dot(&(stepper.at_rest(body, &now[body]).2 * velocities[body]));
    let still = stepper.energy_of(&now, &stepper.momenta_of(&now, &[Vector6::zeros(); 4]));
    let expected = still + (0..4).map(alone).sum::<f64>() + of_bars([1, 2]) + of_bars([0, 3]);
    let energy = stepper.energy_of(&now, &momenta);
    assert!((energy - expected).abs() < 1e-13 && energy - still > 0.1, "{energy} {expected}");
}
