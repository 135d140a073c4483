//! Invariants on `(Π G_a) ⋉ V` at any tolerance: the Casimirs; and P3, the advection of a covector by one of several
//! bodies.
//!
//! A step moves `z = (μ, w)` along a coadjoint orbit of the semidirect product, for every increment. `w` stays on its
//! orbit of the group. The momentum along the `η` with `η·w = 0` moves as on the subgroup of these, so the subgroup's
//! Casimirs of it are conserved. There are no others: their number is the corank of `B(z)`.

use checks::solvers::InaccurateSolver;
use declarations::{DoublePendulum, TwoBodies};
use liestep::groups::{Advected, LieGroup, R3, SE2};
use liestep::laws::samples::{Random, derivative};
use liestep::mechanics::{DiscreteLagrangian, Each, On, Regular};
use liestep::numbers::Bodies;
use liestep::{NonstandardInertia, SO3, lagrangian};
use nalgebra::{DMatrix, DVector, Matrix3, Point2, SVector, UnitComplex, Vector2, Vector3};

use super::declared::CoupledAttitudes;
use super::translated::missed;
use super::{element, started};

const STEPS: u32 = 20_000;

/// Functions of the momentum and of the parameters' numbers.
type OfState<'a, const D: usize> = dyn Fn(&SVector<f64, D>, &[f64]) -> Vec<f64> + 'a;

/// The claimed invariants of a state, with numbers and actions written by hand.
struct Orbit<'a, W, const D: usize> {
    /// The first components of the rotating bodies.
    turning: &'a [usize],
    /// The numbers of the advected parameters.
    numbers: &'a dyn Fn(&W) -> Vec<f64>,
    /// The action `E_k·w`, in these numbers.
    moved: &'a dyn Fn(usize, &[f64]) -> Vec<f64>,
    /// The conserved functions of momentum and parameters.
    kept: &'a OfState<'a, D>,
}

fn matrix(numbers: &[f64]) -> Matrix3<f64> {
    Matrix3::from_column_slice(&numbers[..9])
}

fn vector(numbers: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(&numbers[..3])
}

/// The matrix of the `k`th rotation generator.
fn hat(k: usize) -> Matrix3<f64> {
    Vector3::ith(k % 3, 1.0).cross_matrix()
}

/// The six distinct numbers of a product that should be the identity.
fn gram(q: &Matrix3<f64>) -> Vec<f64> {
    let product = q.transpose() * q;
    (0..3).flat_map(|row| (row..3).map(move |column| product[(row, column)])).collect()
}

