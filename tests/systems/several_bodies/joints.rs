//! Bodies held together by joints: chains against the minimal form, a closed loop against Newton's and Euler's
//! equations, a pendulum on a pin against its recursion; what is conserved, and what can go wrong.

// The letters of the field.
#![allow(non_snake_case)]

use core::array::from_fn;

use declarations::motions::{matrix, number, read, vector};
use liestep::groups::{CayleyRetraction, LieGroup as _, R3, Retraction};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::{Each, Placed};
use liestep::methods::{
    BallJoint, Chain, ChainStepper, Constraint, Joined, Joint, Jointed, Joints, Link, PinJoint, Place,
};
use liestep::motion::{Integrator as _, Motion};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper, lagrangian};
use nalgebra::{Matrix3, Vector3, Vector6};
use serde_json::Value;

use super::{all, apart, order, tenths};

/// A body that is pulled down.
#[lagrangian(
    group(F = SO3, d = R3),
    advected(x = d.seen_from(space)),
    l_d = ((F - I) * K * (F - I).transpose()).trace() / (2.0 * h) + m * d.norm_squared() / (2.0 * h)
        - 0.5 * h * m * g * (x + x + d).dot(&up),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Heavy {
    m: f64,
    K: NonstandardInertia,
    g: f64,
    up: Vector3<f64>,
}

type Body = (SO3, R3);
type Scene<const N: usize> = Placed<Each<N>, Heavy, N>;
type Held<C, const K: usize, const N: usize, const T: usize, const L: usize> =
    Stepper<Scene<N>, Jointed<Scene<N>, C, K, N, T, L>>;
type Components<const N: usize> = Bodies<Vector6<f64>, N>;

const EPSILON: f64 = f64::EPSILON;

/// Mass and inertia of a body.
#[derive(Clone, Copy, Debug)]
struct Free {
    m: f64,
    K: NonstandardInertia,
}

fn scene<const N: usize>(bodies: [Free; N], g: f64, up: Vector3<f64>) -> Scene<N> {
    Each::<N>::of(bodies.map(|Free { m, K }| Heavy { m, K, g, up }))
}

fn six(turning: &Vector3<f64>, velocity: &Vector3<f64>) -> Vector6<f64> {
    Vector6::from_fn(|k, _| if k < 3 { turning[k] } else { velocity[k - 3] })
}

/// The turning part, and the other.
fn halves(of: &Vector6<f64>) -> [Vector3<f64>; 2] {
    [0, 3].map(|first| of.fixed_rows::<3>(first).into_owned())
}

fn place(body: &Body) -> Place {
    Place { attitude: *body.0.as_matrix(), position: body.1.translation() }
}

/// The momentum of all, and their angular momentum about the origin.
fn whole<A, const N: usize>(motion: &Motion<[Body; N], A>) -> [Vector3<f64>; 2]
where
    A: liestep::groups::Advected<[Body; N]>,
{
    let (bodies, momenta) = (motion.attitude(), motion.momentum());
    bodies.iter().zip(&momenta.0).fold([Vector3::zeros(); 2], |[p, l], (body, momentum)| {
        let [turning, linear] = halves(momentum);
        [p + linear, l + body.0.as_matrix() * turning + body.1.translation().cross(&linear)]
    })
}

/// Slopes are the derivatives of gaps, for turns and shifts of either body.
fn check_slopes<C: Constraint<K>, const K: usize>(joint: &C, random: &mut Random) {
    let places: [Body; 2] = from_fn(|_| {
        let (xi, x): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        (<CayleyRetraction as Retraction<SO3>>::retract(&xi), R3::from(x))
    });
    let slopes = joint.slope(&place(&places[0]), &place(&places[1]));
    for (body, slope) in slopes.iter().enumerate() {
        for k in 0..6 {
            let moved = |s: f64| {
                let mut moved = places.map(|body| place(&body));
                let axis = Vector3::ith(k % 3, s);
                if k < 3 {
                    let turn: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&axis);
                    moved[body].attitude = turn.as_matrix() * moved[body].attitude;
                } else {
                    moved[body].position += axis;
                }
                joint.gap(&moved[0], &moved[1])
            };
            let slope = if k < 3 { slope.turn } else { slope.shift };
            for row in 0..K {
                let expected = derivative(|s| moved(s)[row]);
                assert!((slope[(row, k % 3)] - expected).abs() < 1e-9, "{joint:?}: {body} {k} {row} {expected}");
            }
        }
    }
}

#[test]
fn slopes_are_derivatives_of_gaps() {
    let mut random = Random::new(5);
    for _ in 0..10 {
        let mut next = || -> Vector3<f64> { random.sample() };
        let ball = BallJoint { above: next(), below: next() };
        let pin = PinJoint { above: next(), below: next(), axis_above: next(), axis_below: next() };
        check_slopes(&ball, &mut random);
        check_slopes(&pin, &mut random);
        check_slopes(&Joint::Ball(ball), &mut random);
        check_slopes(&Joint::Pin(pin), &mut random);
    }
}

/// The same chain with a joint for each link, its bodies about their centres of mass.
fn with_joints<const N: usize>(chain: &Chain<N>, h: f64) -> Held<BallJoint, 3, N, N, 0> {
    let bodies = chain.links.map(|link| {
        let central = link.J_d.as_matrix() - link.c * link.c.transpose() * link.m;
        Free { m: link.m, K: NonstandardInertia::new(central).unwrap() }
    });
    let joints = Joints::tree(from_fn(|k| {
        let below = -chain.links[k].c;
        if k == 0 {
            return Joined::to_space(BallJoint { above: Vector3::zeros(), below }, 0);
        }
        let upper = chain.links[k - 1];
        Joined::between(BallJoint { above: upper.rho - upper.c, below }, k - 1, k)
    }));
    Stepper::jointed(scene(bodies, chain.g, chain.up), joints, h).unwrap()
}

