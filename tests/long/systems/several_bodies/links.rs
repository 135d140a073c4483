//! Chains of links on ball joints, solved link by link: compared with steps of 30 digits, with the same chain and a
//! full Newton matrix, and with derivatives of the action as a function of the positions of all masses.

use declarations::DoublePendulum;
use declarations::motions::{chain3, link, matrix, number, read, start3, vector};
use liestep::effects::Spring;
use liestep::groups::{CayleyRetraction, Retraction};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::On;
use liestep::methods::{Chain, Link};
use liestep::motion::Integrator as _;
use liestep::numbers::{Bodies, Coordinates as _};
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper};
use nalgebra::{Matrix3, SVector, Vector3, Vector6};

use super::{all, apart, array, assert_reference, attitudes_of, momentum, part, stacked};

fn farthest<const N: usize>(a: &Bodies<Vector3<f64>, N>, b: &[Vector3<f64>]) -> f64 {
    a.0.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// The reference's chain as one declaration: `J` includes the masses beyond a link, and `s` is their moment.
#[liestep::lagrangian(
    group(F_1 = SO3, F_2 = SO3, F_3 = SO3),
    advected(
        w_1 = up.seen_from(F_1),
        w_2 = up.seen_from(F_2),
        w_3 = up.seen_from(F_3),
        Q = F_2.seen_from(F_1),
        R = F_3.seen_from(F_2),
        S = F_3.seen_from(F_1),
    ),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + ((F_3 - I) * J_3 * (F_3 - I).transpose()).trace() / (2.0 * h)
        + ((F_1 - I) * rho_1).dot(&(Q * ((F_2 - I) * s_2) + S * ((F_3 - I) * s_3))) / h
        + ((F_2 - I) * rho_2).dot(&(R * ((F_3 - I) * s_3))) / h
        - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2)) + w_3.dot(&(s_3 + F_3 * s_3))),
)]
struct Chain3 {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    J_3: NonstandardInertia,
    rho_1: Vector3<f64>,
    rho_2: Vector3<f64>,
    s_1: Vector3<f64>,
    s_2: Vector3<f64>,
    s_3: Vector3<f64>,
    g: f64,
    up: Vector3<f64>,
}

impl From<Chain<3>> for Chain3 {
    fn from(Chain { links: [first, second, third], g, up }: Chain<3>) -> Self {
        let hanging = |link: &Link, m: f64| {
            let J = NonstandardInertia::new(link.J_d.as_matrix() + link.rho * link.rho.transpose() * m).unwrap();
            (J, link.c * link.m + link.rho * m)
        };
        let ((J_1, s_1), (J_2, s_2)) = (hanging(&first, second.m + third.m), hanging(&second, third.m));
        let (J_3, s_3) = hanging(&third, 0.0);
        Self { J_1, J_2, J_3, rho_1: first.rho, rho_2: second.rho, s_1, s_2, s_3, g, up }
    }
}

/// Golden steps, link by link and with the whole Newton matrix of the declared chain; and small steps, for which the
/// diamond's terms in 1/h lose no digit.
#[test]
fn golden_steps() {
    let golden = &read("several bodies")["golden steps"]["chain3"];
    let (h, start): (_, [SO3; 3]) = (number(&golden["h"]), array(attitudes_of(&golden["R0"])));
    for (h, steps, is_golden) in [(h, 1, true), (h, 5, true), (1e-4, 1, false), (1e-5, 1, false)] {
        let (declared, chain) = (Stepper::new(Chain3::from(chain3()), h).unwrap(), chain3().stepper(h).unwrap());
        let mut whole = declared.start_with_momentum(<(SO3, SO3, SO3)>::from(start), momentum(&golden["mu0"])).unwrap();
        let mut state = chain.start_with_momentum(start, Bodies(array(all(&golden["mu0"], vector)))).unwrap();
        assert!((declared.energy(&whole) - chain.energy(&state)).abs() < 1e-13);
        declared.run(&mut whole, steps).unwrap();
        chain.run(&mut state, steps).unwrap();
        let both: [([SO3; 3], SVector<f64, 9>); 2] =
            [(whole.attitude().into(), whole.momentum()), (state.attitude(), stacked(&state.momentum().0))];
        let [turned, expected] = ["R", "mu"].map(|name| &golden[format!("{name}{steps}")]);
        let (turned, expected) =
            if is_golden { (attitudes_of(turned), momentum(expected)) } else { (both[1].0.to_vec(), both[1].1) };
        for (attitudes, found) in both {
            let errors = [apart(&attitudes, &turned), (found - expected).norm() / expected.norm()];
            println!("{steps} of {h}: {errors:?}");
            assert!(errors[0] < 1e-14 && errors[1] < if is_golden { 1e-14 } else { 2e-14 }, "{errors:?}");
        }
    }
}

