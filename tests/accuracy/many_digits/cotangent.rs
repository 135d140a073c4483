//! Gauss collocation on the cotangent bundle of all matrices, in the plain form of its tableau: its order with five to
//! eight stages, and its Poisson property to twenty digits, on noncompact groups. The Lagrangian's momentum, Hessian
//! and diamond are written by hand,
//!
//! ```text
//! l = ½ q(ξ) (1 + (w·r)²) + c w·(ξ̂ r) − k (w·r)²,     q = tr(ξ̂ J ξ̂ᵀ),     w = gᵀ a_0
//! ```

use checks::affine::Affine;
use liestep::groups::{LieGroup, SE3, SL2};
use liestep::lagrangian;
use liestep::laws::samples::{MatrixLieGroup, Random};
use liestep::mechanics::ContinuousLagrangian;
use liestep::methods::CotangentGauss;
use nalgebra::{DMatrix, Matrix2, Matrix4, SMatrix, SVector, Vector2, Vector4};
use num_traits::{One as _, Zero as _};

use super::collocation::Tableau;
use super::{DoubleDouble, long};

type LongMatrix = DMatrix<DoubleDouble>;

macro_rules! declared {
    ($name:ident: $group:ident, $vector:ident, $matrix:ident $(, $($own:tt)*)?) => {
        #[lagrangian(
            group = $group,
            $($($own)*)?
            velocity = xi,
            advected(w = covector),
            l = {
                let x = hat(xi);
                let height = w.dot(&r);
                let kinetic = 0.5 * (x * J * x.transpose()).trace() * (1.0 + height.powi(2));
                kinetic + c * w.dot(&(x * r)) - k * height.powi(2)
            },
        )]
        #[derive(Clone, Debug)]
        struct $name {
            J: $matrix<f64>,
            r: $vector<f64>,
            c: f64,
            k: f64,
            covector: $vector<f64>,
        }

        impl $name {
            fn read<const N: usize>(system: &System, w: &SVector<f64, N>) -> Self {
                let rounded = |a: &LongMatrix| a.map(DoubleDouble::rounded);
                Self {
                    J: $matrix::from_iterator(rounded(&system.J).iter().copied()),
                    r: $vector::from_iterator(rounded(&system.r).iter().copied()),
                    c: system.c.rounded(),
                    k: system.k.rounded(),
                    covector: $vector::from_iterator(w.iter().copied()),
                }
            }
        }
    };
}

declared!(OnSl2: SL2, Vector2, Matrix2);
declared!(OnSe3: SE3, Vector4, Matrix4);
declared!(OnAffine: Affine, Vector2, Matrix2, generators = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [0.0, 0.0]]],);

/// The Lagrangian's parameters and the group's basis.
struct System {
    basis: Vec<LongMatrix>,
    J: LongMatrix,
    r: LongMatrix,
    c: DoubleDouble,
    k: DoubleDouble,
}

/// The solution of `A x = b`, by elimination.
fn solve(a: &LongMatrix, b: &LongMatrix) -> LongMatrix {
    let (mut a, mut b, n) = (a.clone(), b.clone(), a.nrows());
    for k in 0..n {
        let size = |i: usize| a[(i, k)].rounded().abs();
        let pivot = (k..n).max_by(|&i, &j| size(i).total_cmp(&size(j))).expect("a row");
        a.swap_rows(k, pivot);
        b.swap_rows(k, pivot);
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[(i, k)] / a[(k, k)];
            (0..n).for_each(|j| a[(i, j)] = a[(i, j)] - factor * a[(k, j)]);
            (0..b.ncols()).for_each(|j| b[(i, j)] = b[(i, j)] - factor * b[(k, j)]);
        }
    }
    LongMatrix::from_fn(n, b.ncols(), |i, j| b[(i, j)] / a[(i, i)])
}

fn paired(a: &LongMatrix, b: &LongMatrix) -> DoubleDouble {
    a.iter().zip(b.iter()).fold(DoubleDouble::zero(), |sum, (a, b)| sum + *a * *b)
}

fn times(a: &LongMatrix, factor: DoubleDouble) -> LongMatrix {
    a.map(|entry| entry * factor)
}