/// Where the links' centres of mass are, and how they move.
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
    (all.map(|(body, _)| body), Bodies(all.map(|(_, velocity)| velocity)))
}

/// Links without any symmetry.
fn irregular<const N: usize>(random: &mut Random) -> Chain<N> {
    let mut vector = |size: f64| -> Vector3<f64> {
        let vector: Vector3<f64> = random.sample();
        vector * size
    };
    let links = [(); N].map(|()| {
        let shape = Matrix3::from_columns(&[vector(0.3), vector(0.3), vector(0.3)]);
        let central = shape * shape.transpose() + Matrix3::from_diagonal_element(0.01);
        let (m, c) = (0.5 + vector(0.4).x.abs(), vector(0.5));
        Link { J_d: NonstandardInertia::new(central + c * c.transpose() * m).unwrap(), m, c, rho: vector(1.0) }
    });
    Chain { links, g: 9.81, up: vector(1.0).normalize() }
}

/// Joints with multipliers and the minimal form are one integrator: they part by rounding alone.
#[test]
fn a_chain_moves_as_in_its_minimal_form() {
    const N: usize = 5;
    let mut random = Random::new(21);
    for h in [0.01, -0.005] {
        let chain = irregular::<N>(&mut random);
        let minimal = ChainStepper::new(chain, h).unwrap();
        let stepper = with_joints(&chain, h);
        let attitudes: [SO3; N] = from_fn(|_| {
            let xi: Vector3<f64> = random.sample();
            <CayleyRetraction as Retraction<SO3>>::retract(&xi)
        });
        let velocities = Bodies(from_fn(|_| random.sample()));
        let mut expected = minimal.start(attitudes, velocities).unwrap();
        let (places, moving) = placed(&chain, &attitudes, &velocities);
        let mut state = stepper.start(places, moving).unwrap();
        assert!((stepper.energy(&state) - minimal.energy(&expected)).abs() < 1e-12);
        let mut iterations = [0; 2];
        for _ in 0..5 {
            iterations[0] += minimal.run(&mut expected, 20).unwrap();
            iterations[1] += stepper.run(&mut state, 20).unwrap();
            let found = state.attitude().map(|body| body.0);
            let velocity = stepper.velocity(&state);
            let other = minimal.velocity(&expected);
            let slower = (0..N).map(|k| (halves(&velocity.0[k])[0] - other.0[k]).amax()).fold(0.0, f64::max);
            let errors = [apart(&found, &expected.attitude()), slower, stepper.widest_gap(&state)];
            println!("{h}: {errors:?}");
            assert!(errors[0] < 1e-12 && errors[1] < 1e-11 && errors[2] < 4.0 * EPSILON * 5.0, "{errors:?}");
        }
        println!("iterations: {iterations:?}");
        assert!(iterations[1] < 2 * iterations[0]);
    }
}

fn plain(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|k, _| number(&value[k]))
}

/// Of the reference, with this joint as the one that closes the loop.
fn closed_loop(h: f64, cut: usize) -> Held<BallJoint, 3, 3, 3, 1> {
    let data = &read("closed loop")["parameters"];
    let bodies = all(&data["bodies"], |body| Free {
        m: number(&body["m"]),
        K: NonstandardInertia::from_principal_moments(plain(&body["J"])).unwrap(),
    });
    let end = |body: usize, side: &str| plain(&data["bodies"][body][side]);
    let joints = [
        Joined::to_space(BallJoint { above: Vector3::zeros(), below: end(0, "left") }, 0),
        Joined::between(BallJoint { above: end(0, "right"), below: end(1, "left") }, 0, 1),
        Joined::between(BallJoint { above: end(1, "right"), below: end(2, "left") }, 1, 2),
        Joined::to_space(BallJoint { above: plain(&data["pivot"]), below: end(2, "right") }, 2),
    ];
    let tree = from_fn(|k| joints[if k < cut { k } else { k + 1 }]);
    let scene = scene(bodies.try_into().unwrap(), number(&data["g"]), Vector3::z());
    Stepper::jointed(scene, Joints::tree(tree).closed_by([joints[cut]]), h).unwrap()
}

fn state_of(value: &Value) -> ([Body; 3], Components<3>) {
    let bodies = &value["bodies"];
    let of = |k: usize| {
        let attitude = SO3::try_from(matrix(&bodies[k]["R"])).unwrap();
        (attitude, R3::from(vector(&bodies[k]["x"])))
    };
    (from_fn(of), Bodies(from_fn(|k| six(&vector(&bodies[k]["Omega_body"]), &vector(&bodies[k]["v"])))))
}

/// Against Newton's and Euler's equations in inertial coordinates, which share nothing with reduced equations: order
/// 2, in attitudes, places and velocities.
#[test]
fn a_closed_loop() {
    let states = &read("closed loop")["states"];
    let ((start, velocity), (end, expected)) = (state_of(&states[0]), state_of(&states[1]));
    let errors = [(0.01, 100), (0.005, 200), (0.0025, 400)].map(|(h, steps)| {
        let stepper = closed_loop(h, 3);
        let mut state = stepper.start(start, velocity).unwrap();
        assert!((stepper.energy(&state) - number(&states[0]["energy"])).abs() < 1e-13);
        let mut gap = 0.0_f64;
        for _ in 0..steps {
            stepper.step(&mut state).unwrap();
            gap = gap.max(stepper.widest_gap(&state));
        }
        assert!(gap < 4.0 * EPSILON * 2.0, "{gap:e}");
        let found = state.attitude();
        let places = found.iter().zip(&end).map(|(a, b)| (a.1.translation() - b.1.translation()).amax());
        let attitudes = apart(&found.map(|body| body.0), &end.map(|body| body.0));
        let velocities = stepper.velocity(&state);
        let slower = velocities.0.iter().zip(&expected.0).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
        [attitudes, places.fold(0.0, f64::max), slower]
    });
    for of in 0..3 {
        order(&errors.map(|errors| errors[of]));
    }
}

