//! Friction between jointed bodies.

use core::array::from_fn;

use liestep::groups::{Advected as _, LieGroup as _};
use liestep::laws::samples::Random;
use liestep::mechanics::{Force as _, Term as _};
use liestep::{SO3, force};
use nalgebra::{Vector3, Vector6};

use super::super::apart;
use super::{Body, Components, EPSILON, Linkage, RIGHT, assert_no_work, ball, chained, falling, rod, row, system};

/// Friction by the relative angular velocity, half of its impulse at either end of a step.
#[force(
    group(F_1 = SO3, F_2 = SO3),
    advected(Q = F_2.seen_from(F_1)),
    displacement(eta_1, eta_2),
    work = {
        let turn = Q * vee(F_2) - vee(F_1);
        -0.5 * c * (turn.dot(&(Q * eta_2 - eta_1)) + turn.dot(&(Q * (F_2 * eta_2_next) - F_1 * eta_1_next)))
    },
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Friction {
    c: f64,
}

const N: usize = 3;

/// A chain with friction in all its joints but the pivot.
fn rubbing(c: f64, h: f64) -> Linkage<N> {
    let bodies = falling([rod(1.0); N], 9.81, Vector3::z());
    let mut system = system(bodies, &chained::<N>());
    for k in 1..N {
        system.between([Some(k - 1), Some(k)], Friction { c });
    }
    Linkage { bodies, stepper: system.stepper(h).unwrap() }
}

/// The start of all chains: bent, and thrown.
fn thrown(held: &Linkage<N>) -> Box<[f64]> {
    let mut random = Random::new(9);
    let moving: Components<N> = from_fn(|_| random.sample());
    held.start_nearest(&row([0.9, 0.2, -0.7]).0, &moving).unwrap()
}

/// The impulses of friction on all bodies before and after a step, by its virtual work.
fn impulses(c: f64, h: f64, start: &[Body; N], end: &[Body; N]) -> [Components<N>; 2] {
    let mut all = [[Vector6::zeros(); N]; 2];
    for k in 1..N {
        let [now, next] = [start, end].map(|bodies| (bodies[k - 1].0, bodies[k].0));
        let f = now.inverse().compose(&next).matrix();
        let term = Friction { c };
        let w = term.advected().seen_from(&now);
        for (component, side) in (0..6).flat_map(|component| [0, 1].map(|side| (component, side))) {
            let axis = Vector6::ith(component, 1.0);
            let ends = [0, 1].map(|end| if end == side { axis } else { Vector6::zeros() });
            all[side][k - 1 + component / 3][component % 3] += term.virtual_work(&f, &w, h, &ends[0], &ends[1]);
        }
    }
    all
}

/// The momenta less the impulses of friction are changed by joints alone, which do no work.
#[test]
fn joints_with_friction_do_no_other_work() {
    let (c, h) = (0.8, 0.005);
    let held = rubbing(c, h);
    let mut state = thrown(&held);
    for step in 0..300 {
        let (start, before) = held.motion(&state);
        held.step(&mut state).unwrap();
        let (end, after) = held.motion(&state);
        if step % 50 == 0 {
            let [first, last] = impulses(c, h, &start, &end);
            assert!(first.iter().map(Vector6::amax).fold(0.0, f64::max) > 1e-4);
            let before = from_fn(|body| before[body] + first[body]);
            let after = from_fn(|body| after[body] - last[body]);
            let still = [Vector6::zeros(); N];
            assert_no_work((&held.scene(), h), &chained::<N>(), &still, [(start, before), (end, after)]);
        }
        assert!(held.widest_gap(&state) < 4.0 * EPSILON * 3.0);
    }
}

/// Steps of a chain with friction are of second order, by Richardson's ratio.
#[test]
fn friction_is_of_order_two() {
    let ends = [100_u32, 200, 400].map(|steps| {
        let held = rubbing(0.3, 0.5 / f64::from(steps));
        let mut state = thrown(&held);
        held.run(&mut state, steps.into()).unwrap();
        held.turns(&state)
    });
    let ratio = apart(&ends[0], &ends[1]) / apart(&ends[1], &ends[2]);
    println!("{ratio}");
    assert!((ratio - 4.0).abs() < 0.04, "{ratio}");
}

/// Means of the energy fall from weak to strong friction, `c h/J` from 1e-3 to 1e3, over ten thousand steps, and the energy
/// never exceeds its start by more than without friction.
#[test]
fn friction_of_any_strength_takes_energy() {
    let run = |x: f64| {
        let h = 0.01;
        // The inertia of a rod about its end.
        let held = rubbing(x * 0.35 / h, h);
        let mut state = thrown(&held);
        let start = held.energy(&state);
        let (mut means, mut above) = ([0.0; 10], 0.0_f64);
        for mean in &mut means {
            for _ in 0..1000 {
                held.step(&mut state).unwrap();
                let energy = held.energy(&state);
                above = above.max(energy - start);
                *mean += energy / 1000.0;
            }
            assert!(held.widest_gap(&state) < 1e-14);
        }
        (means, above)
    };
    let (_, band) = run(0.0);
    for exponent in -3..=3 {
        let x = 10_f64.powi(exponent);
        let (means, above) = run(x);
        println!("{x:e}: {means:.4?}, above the start by {above:.1e} ({band:.1e} without friction)");
        // At rest, or as one rigid body, there is nothing left to take.
        let falls = |pair: &[f64]| pair[1] < pair[0] + 1e-9 * pair[0].abs();
        assert!(means.windows(2).all(falls) && means[1] < means[0], "{x:e}: {means:?}");
        assert!(above <= band, "{x:e}: {above:e}");
    }
}

/// Two pivots at either end, and friction in the joints of the loop: the equations of loops have the blocks of terms, too.
#[test]
fn a_loop_with_friction_comes_to_rest() {
    let held = |h: f64| {
        let bodies = falling([rod(1.0); N], 9.81, Vector3::z());
        let mut system = system(bodies, &chained::<N>());
        system.join(ball(Vector3::new(2.0, 0.0, 0.0), RIGHT), None, N - 1);
        for k in 0..N {
            system.between([k.checked_sub(1), Some(k)], Friction { c: 0.4 });
        }
        system.between([Some(0), Some(2)], Friction { c: 0.1 });
        Linkage { bodies, stepper: system.stepper(h).unwrap() }
    };
    let of = |h: f64, steps: u64| {
        let held = held(h);
        let mut random = Random::new(12);
        let moving: Components<N> = from_fn(|_| random.sample());
        let mut state = held.start_nearest(&row([1.0, 0.0, -1.0]).0, &moving).unwrap();
        held.run(&mut state, steps).unwrap();
        assert!(held.widest_gap(&state) < 1e-14);
        (held.turns(&state), held.energy(&state), held.momenta(&state))
    };
    let ends = [of(0.01, 100), of(0.005, 200), of(0.0025, 400)];
    let ratio = apart(&ends[0].0, &ends[1].0) / apart(&ends[1].0, &ends[2].0);
    println!("{ratio}");
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    // The swing across the plane decays slowly.
    let fastest = [5000, 10_000].map(|steps| of(0.01, steps).2.iter().map(Vector6::amax).fold(0.0, f64::max));
    println!("{fastest:?}");
    assert!(fastest[0] < 0.1 && fastest[1] < 0.01 * fastest[0], "{fastest:?}");
}