/// The order, and the errors relative to unreduced steps; the energy at the start is the reference's.
#[test]
fn trajectory() {
    let states = &read("several bodies")["chain3"]["states"];
    let (attitudes, velocities) = start3();
    let errors = [(0.02, 100), (0.01, 200), (0.005, 400), (0.0025, 800)].map(|(h, steps)| {
        let stepper = chain3().stepper(h).unwrap();
        let mut state = stepper.start(attitudes, velocities).unwrap();
        assert!((stepper.energy(&state) - number(&states[0]["energy"])).abs() < 1e-13);
        assert!(farthest(&stepper.velocity(&state), &velocities.0) < 1e-14);
        let before = stepper.vertical_momentum(&state);
        stepper.run(&mut state, steps).unwrap();
        assert!((stepper.vertical_momentum(&state) - before).abs() < 1e-12);
        let end = &states[1]["bodies"];
        let attitude = (state.attitude()[0].as_matrix() - matrix(&end[0]["R"])).amax();
        (attitude, (stepper.velocity(&state).0[2] - vector(&end[2]["Omega_body"])).amax())
    });
    assert_reference(&errors);
}

/// Two links are the double pendulum, declared and solved with its whole Newton matrix.
#[test]
fn two_links_are_the_declared_double_pendulum() {
    let central = Matrix3::new(0.3, 0.02, -0.03, 0.02, 0.2, 0.01, -0.03, 0.01, 0.4);
    let upper = link(&central, 1.2, Vector3::new(0.1, 0.05, -0.5), Vector3::new(0.1, 0.2, -1.0));
    let lower = link(&(central * 0.3), 0.7, Vector3::new(0.05, -0.1, -0.4), Vector3::zeros());
    let (rho, up) = (upper.rho, Vector3::new(0.6, 0.0, 0.8));
    let J_1 = NonstandardInertia::new(upper.J_d.as_matrix() + rho * rho.transpose() * lower.m).unwrap();
    let (s_1, s_2) = (upper.c * upper.m + rho * lower.m, lower.c * lower.m);
    let declared = DoublePendulum { J_1, J_2: lower.J_d, rho, s_1, s_2, g: 9.81, up };
    let chain = Chain { links: [upper, lower], g: 9.81, up };
    let attitudes = [SO3::from_euler_angles(0.3, 1.0, -0.2), SO3::from_euler_angles(-0.5, 0.4, 0.1)];
    let velocity = Vector6::new(0.5, -1.0, 2.0, 1.0, 0.3, -0.5);
    // The diamond's terms in 1/h lose no digit if the step is small.
    for (h, steps) in [(0.01, &[1, 99][..]), (1e-4, &[1]), (1e-5, &[1])] {
        let (declared, stepper) = (Stepper::new(declared.clone(), h).unwrap(), chain.stepper(h).unwrap());
        let mut whole = declared.start((attitudes[0], attitudes[1]), velocity).unwrap();
        let mut state = stepper.start(attitudes, Bodies([part(&velocity, 0), part(&velocity, 1)])).unwrap();
        assert!((stepper.energy(&state) - declared.energy(&whole)).abs() < 1e-13);
        for &steps in steps {
            declared.run(&mut whole, steps).unwrap();
            stepper.run(&mut state, steps).unwrap();
            let expected = [part(&whole.momentum(), 0), part(&whole.momentum(), 1)];
            let errors = [
                apart(&state.attitude(), &[whole.attitude().0, whole.attitude().1]),
                farthest(&state.momentum(), &expected),
            ];
            println!("{steps} of {h}: {errors:?}");
            assert!(errors.iter().all(|&error| error < if steps == 1 { 1e-14 } else { 1e-12 }), "{errors:?}");
        }
    }
}

