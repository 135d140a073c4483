//! The cost of a step of the heavy top: (3.13) derived, written by hand for speed, and by Runge–Kutta; then each
//! declared Lagrangian of one body with a full inertia tensor.
//!
//! The scene of the first is the looping case of \[RDAE, figure 3.8\] with `J_d = diag(2, 2, 1)` and `h = 0.01 s`.

use core::hint::black_box;

use declarations::{CayleyTop, FourthOrderTop, FullTop, HeavyTop, LogTop, SixthOrderTop};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};
use workbench::top_equations::Equations;

use crate::by_hand;
use crate::kernel::{Effort, Failure, Group, Kernel};
use crate::stepping::stepping;

const STEP: f64 = 0.01;
const MOMENTS: [f64; 3] = [3.0, 3.0, 4.0];
const WEIGHT: f64 = 9.81;
const RHO: [f64; 3] = [0.0, 0.0, 1.0];
const EFFORT: Effort = Effort { batch: 20_000, rounds: 300, counted: 10_000 };

type TopRun = (Stepper<HeavyTop>, State<SO3, Vector3<f64>>);

fn derived() -> Result<TopRun, Failure> {
    let inertia = DiagonalNonstandardInertia::from_principal_moments(MOMENTS.into())?;
    let top = HeavyTop { J_d: inertia, m: 1.0, g: WEIGHT, rho: RHO.into(), up: Vector3::z() };
    let stepper = Stepper::new(top, STEP)?;
    let (tilt, precession, nutation, spin) = (0.8_f64, 3.0, 0.5, 10.0);
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(tilt, 0.0, 0.0));
    let velocity = Vector3::new(nutation, precession * tilt.sin(), spin + precession * tilt.cos());
    let state = stepper.start(attitude, velocity)?;
    Ok((stepper, state))
}

fn written_by_hand() -> Result<(by_hand::Top, by_hand::State), Failure> {
    let (_, start) = derived()?;
    let attitude = start.attitude();
    let r = attitude.as_matrix();
    let momentum: [f64; 3] = start.momentum().into();
    let first = [0, 1, 2].map(|k| 0.5 * STEP * momentum[k] / MOMENTS[k]);
    let state = by_hand::State {
        attitude: [0, 1, 2].map(|i| [r[(i, 0)], r[(i, 1)], r[(i, 2)]]),
        momentum,
        vertical: start.advected().into(),
        last: first,
        change: [0.0; 3],
        guess: first,
    };
    Ok((by_hand::Top::new(MOMENTS, WEIGHT, RHO, STEP), state))
}

#[inline(never)]
fn run_by_hand(top: &by_hand::Top, state: &mut by_hand::State, steps: u32) {
    for _ in 0..steps {
        assert!(top.step(state), "a solvable step");
    }
}

#[inline(never)]
fn run_runge_kutta(top: &Equations, state: &mut workbench::top_equations::State, steps: u32) {
    for _ in 0..steps {
        *state = top.rk4_step(STEP, state);
    }
}

/// Checks that the derived and the hand-written kernel make the same motion: their largest difference after a thousand
/// steps, relative to the size of each part.
pub(crate) fn check() -> Result<(), Failure> {
    let ((stepper, mut state), (top, mut other)) = (derived()?, written_by_hand()?);
    stepper.run(&mut state, 1000)?;
    run_by_hand(&top, &mut other, 1000);
    let attitude = state.attitude();
    let attitude = (0..3)
        .flat_map(|i| (0..3).map(move |j| (i, j)))
        .map(|(i, j)| (attitude.as_matrix()[(i, j)] - other.attitude[i][j]).abs())
        .fold(0.0, f64::max);
    let momentum = (state.momentum() - Vector3::from(other.momentum)).norm() / state.momentum().norm();
    let vertical = (state.advected() - Vector3::from(other.vertical)).norm();
    let disagreement = attitude.max(momentum).max(vertical);
    println!("derived and by hand after 1000 steps: {disagreement:.1e} apart");
    if disagreement < 1e-12 { Ok(()) } else { Err("the two kernels don't compute the same motion".into()) }
}

/// Kernels of (3.13), by the same body and from the same state.
fn of_one_declaration() -> Group {
    let compensated = || {
        let (stepper, state) = derived()?;
        let compensated = stepper.compensated();
        let state = compensated.adopt(&state);
        Ok((compensated, state))
    };
    let by_hand = || {
        let (top, mut state) = written_by_hand()?;
        Ok(move |steps| {
            run_by_hand(black_box(&top), black_box(&mut state), steps);
            Ok(0)
        })
    };
    let runge_kutta = || {
        let (_, start) = derived()?;
        let (q, p) = (start.attitude().to_quaternion(), start.momentum());
        let rival = Equations::new(MOMENTS, RHO.map(|entry| WEIGHT * entry));
        let mut state = [q.w, q.i, q.j, q.k, p.x, p.y, p.z];
        Ok(move |steps| {
            run_runge_kutta(black_box(&rival), black_box(&mut state), steps);
            Ok(0)
        })
    };
    let kernels = [
        Kernel::new("by hand", by_hand),
        stepping("derived", derived),
        Kernel::new("Runge-Kutta 4", runge_kutta),
        stepping("compensated", compensated),
    ];
    Group::new("(3.13)", EFFORT, kernels)
}

/// The steps of a declaration, with their iterations.
fn declared<L>(name: &str, lagrangian: L, h: f64) -> Kernel
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + Clone + 'static,
{
    Kernel::new(name, move || {
        let stepper = Stepper::new(lagrangian.clone(), h)?;
        let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
        let mut state = stepper.start(attitude, Vector3::new(0.5, 2.15, 12.09))?;
        Ok(move |steps| {
            let mut iterations = 0;
            for _ in 0..steps {
                iterations += u64::from(black_box(&stepper).step(&mut state)?.iterations);
            }
            Ok(iterations)
        })
    })
}

pub(crate) fn groups() -> Result<Vec<Group>, Failure> {
    let J = Inertia::from_principal_moments(Vector3::from(MOMENTS))?;
    let (weight, rho, up) = (WEIGHT, Vector3::z(), Vector3::z());
    let full = FullTop { J_d: J.to_nonstandard(), m: 1.0, g: weight, rho, up };
    let kinetic = |h: f64| {
        let kernels = [
            declared("(3.13)", full.clone(), h),
            declared("Cayley", CayleyTop { J, weight, rho, up }, h),
            declared("log", LogTop { J, weight, rho, up }, h),
            declared("L4", FourthOrderTop { J, weight, rho, up }, h),
            declared("L6", SixthOrderTop { J, weight, rho, up }, h),
        ];
        Group::new(format!("h = {h}"), Effort { batch: 500, rounds: 200, counted: 10_000 }, kernels)
    };
    Ok(vec![of_one_declaration(), kinetic(0.01), kinetic(0.05)])
}