/// The phase-space point `(g, p)`.
type Place = [LongMatrix; 2];

impl System {
    fn new<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let (root, r): (SMatrix<f64, N, N>, SVector<f64, N>) = (random.sample(), random.sample());
        let metric = root * root.transpose() + SMatrix::identity();
        let lifted = |rows: usize, columns: usize, entry: &dyn Fn(usize, usize) -> f64| {
            LongMatrix::from_fn(rows, columns, |i, j| long(entry(i, j)))
        };
        let basis = (0..D).map(|k| {
            let generator = G::hat(&SVector::from_fn(|j, _| if j == k { 1.0 } else { 0.0 }));
            lifted(N, N, &|i, j| generator[(i, j)])
        });
        Self {
            basis: basis.collect(),
            J: lifted(N, N, &|i, j| metric[(i, j)]),
            r: lifted(N, 1, &|i, _| r[i]),
            c: long(0.3),
            k: long(0.7),
        }
    }

    fn hat(&self, xi: &LongMatrix) -> LongMatrix {
        let zero = LongMatrix::zeros(self.J.nrows(), self.J.nrows());
        self.basis.iter().zip(xi.iter()).fold(zero, |sum, (generator, x)| sum + times(generator, *x))
    }

    /// The momentum `μ_k = tr(pᵀ g E_k)`.
    fn momentum(&self, [g, p]: &Place) -> LongMatrix {
        let own = g.transpose() * p;
        LongMatrix::from_fn(self.basis.len(), 1, |k, _| paired(&own, &self.basis[k]))
    }

    /// The components of an element of the algebra; the basis is orthogonal.
    fn components(&self, element: &LongMatrix) -> LongMatrix {
        LongMatrix::from_fn(self.basis.len(), 1, |k, _| {
            paired(element, &self.basis[k]) / paired(&self.basis[k], &self.basis[k])
        })
    }

    /// The rates `ġ = g ξ̂`, `ṗ = −p ξ̂ᵀ + g⁻ᵀ Γ` with `Γ = w (∂l/∂w)ᵀ`.
    fn rate(&self, spatial: &LongMatrix, place: &Place) -> Place {
        let [g, p] = place;
        let w = g.transpose() * spatial;
        let (height, one, two) = (paired(&w, &self.r), DoubleDouble::one(), long(2.0));
        let factor = one + height * height;
        let dimension = self.basis.len();
        let at_rest = LongMatrix::from_fn(dimension, 1, |k, _| self.c * paired(&w, &(&self.basis[k] * &self.r)));
        let hessian = LongMatrix::from_fn(dimension, dimension, |k, j| {
            factor * paired(&(&self.basis[k] * &self.J), &self.basis[j])
        });
        let x = self.hat(&solve(&hessian, &(self.momentum(place) - at_rest)));
        let quadratic = paired(&(&x * &self.J), &x);
        let slope = times(&self.r, quadratic * height - two * self.k * height) + times(&(&x * &self.r), self.c);
        let force = solve(&g.transpose(), &(&w * slope.transpose()));
        [g * &x, force - p * x.transpose()]
    }

    /// The attitude and momentum after this number of steps, from the identity with this momentum.
    fn end(
        &self,
        tableau: &Tableau,
        spatial: &LongMatrix,
        momentum: &LongMatrix,
        h: DoubleDouble,
        steps: u32,
    ) -> (LongMatrix, LongMatrix) {
        let n = self.J.nrows();
        let unit = |k: usize| paired(&self.basis[k], &self.basis[k]);
        let scaled = LongMatrix::from_fn(self.basis.len(), 1, |k, _| momentum[k] / unit(k));
        let mut place: Place = [LongMatrix::identity(n, n), self.hat(&scaled)];
        for _ in 0..steps {
            let sum = |row: &[DoubleDouble], rates: &[Place]| {
                row.iter().zip(rates).fold(place.clone(), |at, (a, rate)| {
                    core::array::from_fn(|part| &at[part] + times(&rate[part], h * *a))
                })
            };
            let mut rates = vec![self.rate(spatial, &place); tableau.weights.len()];
            let mut before = f64::INFINITY;
            loop {
                let next: Vec<Place> = tableau.a.iter().map(|row| self.rate(spatial, &sum(row, &rates))).collect();
                let change = |(old, new): (&Place, &Place)| {
                    (0..2).map(|part| (&old[part] - &new[part]).map(DoubleDouble::rounded).norm()).sum::<f64>()
                };
                let changed: f64 = rates.iter().zip(&next).map(change).sum();
                rates = next;
                if changed < 1e-20 && changed >= before {
                    break;
                }
                assert!(changed.is_finite() && changed <= 2.0 * before, "the stages don't converge");
                before = changed;
            }
            place = sum(&tableau.weights, &rates);
        }
        let momentum = self.momentum(&place);
        let [g, _] = place;
        (g, momentum)
    }

    /// The Poisson tensor `{μ_k, μ_l} = −⟨μ, [E_k, E_l]⟩`, `{μ_k, w} = E_k·w = −E_kᵀ w`.
    fn tensor(&self, z: &LongMatrix) -> LongMatrix {
        let dimension = self.basis.len();
        let (momentum, w) = (z.rows(0, dimension).into_owned(), z.rows(dimension, self.J.nrows()).into_owned());
        let moved: Vec<LongMatrix> = self.basis.iter().map(|generator| generator.transpose() * &w).collect();
        let bracket = |k: usize, l: usize| {
            let (a, b) = (&self.basis[k], &self.basis[l]);
            -paired(&momentum, &self.components(&(a * b - b * a)))
        };
        LongMatrix::from_fn(z.nrows(), z.nrows(), |i, j| match (i < dimension, j < dimension) {
            (true, true) => bracket(i, j),
            (true, false) => -moved[i][j - dimension],
            (false, true) => moved[j][i - dimension],
            (false, false) => DoubleDouble::zero(),
        })
    }

    /// The largest entry of `DΦ B(z) DΦᵀ − B(Φ(z))`, by differences of six points with an error of some 10⁻²⁶.
    fn poisson_defect(&self, tableau: &Tableau, z: &LongMatrix, h: f64) -> f64 {
        let dimension = self.basis.len();
        let map = |z: &LongMatrix| {
            let (momentum, w) = (z.rows(0, dimension).into_owned(), z.rows(dimension, self.J.nrows()).into_owned());
            let (g, momentum) = self.end(tableau, &w, &momentum, long(h), 1);
            let w = g.transpose() * w;
            LongMatrix::from_iterator(z.nrows(), 1, momentum.iter().chain(w.iter()).copied())
        };
        let d = 1e-5;
        let mut tangent = LongMatrix::zeros(z.nrows(), z.nrows());
        for k in 0..z.nrows() {
            let at = |steps: f64| {
                let mut z = z.clone();
                z[k] += long(steps) * long(d);
                map(&z)
            };
            let odd = |steps: f64| at(steps) - at(-steps);
            let column = times(&odd(1.0), long(45.0)) - times(&odd(2.0), long(9.0)) + odd(3.0);
            tangent.set_column(k, &column.column(0).map(|change| change / (long(60.0) * long(d))));
        }
        let defect = &tangent * self.tensor(z) * tangent.transpose() - self.tensor(&map(z));
        defect.iter().map(|entry| entry.rounded().abs()).fold(0.0, f64::max)
    }
}