/// Links without any symmetry.
pub(super) fn irregular<const N: usize>(random: &mut Random) -> Chain<N> {
    let mut vector = |size: f64| -> Vector3<f64> {
        let vector: Vector3<f64> = random.sample();
        vector * size
    };
    let links = [(); N].map(|()| {
        let shape = Matrix3::from_columns(&[vector(0.3), vector(0.3), vector(0.3)]);
        let central = shape * shape.transpose() + Matrix3::from_diagonal_element(0.01);
        link(&central, 0.5 + vector(0.4).x.abs(), vector(0.5), vector(1.0))
    });
    Chain { links, g: 9.81, up: vector(1.0).normalize() }
}

/// The discrete action `L_d` of the attitudes before and after a step, as a function of the positions of all masses,
/// without reduction.
fn action<const N: usize>(chain: &Chain<N>, h: f64, before: &[SO3; N], after: &[SO3; N]) -> f64 {
    let (mut action, mut joints) = (0.0, [Vector3::zeros(); 2]);
    for (k, link) in chain.links.iter().enumerate() {
        let turns = [before[k].as_matrix(), after[k].as_matrix()];
        let [first, second] = [0, 1].map(|end| joints[end] + turns[end] * link.c);
        let central = link.J_d.as_matrix() - link.c * link.c.transpose() * link.m;
        let turned = turns[1] - turns[0];
        let way: Vector3<f64> = second - first;
        action += ((turned * central * turned.transpose()).trace() + link.m * way.norm_squared()) / (2.0 * h)
            - 0.5 * h * link.m * chain.g * chain.up.dot(&(first + second));
        joints = [0, 1].map(|end| joints[end] + turns[end] * link.rho);
    }
    action
}

/// The momenta before and after a step are the derivatives of the action with respect to the attitudes.
#[test]
fn a_step_is_that_of_the_action() {
    const N: usize = 5;
    let mut random = Random::new(11);
    for h in [0.02, -0.01] {
        let chain = irregular::<N>(&mut random);
        let stepper = chain.stepper(h).unwrap();
        let attitudes = [(); N].map(|()| {
            let xi: Vector3<f64> = random.sample();
            <CayleyRetraction as Retraction<SO3>>::retract(&xi)
        });
        let before = stepper.start(attitudes, Bodies([(); N].map(|()| random.sample()))).unwrap();
        let mut after = before;
        stepper.step(&mut after).unwrap();
        let size = before.momentum().0.iter().map(|momentum: &Vector3<f64>| momentum.norm()).fold(0.0, f64::max);
        for k in 0..3 * N {
            let turned = |attitudes: &[SO3; N], s: f64| {
                let mut turned = *attitudes;
                let axis = Vector3::from_fn(|i, _| if i == k % 3 { s } else { 0.0 });
                turned[k / 3] = turned[k / 3].compose(&<CayleyRetraction as Retraction<SO3>>::retract(&axis));
                turned
            };
            let (start, end) = (before.attitude(), after.attitude());
            let minus = -derivative(|s| action(&chain, h, &turned(&start, s), &end));
            let plus = derivative(|s| action(&chain, h, &start, &turned(&end, s)));
            let found = [before.momentum().0[k / 3][k % 3], after.momentum().0[k / 3][k % 3]];
            let missed = (found[0] - minus).abs().max((found[1] - plus).abs());
            assert!(missed < 1e-8 * size, "{k}: {found:?} {minus} {plus}");
        }
    }
}

