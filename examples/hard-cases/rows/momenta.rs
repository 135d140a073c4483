//! P2, P3: momentum maps, Casimirs, and how a covector is advected.

use declarations::Motion;
use declarations::{CayleyTop, FourthOrderTop, LogTop, LogTraceTop, SixthOrderTop};
use liestep::SO3;
use liestep::groups::{Advected, ContravariantVector, Heisenberg, LieGroup as _, SE2, SE3, SL2};
use liestep::laws::samples::{MatrixLieGroup, Random, eliminated_inverse};
use liestep::mechanics::{DiscreteLagrangian, Inertia, Regular};
use liestep::motion::DiscreteLiePoisson;
use nalgebra::{SVector, Vector3};
use workbench::measure::{greater, relative};

use crate::curves::Curves;
use crate::row::{Effort, Failure, Row};

const H: f64 = 0.05;

/// How far `left = Ad* right` and `μ⁺ = Ad*(μ + diamond)` are from holding, relative, and the Casimirs `|w|²` and
/// `μ·w`.
fn laws<L>(lagrangian: L) -> Result<[f64; 3], Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular,
{
    let flow = DiscreteLiePoisson::new(lagrangian, H)?;
    let (mut random, mut worst) = (Random::new(12), [0.0; 3]);
    for _ in 0..20 {
        let (sample, w): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        let (momentum, w) = (sample * 10.0, w.normalize());
        let step = flow.step(&momentum, &w, &Vector3::zeros())?;
        let (l, f) = (flow.scene(), step.element());
        let right = l.right_momentum(&f.matrix(), &w, H);
        let left = l.left_momentum(&f.matrix(), &w, H);
        let transported = f.adjoint_transpose(&(momentum + l.diamond(&f.matrix(), &w, H)));
        let casimirs = (step.advected.norm_squared() - 1.0)
            .abs()
            .max((step.momentum.dot(&step.advected) - momentum.dot(&w)).abs() / momentum.norm());
        let found = [relative(&left, &f.adjoint_transpose(&right)), relative(&step.momentum, &transported), casimirs];
        worst = [0, 1, 2].map(|k| greater(worst[k], found[k]));
    }
    Ok(worst)
}

pub(crate) fn p2(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let top = Motion::chaotic().top;
    let d = top.J_d.diagonal();
    #[allow(non_snake_case)] // the letter of the field
    let J = Inertia::from_principal_moments(Vector3::new(d.y + d.z, d.z + d.x, d.x + d.y))?;
    let (weight, rho, up) = (top.m * top.g, top.rho, Vector3::z());
    let declared = [
        ("(3.13)", laws(top)?),
        ("Cayley", laws(CayleyTop { J, weight, rho, up })?),
        ("geodesic", laws(LogTop { J, weight, rho, up })?),
        ("log-trace", laws(LogTraceTop { I1: 3.0, weight, rho, up })?),
        ("L4", laws(FourthOrderTop { J, weight, rho, up })?),
        ("L6", laws(SixthOrderTop { J, weight, rho, up })?),
    ];
    let mut row = Row::new(
        "P2",
        "left = Ad* right, μ⁺ = Ad*(μ + diamond), Casimirs, in a step",
        "round-off (1e-13, of momenta formed from F itself)",
    );
    for (name, [adjoint, transport, casimirs]) in declared {
        row = row
            .at_most(&format!("{name}: left and right"), adjoint, 1e-13)
            .at_most(&format!("{name}: transport"), transport, 1e-13)
            .at_most(&format!("{name}: Casimirs"), casimirs, 1e-15 * 4.0);
    }
    Ok(row.shows("other groups and parameters: tests/systems, tests/random_lagrangians"))
}

/// The largest changes of `⟨w, v⟩` over some elements: with `Fᵀ w`, and with the product `F⁻¹ w` in its place.
fn changes<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() -> (f64, f64) {
    let mut random = Random::new(31);
    let (mut right, mut naive) = (0.0, 0.0);
    for _ in 0..20 {
        let f: G = random.element();
        let (w, v): (SVector<f64, N>, ContravariantVector<f64, N>) = (random.sample(), random.sample());
        let moved = Advected::<G>::advect(&v, &f.increment()).0;
        right = greater(right, (w.seen_from(&f).dot(&moved) - w.dot(&v.0)).abs());
        naive = greater(naive, ((eliminated_inverse(&f) * w).dot(&moved) - w.dot(&v.0)).abs());
    }
    (right, naive)
}

#[allow(clippy::unnecessary_wraps)] // as all rows
pub(crate) fn p3(_: Effort, _: &mut Curves) -> Result<Row, Failure> {
    let groups = [
        ("SE(2)", changes::<SE2, _, _>()),
        ("SE(3)", changes::<SE3, _, _>()),
        ("SL(2)", changes::<SL2, _, _>()),
        ("Heisenberg", changes::<Heisenberg, _, _>()),
    ];
    let mut row =
        Row::new("P3", "a covector under matrices that aren't orthogonal", "⟨w, v⟩ constant to round-off (1e-13)");
    for (name, (right, naive)) in groups {
        row = row.at_most(name, right, 1e-13).other(format!("{name}: F⁻¹w changes it by {naive:.1e}"));
    }
    Ok(row)
}
