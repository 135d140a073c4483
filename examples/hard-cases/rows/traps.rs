//! S3: about a principal axis `sin θ = hΩ` has a second root at `π − θ`.

use declarations::FreeBody;
use liestep::groups::Retraction as _;
use liestep::mechanics::Effect;
use liestep::motion::DiscreteLiePoisson;
use liestep::{SO3, StepError};
use nalgebra::{UnitQuaternion, Vector3};
use workbench::measure::greater;

use crate::curves::Curves;
use crate::row::{Effort, Failure, Row};

const STEP: f64 = 0.1;

fn rotation(axis: &Vector3<f64>, degrees: f64) -> SO3 {
    UnitQuaternion::from_scaled_axis(axis * degrees.to_radians()).into()
}

pub(crate) fn s3(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let (mut refused, mut traps, mut wrong, mut error, mut from_below) = (0_u32, 0_u32, 0_u32, 0.0, true);
    for moments in [[3.0, 3.0, 4.0], [2.0, 3.0, 4.5], [1.0, 2.0, 3.0], [1.0, 1.0, 1.0]] {
        let body = FreeBody { J_d: liestep::NonstandardInertia::from_principal_moments(moments.into())? };
        let flow = DiscreteLiePoisson::new(body.clone(), STEP)?;
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let momentum = body.inertia() * axis * (0.5 / STEP);
            let right = axis * 30.0_f64.to_radians();
            let solve = |degrees: f64| {
                let guess = <FreeBody as Effect>::Retraction::local_coordinates(&rotation(&axis, degrees));
                guess.map(|guess| flow.invert_legendre_minus(&momentum, &(), &guess))
            };
            traps += 1;
            refused += u32::from(matches!(solve(150.0), Some(Err(StepError::WrongBranch { .. }))));
            for degrees in (0..=175).step_by(5) {
                match solve(f64::from(degrees)) {
                    Some(Ok(found)) if (found.log() - right).norm() < 1e-6 => {
                        error = greater(error, (found.log() - right).norm());
                    }
                    Some(Ok(_)) => wrong += 1,
                    _ => from_below &= degrees > 90,
                }
            }
        }
    }
    let row = Row::new("S3", "guess at 150° where the root is at 30°", "refused; the wrong root never comes out")
        .holds(&format!("{refused} of {traps} refused as WrongBranch (four bodies, three axes)"), refused == traps)
        .holds(&format!("{wrong} wrong roots from guesses of 0° to 175°"), wrong == 0)
        .holds("solved from every guess up to 90°", from_below)
        .at_most("error of the root in rad", error, 1e-15);
    Ok(row)
}