/// The functions around a step work with links as with any method: a checkpoint continues with identical bits, a torque
/// does its work, and remedies and compensated sums use the links' inertia.
#[test]
fn what_goes_with_every_stepper() {
    let (attitudes, velocities) = start3();
    let stepper = chain3().stepper(0.001).unwrap();
    let mut state = stepper.start(attitudes, velocities).unwrap();
    stepper.run(&mut state, 100).unwrap();
    let mut resumed = stepper.resume(&stepper.checkpoint(&state)).unwrap();
    for _ in 0..10 {
        stepper.step(&mut state).unwrap();
        stepper.step(&mut resumed).unwrap();
        assert_eq!(resumed, state);
    }
    let (energy, mut work) = (stepper.energy(&state), 0.0);
    for _ in 0..500 {
        let before = stepper.velocity(&state);
        let torque = Bodies([Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.0, 0.1, 0.2), Vector3::new(-0.1, 0.0, 0.1)]);
        stepper.step_forced(&mut state, &torque).unwrap();
        work += 0.0005 * torque.dot(&(before + stepper.velocity(&state)));
    }
    let gained = stepper.energy(&state) - energy;
    println!("gained {gained:.6} of the work {work:.6}");
    assert!((gained - work).abs() < 1e-4 && work.abs() > 0.1, "{gained} {work}");

    let compensated = chain3().stepper(0.001).unwrap().compensated().or_substeps(4);
    let mut carried = compensated.start(attitudes, velocities).unwrap();
    let mut plain = stepper.start(attitudes, velocities).unwrap();
    assert_eq!(compensated.energy(&carried).to_bits(), stepper.energy(&plain).to_bits());
    compensated.run(&mut carried, 1000).unwrap();
    stepper.run(&mut plain, 1000).unwrap();
    let off = farthest(&compensated.velocity(&carried), &stepper.velocity(&plain).0);
    assert!(off < 1e-11 && carried.orthogonality_defect() < 1e-15, "{off:e}");
}

/// Other potentials add to the weight: a spring acts on the last link, and the energy with its own is conserved.
#[test]
fn links_in_a_scene() {
    let (attitudes, velocities) = start3();
    let chain = chain3();
    let spring = Spring { k: 30.0, length: 0.2, at: chain.links[0].rho, anchor: Vector3::new(1.0, 0.5, -0.5) };
    let scene = chain.weights() + On::<0, 3>::of([spring]);
    let stepper = Stepper::linked(scene, chain.links, 0.002).unwrap();
    let free = chain.stepper(0.002).unwrap();
    let mut state = stepper.start(attitudes, velocities).unwrap();
    let mut other = free.start(attitudes, velocities).unwrap();
    let stretched = (stepper.joints(&state)[0] - spring.anchor).norm() - spring.length;
    let before = stepper.energy(&state);
    assert!((before - free.energy(&other) - 0.5 * spring.k * stretched * stretched).abs() < 1e-12);
    let mut off = 0.0_f64;
    for _ in 0..100 {
        stepper.run(&mut state, 10).unwrap();
        off = off.max((stepper.energy(&state) - before).abs());
    }
    free.run(&mut other, 1000).unwrap();
    println!("energy {before:.3} within {off:.1e}");
    assert!(off < 5e-3 && apart(&state.attitude(), &other.attitude()) > 0.1, "{off:e}");
}

/// A step of `−h` undoes one of `h`; parts of a step are steps.
#[test]
fn a_step_back_undoes_a_step() {
    let (attitudes, velocities) = start3();
    let [there, back] = [0.01, -0.01].map(|h| chain3().stepper(h).unwrap());
    let mut state = there.start(attitudes, velocities).unwrap();
    there.run(&mut state, 50).unwrap();
    let mut returned = back.adopt(&state);
    back.run(&mut returned, 50).unwrap();
    assert!(apart(&returned.attitude(), &attitudes) < 1e-13);
    let start = there.start(attitudes, velocities).unwrap();
    let at = there.state_at(&start, 0.5).unwrap();
    assert!(apart(&at.attitude(), &state.attitude()) < 1e-12);
    let standing = chain3().stepper(0.0).unwrap();
    let mut state = start;
    standing.step(&mut state).unwrap();
    assert_eq!((state.attitude(), state.momentum()), (start.attitude(), start.momentum()));
}

/// Rods of one metre that hang along their axes, the last with another mass.
pub(super) fn rods<const N: usize>(last: f64) -> Chain<N> {
    let e = Vector3::z();
    let rod = |m: f64| link(&(Matrix3::from_diagonal(&Vector3::new(0.005, 0.005, 1.0 / 12.0)) * m), m, -e * 0.5, -e);
    let mut links = [rod(1.0); N];
    links[N - 1] = rod(last);
    Chain { links, g: 9.81, up: e }
}

