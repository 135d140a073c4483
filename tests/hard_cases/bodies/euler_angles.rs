//! T10: section 3.1 as printed. Each equation of (3.1) to (3.12) from the ones before it, at random angles and rates.

use checks::random::Random;
use liestep::SO3;
use liestep::laws::samples::derivative;
use nalgebra::{Matrix3, Rotation3, Vector3};
use workbench::heavy_top::declaration::HeavyTop;
use workbench::heavy_top::euler_angles::{EulerAngles, SymmetricTop};

fn samples() -> Vec<EulerAngles> {
    let mut random = Random::new(310);
    let tilt = Vector3::new(0.0, 1.2, 0.0);
    (0..20).map(|_| EulerAngles { angles: random.vector() + tilt, rates: random.vector() * 3.0 }).collect()
}

/// The angles and rates after the time `t`, to second order.
fn later(start: &EulerAngles, accelerations: &Vector3<f64>, t: f64) -> EulerAngles {
    EulerAngles { angles: start.angles + start.rates * t, rates: start.rates + accelerations * t }
}

#[test]
fn t10_frame_and_rates() {
    for here in samples() {
        let ((sp, cp), (st, ct)) = (here.angles.x.sin_cos(), here.angles.y.sin_cos());
        let printed = Matrix3::new(cp, sp, 0.0, -ct * sp, ct * cp, st, st * sp, -st * cp, ct);
        let spin = Rotation3::from_axis_angle(&Vector3::z_axis(), here.angles.z);
        let frame = here.attitude() * spin.inverse();
        assert!((frame.transpose() - printed).norm() < 1e-15, "(3.1)");
        // `ω̂ = RᵀṘ`, seen from the frame that doesn't take part in the spin.
        let rate = derivative(|t| later(&here, &Vector3::zeros(), t).attitude());
        let hat = here.attitude().transpose() * rate;
        let velocity = Vector3::new(hat.m32, hat.m13, hat.m21);
        assert!((velocity - here.velocity()).norm() < 1e-11, "(3.2) to (3.4)");
        assert!((spin * velocity - here.velocity_without_spin()).norm() < 1e-11, "(3.2) to (3.4)");
        let [precession, nutation, spin] = here.angles.into();
        let attitude = SO3::from_euler_angles(precession, nutation, spin);
        assert!((attitude.as_matrix() - here.attitude()).norm() < 1e-15, "from_euler_angles");
        assert!((Vector3::from(attitude.euler_angles()) - here.angles).norm() < 1e-14, "euler_angles");
        let back = EulerAngles::of(&here.attitude(), &here.velocity());
        assert!((back.angles - here.angles).norm() + (back.rates - here.rates).norm() < 1e-13, "angles and back");
    }
}

/// `M = Ω × 𝕀ω + 𝕀ω̇` with (3.5) to (3.9); erratum: with the `Ω_Z` that is printed, (3.10) and (3.11) don't follow.
#[test]
fn t10_equations_of_motion() {
    let top = HeavyTop::thesis();
    let SymmetricTop { across, along, weight } = SymmetricTop::of(&top);
    assert_eq!((across, along, weight), (3.0, 4.0, 9.81));
    let inertia = Vector3::new(across, across, along);
    for here in samples() {
        let (sine, cosine) = here.angles.y.sin_cos();
        let accelerations = SymmetricTop::of(&top).accelerations(&here);
        let velocity = here.velocity_without_spin();
        let changing = derivative(|t| later(&here, &accelerations, t).velocity_without_spin());
        let moment =
            |frame: Vector3<f64>| frame.cross(&inertia.component_mul(&velocity)) + inertia.component_mul(&changing);
        let [precession, nutation, spin] = here.rates.into();
        let frame = Vector3::new(nutation, precession * sine, precession * cosine);
        let expected = Vector3::new(weight * sine, 0.0, 0.0);
        assert!((moment(frame) - expected).norm() < 1e-9, "(3.10) to (3.12): {}", moment(frame) - expected);
        let printed = frame + Vector3::new(0.0, 0.0, spin);
        let left = Vector3::new(-across * precession * spin * sine, across * spin * nutation, 0.0);
        assert!((moment(printed) - expected - left).norm() < 1e-9, "what the printed Ω_Z leaves");

        // (3.9) is `mg w × ρ`, in the frame.
        let w = here.attitude().row(2).transpose();
        let torque = w.cross(&top.rho) * (top.m * top.g);
        let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), here.angles.z) * torque;
        assert!((turned - expected).norm() < 1e-14 * weight, "(3.9)");
    }
}
