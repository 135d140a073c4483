//! Chains and trees.

use core::array::from_fn;

use liestep::groups::{CayleyRetraction, LieGroup as _, R3, Retraction};
use liestep::laws::samples::Random;
use liestep::methods::{Chain, Joint};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, StepError};
use nalgebra::{Vector3, Vector6};

use super::super::links::{irregular, rods};
use super::super::{apart, part};
use super::{Body, Components, Connection, EPSILON, Linkage, MassAndInertia, falling, jointed, row, six, watched};

/// The bodies and joints of a chain, with coordinates about the centres of mass.
fn with_joints<const N: usize>(chain: &Chain<N>, h: f64) -> Linkage<N> {
    checked(chain, h).unwrap()
}

fn checked<const N: usize>(chain: &Chain<N>, h: f64) -> Result<Linkage<N>, SetupError> {
    let bodies = chain.links.map(|link| {
        let central = link.J_d.as_matrix() - link.c * link.c.transpose() * link.m;
        MassAndInertia { m: link.m, K: NonstandardInertia::new(central).unwrap() }
    });
    let joints: [_; N] = from_fn(|k| {
        let below = -chain.links[k].c;
        if k == 0 {
            return Connection::to_space(Joint::ball([Vector3::zeros(), below]), 0);
        }
        let upper = chain.links[k - 1];
        Connection::between(Joint::ball([upper.rho - upper.c, below]), k - 1, k)
    });
    jointed(falling(bodies, chain.g, chain.up), &joints, h)
}

/// The positions and velocities of the links' centres of mass.
fn placed<const N: usize>(
    chain: &Chain<N>,
    attitudes: &[SO3; N],
    velocities: &Bodies<Vector3<f64>, N>,
) -> ([Body; N], Components<N>) {
    let (mut joint, mut velocity) = (Vector3::zeros(), Vector3::zeros());
    let mut all = [(Body::identity(), Vector6::zeros()); N];
    for (k, link) in chain.links.iter().enumerate() {
        let (r, omega) = (attitudes[k].as_matrix(), &velocities.0[k]);
        let of_centre = velocity + r * omega.cross(&link.c);
        all[k] = ((attitudes[k], R3::from(joint + r * link.c)), six(omega, &of_centre));
        joint += r * link.rho;
        velocity += r * omega.cross(&link.rho);
    }
    (all.map(|(body, _)| body), all.map(|(_, velocity)| velocity))
}

/// Joints with multipliers and the minimal form are one integrator: they differ by rounding only.
#[test]
fn a_chain_moves_as_in_its_minimal_form() {
    const N: usize = 5;
    let mut random = Random::new(21);
    for h in [0.01, -0.005] {
        let chain = irregular::<N>(&mut random);
        let minimal = chain.stepper(h).unwrap();
        let stepper = with_joints(&chain, h);
        let attitudes: [SO3; N] = from_fn(|_| {
            let xi: Vector3<f64> = random.sample();
            <CayleyRetraction as Retraction<SO3>>::retract(&xi)
        });
        let velocities = Bodies(from_fn(|_| random.sample()));
        let mut expected = minimal.start(attitudes, velocities).unwrap();
        let (places, moving) = placed(&chain, &attitudes, &velocities);
        let mut state = stepper.start(&places, &moving).unwrap();
        assert!((stepper.energy(&state) - minimal.energy(&expected)).abs() < 1e-12);
        let mut iterations = [0; 2];
        for _ in 0..5 {
            iterations[0] += minimal.run(&mut expected, 20).unwrap();
            iterations[1] += stepper.run(&mut state, 20).unwrap();
            let (found, velocity) = (stepper.turns(&state), stepper.velocities(&state));
            let other = minimal.velocity(&expected);
            let slower = (0..N).map(|k| (part(&velocity[k], 0) - other.0[k]).amax()).fold(0.0, f64::max);
            let errors = [apart(&found, &expected.attitude()), slower, stepper.widest_gap(&state)];
            println!("{h}: {errors:?}");
            assert!(errors[0] < 1e-12 && errors[1] < 1e-12 && errors[2] < 4.0 * EPSILON * 5.0, "{errors:?}");
        }
        println!("iterations: {iterations:?}");
        assert!(iterations[1] < 2 * iterations[0]);
    }
}