/// A random momentum and random advected parameters.
fn start<const N: usize, const D: usize>(seed: u64) -> (SVector<f64, D>, SVector<f64, N>) {
    let mut random = Random::new(seed);
    (random.sample(), random.sample())
}

fn column<const R: usize>(vector: &SVector<f64, R>) -> LongMatrix {
    LongMatrix::from_iterator(R, 1, vector.iter().map(|&entry| long(entry)))
}

/// The relative distance of doubles from the long numbers.
fn relative<'a>(expected: &LongMatrix, found: impl Iterator<Item = &'a f64>) -> f64 {
    let rounded = expected.map(DoubleDouble::rounded);
    let apart: f64 = rounded.iter().zip(found).map(|(a, b)| (a - b).powi(2)).sum();
    apart.sqrt() / rounded.norm()
}

/// The step and the number of steps in the comparison with the library.
const STEP: f64 = 0.2;
const STEPS: u32 = 5;

/// The end of the library's motion from the identity.
fn library<L, const PAIRS: usize, const N: usize, const D: usize>(
    declared: &L,
    momentum: &SVector<f64, D>,
) -> (SMatrix<f64, N, N>, SVector<f64, D>)
where
    L: ContinuousLagrangian<Scalar = f64, Group: MatrixLieGroup<N, D>> + Clone,
{
    let gauss = CotangentGauss::<_, PAIRS, N>::new(declared.clone(), STEP).unwrap();
    let start = (L::Group::identity(), *momentum);
    let (attitude, momentum) =
        (0..STEPS).fold(start, |(attitude, momentum), _| gauss.step(&attitude, &momentum).unwrap());
    (attitude.matrix(), momentum)
}