/// Whichever joint of the loop is given apart, and in whichever direction the others are gone through, the motion is
/// the same; with its sums compensated, too.
#[test]
fn a_loop_may_be_cut_anywhere() {
    let (start, velocity) = state_of(&read("closed loop")["states"][0]);
    let moved = [0, 1, 2, 3].map(|cut| {
        let stepper = closed_loop(0.01, cut);
        let mut state = stepper.start(start, velocity).unwrap();
        stepper.run(&mut state, 100).unwrap();
        assert!(stepper.widest_gap(&state) < 4.0 * EPSILON * 2.0);
        state.attitude().map(|body| body.0)
    });
    for other in &moved[1..] {
        assert!(apart(&moved[0], other) < 1e-12, "{:e}", apart(&moved[0], other));
    }
    let compensated = closed_loop(0.01, 3).compensated();
    let mut state = compensated.start(start, velocity).unwrap();
    compensated.run(&mut state, 100).unwrap();
    assert!(apart(&state.attitude().map(|body| body.0), &moved[0]) < 1e-12);
    assert!(closed_loop(0.01, 3).widest_gap(&state) < 6.0 * EPSILON * 2.0);
}

/// A body on a pivot with three on it, one of which carries another: energy, the momentum about the vertical, and the
/// joints. The order of the joints and which of its bodies a joint calls the one above make no difference.
#[test]
fn a_tree() {
    const N: usize = 5;
    let mut random = Random::new(3);
    let mut next = |size: f64| -> Vector3<f64> {
        let vector: Vector3<f64> = random.sample();
        vector * size
    };
    let bodies: [Free; N] = from_fn(|_| Free {
        m: 0.5 + next(1.0).x.abs(),
        K: NonstandardInertia::from_principal_moments(Vector3::new(0.05, 0.06, 0.07) + next(0.01)).unwrap(),
    });
    let joints: [BallJoint; N] = from_fn(|_| BallJoint { above: next(0.5), below: next(0.5) });
    let parents = [None, Some(0), Some(0), Some(0), Some(2)];
    let straight: [Joined<BallJoint>; N] = from_fn(|k| Joined { joint: joints[k], above: parents[k], below: k });
    let turned: [Joined<BallJoint>; N] = from_fn(|k| {
        let Joined { joint, above, below } = straight[N - 1 - k];
        let back = BallJoint { above: joint.below, below: joint.above };
        above.map_or(straight[N - 1 - k], |above| Joined::between(back, below, above))
    });
    let about = from_fn(|_| {
        let turn: SO3 = <CayleyRetraction as Retraction<SO3>>::retract(&next(1.0));
        (turn, R3::from(next(1.0)))
    });
    let moving = Bodies(from_fn(|_| six(&next(1.0), &next(1.0))));
    let pivot = joints[0].above;
    let about_pivot = |[p, l]: [Vector3<f64>; 2]| (l - pivot.cross(&p)).z;
    let ends = [straight, turned].map(|tree| {
        let stepper = Stepper::jointed(scene(bodies, 9.81, Vector3::z()), Joints::tree(tree), 0.005).unwrap();
        let mut state = stepper.start_nearest(about, moving).unwrap();
        let (energy, vertical) = (stepper.energy(&state), about_pivot(whole(&state)));
        stepper.run(&mut state, 200).unwrap();
        let middle = state.attitude().map(|body| body.0);
        let (mut gap, mut off) = (0.0_f64, 0.0_f64);
        for _ in 0..2000 {
            stepper.step(&mut state).unwrap();
            gap = gap.max(stepper.widest_gap(&state));
            off = off.max((stepper.energy(&state) - energy).abs());
        }
        let moved = about_pivot(whole(&state)) - vertical;
        println!("energy {energy:.3} within {off:.1e}, momentum {moved:.1e}, gap {gap:.1e}");
        assert!(off < 0.02 && moved.abs() < 1e-11 && gap < 4.0 * EPSILON * 2.0);
        middle
    });
    assert!(apart(&ends[0], &ends[1]) < 1e-11, "{:e}", apart(&ends[0], &ends[1]));
}

/// The energy of a loop is bounded over a hundred thousand steps, its joints stay closed, and what is put around steps
/// goes around these.
#[test]
fn energy_of_a_closed_loop() {
    let (start, velocity) = state_of(&read("closed loop")["states"][0]);
    let stepper = closed_loop(0.01, 3);
    let mut state = stepper.start(start, velocity).unwrap();
    let (energy, mut gap) = (stepper.energy(&state), 0.0_f64);
    let (means, most) = tenths(|| {
        stepper.step(&mut state).unwrap();
        gap = gap.max(stepper.widest_gap(&state));
        stepper.energy(&state) - energy
    });
    let [first, second] = [&means[..5], &means[5..]].map(|half| half.iter().sum::<f64>() / 5.0);
    println!("energy {energy:.4}: within {most:.4}, means {means:.5?}; gap {gap:.1e}");
    assert!(most < 0.004 && (first - second).abs() < 2e-4 && gap < 4.0 * EPSILON * 2.0);
    assert!(state.orthogonality_defect() < 1e-12);

    let mut there = stepper.start(start, velocity).unwrap();
    stepper.run(&mut there, 40).unwrap();
    let back = stepper.inverse().unwrap();
    let mut returned = back.adopt(&there);
    back.run(&mut returned, 40).unwrap();
    assert!(apart(&returned.attitude().map(|body| body.0), &start.map(|body| body.0)) < 1e-12);
    let first = stepper.start(start, velocity).unwrap();
    let at = stepper.state_at(&first, 0.4).unwrap();
    assert!(apart(&at.attitude().map(|body| body.0), &there.attitude().map(|body| body.0)) < 1e-12);
    let part = stepper.part(&first, 0.3).unwrap();
    assert!(stepper.widest_gap(&part) < 4.0 * EPSILON * 2.0);

    let saved = serde_json::to_string(&stepper.checkpoint(&there)).unwrap();
    let mut resumed = stepper.resume(&serde_json::from_str(&saved).unwrap()).unwrap();
    stepper.run(&mut resumed, 10).unwrap();
    stepper.run(&mut there, 10).unwrap();
    assert_eq!(resumed, there);
}

