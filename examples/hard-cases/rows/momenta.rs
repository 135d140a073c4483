//! P2, P3: momentum maps, Casimirs, and the advection of a covector.

use declarations::{CayleyTop, FourthOrderTop, LogTop, LogTraceTop, Motion, SixthOrderTop, Top as _};
use liestep::SO3;
use liestep::groups::{Advected, ContravariantVector, Heisenberg, LieGroup as _, SE2, SE3, SL2, SO2, SU2};
use liestep::laws::samples::{MatrixLieGroup, Random, eliminated_inverse};
use liestep::mechanics::{DiscreteLagrangian, Regular};
use liestep::motion::DiscreteLiePoisson;
use nalgebra::{SVector, Vector3};
use workbench::measure::{greater, relative};

use crate::row::{Effort, Failure, Row};

/// The relative errors of `left = Ad* right` and of `μ⁺ = Ad*(μ + diamond)`, and of the Casimirs `|w|²` and `μ·w`.
fn laws<L>(lagrangian: &L, steps: &[(f64, f64)]) -> Result<[f64; 4], Failure>
where
    L: DiscreteLagrangian<Scalar = f64, Group = SO3, Advected = Vector3<f64>> + Regular + Clone,
{
    let (mut random, mut worst) = (Random::new(12), [0.0; 4]);
    for ((h, size), _) in steps.iter().flat_map(|step| (0..20).map(move |sample| (*step, sample))) {
        let flow = DiscreteLiePoisson::new(lagrangian.clone(), h)?;
        let (sample, w): (Vector3<f64>, Vector3<f64>) = (random.sample(), random.sample());
        let (momentum, w) = (sample * size, w.normalize());
        let step = flow.step(&momentum, &w, &Vector3::zeros())?;
        let (l, f) = (flow.scene(), step.element());
        let right = l.right_momentum(&f.matrix(), &w, h);
        let left = l.left_momentum(&f.matrix(), &w, h);
        let transported = f.adjoint_transpose(&(momentum + l.diamond(&f.matrix(), &w, h)));
        let length = (step.advected.norm_squared() - 1.0).abs();
        let vertical = (step.momentum.dot(&step.advected) - momentum.dot(&w)).abs() / momentum.norm();
        let left = relative(&left, &f.adjoint_transpose(&right));
        let found = [left, relative(&step.momentum, &transported), length, vertical];
        worst = [0, 1, 2, 3].map(|k| greater(worst[k], found[k]));
    }
    Ok(worst)
}

pub(crate) fn p2(_: Effort) -> Result<Row, Failure> {
    let top = Motion::chaotic().top;
    // Pairs of steps and of momenta for which they are solvable.
    let usual = &[(0.05, 10.0)];
    let declared = [
        ("(3.13)", laws(&top, &[(1e-3, 10.0), (0.05, 10.0), (0.1, 3.0), (0.3, 3.0)])?),
        ("Cayley", laws(&CayleyTop::of(&top), usual)?),
        ("geodesic", laws(&LogTop::of(&top), usual)?),
        ("log-trace", laws(&LogTraceTop { I1: 3.0, weight: top.m * top.g, rho: top.rho, up: top.up }, usual)?),
        ("L4", laws(&FourthOrderTop::of(&top), usual)?),
        ("L6", laws(&SixthOrderTop::of(&top), usual)?),
    ];
    let mut row = Row::new(
        "P2",
        "left = Ad* right, μ⁺ = Ad*(μ + diamond), Casimirs, in a step",
        "round-off (1e-13, of momenta formed from F itself)",
    );
    for (name, [adjoint, transport, length, vertical]) in declared {
        row = row
            .at_most(&format!("{name}: left and right"), adjoint, 1e-13)
            .at_most(&format!("{name}: transport"), transport, 1e-13)
            .at_most(&format!("{name}: |w|²"), length, 2e-15)
            .at_most(&format!("{name}: μ·w"), vertical, 2e-15);
    }
    Ok(row.shows("other groups and parameters: tests/systems, tests/long/random_lagrangians"))
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

#[allow(clippy::unnecessary_wraps)] // as for all rows
pub(crate) fn p3(_: Effort) -> Result<Row, Failure> {
    let groups = [
        ("SE(2)", changes::<SE2, _, _>()),
        ("SE(3)", changes::<SE3, _, _>()),
        ("SL(2)", changes::<SL2, _, _>()),
        ("Heisenberg", changes::<Heisenberg, _, _>()),
    ];
    let mut row =
        Row::new("P3", "a covector under matrices that aren't orthogonal", "⟨w, v⟩ constant to round-off (1e-13)");
    for (name, (right, naive)) in groups {
        let naive_fails = naive > 0.1;
        let naive = format!("{name}: F⁻¹w in the place of Fᵀw changes it by {naive:.1e}, so the row can fail");
        row = row.at_most(name, right, 1e-13).holds(&naive, naive_fails);
    }
    for (name, (right, naive)) in
        [("SO(2)", changes::<SO2, _, _>()), ("SO(3)", changes::<SO3, _, _>()), ("SU(2)", changes::<SU2, _, _>())]
    {
        row = row.at_most(&format!("{name}, where both are the same"), greater(right, naive), 1e-13);
    }
    Ok(row)
}
