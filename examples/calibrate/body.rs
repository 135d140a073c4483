//! The top, its gyroscope, and how the readings depend on twelve numbers.

use liestep::effects::{Gravity, PrincipalBody};
use liestep::gradients::Linearised;
use liestep::groups::{CayleyRetraction, LieGroup as _, Retraction as _};
use liestep::laws::samples::Random;
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::methods::{Composed, CompositionScheme};
use liestep::{SO3, Stepper};
use nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};
use workbench::args::Failure;

/// Between two readings, s.
pub(crate) const STEP: f64 = 0.01;
/// Standard deviation of a reading, rad/s.
pub(crate) const NOISE: f64 = 0.01;

/// A scene with a body in its principal axes.
pub(crate) type Top = Sum<PrincipalBody, Gravity>;
/// Three logarithms of the entries of `J_d`, the centre of mass, a turn of the body at the start, its momentum there.
pub(crate) type Numbers = SVector<f64, 12>;
/// How a reading depends on them.
pub(crate) type Row = SMatrix<f64, 3, 12>;

pub(crate) const NAMES: [&str; 12] =
    ["ln J_d1", "ln J_d2", "ln J_d3", "rho 1", "rho 2", "rho 3", "turn 1", "turn 2", "turn 3", "p 1", "p 2", "p 3"];

/// What twelve numbers are changes of: a top and where it starts.
#[derive(Clone, Copy)]
pub(crate) struct Reference {
    pub(crate) moments: Vector3<f64>,
    pub(crate) rho: Vector3<f64>,
    pub(crate) attitude: SO3,
    pub(crate) momentum: Vector3<f64>,
}

/// The top that the readings are of.
pub(crate) fn truth() -> Reference {
    let moments = Vector3::new(2.75, 1.75, 0.25);
    let inertia = Vector3::repeat(moments.sum()) - moments;
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(0.8, 0.0, 0.0)).into();
    let velocity = Vector3::new(0.5, 2.0, 6.0);
    Reference { moments, rho: Vector3::new(0.3, 0.2, 0.4), attitude, momentum: inertia.component_mul(&velocity) }
}

impl Reference {
    /// With the changes made.
    pub(crate) fn changed(&self, numbers: &Numbers) -> Self {
        let part = |first: usize| numbers.fixed_rows::<3>(first).into_owned();
        Self {
            moments: self.moments.component_mul(&part(0).map(f64::exp)),
            rho: self.rho + part(3),
            attitude: self.attitude.compose(&CayleyRetraction::retract(&part(6))),
            momentum: self.momentum + part(9),
        }
    }

    /// The principal moments of inertia, kg m².
    pub(crate) fn inertia(&self) -> Vector3<f64> {
        Vector3::repeat(self.moments.sum()) - self.moments
    }

    /// The vertical, as the body sees it at the start.
    pub(crate) fn vertical(&self) -> Vector3<f64> {
        self.attitude.matrix().transpose() * Vector3::z()
    }

    fn stepper(&self, scheme: CompositionScheme) -> Result<Stepper<Top, Composed<Top>>, Failure> {
        let body = PrincipalBody { J_d: DiagonalNonstandardInertia::from_diagonal(self.moments)? };
        let gravity = Gravity { m: 1.0, g: 9.81, rho: self.rho, up: Vector3::z() };
        Ok(Stepper::composed(body + gravity, STEP, scheme)?)
    }

    /// What a gyroscope without noise reads, rad/s; of the fourth order, or of the eighth.
    pub(crate) fn readings(&self, count: usize, is_exact: bool) -> Result<Vec<Vector3<f64>>, Failure> {
        let scheme = if is_exact { CompositionScheme::KAHAN_LI_8 } else { CompositionScheme::SUZUKI_4 };
        let stepper = self.stepper(scheme)?;
        let mut state = stepper.start_with_momentum(self.attitude, self.momentum)?;
        let mut readings = Vec::with_capacity(count);
        for _ in 0..count {
            stepper.step(&mut state)?;
            readings.push(stepper.velocity(&state));
        }
        Ok(readings)
    }

    /// How the readings change with the numbers, at those of `changes` from here.
    pub(crate) fn jacobian(&self, changes: &Numbers, count: usize) -> Result<Vec<Row>, Failure> {
        let here = self.changed(changes);
        let stepper = here.stepper(CompositionScheme::SUZUKI_4)?;
        let linear = stepper.linearised()?;
        let mut tangent = linear.tangent(&parameters(&linear)?);
        let mut state = stepper.start_with_momentum(here.attitude, here.momentum)?;
        // A turn x of the reference is one of cay(x)⁻¹ T(x) dx of the body.
        let turn = changes.fixed_rows::<3>(6).into_owned();
        let element: SO3 = CayleyRetraction::retract(&turn);
        let turned =
            element.matrix().transpose() * <CayleyRetraction as liestep::groups::Retraction<SO3>>::tangent(&turn);
        let inverse = here.inertia().map(f64::recip);
        let mut rows = Vec::with_capacity(count);
        for _ in 0..count {
            linear.step(&mut state, &mut tangent)?;
            let velocity = stepper.velocity(&state);
            // Ω = J⁻¹ p, and J = tr(J_d) − J_d.
            let mut row = Row::zeros();
            let columns: Vec<Vector3<f64>> =
                tangent.columns().map(|(_, momentum)| momentum.component_mul(&inverse)).collect();
            let by_turn = Matrix3::from_columns(&columns[..3]) * turned;
            for k in 0..3 {
                let (axis, moment) = (Vector3::ith(k, 1.0), here.moments[k]);
                let direct = (Vector3::repeat(1.0) - axis).component_mul(&velocity).component_mul(&inverse);
                row.set_column(k, &((columns[6 + k] - direct) * moment));
                row.set_column(3 + k, &columns[9 + k]);
                row.set_column(6 + k, &by_turn.column(k));
                row.set_column(9 + k, &columns[3 + k]);
            }
            rows.push(row);
        }
        Ok(rows)
    }

    /// The same by forward differences.
    #[cfg(test)]
    pub(crate) fn differences(&self, changes: &Numbers, count: usize, free: &[usize]) -> Result<Vec<Row>, Failure> {
        const SMALL: f64 = 1e-7;
        let readings = self.changed(changes).readings(count, false)?;
        let mut rows = vec![Row::zeros(); count];
        for &number in free {
            let mut changes = *changes;
            changes[number] += SMALL;
            let changed = self.changed(&changes).readings(count, false)?;
            for ((row, changed), reading) in rows.iter_mut().zip(changed).zip(&readings) {
                row.set_column(number, &((changed - reading) / SMALL));
            }
        }
        Ok(rows)
    }
}

/// The entries of `J_d` on its diagonal, and the centre of mass.
fn parameters(linear: &Linearised<'_, Top, Composed<Top>>) -> Result<Vec<usize>, Failure> {
    let moments = linear.numbers(0, "J_d").ok_or("the body has no J_d")?;
    let rho = linear.numbers(1, "rho").ok_or("gravity has no rho")?;
    Ok(moments.step_by(4).chain(rho).collect())
}

/// Readings with noise.
pub(crate) fn measured(count: usize, seed: u64) -> Result<Vec<Vector3<f64>>, Failure> {
    let mut random = Random::new(seed);
    let mut noisy = truth().readings(count, true)?;
    for reading in &mut noisy {
        *reading += Vector3::from_fn(|_, _| NOISE * random.normal());
    }
    Ok(noisy)
}