/// A ring of six that nothing pulls keeps its momentum and its angular momentum; hung up at one point and pulled down,
/// the part of the latter about the vertical.
#[test]
fn momenta_of_a_ring() {
    const N: usize = 6;
    let side = 0.5;
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.01, 0.05, 0.045)).unwrap();
    let link = BallJoint { above: Vector3::x() * side, below: Vector3::x() * -side };
    let pivot = Vector3::new(-side, 0.0, 0.0);
    // A hexagon, upright; the first side begins at the origin.
    let attitudes: [SO3; N] = from_fn(|k| {
        let k = u8::try_from(k).unwrap();
        SO3::exp(Vector3::y() * (core::f64::consts::FRAC_PI_3 * f64::from(k)))
    });
    let mut corner = Vector3::zeros();
    let places = attitudes.map(|attitude| {
        let along = attitude.as_matrix() * Vector3::x();
        let centre = corner + along * side;
        corner += along * (2.0 * side);
        (attitude, R3::from(centre))
    });
    let mut random = Random::new(8);
    let moving = Bodies(from_fn(|_| {
        let (omega, v): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        six(&omega, &v)
    }));

    let row: [Joined<BallJoint>; N - 1] = from_fn(|k| Joined::between(link, k, k + 1));
    let ring = Joints::tree(row).closed_by([Joined::between(link, N - 1, 0)]);
    let free = Stepper::jointed(scene([Free { m: 1.0, K }; N], 0.0, Vector3::z()), ring, 0.01).unwrap();
    let mut state = free.start_nearest(places, moving).unwrap();
    let ([p, l], energy) = (whole(&state), free.energy(&state));
    let mut gap = 0.0_f64;
    for _ in 0..5000 {
        free.step(&mut state).unwrap();
        gap = gap.max(free.widest_gap(&state));
    }
    let [dp, dl] = whole(&state);
    // It has flown away by its velocity, and roundings of places with it.
    let far = state.attitude()[0].1.translation().norm();
    println!(
        "free: {:.1e} {:.1e}, energy {:.1e}, gap {gap:.1e} at {far:.0} m",
        (dp - p).amax(),
        (dl - l).amax(),
        free.energy(&state) - energy
    );
    assert!((dp - p).amax() < 1e-12 && (dl - l).amax() < 1e-10 && gap < 4.0 * EPSILON * far.max(1.0));
    assert!((free.energy(&state) - energy).abs() < 1e-2 * energy);

    let hung = [Joined::to_space(BallJoint { above: Vector3::zeros(), below: pivot }, 0)];
    let tree: [Joined<BallJoint>; N] = from_fn(|k| if k == 0 { hung[0] } else { row[k - 1] });
    let ring = Joints::tree(tree).closed_by([Joined::between(link, N - 1, 0)]);
    let hanging = Stepper::jointed(scene([Free { m: 1.0, K }; N], 9.81, Vector3::z()), ring, 0.005).unwrap();
    let mut state = hanging.start_nearest(places, moving).unwrap();
    let (vertical, energy) = (whole(&state)[1].z, hanging.energy(&state));
    hanging.run(&mut state, 5000).unwrap();
    println!("hung up: {:.1e}, energy {:.1e}", whole(&state)[1].z - vertical, hanging.energy(&state) - energy);
    assert!((whole(&state)[1].z - vertical).abs() < 1e-11 && (hanging.energy(&state) - energy).abs() < 0.1);
}

/// On a pin a body is a pendulum of one angle: `I (sin δ_k − sin δ_{k−1}) = −h² V'(θ_k)`, with the moment about the
/// pin.
#[test]
fn a_pendulum_on_a_pin() {
    let (h, m, reach) = (0.01, 1.3, 0.7);
    // The axis is the body's z axis and space's y axis, and the body hangs along its x axis.
    let moments = Vector3::new(0.05, 0.2, 0.22);
    let K = NonstandardInertia::from_principal_moments(moments).unwrap();
    let pin = PinJoint {
        above: Vector3::new(0.3, -0.2, 1.0),
        below: Vector3::x() * -reach,
        axis_above: Vector3::y() * 2.0,
        axis_below: Vector3::z(),
    };
    let joints = Joints::tree([Joined::to_space(pin, 0)]);
    let stepper = Stepper::jointed(scene([Free { m, K }], 9.81, Vector3::z()), joints, h).unwrap();
    // From hanging along −z the angle turns towards −x.
    let attitude = |angle: f64| {
        let hanging = Matrix3::from_columns(&[-Vector3::z(), -Vector3::x(), Vector3::y()]);
        SO3::try_from(SO3::exp(Vector3::y() * angle).as_matrix() * hanging).unwrap()
    };
    let centre = |attitude: &SO3| R3::from(pin.above + attitude.as_matrix() * Vector3::x() * reach);
    let (mut angle, rate) = (1.2, -0.8);
    let first = attitude(angle);
    let velocity = first.as_matrix() * (Vector3::z() * rate).cross(&(Vector3::x() * reach));
    let start = [(first, centre(&first))];
    let mut state = stepper.start(start, Bodies([six(&(Vector3::z() * rate), &velocity)])).unwrap();
    let inertia = moments.z + m * reach * reach;
    let torque = |angle: f64| -m * 9.81 * reach * angle.sin();
    let mut momentum = inertia * rate;
    for _ in 0..1000 {
        stepper.step(&mut state).unwrap();
        momentum += 0.5 * h * torque(angle);
        angle += (h * momentum / inertia).asin();
        momentum += 0.5 * h * torque(angle);
    }
    let expected = attitude(angle);
    let errors = [
        apart(&[state.attitude()[0].0], &[expected]),
        (state.attitude()[0].1.translation() - centre(&expected).translation()).amax(),
        (stepper.velocity(&state).0[0].z - momentum / inertia).abs(),
        stepper.widest_gap(&state),
    ];
    println!("{errors:?}");
    assert!(errors[..3].iter().all(|&error| error < 1e-11) && errors[3] < 4.0 * EPSILON * 2.0, "{errors:?}");
}

