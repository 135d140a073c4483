//! Invariants of many steps of tops of higher order: energy without drift, Casimirs and momenta.

use declarations::{self, FourthOrderTop, SixthOrderTop};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::prelude::*;
use nalgebra::{UnitQuaternion, Vector3};

const STEPS: u32 = 100_000;

fn body<L: declarations::Top>() -> L {
    let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0)).unwrap();
    L::new(J, 9.81, Vector3::z(), Vector3::z())
}

fn fourth() -> FourthOrderTop {
    body()
}

fn sixth() -> SixthOrderTop {
    body()
}

/// Relative changes over a run: of the energy's mean between the first and the last tenth, and at the end of `w·w`,
/// `p·w` and `p₃`.
#[derive(Debug)]
struct Changes {
    energy: f64,
    casimirs: f64,
    spin: f64,
}

fn kept<L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular>(
    lagrangian: L,
    h: f64,
) -> Changes {
    let stepper = Stepper::new(lagrangian, h).unwrap();
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0));
    let mut state = stepper.start(attitude, Vector3::new(0.5, 2.15, 12.09)).unwrap();
    let start = state;
    let mean = |state: &mut _, steps: u32| {
        let sum = (0..steps).fold(0.0, |sum, _| {
            stepper.step(state).unwrap();
            sum + stepper.energy(state)
        });
        sum / f64::from(steps)
    };
    let first = mean(&mut state, STEPS / 10);
    mean(&mut state, 8 * (STEPS / 10));
    let last = mean(&mut state, STEPS / 10);
    let casimir = |state: &liestep::motion::Motion<SO3, Vector3<f64>>| state.momentum().dot(&state.advected());
    Changes {
        energy: (last / first - 1.0).abs(),
        casimirs: (state.advected().norm_squared() - 1.0).abs().max((casimir(&state) / casimir(&start) - 1.0).abs()),
        spin: (state.momentum().z / start.momentum().z - 1.0).abs(),
    }
}

fn assert_kept(found: &Changes) {
    println!("{found:?}");
    assert!(found.energy < 1e-5 && found.casimirs < 1e-12 && found.spin < 1e-12);
}

#[test]
fn the_fourth_order_top_keeps_its_invariants() {
    assert_kept(&kept(fourth(), 0.01));
    assert_kept(&kept(fourth(), 0.05));
}

#[test]
fn the_sixth_order_top_keeps_its_invariants() {
    assert_kept(&kept(sixth(), 0.01));
    assert_kept(&kept(sixth(), 0.05));
}
