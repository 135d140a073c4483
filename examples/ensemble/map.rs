//! A map of the chaos of an asymmetric heavy top: Lyapunov exponents over a grid of tilts and spins.
//!
//! Each point of the grid is a pair of members with almost the same initial state. The map shows the exponent over a
//! finite time, `ln(d(T)/d(0))/T`: for a regular motion it falls with `T` like `ln T/T`, for a chaotic one it stays.
//!
//! `Linearisation::lyapunov_exponents` computes all exponents of one motion. Its tangent maps belong to single motions,
//! whereas pairs are ordinary members, in lanes; and the map shows only the largest exponent.

use liestep::effects::{Gravity, PrincipalBody};
use liestep::mechanics::{DiagonalNonstandardInertia, Sum};
use liestep::{SO3, Stepper};
use liestep_ensemble::{Ensemble, Member, Status, Store};
use nalgebra::Vector3;

use crate::Mistake;

const STEP: f64 = 0.01; // s
const STEPS: u64 = 2_000;
/// The initial distance of the tilts of a pair, rad: `exp(λT)` of it is still small for the largest exponents here.
const APART: f64 = 1e-9;

type Top = Stepper<Sum<PrincipalBody, Gravity>>;

/// A grid of tilts (0.1 to 3 rad) across and spins (0 to 8 rad/s) upwards.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// The number of points across.
    pub(crate) tilts: u64,
    /// The number of points upwards.
    pub(crate) spins: u64,
}

impl Grid {
    /// The tilt and the spin of a point, rad and rad/s.
    #[allow(clippy::cast_precision_loss)] // a grid
    pub(crate) fn point(&self, number: u64) -> (f64, f64) {
        let (across, up) = (number % self.tilts, number / self.tilts);
        (0.1 + 2.9 * across as f64 / (self.tilts - 1) as f64, 8.0 * up as f64 / (self.spins - 1) as f64)
    }

    /// The ensemble with two members per point.
    pub(crate) fn ensemble(self) -> Ensemble<Top> {
        let make = move |member: &Member<'_>| {
            let (tilt, spin) = self.point(member.number() / 2);
            let tilt = tilt + if member.number() % 2 == 1 { APART } else { 0.0 };
            let J_d = DiagonalNonstandardInertia::from_principal_moments(Vector3::new(2.0, 3.0, 4.0))?;
            let gravity = Gravity { m: 1.0, g: 9.81, rho: Vector3::new(0.3, 0.1, 0.9), up: Vector3::z() };
            let stepper = Stepper::new(PrincipalBody { J_d } + gravity, STEP)?;
            let state = stepper.start(SO3::exp(Vector3::x() * tilt), Vector3::new(0.0, 0.0, spin))?;
            Ok((stepper, state))
        };
        Ensemble::new("pairs of tops", 2 * self.tilts * self.spins, STEPS, make)
            .chunks_of(256)
            .every(STEPS)
            .keep(["p1", "p2", "p3"], |run| run.state.momentum().into())
            .keep(["w1", "w2", "w3"], |run| run.state.advected().1.into())
    }

    /// The exponent of each point, 1/s, if neither of its tops failed.
    #[allow(clippy::cast_precision_loss)] // steps
    pub(crate) fn exponents(&self, ensemble: &Ensemble<Top>, store: &Store) -> Result<Vec<Option<f64>>, Mistake> {
        let ends = usize::try_from(2 * self.tilts * self.spins)?;
        let (mut first, mut last) = (vec![[f64::NAN; 6]; ends], vec![[f64::NAN; 6]; ends]);
        for shard in ensemble.shards(store)? {
            let rows = shard.map_err(|fault| fault.to_string())?.rows;
            for (row, member) in rows.member.iter().enumerate() {
                let values = [0, 1, 2, 3, 4, 5].map(|column| rows.columns[column][row]);
                let member = usize::try_from(*member)?;
                match rows.status[row] {
                    Status::Going => first[member] = values,
                    Status::Finished => last[member] = values,
                    Status::Stopped | Status::Impossible | Status::Left => {}
                }
            }
        }
        let apart = |pair: &[[f64; 6]]| {
            let difference = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).powi(2));
            difference.sum::<f64>().sqrt()
        };
        let time = STEPS as f64 * STEP;
        let exponent = |(first, last): (&[[f64; 6]], &[[f64; 6]])| (apart(last) / apart(first)).ln() / time;
        let exponents = first.chunks(2).zip(last.chunks(2)).map(exponent);
        Ok(exponents.map(|exponent| exponent.is_finite().then_some(exponent)).collect())
    }
}