/// Rods of one metre that hang along their axes, the last with another mass.
fn rods<const N: usize>(last: f64) -> Chain<N> {
    let e = Vector3::z();
    let rod = |m: f64| {
        let central = Matrix3::from_diagonal(&Vector3::new(0.005, 0.005, 1.0 / 12.0)) * m;
        let J_d = NonstandardInertia::new(central + e * e.transpose() * (0.25 * m)).unwrap();
        Link { J_d, m, c: -e * 0.5, rho: -e }
    };
    let mut links = [rod(1.0); N];
    links[N - 1] = rod(last);
    Chain { links, g: 9.81, up: e }
}

/// A hundred links are let go horizontally, and the last has up to ten thousand times the mass of the others: as in
/// their minimal form, and with the energy that they had.
#[test]
fn a_hundred_links_let_go_horizontally() {
    for (last, h, steps, allowed) in [(1.0, 0.005, 200, 1e-9), (1e4, 0.002, 100, 1e-8), (1e-4, 0.002, 100, 1e-8)] {
        let chain = rods::<100>(last);
        let (stepper, minimal) = (with_joints(&chain, h), ChainStepper::new(chain, h).unwrap());
        let flat = [SO3::from_euler_angles(0.3, core::f64::consts::FRAC_PI_2, 0.0); 100];
        let at_rest = Bodies([Vector3::zeros(); 100]);
        let (places, moving) = placed(&chain, &flat, &at_rest);
        let mut state = stepper.start(places, moving).unwrap();
        let mut expected = minimal.start(flat, at_rest).unwrap();
        let before = stepper.energy(&state);
        let mut gap = 0.0_f64;
        for _ in 0..steps / 10 {
            stepper.run(&mut state, 10).unwrap();
            minimal.run(&mut expected, 10).unwrap();
            gap = gap.max(stepper.widest_gap(&state));
        }
        let off = apart(&state.attitude().map(|body| body.0), &expected.attitude());
        let energy = (stepper.energy(&state) - before) / (9.81 * 50.0 * (99.0 + 2.0 * last));
        println!("{last}: {off:.1e} from the minimal form, energy {energy:.1e}, gap {gap:.1e}");
        assert!(off < allowed && energy.abs() < 1e-4 && gap < 4.0 * EPSILON * 100.0);
    }
}

/// Links of one metre in a row from the origin, each turned about the y axis by so much, and where the last ends.
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

/// Three links of one metre with these masses between pivots so far apart, under gravity.
fn garland(masses: [f64; 3], apart: f64) -> Held<BallJoint, 3, 3, 3, 1> {
    let bodies = masses
        .map(|m| Free { m, K: NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1) * m).unwrap() });
    let [left, right] = [-0.5, 0.5].map(|x| Vector3::x() * x);
    let pivot = |x: f64, below| BallJoint { above: Vector3::x() * x, below };
    let joints = Joints::tree([
        Joined::to_space(pivot(0.0, left), 0),
        Joined::between(BallJoint { above: right, below: left }, 0, 1),
        Joined::between(BallJoint { above: right, below: left }, 1, 2),
    ]);
    let joints = joints.closed_by([Joined::to_space(pivot(apart, right), 2)]);
    Stepper::jointed(scene(bodies, 9.81, Vector3::z()), joints, 0.002).unwrap()
}

/// A loop whose bodies differ by ten thousand in mass: energy and joints as ever. It can't be stretched.
#[test]
fn a_loop_of_unlike_masses() {
    for masses in [[1e4, 1.0, 1.0], [1.0, 1e4, 1.0], [1.0, 1e-4, 1.0]] {
        let stepper = garland(masses, 0.9);
        let about = row([1.6, 0.3, -1.5]).0;
        let mut state = stepper.start_nearest(about, Bodies([Vector6::from_element(0.2); 3])).unwrap();
        let (before, mut most, mut gap) = (stepper.energy(&state), 0.0_f64, 0.0_f64);
        for _ in 0..2000 {
            stepper.step(&mut state).unwrap();
            most = most.max((stepper.energy(&state) - before).abs());
            gap = gap.max(stepper.widest_gap(&state));
        }
        let scale = 9.81 * masses.iter().sum::<f64>();
        println!("{masses:?}: energy {:.1e}, gap {gap:.1e}", most / scale);
        assert!(most < 1e-3 * scale && gap < 4.0 * EPSILON * 2.0);
    }
}

/// A heavy body stretches the light ones that hold it until the loop is at its singular position, like a blow: up to
/// there energy and joints are kept, and then the joint is named, and the state stays.
#[test]
fn a_loop_that_is_stretched_names_the_joint() {
    let stepper = garland([1e4, 1.0, 1.0], 2.0);
    let mut state = stepper.start_nearest(row([0.9, 0.0, -0.9]).0, Bodies([Vector6::from_element(0.5); 3])).unwrap();
    let (energy, mut gap) = (stepper.energy(&state), 0.0_f64);
    for step in 0..2000 {
        let before = state;
        if let Err(error) = stepper.step(&mut state) {
            let off = (stepper.energy(&state) - energy) / energy;
            println!("after {step} steps: {error}; energy {off:.1e}, gap {gap:.1e}");
            assert!(matches!(error, StepError::SingularJoint { joint: 3, .. }) && state == before);
            assert!(step > 100 && off.abs() < 1e-2 && gap < 4.0 * EPSILON * 2.0);
            return;
        }
        gap = gap.max(stepper.widest_gap(&state));
    }
    panic!("it is never stretched");
}