/// The errors name an invalid link, and one that would turn too far; the state stays unchanged.
#[test]
fn errors_name_the_link() {
    let mut chain = rods::<4>(1.0);
    chain.links[2].m = -1.0;
    let refused = |chain: Chain<4>| chain.stepper(0.01).unwrap_err();
    assert!(matches!(refused(chain), SetupError::BodyParameter { body: 2, field: "m", .. }));
    chain = rods(1.0);
    chain.links[1].c = Vector3::new(0.0, 0.0, -5.0);
    assert!(matches!(refused(chain), SetupError::BodyParameter { body: 1, field: "J_d", .. }));
    chain = rods(1.0);
    chain.links[3].rho.x = f64::NAN;
    assert!(matches!(refused(chain), SetupError::BodyParameter { body: 3, field: "rho", .. }));
    assert!(matches!(refused(Chain { g: f64::INFINITY, ..rods(1.0) }), SetupError::Parameter { field: "g", .. }));
    assert!(matches!(rods::<4>(1.0).stepper(f64::NAN), Err(SetupError::InvalidStep { .. })));

    let stepper = rods::<4>(1.0).stepper(0.1).unwrap();
    let mut velocities = [Vector3::zeros(); 4];
    assert!(matches!(
        stepper.start([SO3::identity(); 4], Bodies([Vector3::new(f64::NAN, 0.0, 0.0); 4])),
        Err(SetupError::NonFinite { what: "velocity" })
    ));
    for entry in [1.1, f64::NAN] {
        let stretched = SO3::from_matrix_unchecked(Matrix3::from_diagonal_element(entry));
        for body in 0..4 {
            let mut attitudes = [SO3::identity(); 4];
            attitudes[body] = stretched;
            let off = stepper.start(attitudes, Bodies(velocities));
            assert!(matches!(off, Err(SetupError::NotInGroup { .. })), "{body}: {entry}");
        }
    }
    let twice = Chain { up: Vector3::z() * 2.0, ..rods(1.0) };
    assert!(matches!(refused(twice), SetupError::Parameter { field: "up", .. }));
    velocities[2] = Vector3::new(0.0, 0.0, 50.0);
    let mut state = stepper.start([SO3::identity(); 4], Bodies(velocities)).unwrap();
    let before = state;
    let error = stepper.step(&mut state).unwrap_err();
    assert!(matches!(error, StepError::UnsolvedBody { body: 2, .. }), "{error}");
    assert_eq!(state, before);
}

/// Rods that start without spin move as directions: none gains a momentum about its axis, and their moments about these
/// axes don't matter.
#[test]
fn rods_move_as_directions() {
    let (e, l) = (-Vector3::z(), 1.2);
    let along = e * l;
    let slim = NonstandardInertia::of_rod(1.0 / 3.0, &along).unwrap();
    let slimmer = NonstandardInertia::from_diagonal(Vector3::new(1e-4, 1e-4, l * l / 3.0 - 1e-4)).unwrap();
    let directions = [Vector3::x(), Vector3::new(0.6, 0.0, -0.8), Vector3::new(0.0, 0.8, 0.6), -Vector3::y()];
    let rates = [0.3, -1.0, 2.0, 0.5].map(|rate| Vector3::new(0.5, 1.0, -0.3) * rate);
    let ends = [slim, slimmer].map(|J_d| {
        let links = [Link { J_d, m: 1.0, c: along * 0.5, rho: along }; 4];
        let stepper = Chain { links, g: 9.81, up: Vector3::z() }.stepper(0.005).unwrap();
        let started = [0, 1, 2, 3].map(|k| {
            let q = directions[k];
            J_d.pointing(&e, &q, &(rates[k] - q * q.dot(&rates[k]))).unwrap()
        });
        let velocities = Bodies(started.map(|(_, velocity)| velocity));
        let mut state = stepper.start(started.map(|(attitude, _)| attitude), velocities).unwrap();
        for _ in 0..20 {
            stepper.run(&mut state, 10).unwrap();
            let momenta = state.momentum().0;
            let size = momenta.iter().map(Vector3::norm).fold(0.0, f64::max);
            assert!(momenta.iter().all(|momentum| momentum.z.abs() < 1e-15 * size), "{momenta:?}");
        }
        state.attitude().map(|attitude| attitude.as_matrix() * e)
    });
    let off = ends[0].iter().zip(&ends[1]).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
    assert!(off < 1e-12 && (ends[0][3] - directions[3]).norm() > 0.5, "{off:e}");
}
