//! P1 of splittings: Poisson maps where their kinetic flows are, and as nearly as these where not.

use checks::random::Random;
use checks::structure::poisson::{TOLERANCE, defect_of};
use declarations::{FourthOrderBody, FreeBody, HeavyTop, SixthOrderBody};
use liestep::methods::{KineticFlow, SplittingScheme};
use liestep::{SO3, Stepper};
use nalgebra::Vector3;

use crate::splitting::symmetric;

/// How far a step of length `h` is from a Poisson map at a momentum and a parameter. One off the orbit of the declared
/// one is that of another top, whose vertical it is.
pub(crate) fn poisson_defect<K: KineticFlow<f64>>(
    top: &HeavyTop,
    kinetic: impl Fn() -> K,
    (scheme, h): (SplittingScheme, f64),
    (momentum, w): (&Vector3<f64>, &Vector3<f64>),
) -> f64 {
    let step = |momentum: &Vector3<f64>, w: &Vector3<f64>| {
        let splitting = Stepper::split(HeavyTop { up: *w, ..top.clone() }, h, kinetic(), scheme).unwrap();
        let mut state = splitting.start_with_momentum(SO3::identity(), *momentum).unwrap();
        splitting.step(&mut state).unwrap();
        (state.momentum(), state.advected())
    };
    defect_of::<HeavyTop, 3, 3>(step, momentum, w).0
}

fn assert_poisson<K: KineticFlow<f64>>(top: &HeavyTop, kinetic: impl Fn() -> K, name: &str) {
    let mut random = Random::new(31);
    for scheme in SplittingScheme::ALL {
        for h in [0.1, 0.3] {
            let (momentum, w) = (random.vector() * 3.0, random.vector());
            let defect = poisson_defect(top, &kinetic, (scheme, h), (&momentum, &w));
            println!("{name}, {}, h = {h}: {defect:.1e}", scheme.name());
            assert!(defect < TOLERANCE, "{name}, {}, h = {h}: {defect:e}", scheme.name());
        }
    }
}

#[test]
fn p1_splittings_are_poisson_maps() {
    let (symmetric_top, asymmetric) = (HeavyTop::thesis(), HeavyTop::asymmetric());
    assert_poisson(&symmetric_top, || symmetric(&symmetric_top), "exact");
    assert_poisson(&asymmetric, || FreeBody { J_d: asymmetric.J_d.into() }, "(3.13)");
    assert_poisson(&asymmetric, || FourthOrderBody { J: asymmetric.ordinary_inertia() }, "K4");
    assert_poisson(&asymmetric, || SixthOrderBody { J: asymmetric.ordinary_inertia() }, "K6");
}