/// Two links between pivots so far apart that they are stretched: the joint that closes the loop is named, and the
/// state stays.
#[test]
fn a_singular_position_names_the_joint() {
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1)).unwrap();
    let [left, right] = [-0.5, 0.5].map(|x| Vector3::x() * x);
    let pivot = |x: f64, below| BallJoint { above: Vector3::x() * x, below };
    let joints = |apart: f64| {
        let link = BallJoint { above: right, below: left };
        let tree = [Joined::to_space(pivot(0.0, left), 0), Joined::between(link, 0, 1)];
        Joints::tree(tree).closed_by([Joined::to_space(pivot(apart, right), 1)])
    };
    let scene = scene([Free { m: 1.0, K }; 2], 9.81, Vector3::z());
    let stepper = Stepper::jointed(scene, joints(2.0), 0.01).unwrap();
    let straight = [0.5, 1.5].map(|x| (SO3::identity(), R3::from(Vector3::x() * x)));
    let still = Bodies([Vector6::zeros(); 2]);
    let refused = stepper.start(straight, still).unwrap_err();
    println!("{refused}");
    assert!(matches!(refused, SetupError::RedundantJoint { joint: 2, .. }));
    assert!(matches!(stepper.start_nearest(straight, still), Err(SetupError::RedundantJoint { joint: 2, .. })));
    // Started elsewhere and taken there.
    let bent = Stepper::jointed(scene, joints(1.9), 0.01).unwrap();
    let tilt = 0.95_f64.acos();
    let about = [1.0, -1.0].map(|side| {
        let attitude = SO3::exp(Vector3::y() * (tilt * side));
        (attitude, R3::from(Vector3::new(0.95 - 0.475 * side, 0.0, -0.5 * tilt.sin())))
    });
    let mut state = bent.start_nearest(about, still).unwrap();
    bent.run(&mut state, 10).unwrap();
    let motion = Stepper::new(scene, 0.01).unwrap().start(straight, still).unwrap();
    let mut taken = stepper.adopt(&motion);
    let before = taken;
    let error = stepper.step(&mut taken).unwrap_err();
    println!("{error}");
    assert!(matches!(error, StepError::SingularJoint { joint: 2, .. }) && taken == before);
}

/// A planar linkage of pins alone: the others do a part of what the last is to do.
#[test]
fn redundant_pins_are_named() {
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1)).unwrap();
    let [left, right] = [-0.5, 0.5].map(|x| Vector3::x() * x);
    let pin = |above, below| PinJoint { above, below, axis_above: Vector3::y(), axis_below: Vector3::y() };
    let ball = |above, below| BallJoint { above, below };
    let (places, corner) = row([0.9, 0.0, -0.9]);
    let tree = Joints::tree([
        Joined::to_space(Joint::Pin(pin(Vector3::zeros(), left)), 0),
        Joined::between(Joint::Pin(pin(right, left)), 0, 1),
        Joined::between(Joint::Ball(ball(right, left)), 1, 2),
    ]);
    let scene = scene([Free { m: 1.0, K }; 3], 9.81, Vector3::z());
    let still = Bodies([Vector6::zeros(); 3]);
    let all_pins = Joints::tree([
        Joined::to_space(Joint::Pin(pin(Vector3::zeros(), left)), 0),
        Joined::between(Joint::Pin(pin(right, left)), 0, 1),
        Joined::between(Joint::Pin(pin(right, left)), 1, 2),
    ]);
    let last = Joined::to_space(Joint::Pin(pin(corner, right)), 2);
    let redundant = Stepper::jointed(scene, all_pins.closed_by([last]), 0.005).unwrap();
    let error = redundant.start(places, still).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SetupError::RedundantJoint { joint: 3, .. }));
    // With balls at both ends of the last body it is a linkage that turns one way, and that body about itself.
    let last = Joined::to_space(Joint::Ball(ball(corner, right)), 2);
    let linkage = Stepper::jointed(scene, tree.closed_by([last]), 0.005).unwrap();
    let mut state = linkage.start(places, still).unwrap();
    let (energy, mut gap, mut off) = (linkage.energy(&state), 0.0_f64, 0.0_f64);
    for _ in 0..2000 {
        linkage.step(&mut state).unwrap();
        gap = gap.max(linkage.widest_gap(&state));
        off = off.max((linkage.energy(&state) - energy).abs());
    }
    // Pins and an even start keep it in its plane.
    let sideways = state.attitude().iter().map(|body| body.1.translation().y.abs()).fold(0.0, f64::max);
    println!("energy {off:.1e}, gap {gap:.1e}, sideways {sideways:.1e}");
    assert!(off < 2e-2 && gap < 4.0 * EPSILON * 2.0 && sideways < 1e-12);
}