impl<W, const D: usize> Orbit<'_, W, D> {
    fn joined(&self, momentum: &SVector<f64, D>, w: &W) -> DVector<f64> {
        DVector::from_vec([momentum.as_slice(), &(self.numbers)(w)].concat())
    }

    fn kept(&self, z: &DVector<f64>) -> DVector<f64> {
        DVector::from_vec((self.kept)(&z.fixed_rows::<D>(0).into_owned(), &z.as_slice()[D..]))
    }

    /// The tensor `{μ_k, μ_l} = −⟨μ, [E_k, E_l]⟩`, which is `μ̂` for each rotating body, and `{μ_k, w} = E_k·w`.
    fn tensor(&self, z: &DVector<f64>) -> DMatrix<f64> {
        let mut tensor = DMatrix::zeros(z.len(), z.len());
        for &body in self.turning {
            tensor.view_mut((body, body), (3, 3)).copy_from(&vector(&z.as_slice()[body..]).cross_matrix());
        }
        for k in 0..D {
            for (j, moved) in (self.moved)(k, &z.as_slice()[D..]).into_iter().enumerate() {
                (tensor[(k, D + j)], tensor[(D + j, k)]) = (moved, -moved);
            }
        }
        tensor
    }

    /// Checks that the functions commute with all others at this state, and that their number is the corank of `B(z)`.
    fn assert_complete(&self, z: &DVector<f64>) {
        let tensor = self.tensor(z);
        let mut gradients = DMatrix::zeros(self.kept(z).len(), z.len());
        for k in 0..z.len() {
            let along = |s: f64| self.kept(&DVector::from_fn(z.len(), |i, _| z[i] + if i == k { s } else { 0.0 }));
            gradients.set_column(k, &derivative(along));
        }
        let commuted = (&gradients * &tensor).amax();
        // Gradients by differences have errors of some 1e-11, and a product sums up to 33 of their entries.
        assert!(commuted < 1e-10 * gradients.amax() * tensor.amax(), "{commuted:e}");
        // Nonzero numbers are far above the error of the differences.
        let ranks = [gradients.rank(1e-8), tensor.rank(1e-8)];
        assert_eq!(ranks, [gradients.nrows(), z.len() - gradients.nrows()]);
    }

    /// The largest error of the functions over many steps, and the least error of (2.7).
    fn run<S>(&self, scene: &S, h: f64, attitude: S::Group, velocity: &SVector<f64, D>) -> (f64, f64)
    where
        S: DiscreteLagrangian<Scalar = f64, Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>, Advected = W>
            + Regular
            + Clone,
        W: Advected<S::Group>,
    {
        let (stepper, mut state) = started(scene.clone(), h, (attitude, *velocity));
        let now = |momentum, w| self.joined(&momentum, &w);
        let first = now(state.momentum(), state.advected());
        self.assert_complete(&first);
        let (mut off, mut least) = (0.0_f64, f64::INFINITY);
        for _ in 0..STEPS {
            let last = state;
            stepper.step(&mut state).unwrap();
            least = least.min(missed(scene, &last, &state, h));
            off = off.max((self.kept(&now(state.momentum(), state.advected())) - self.kept(&first)).amax());
        }
        let last = now(state.momentum(), state.advected());
        assert!((&last - &first).amax() > 0.1);
        self.assert_complete(&last);
        (off / first.norm_squared().max(1.0), least)
    }

    /// Checks that the functions are conserved whether the equation of the step is solved or not.
    fn assert_kept<L>(&self, l: &L, h: f64, attitude: L::Group, velocity: &SVector<f64, D>)
    where
        L: DiscreteLagrangian<Scalar = f64, Group: LieGroup<Scalar = f64, Vector = SVector<f64, D>>, Advected = W>
            + Regular
            + Clone,
        InaccurateSolver<L>: DiscreteLagrangian<Scalar = f64, Group = L::Group, Advected = W> + Regular,
        W: Advected<L::Group>,
    {
        let (off, _) = self.run(l, h, attitude, velocity);
        let (badly, least) = self.run(&InaccurateSolver(l.clone()), h, attitude, velocity);
        println!("off by {off:.1e}; where (2.7) is missed by {least:.1e} at least, by {badly:.1e}");
        // The bound is a walk of roundings: √STEPS ε is 3e-14, and a step has several. `InaccurateSolver` has errors of some
        // thousandths.
        assert!(off < 3e-13 && badly < 3e-13 && least > 1e-4, "{off:e} {badly:e} {least:e}");
    }
}

/// The invariants on (SO(3) × SO(3)) ⋉ V with `w_1`, `w_2` and `Q`, 21 numbers in all. The orbit of `w` is `QᵀQ = I`,
/// `|w_1|` and `w_1 = Q w_2`. Turns of both about the vertical leave it unchanged, `η = (w_1, w_2)`, so
/// `μ_1·w_1 + μ_2·w_2` is conserved.
#[test]
fn casimirs_of_a_double_pendulum() {
    let random = &mut Random::new(7);
    let xi: SVector<f64, 6> = random.sample();
    let velocity = SVector::from([0.5, -1.0, 2.0, 1.0, 0.3, -0.5]);
    let orbit = Orbit {
        turning: &[0, 3],
        numbers: &|w: &<DoublePendulum as liestep::mechanics::Term>::Advected| {
            [w.0.0.as_slice(), w.1.0.as_slice(), w.2.0.as_slice()].concat()
        },
        moved: &|k, w| {
            let (e, q) = (hat(k), matrix(&w[6..]));
            let still = Vector3::zeros();
            let (w_1, w_2, q) =
                if k < 3 { (e * vector(w), still, e * q) } else { (still, e * vector(&w[3..]), -q * e) };
            [w_1.as_slice(), w_2.as_slice(), q.as_slice()].concat()
        },
        kept: &|momentum: &SVector<f64, 6>, w| {
            let (w_1, w_2, q) = (vector(w), vector(&w[3..]), matrix(&w[6..]));
            let vertical = momentum.fixed_rows::<3>(0).dot(&w_1) + momentum.fixed_rows::<3>(3).dot(&w_2);
            [&gram(&q)[..], (w_1 - q * w_2).as_slice(), &[w_1.norm_squared(), vertical]].concat()
        },
    };
    orbit.assert_kept(&DoublePendulum::asymmetric(), 0.01, element(&xi), &velocity);
}

