//! The memory of laws and wheels in a state.

use nalgebra::Vector3;

/// The memory of a state between its steps.
#[derive(Clone)]
pub(super) struct Memory {
    /// Momenta of the wheels about their axes, kg m²/s.
    pub(super) momenta: Vec<f64>,
    /// Held torques of the laws of wheels, and torques from outside on wheels without a law, N m.
    pub(super) motors: Vec<f64>,
    /// Held torque of each law on a body, N m.
    pub(super) torques: Vec<Vector3<f64>>,
    /// The readings of the last sample of each law.
    pub(super) readings: Vec<Vector3<f64>>,
    /// Time behind the last whole step, s.
    pub(super) part: f64,
}

impl Memory {
    pub(super) fn read(entries: &[f64], (wheels, controls): (usize, usize)) -> Self {
        let (momenta, rest) = entries.split_at(wheels);
        let (motors, rest) = rest.split_at(wheels);
        let (torques, rest) = rest.split_at(3 * controls);
        let (readings, part) = rest.split_at(rest.len() - 1);
        let [torques, readings] =
            [torques, readings].map(|entries| entries.chunks(3).map(Vector3::from_column_slice).collect());
        Self { momenta: momenta.to_vec(), motors: motors.to_vec(), torques, readings, part: part[0] }
    }

    pub(super) fn entries(&self) -> impl Iterator<Item = f64> + '_ {
        let vectors = self.torques.iter().chain(&self.readings).flat_map(|vector| vector.iter().copied());
        self.momenta.iter().chain(&self.motors).copied().chain(vectors).chain([self.part])
    }

    /// The momenta of the wheels this time, s, after the beginning of a step with these torques of their motors.
    pub(super) fn after(&self, motors: &[f64], time: f64) -> Vec<f64> {
        self.momenta.iter().zip(motors).map(|(momentum, torque)| momentum + torque * time).collect()
    }
}