/// A hundred links fall from the horizontal; the last has up to ten thousand times the mass of the others. The motion
/// is that of the minimal form, which is run for longer, and the energy is conserved to the error of the method.
#[test]
fn a_hundred_links_let_go_horizontally() {
    for (last, h, tens, allowed) in [
        (1.0, 0.005, [20, 20], [1e-12, 1e-4]),
        (1e4, 0.002, [10, 40], [1e-11, 1e-5]),
        (1e-4, 0.002, [10, 40], [1e-12, 1e-4]),
    ] {
        let chain = rods::<100>(last);
        let (stepper, minimal) = (with_joints(&chain, h), chain.stepper(h).unwrap());
        let flat = [SO3::from_euler_angles(0.3, core::f64::consts::FRAC_PI_2, 0.0); 100];
        let at_rest = Bodies([Vector3::zeros(); 100]);
        let (places, moving) = placed(&chain, &flat, &at_rest);
        let mut state = stepper.start(&places, &moving).unwrap();
        let mut expected = minimal.start(flat, at_rest).unwrap();
        let energies = [stepper.energy(&state), minimal.energy(&expected)];
        let (mut gap, mut most) = (0.0_f64, 0.0_f64);
        let mut run = |state: &mut _| {
            minimal.run(state, 10).unwrap();
            most = most.max((minimal.energy(state) - energies[1]).abs());
        };
        for _ in 0..tens[0] {
            stepper.run(&mut state, 10).unwrap();
            run(&mut expected);
            gap = gap.max(stepper.widest_gap(&state));
        }
        let off = apart(&stepper.turns(&state), &expected.attitude());
        for _ in 0..tens[1] {
            run(&mut expected);
        }
        // The scale of the energy is that of the weight.
        let scale = 9.81 * 50.0 * (99.0 + 2.0 * last);
        let energy = [(stepper.energy(&state) - energies[0]).abs(), most].map(|of| of / scale);
        println!("{last}: {off:.1e} from the minimal form, energy {energy:?}, gap {gap:.1e}");
        assert!(off < allowed[0] && gap < 4.0 * EPSILON * 100.0);
        assert!(energy[0] < 1e-4 && energy[1] < allowed[1], "{last}: {energy:?}");
        assert!(minimal.joints(&expected)[99].z < -1.0);
    }
}

/// A body on a pivot with three bodies on it, one of which carries another: energy, the momentum about the vertical,
/// and the joints. The order of the joints and the choice of each joint's body above don't matter.
#[test]
fn a_tree() {
    const N: usize = 5;
    let mut random = Random::new(3);
    let mut next = |size: f64| -> Vector3<f64> {
        let vector: Vector3<f64> = random.sample();
        vector * size
    };
    let bodies: [MassAndInertia; N] = from_fn(|_| MassAndInertia {
        m: 0.5 + next(1.0).x.abs(),
        K: NonstandardInertia::from_principal_moments(Vector3::new(0.05, 0.06, 0.07) + next(0.01)).unwrap(),
    });
    let points: [[Vector3<f64>; 2]; N] = from_fn(|_| [next(0.5), next(0.5)]);
    let parents = [None, Some(0), Some(0), Some(0), Some(2)];
    let straight: [Connection<Joint>; N] = from_fn(|k| {
        let joint = Joint::ball(points[k]);
        Connection { joint, above: parents[k], below: k }
    });
    let turned: [Connection<Joint>; N] = from_fn(|k| {
        let Connection { above, below, .. } = straight[N - 1 - k];
        let [upper, lower] = points[N - 1 - k];
        let back = Joint::ball([lower, upper]);
        above.map_or(straight[N - 1 - k], |above| Connection::between(back, below, above))
    });
    let about: [Body; N] = from_fn(|_| {
        let turn: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&next(1.0));
        (turn, R3::from(next(1.0)))
    });
    let moving: Components<N> = from_fn(|_| six(&next(1.0), &next(1.0)));
    let [pivot, _] = points[0];
    let about_pivot = |[p, l]: [Vector3<f64>; 2]| (l - pivot.cross(&p)).z;
    let ends = [straight, turned].map(|tree| {
        let stepper = jointed(falling(bodies, 9.81, Vector3::z()), &tree, 0.005).unwrap();
        let mut state = stepper.start_nearest(&about, &moving).unwrap();
        let (energy, vertical) = (stepper.energy(&state), about_pivot(stepper.whole(&state)));
        stepper.run(&mut state, 200).unwrap();
        let middle = stepper.turns(&state);
        let [off, gap] = watched(&stepper, &mut state, energy, 2000);
        let moved = about_pivot(stepper.whole(&state)) - vertical;
        println!("energy {energy:.3} within {off:.1e}, momentum {moved:.1e}, gap {gap:.1e}");
        assert!(off < 0.02 && moved.abs() < 1e-11 && gap < 4.0 * EPSILON * 2.0);
        middle
    });
    assert!(apart(&ends[0], &ends[1]) < 1e-11, "{:e}", apart(&ends[0], &ends[1]));
}