/// The invariants on SO(3)⁴ ⋉ V with the attitudes relative to the body before. Turns of all bodies together leave
/// these unchanged: a subgroup SO(3), whose momentum `μ_1 + Q μ_2 + Q R μ_3 + Q R S μ_4` has a conserved length.
#[test]
fn casimirs_of_coupled_attitudes() {
    let random = &mut Random::new(8);
    let (xi, velocity): (SVector<f64, 12>, SVector<f64, 12>) = (random.sample(), random.sample());
    let orbit = Orbit {
        turning: &[0, 3, 6, 9],
        numbers: &|w: &<CoupledAttitudes as liestep::mechanics::Term>::Advected| {
            [w.0.0.as_slice(), w.1.0.as_slice(), w.2.0.as_slice()].concat()
        },
        moved: &|k, w| {
            let seen = |place: usize| {
                let q = matrix(&w[9 * place..]);
                if k / 3 == place {
                    hat(k) * q
                } else if k / 3 == place + 1 {
                    -q * hat(k)
                } else {
                    Matrix3::zeros()
                }
            };
            [0, 1, 2].map(seen).iter().flat_map(|moved| moved.iter().copied()).collect()
        },
        kept: &|momentum: &SVector<f64, 12>, w| {
            let [q, r, s] = [0, 9, 18].map(|first| matrix(&w[first..]));
            let [a, b, c, d] = [0, 3, 6, 9].map(|first| momentum.fixed_rows::<3>(first).into_owned());
            let whole = a + q * (b + r * (c + s * d));
            [gram(&q), gram(&r), gram(&s), vec![whole.norm_squared()]].concat()
        },
    };
    let J = |a: f64| {
        let moments = Vector3::new(1.0, 1.3, 1.7) * a;
        liestep::mechanics::DiagonalNonstandardInertia::from_principal_moments(moments).unwrap()
    };
    let bodies = CoupledAttitudes { J_1: J(1.0), J_2: J(1.5), J_3: J(0.7), J_4: J(1.2), kappa: 1.3 };
    orbit.assert_kept(&bodies, 0.02, element(&xi), &velocity);
}

/// The invariants on (SO(3) × R³ × SO(3) × R³) ⋉ V with `R`, `Q` and `r`. A common translation leaves these unchanged:
/// all of `p_1 + p_2` is conserved, because that subgroup is commutative. Every `r` is on the orbit of every other.
#[test]
fn casimirs_of_two_bodies_that_attract_each_other() {
    let random = &mut Random::new(9);
    let K = |m: f64| NonstandardInertia::from_principal_moments(Vector3::new(0.5, 0.6, 0.7) * m).unwrap();
    let [K_1, K_2] = [1.0, 0.4].map(K);
    let bodies = TwoBodies { m_1: 1.0, m_2: 0.4, K_1, K_2, J_1: K_1.to_inertia(), J_2: K_2.to_inertia(), G: 1.0 };
    let turned = [(); 2].map(|()| SO3::exp(random.sample::<Vector3<f64>>()));
    let [first, second] = [-1.0, 2.5].map(|x| R3::from(Vector3::new(x, 0.1, -0.2)));
    let velocity = SVector::from([0.3, -0.5, 0.8, 0.0, -0.2, 0.1, 0.6, 0.2, -0.4, 0.1, 0.5, -0.1]);
    let orbit = Orbit {
        turning: &[0, 6],
        numbers: &|w: &<TwoBodies as liestep::mechanics::Term>::Advected| {
            [w.0.0.as_slice(), w.1.0.as_slice(), w.2.0.fixed_view::<3, 1>(0, 3).into_owned().as_slice()].concat()
        },
        moved: &|k, w| {
            let (e, r, q) = (hat(k), matrix(w), matrix(&w[9..]));
            let (still, nothing, step) = (Matrix3::zeros(), Vector3::zeros(), Vector3::ith(k % 3, 1.0));
            let (r, q, apart) = match k / 3 {
                0 => (-r * e, e * q, nothing),
                1 => (still, still, step),
                2 => (still, -q * e, nothing),
                _ => (still, still, -step),
            };
            [r.as_slice(), q.as_slice(), apart.as_slice()].concat()
        },
        kept: &|momentum: &SVector<f64, 12>, w| {
            let together = momentum.fixed_rows::<3>(3) + momentum.fixed_rows::<3>(9);
            [&gram(&matrix(w))[..], &gram(&matrix(&w[9..])), together.as_slice()].concat()
        },
    };
    orbit.assert_kept(&bodies, 0.01, (turned[0], first, turned[1], second), &velocity);
}

/// A plate in a uniform field of force: `w·(p, 1)` is the potential of the point `p`.
#[lagrangian(
    group = SE2,
    advected(w = field),
    l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * (w.dot(&r) + w.dot(&(F * r))),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plate {
    J: Matrix3<f64>,
    r: Vector3<f64>,
    field: Vector3<f64>,
}

/// A spring between a point of the body and one of space.
#[lagrangian(
    group = SE2,
    advected(a = anchor),
    l_d = -0.25 * h * k * ((a - p).norm_squared() + (inverse(F) * a - p).norm_squared()),
)]
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tether {
    k: f64,
    p: Point2<f64>,
    anchor: Point2<f64>,
}

