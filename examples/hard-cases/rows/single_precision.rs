//! P8: the same in `f32`.

use liestep::effects::{Gravity, PrincipalBody};
use liestep::groups::LieGroup as _;
use liestep::mechanics::DiagonalNonstandardInertia;
use liestep::{SO3, StepError, Stepper};
use nalgebra::{UnitQuaternion, Vector3};

use crate::curves::Curves;
use crate::row::{Effort, Failure, Row};

const EPSILON: f64 = f32::EPSILON as f64;
/// What a bound for `f64` is in units of its epsilon.
fn units(bound: f64) -> f64 {
    bound / f64::EPSILON
}

/// Largest errors of the energy and of the spatial momentum of a free body, in units of epsilon, computed in `f64`.
fn free(moments: [f64; 3], velocity: [f64; 3], h: f64, steps: u32) -> Result<[f64; 2], Failure> {
    let moments = Vector3::from(moments);
    let inertia = DiagonalNonstandardInertia::from_principal_moments(moments.cast::<f32>())?;
    let stepper = Stepper::new(PrincipalBody { J_d: inertia }, single(h))?;
    let mut state = stepper.start(SO3::identity(), Vector3::from(velocity).cast::<f32>())?;
    // The moments that the program has, not those it was to have.
    let d = inertia.diagonal().cast::<f64>();
    let moments = Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y);
    let kept = |momentum: Vector3<f32>, attitude: nalgebra::Matrix3<f32>| {
        let momentum = momentum.cast::<f64>();
        (momentum.dot(&momentum.component_div(&moments)), attitude.cast::<f64>() * momentum)
    };
    let start = kept(state.momentum(), state.attitude().matrix());
    let mut worst = [0.0_f64; 2];
    for _ in 0..steps {
        stepper.step(&mut state)?;
        let now = kept(state.momentum(), state.attitude().matrix());
        worst[0] = worst[0].max((now.0 / start.0 - 1.0).abs() / EPSILON);
        worst[1] = worst[1].max((now.1 - start.1).norm() / start.1.norm() / EPSILON);
    }
    Ok(worst)
}

#[allow(clippy::cast_possible_truncation)] // that is what it is for
fn single(value: f64) -> f32 {
    value as f32
}

type Scene = liestep::mechanics::Sum<PrincipalBody<f32>, Gravity<f32>>;
/// Nothing is advected for the body, the vertical for gravity.
type Turning = liestep::State<SO3<f32>, ((), Vector3<f32>)>;

fn looping(h: f64) -> Result<(Stepper<Scene>, Turning), Failure> {
    let inertia = DiagonalNonstandardInertia::new(Vector3::new(2.0, 2.0, 1.0_f32))?;
    let gravity = Gravity { m: 1.0, g: 9.81_f32, rho: Vector3::z(), up: Vector3::z() };
    let stepper = Stepper::new(PrincipalBody { J_d: inertia } + gravity, single(h))?;
    let tilt = 0.8_f32;
    let velocity = Vector3::new(0.5, 3.0 * tilt.sin(), 10.0 + 3.0 * tilt.cos());
    let state = stepper.start(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt), velocity)?;
    Ok((stepper, state))
}

pub(crate) fn p8(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    // Half-extents 0.1, 0.2, 0.3 and 1 kg.
    let of_box = [0.13 / 3.0, 0.1 / 3.0, 0.05 / 3.0];
    let free_bodies = [
        ("B1", free(of_box, [1.0, 2.0, 3.0], 0.01, 500)?, units(1e-14)),
        ("B2 middle axis", free(of_box, [0.05, 5.0, 0.05], 0.005, 20_000)?, units(1e-13)),
        ("B2 fast spin", free(of_box, [20.0, 0.05, 0.05], 0.005, 20_000)?, units(1e-13)),
        ("B3 plate", free([1.0, 2.0, 3.0], [1.0, 0.5, 0.3], 1.0 / 60.0, 10_000)?, units(1e-13)),
    ];
    let mut row = Row::new("P8", "f32", "thresholds of f64 in units of epsilon; the same errors");
    for (name, [energy, momentum], bound) in free_bodies {
        row = row.at_most(&format!("{name}: energy, ε"), energy, bound).at_most(
            &format!("{name}: momentum, ε"),
            momentum,
            bound,
        );
    }

    // S1, S2.
    let (wide, state) = looping(1.0)?;
    let fold = f64::from(wide.max_step(&state));
    row = row.near("S1 fold", fold, 0.0815, 5e-5);
    let (stepper, mut near) = looping(0.999 * fold)?;
    let iterations = stepper.step(&mut near).map_or(f64::NAN, |report| f64::from(report.iterations));
    row = row.at_most("S1 iterations at 0.999 of the fold", iterations, 9.0);
    let (stepper, mut far) = looping(0.1)?;
    let before = far;
    let refused = matches!(stepper.step(&mut far), Err(StepError::BeyondSolvable { .. })) && far == before;
    row = row.holds("S2 refused, state unchanged", refused);

    // T3, a million steps.
    let (stepper, mut state) = looping(0.01)?;
    let (axial, vertical) = (state.momentum().z, state.momentum().dot(&state.advected().1));
    let (mut changed, mut casimirs, mut orthogonality) = (0_u32, 0.0_f64, 0.0_f64);
    for _ in 0..1_000_000 {
        stepper.step(&mut state)?;
        changed += u32::from(state.momentum().z.to_bits() != axial.to_bits());
        let relative = f64::from(state.momentum().dot(&state.advected().1) / vertical - 1.0).abs();
        casimirs = casimirs.max(relative).max(f64::from(state.advected().1.norm() - 1.0).abs());
        orthogonality = orthogonality.max(f64::from(state.orthogonality_defect()));
    }
    Ok(row
        .at_most("T3, 10⁶ steps: steps that changed p₃", f64::from(changed), 0.0)
        .at_most("T3: ‖RᵀR − I‖, ε", orthogonality / EPSILON, units(2e-12))
        .at_most("T3: Casimirs, ε", casimirs / EPSILON, units(3e-12)))
}