/// What can't be started is refused, and says which joint.
#[test]
fn errors_name_the_joint() {
    let chain = rods::<4>(1.0);
    let stepper = with_joints(&chain, 0.01);
    let attitudes = [0.1, 0.5, -0.3, 0.2].map(|tilt| SO3::exp(Vector3::new(tilt, 0.2, 0.0)));
    let velocities = Bodies([Vector3::new(0.3, -0.2, 0.1); 4]);
    let (places, moving) = placed(&chain, &attitudes, &velocities);
    let mut open = places;
    open[2].1 = R3::from(open[2].1.translation() + Vector3::x() * 1e-6);
    let error = stepper.start(open, moving).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SetupError::OffConstraint { joint: 2 | 3, by } if (by - 1e-6).abs() < 1e-12));
    let mut opening = moving;
    opening.0[1][4] += 1e-6;
    let error = stepper.start(places, opening).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SetupError::OffVelocity { joint: 1 | 2, by } if (by - 1e-6).abs() < 1e-12));
    // Both are put right, and what is right stays.
    let state = stepper.start_nearest(open, opening).unwrap();
    let off = (state.attitude()[2].1.translation() - places[2].1.translation()).norm();
    assert!(off < 1e-6 && off > 1e-9 && stepper.widest_gap(&state) < 4.0 * EPSILON * 4.0, "{off:e}");
    let state = stepper.start_nearest(places, moving).unwrap();
    let (right, found) = (stepper.start(places, moving).unwrap(), stepper.velocity(&state));
    assert!(apart(&state.attitude().map(|body| body.0), &attitudes) < 1e-14);
    assert!((found - stepper.velocity(&right)).0.iter().all(|difference| difference.amax() < 1e-13));

    let link = BallJoint { above: Vector3::z(), below: -Vector3::z() };
    let scene = scene([Free { m: 1.0, K: rods::<1>(1.0).links[0].J_d }; 3], 9.81, Vector3::z());
    let refused = |tree: [Joined<BallJoint>; 2]| Stepper::jointed(scene, Joints::tree(tree), 0.01).unwrap_err();
    let first = Joined::between(link, 0, 1);
    assert!(matches!(refused([first, Joined::between(link, 1, 3)]), SetupError::Joint { joint: 1, .. }));
    assert!(matches!(refused([first, Joined::between(link, 2, 2)]), SetupError::Joint { joint: 1, .. }));
    assert!(matches!(refused([first, Joined::between(link, 1, 0)]), SetupError::Joint { .. }));
    let broken = BallJoint { below: Vector3::new(0.0, f64::NAN, 0.0), ..link };
    let error = refused([first, Joined::between(broken, 1, 2)]);
    assert!(matches!(error, SetupError::JointParameter { joint: 1, field: "below", .. }), "{error}");
    let (axis_above, axis_below) = (Vector3::zeros(), Vector3::x());
    let pin = PinJoint { above: Vector3::z(), below: Vector3::z(), axis_above, axis_below };
    let error = Stepper::jointed(scene, Joints::tree([Joined::between(pin, 0, 1)]), 0.01).unwrap_err();
    assert!(matches!(error, SetupError::JointParameter { joint: 0, field: "axis_above", .. }), "{error}");
    assert!(matches!(with_joints_checked(&chain, f64::NAN), Err(SetupError::InvalidStep { .. })));

    // A step that turns a link too far names it.
    let long = with_joints(&chain, 0.1);
    let mut fast = velocities;
    fast.0[2] = Vector3::new(0.0, 0.0, 50.0);
    let (places, moving) = placed(&chain, &attitudes, &fast);
    let mut state = long.start(places, moving).unwrap();
    let before = state;
    let error = long.step(&mut state).unwrap_err();
    println!("{error}");
    assert!(matches!(error, StepError::UnsolvedBody { body: 2, .. }) && state == before, "{error}");
}

fn with_joints_checked(chain: &Chain<4>, h: f64) -> Result<(), SetupError> {
    let stepper = with_joints(chain, 0.01);
    Stepper::jointed(*stepper.scene(), *stepper.plan().joints(), h).map(|_| ())
}

/// A wheel that is pinned at its centre, at the origin and far from it: cosines are compared with one, and places with
/// what the wheel and its place are long.
#[test]
fn a_wheel_on_its_axle() {
    let moments = Vector3::new(0.1, 0.1, 0.2);
    let K = NonstandardInertia::from_principal_moments(moments).unwrap();
    let axis = Vector3::new(0.3, -0.7, 0.2);
    for centre in [Vector3::zeros(), Vector3::new(1e6, 0.0, 0.0)] {
        let pin = PinJoint { above: centre, below: Vector3::zeros(), axis_above: axis, axis_below: Vector3::z() };
        let joints = Joints::tree([Joined::to_space(pin, 0)]);
        let stepper = Stepper::jointed(scene([Free { m: 5.0, K }], 0.0, Vector3::z()), joints, 0.01).unwrap();
        let attitude = nalgebra::Rotation3::rotation_between(&Vector3::z(), &axis).unwrap();
        let about = [(SO3::try_from(*attitude.matrix()).unwrap(), R3::from(centre))];
        for rate in [0.0, 1e-7, 3.0] {
            let turning = Bodies([six(&(Vector3::z() * rate), &Vector3::zeros())]);
            let mut state = stepper.start(about, turning).unwrap();
            stepper.run(&mut state, 1000).unwrap();
            let moved = stepper.velocity(&state).0[0] - turning.0[0];
            assert!(
                moved.amax() < 1e-12 * (rate + 1.0)
                    && stepper.widest_gap(&state) < 8.0 * EPSILON * centre.norm().max(1.0)
            );
            // What steps leave may be started from.
            stepper.start_with_momentum(state.attitude(), state.momentum()).unwrap();
        }
        // It is open by more than roundings.
        let mut open = about;
        open[0].1 = R3::from(centre + Vector3::y() * 1e-10 * centre.norm().max(1.0));
        let error = stepper.start(open, Bodies([Vector6::zeros()])).unwrap_err();
        assert!(matches!(error, SetupError::OffConstraint { joint: 0, .. }), "{error}");
        let closed = stepper.start_nearest(open, Bodies([Vector6::zeros()])).unwrap();
        assert!(stepper.widest_gap(&closed) < 4.0 * EPSILON * centre.norm().max(1.0));
    }
}