/// Checks orders from five stages to eight, the Poisson property, and the library's step.
macro_rules! assert_collocation {
    ($declared:ident: $group:ident, $n:literal, $d:literal, $time:literal) => {
        let name = stringify!($group);
        let system = System::new::<$group, $n, $d>(3);
        let (momentum, w) = start::<$n, $d>(4);
        let (long_momentum, spatial) = (column(&momentum), column(&w));

        let time = $time;
        let after = |stages: usize, steps: u32| {
            let h = long(time) / long(steps.into());
            system.end(&Tableau::new(stages), &spatial, &long_momentum, h, steps)
        };
        let exact = after(10, 56);
        for stages in 5..=8 {
            let error = |steps: u32| {
                let end = after(stages, steps);
                (end.0 - &exact.0).map(DoubleDouble::rounded).norm()
                    + (end.1 - &exact.1).map(DoubleDouble::rounded).norm()
            };
            // Higher terms still contribute with half as many steps; with twice as many the error is rounding.
            let errors = [20, 28].map(error);
            let order = (errors[0] / errors[1]).ln() / 1.4_f64.ln();
            println!("{name}, {stages} stages: order {order:.2}, errors {errors:?}");
            let expected = 2.0 * f64::from(u32::try_from(stages).unwrap());
            assert!((order - expected).abs() < 0.15, "{name}, {stages} stages: order {order}, errors {errors:?}");
        }

        let z = LongMatrix::from_iterator($d + $n, 1, long_momentum.iter().chain(spatial.iter()).copied());
        for stages in [2, 6] {
            let tableau = Tableau::new(stages);
            let defect = system.poisson_defect(&tableau, &z, 0.2);
            println!("{name}, {stages} stages: Poisson {defect:.1e}");
            assert!(defect < 1e-20, "{name}, {stages} stages: {defect:e}");
        }

        let declared = $declared::read(&system, &w);
        let ends = [
            library::<_, 1, $n, $d>(&declared, &momentum),
            library::<_, 2, $n, $d>(&declared, &momentum),
            library::<_, 3, $n, $d>(&declared, &momentum),
            library::<_, 4, $n, $d>(&declared, &momentum),
        ];
        for (stages, (attitude, after)) in [2, 4, 6, 8].into_iter().zip(ends) {
            let expected = system.end(&Tableau::new(stages), &spatial, &long_momentum, long(STEP), STEPS);
            let apart = relative(&expected.0, attitude.iter()).max(relative(&expected.1, after.iter()));
            println!("{name}, {stages} stages: the library is {apart:.1e} apart");
            assert!(apart < 1e-14, "{name}, {stages} stages: the library is {apart:e} apart");
        }
    };
}

#[test]
fn cotangent_collocation_on_sl2() {
    assert_collocation!(OnSl2: SL2, 2, 3, 4.0);
}

#[test]
fn cotangent_collocation_on_se3() {
    assert_collocation!(OnSe3: SE3, 4, 6, 6.0);
}

#[test]
fn cotangent_collocation_on_a_group_of_ones_own() {
    assert_collocation!(OnAffine: Affine, 2, 2, 6.0);
}