type AdvectedPair = ([Vector3<f64>; 2], liestep::groups::SeenFrom<1, Point2<f64>>);
/// Velocities or momenta of both bodies.
type OfBoth = Bodies<Vector3<f64>, 2>;

/// Checks that each body's parameters are advected by its own configuration, and that the functions are conserved.
/// Returns the least and the largest error of (2.7).
fn assert_p3<S>(
    scene: S,
    start: [SE2; 2],
    velocity: OfBoth,
    kept: impl Fn(&AdvectedPair, &OfBoth) -> [f64; 4],
) -> [f64; 2]
where
    S: DiscreteLagrangian<Scalar = f64, Group = [SE2; 2], Advected = AdvectedPair> + Regular,
{
    let spatial = scene.advected();
    let (stepper, mut state) = started(scene, 0.01, (start, velocity));
    let first = kept(&state.advected(), &state.momentum());
    let (mut off, mut parted, mut naive) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut misses = [f64::INFINITY, 0.0];
    for _ in 0..1000 {
        let last = state;
        stepper.step(&mut state).unwrap();
        let miss = missed(stepper.scene(), &last, &state, 0.01);
        misses = [misses[0].min(miss), misses[1].max(miss)];
        let w = state.advected();
        for (body, place) in state.attitude().iter().enumerate() {
            let (g, inverse) = (place.matrix(), place.matrix().try_inverse().unwrap());
            let size = g.norm() * spatial.0[body].norm();
            parted = parted.max((w.0[body] - g.transpose() * spatial.0[body]).norm() / size);
            naive = naive.max((w.0[body] - inverse * spatial.0[body]).norm());
            if body == 1 {
                let seen = inverse * spatial.1.0.to_homogeneous();
                parted = parted.max((w.1.0.to_homogeneous() - seen).norm() / size);
            }
        }
        let now = kept(&w, &state.momentum());
        off = now.iter().zip(first).map(|(now, first)| (now / first - 1.0).abs()).fold(off, f64::max);
    }
    println!(
        "w is off by {parted:.1e}, by {naive:.1e} of F⁻¹ w; Casimirs {off:.1e}; (2.7) by {:.1e} to {:.1e}",
        misses[0], misses[1]
    );
    // The bound is the rounding of a thousand steps: of a product of matrices in each, and of a force that all of them
    // rotate.
    assert!(parted < 1e-13 && off < 1e-12 && naive > 0.1, "{parted:e} {off:e} {naive:e}");
    misses
}

/// P3 on SE(2) × SE(2), each factor of which advects its body's parameters: `w⁺ = Fᵀ w`, and not `F⁻¹ w`. The force in
/// each body's frame is rotated, so its size is conserved. For the body without a spring the translation across the
/// force is a symmetry, and its momentum `p × w` is conserved; for the body with the spring, the potential of the
/// anchor is.
#[test]
fn p3_plates_in_a_field() {
    let J = |m: f64| Matrix3::new(0.4, 0.05, 0.1, 0.05, 0.3, -0.1, 0.1, -0.1, 1.0) * m;
    let field = |x: f64| Vector3::new(x, -0.8, 0.3);
    let plate = |m: f64, x: f64| Plate { J: J(m), r: Vector3::new(0.2, -0.1, 1.0), field: field(x) };
    let anchor = Point2::new(0.7, 1.1);
    let scene = Each::<2>::of([plate(1.0, 0.5), plate(1.6, -0.4)])
        + On::<1, 2>::of([Tether { k: 3.0, p: Point2::new(0.4, -0.3), anchor }]);
    let place = |angle: f64, x: f64| SE2::from_rotation_and_translation(UnitComplex::new(angle), Vector2::new(x, -0.2));
    let (start, velocity) =
        ([place(0.8, 0.5), place(-0.3, 1.4)], Bodies([Vector3::new(1.2, 0.4, -0.3), Vector3::new(-0.7, 0.2, 0.5)]));
    let kept = |w: &AdvectedPair, Bodies(mu): &OfBoth| {
        let potential = w.0[1].dot(&w.1.0.to_homogeneous());
        [w.0[0].xy().norm(), w.0[1].xy().norm(), mu[0].yz().perp(&w.0[0].xy()), potential]
    };
    let [_, most] = assert_p3(scene, start, velocity, kept);
    let [least, _] = assert_p3(InaccurateSolver(scene), start, velocity, kept);
    // A solve ends at rounding, and `InaccurateSolver` has errors of some thousandths.
    assert!(most < 1e-12 && least > 1e-4, "{most:e} {least:e}");
}