/// Systems of any size, at rest and as good as at rest: what roundings leave is compared with what there is.
#[test]
fn small_and_slow() {
    for size in [1.0, 1e-3, 1e-6] {
        let (e, mass) = (Vector3::x() * (0.5 * size), size * size * size);
        let moments = Vector3::new(0.02, 0.1, 0.1) * (mass * size * size);
        let K = NonstandardInertia::from_principal_moments(moments).unwrap();
        let link = BallJoint { above: e, below: -e };
        let joints = Joints::tree([Joined::between(link, 0, 1), Joined::between(link, 1, 2)]);
        let scene = scene([Free { m: mass, K }; 3], 0.0, Vector3::z());
        let stepper = Stepper::jointed(scene, joints, 0.01).unwrap();
        let about = row([0.9, 0.2, -0.5]).0.map(|(turn, place)| (turn, R3::from(place.translation() * size)));
        for rate in [0.0, 1e-7, 1.0] {
            let moving = Bodies([six(&(Vector3::new(0.3, 1.0, -0.2) * rate), &Vector3::zeros()); 3]);
            let mut state = stepper.start_nearest(about, moving).unwrap();
            let [p, l] = whole(&state);
            stepper.run(&mut state, 500).unwrap();
            let after = whole(&state);
            let off = [(after[0] - p).norm() / (mass * size), (after[1] - l).norm() / (mass * size * size)];
            println!("{size:e} {rate:e}: {off:?}, gap {:e}", stepper.widest_gap(&state) / size);
            assert!(stepper.widest_gap(&state) < 8.0 * EPSILON * size);
            assert!(off.iter().all(|&off| off < 1e-12 * (rate + 1.0)), "{off:?}");
        }
    }
}

/// A force that is given to each step anew: with the weight of the bodies it is their step under gravity, and
/// velocities keep to the joints.
#[test]
fn a_control_force() {
    let (start, velocity) = state_of(&read("closed loop")["states"][0]);
    let falling = closed_loop(0.01, 3);
    let data = &read("closed loop")["parameters"];
    let weights = all(&data["bodies"], |body| number(&body["m"]) * number(&data["g"]));
    let bodies = all(&data["bodies"], |body| Free {
        m: number(&body["m"]),
        K: NonstandardInertia::from_principal_moments(plain(&body["J"])).unwrap(),
    });
    let floating = scene::<3>(bodies.try_into().unwrap(), 0.0, Vector3::z());
    let pushed = Stepper::jointed(floating, *falling.plan().joints(), 0.01).unwrap();
    let force = Bodies(from_fn(|k| -Vector6::ith(5, weights[k])));
    let mut expected = falling.start(start, velocity).unwrap();
    falling.run(&mut expected, 100).unwrap();
    let mut state = pushed.start(start, velocity).unwrap();
    let compensated = pushed.clone().compensated();
    let mut carried = compensated.start(start, velocity).unwrap();
    for _ in 0..100 {
        pushed.step_forced(&mut state, &force).unwrap();
        compensated.step_forced(&mut carried, &force).unwrap();
        pushed.start_with_momentum(state.attitude(), state.momentum()).unwrap();
        pushed.start_with_momentum(carried.attitude(), carried.momentum()).unwrap();
    }
    let turned = expected.attitude().map(|body| body.0);
    let off = [state.attitude(), carried.attitude()].map(|found| apart(&found.map(|body| body.0), &turned));
    println!("{off:?}");
    assert!(off.iter().all(|&off| off < 1e-12));
}

/// A joint whose functions repeat each other is named where it starts; what isn't in the group isn't a start either.
#[test]
fn a_joint_that_repeats_itself() {
    /// The height of a point, twice over, and then perhaps a function whose slope is zero.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Heights([f64; 2]);
    impl Constraint<2> for Heights {
        fn name(&self) -> &'static str {
            "heights"
        }

        fn validate(&self) -> Result<(), SetupError> {
            Ok(())
        }
        fn gap(&self, above: &Place, below: &Place) -> nalgebra::SVector<f64, 2> {
            nalgebra::SVector::from(self.0) * (below.position.z - above.position.z)
        }
        fn slope(&self, _: &Place, _: &Place) -> [liestep::methods::Slope<2>; 2] {
            let turn = nalgebra::SMatrix::zeros();
            let shift =
                nalgebra::SMatrix::<f64, 2, 3>::from_fn(|row, column| if column == 2 { self.0[row] } else { 0.0 });
            [liestep::methods::Slope { turn, shift: -shift }, liestep::methods::Slope { turn, shift }]
        }
        fn describe(&self, visit: &mut dyn FnMut(&'static str, f64)) {
            self.0.iter().for_each(|&height| visit("height", height));
        }
    }
    let K = NonstandardInertia::from_principal_moments(Vector3::new(0.02, 0.1, 0.1)).unwrap();
    let still = Bodies([Vector6::zeros()]);
    for heights in [[1.0, 1.0], [1.0, 0.3], [1.0, 0.0], [0.0, 1.0]] {
        let joints = Joints::tree([Joined::to_space(Heights(heights), 0)]);
        let stepper = Stepper::jointed(scene([Free { m: 1.0, K }], 9.81, Vector3::z()), joints, 0.01).unwrap();
        let named = |error: Result<_, SetupError>| matches!(error, Err(SetupError::RedundantJoint { joint: 0, .. }));
        assert!(named(stepper.start([Body::identity()], still).map(|_| ())), "{heights:?}");
        assert!(named(stepper.start_nearest([Body::identity()], still).map(|_| ())), "{heights:?}");
        let nowhere = [(SO3::identity(), R3::from(Vector3::x() * f64::NAN))];
        let error = stepper.start_nearest(nowhere, still).unwrap_err();
        assert!(matches!(error, SetupError::NotInGroup { .. }), "{error}");
    }
}