/// An invalid start is refused, and the error names the joint.
#[test]
fn errors_name_the_joint() {
    let chain = rods::<4>(1.0);
    let stepper = with_joints(&chain, 0.01);
    let attitudes = [0.1, 0.5, -0.3, 0.2].map(|tilt| SO3::exp(Vector3::new(tilt, 0.2, 0.0)));
    let velocities = Bodies([Vector3::new(0.3, -0.2, 0.1); 4]);
    let (places, moving) = placed(&chain, &attitudes, &velocities);
    let mut open = places;
    open[2].1 = R3::from(open[2].1.translation() + Vector3::x() * 1e-6);
    let error = stepper.start(&open, &moving).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SetupError::OffConstraint { joint: 2 | 3, by } if (by - 1e-6).abs() < 1e-12));
    let mut opening = moving;
    opening[1][4] += 1e-6;
    let error = stepper.start(&places, &opening).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SetupError::OffVelocity { joint: 1 | 2, by } if (by - 1e-6).abs() < 1e-12));
    // Configuration and velocities are corrected, and valid ones stay the same.
    let state = stepper.start_nearest(&open, &opening).unwrap();
    let off = (stepper.attitude(&state, 2).1.translation() - places[2].1.translation()).norm();
    assert!(off < 1e-6 && off > 1e-9 && stepper.widest_gap(&state) < 4.0 * EPSILON * 4.0, "{off:e}");
    let state = stepper.start_nearest(&places, &moving).unwrap();
    let (right, found) = (stepper.start(&places, &moving).unwrap(), stepper.velocities(&state));
    assert!(apart(&stepper.turns(&state), &attitudes) < 1e-14);
    assert!(found.iter().zip(stepper.velocities(&right)).all(|(a, b)| (a - b).amax() < 1e-13));

    let (end, link) = (Vector3::z(), Joint::ball([Vector3::z(), -Vector3::z()]));
    let bodies = falling([MassAndInertia { m: 1.0, K: rods::<1>(1.0).links[0].J_d }; 3], 9.81, Vector3::z());
    let refused = |joints: [Connection<Joint>; 2]| jointed(bodies, &joints, 0.01).unwrap_err();
    let first = Connection::between(link, 0, 1);
    assert!(matches!(refused([first, Connection::between(link, 1, 3)]), SetupError::Joint { joint: 1, .. }));
    assert!(matches!(refused([first, Connection::between(link, 2, 2)]), SetupError::Joint { joint: 1, .. }));
    // Two ball joints at different points of two bodies close a loop, and are redundant in part.
    let twice = [first, Connection::between(Joint::ball([-end, end]), 1, 0)];
    let redundant = jointed(bodies, &twice, 0.01).unwrap();
    let at = [0.0, 2.0, 9.0].map(|z| (SO3::identity(), R3::from(Vector3::z() * z)));
    let error_of_two = redundant.start(&at, &[Vector6::zeros(); 3]).unwrap_err();
    assert!(matches!(error_of_two, SetupError::RedundantJoint { joint: 1, .. }), "{error_of_two}");
    let broken = Joint::ball([end, Vector3::new(0.0, f64::NAN, 0.0)]);
    let broken = refused([first, Connection::between(broken, 1, 2)]);
    assert!(matches!(broken, SetupError::JointParameter { joint: 1, field: "below", .. }), "{broken}");
    let (axis_above, axis_below) = (Vector3::zeros(), Vector3::x());
    let pin = Joint::pin([Vector3::z(), Vector3::z()], [axis_above, axis_below]);
    let broken = jointed(bodies, &[Connection::between(pin, 0, 1)], 0.01).unwrap_err();
    assert!(matches!(broken, SetupError::JointParameter { joint: 0, field: "axis_above", .. }), "{broken}");
    assert!(matches!(checked(&chain, f64::NAN), Err(SetupError::InvalidStep { .. })));

    // A step that turns a link too far names it.
    let long = with_joints(&chain, 0.1);
    let mut fast = velocities;
    fast.0[2] = Vector3::new(0.0, 0.0, 50.0);
    let (places, moving) = placed(&chain, &attitudes, &fast);
    let mut state = long.start(&places, &moving).unwrap();
    let before = state.clone();
    let error = long.step(&mut state).unwrap_err();
    println!("{error}");
    assert!(matches!(error, StepError::UnsolvedBody { body: 2, .. }) && state == before, "{error}");
}

/// Systems of all sizes, at rest and nearly at rest: rounding errors are compared with the system's own scales.
#[test]
fn small_and_slow() {
    for size in [1.0, 1e-3, 1e-6] {
        let (e, mass) = (Vector3::x() * (0.5 * size), size * size * size);
        let moments = Vector3::new(0.02, 0.1, 0.1) * (mass * size * size);
        let K = NonstandardInertia::from_principal_moments(moments).unwrap();
        let link = Joint::ball([e, -e]);
        let joints = [Connection::between(link, 0, 1), Connection::between(link, 1, 2)];
        let stepper = jointed(falling([MassAndInertia { m: mass, K }; 3], 0.0, Vector3::z()), &joints, 0.01).unwrap();
        let about = row([0.9, 0.2, -0.5]).0.map(|(turn, place)| (turn, R3::from(place.translation() * size)));
        for rate in [0.0, 1e-7, 1.0] {
            let moving = [six(&(Vector3::new(0.3, 1.0, -0.2) * rate), &Vector3::zeros()); 3];
            let mut state = stepper.start_nearest(&about, &moving).unwrap();
            let [p, l] = stepper.whole(&state);
            stepper.run(&mut state, 500).unwrap();
            let after = stepper.whole(&state);
            let off = [(after[0] - p).norm() / (mass * size), (after[1] - l).norm() / (mass * size * size)];
            println!("{size:e} {rate:e}: {off:?}, gap {:e}", stepper.widest_gap(&state) / size);
            assert!(stepper.widest_gap(&state) < 4.0 * EPSILON * size);
            assert!(off.iter().all(|&off| off < 1e-12 * (rate + 1.0)), "{off:?}");
        }
    }
}
