//! The fit, by Levenberg's and Marquardt's method.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, SVector, Vector3};
use nalgebra_of_levenberg_marquardt as lm;
use workbench::args::Failure;

use crate::body::{NOISE, Numbers, Reference, Row, STEP, truth};

/// How many numbers the readings show.
pub(crate) const FREE: usize = 10;
/// Of a record this long from the start, then of a longer one: on a long one the first guess would turn too far.
const RECORDS: [f64; 4] = [1.0, 2.5, 5.0, 10.0];

/// What is fitted, as directions in the twelve numbers: all but what the readings don't show. The third coordinate of the
/// centre of mass is measured with a ruler, which gives the scale, and the body isn't turned about the vertical.
fn directions(reference: &Reference) -> [Numbers; FREE] {
    let axis = |number: usize| Numbers::ith(number, 1.0);
    let vertical = reference.vertical();
    let across = vertical.cross(&Vector3::x()).normalize();
    let other = vertical.cross(&across);
    let turn = |direction: &Vector3<f64>| {
        let mut numbers = Numbers::zeros();
        numbers.fixed_rows_mut::<3>(6).copy_from(direction);
        numbers
    };
    let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(axis);
    [a, b, c, d, e, turn(&across), turn(&other), axis(9), axis(10), axis(11)]
}

/// A fit of a record.
struct Problem<'a> {
    reference: Reference,
    directions: [Numbers; FREE],
    at: lm::SVector<f64, FREE>,
    readings: &'a [Vector3<f64>],
}

impl Problem<'_> {
    fn changes(&self) -> Numbers {
        self.directions.iter().zip(self.at.iter()).fold(Numbers::zeros(), |sum, (direction, &by)| sum + direction * by)
    }
}

impl LeastSquaresProblem<f64, lm::Dyn, lm::Const<FREE>> for Problem<'_> {
    type ResidualStorage = lm::VecStorage<f64, lm::Dyn, lm::U1>;
    type JacobianStorage = lm::VecStorage<f64, lm::Dyn, lm::Const<FREE>>;
    type ParameterStorage = lm::ArrayStorage<f64, FREE, 1>;

    fn set_params(&mut self, at: &lm::SVector<f64, FREE>) {
        self.at = *at;
    }

    fn params(&self) -> lm::SVector<f64, FREE> {
        self.at
    }

    fn residuals(&self) -> Option<lm::DVector<f64>> {
        let count = self.readings.len();
        // A trial that can't be stepped is a bad one, and not the end.
        let Ok(found) = self.reference.changed(&self.changes()).readings(count, false) else {
            return Some(lm::DVector::repeat(3 * count, 1e6));
        };
        let differences = found.iter().zip(self.readings).flat_map(|(found, read)| {
            let difference = (found - read) / NOISE;
            [difference.x, difference.y, difference.z]
        });
        Some(lm::DVector::from_iterator(3 * count, differences))
    }

    fn jacobian(&self) -> Option<lm::OMatrix<f64, lm::Dyn, lm::Const<FREE>>> {
        let rows = self.reference.jacobian(&self.changes(), self.readings.len()).ok()?;
        let small = along(&rows, &self.directions);
        Some(lm::OMatrix::<f64, lm::Dyn, lm::Const<FREE>>::from_fn(3 * rows.len(), |i, j| small[(i, j)] / NOISE))
    }
}

/// The rows along some directions, below each other.
pub(crate) fn along(rows: &[Row], directions: &[Numbers]) -> DMatrix<f64> {
    let columns: Vec<_> = directions
        .iter()
        .map(|direction| {
            rows.iter()
                .flat_map(|row| {
                    let change = row * direction;
                    [change.x, change.y, change.z]
                })
                .collect::<Vec<f64>>()
        })
        .collect();
    DMatrix::from_fn(3 * rows.len(), directions.len(), |i, j| columns[j][i])
}

/// What a fit has found.
pub(crate) struct Fitted {
    pub(crate) found: Reference,
    /// Root of the mean square of the residuals, rad/s.
    pub(crate) rms: f64,
    /// Standard deviations of what is fitted, in the order of its directions.
    pub(crate) deviations: SVector<f64, FREE>,
}

impl Fitted {
    /// How far the moments' logarithms and two coordinates of the centre of mass are from the truth, in their standard
    /// deviations.
    pub(crate) fn errors(&self) -> [f64; 5] {
        let truth = truth();
        let moments = self.found.moments.component_div(&truth.moments).map(f64::ln);
        let rho = self.found.rho - truth.rho;
        let errors = [moments.x, moments.y, moments.z, rho.x, rho.y];
        core::array::from_fn(|k| errors[k] / self.deviations[k])
    }
}

/// Off by 15 % in every moment and in the centre of mass, and by some degrees; the momentum is what the first reading
/// makes of it.
pub(crate) fn guess(readings: &[Vector3<f64>]) -> Reference {
    let truth = truth();
    let mut guess = truth.changed(&Numbers::from_column_slice(&[
        0.15, -0.15, 0.15, 0.045, -0.03, 0.0, 0.05, -0.05, 0.05, 0.0, 0.0, 0.0,
    ]));
    guess.momentum = guess.inertia().component_mul(&readings[0]);
    guess
}

/// The fit of all readings, from that guess.
pub(crate) fn fit(readings: &[Vector3<f64>]) -> Result<Fitted, Failure> {
    let mut reference = guess(readings);
    let mut rms = f64::NAN;
    for record in RECORDS {
        let count = readings.iter().enumerate().take_while(|(n, _)| (*n as f64) * STEP < record).count();
        let problem = Problem {
            reference,
            directions: directions(&reference),
            at: lm::SVector::zeros(),
            readings: &readings[..count],
        };
        let (solved, report) = LevenbergMarquardt::new().with_patience(50).minimize(problem);
        if !report.termination.was_successful() {
            return Err(format!("the fit of {record} s has failed: {:?}", report.termination).into());
        }
        reference = reference.changed(&solved.changes());
        rms = NOISE * (2.0 * report.objective_function / (3.0 * count as f64)).sqrt();
    }
    let deviations = deviations(&reference, readings.len())?;
    Ok(Fitted { found: reference, rms, deviations })
}

/// Standard deviations of what a record of this number of readings gives.
pub(crate) fn deviations(reference: &Reference, count: usize) -> Result<SVector<f64, FREE>, Failure> {
    let rows = reference.jacobian(&Numbers::zeros(), count)?;
    let jacobian = along(&rows, &directions(reference));
    let normal = jacobian.transpose() * &jacobian;
    let inverse = normal.try_inverse().ok_or("the readings don't show what is fitted")?;
    Ok(SVector::from_fn(|k, _| NOISE * inverse[(k, k)].sqrt()))
}
