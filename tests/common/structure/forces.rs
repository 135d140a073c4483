//! The terms derived from the virtual work of a force.

use liestep::groups::{Advected as _, LieGroup as _, Retraction as _};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::Force;
use liestep::numbers::Coordinates as _;

use super::numbers::from_numbers;
use super::{Group, Vector, axis, norm};

/// Compares the stages with the declared virtual work, at a random increment.
pub fn assert_stages<E: Force<Scalar = f64, Group: Group>>(force: &E, random: &mut Random) {
    let (h, half) = (0.1, random.sample::<Vector<E>>() * 0.4);
    let element = E::Retraction::retract(&(half * 2.0));
    let f = element.matrix();
    let w = force.advected().seen_from(&E::Group::along(&random.sample(), 1.0));
    // The components of `f⁻` and `f⁺`.
    let forces = |f: &_| {
        [[1.0, 0.0], [0.0, 1.0]].map(|[before, after]| -> Vector<E> {
            let work = |k| force.virtual_work(f, &w, h, &axis(k, before), &axis(k, after));
            from_numbers((0..E::Group::DIMENSION).map(work))
        })
    };
    let constants = force.constants(h);
    let [before, after] = forces(&f);
    let kick = E::kick_before(&constants, &w);
    // The unknown part is U = −(f⁻ − kick_before), and newton_system is a multiple of U − a.
    let a: Vector<E> = random.sample();
    let terms = E::step_terms(&constants, &a, &w);
    let (residual, jacobian) = E::newton_system(&constants, &terms, &half);
    let factor = 0.5 * h * (1.0 + half.dot(&half)).powi(E::FACTS.denominators.cast_signed());
    let missed = norm(&(residual - (kick - before - a) * factor));
    assert!(missed < 1e-13 * factor * (1.0 + norm(&before)), "{missed:e}");
    for j in 0..E::Group::DIMENSION {
        let slope = derivative(|s| E::newton_system(&constants, &terms, &(half + axis(j, s))).0);
        let missed = norm(&(Vector::<E>::column(&jacobian, j) - slope));
        assert!(missed < 1e-9 * (1.0 + norm(&slope)), "Newton's column {j}: {missed:e}");
        let slope = derivative(|s| -forces(&E::Group::turn(j, s).compose(&element).matrix())[0]);
        let missed = norm(&(Vector::<E>::column(&force.momentum_jacobian(&f, &w, h), j) - slope));
        assert!(missed < 1e-9 * (1.0 + norm(&slope)), "column {j}: {missed:e}");
    }
    let next = w.advect(&element.increment());
    let expected = element.adjoint_transpose(&(before - kick)) + after;
    let missed = norm(&(E::kick_after(&constants, &element.increment(), &next) - expected));
    assert!(missed < 1e-13 * (1.0 + norm(&expected)), "{missed:e}");
}
