//! Chapter 1 of the thesis and section 2.1, on every group: the unreduced statements in a chart compared with the
//! reduced ones.
//!
//! The chart is `q ↦ g_0 exp(q̂)`. Its tangent is a series of matrix commutators, so the unreduced side doesn't use the
//! bracket of the group or any derived term. The Lagrangian has a term of fourth order in the velocity and one that
//! couples it to the parameter:
//!
//! ```text
//! l(ξ, a) = ½ ξ·Mξ + ¼ κ (ξ·ξ)² + (b·a)(n·ξ) − u·a − ½ (v·a)²,     a = g⁻¹·a_0 in V*
//! ```

use core::f64::consts::PI;

use liestep::groups::Advected as _;
use liestep::laws::samples::{MatrixLieGroup, Random, along, assert_close, assert_small, derivative};
use nalgebra::{SMatrix, SVector};

/// The error of [`derivative`] for functions of some products.
const DIFFERENCE: f64 = 1e-9;

/// A reduced Lagrangian on `𝔤 × V*`, a configuration in the group and the spatial value `a_0`.
struct Body<G, const N: usize, const D: usize> {
    inertia: SMatrix<f64, D, D>,
    fourth: f64,
    coupled: (SVector<f64, N>, SVector<f64, D>),
    weight: SVector<f64, N>,
    spring: SVector<f64, N>,
    place: G,
    spatial: SVector<f64, N>,
}

/// The velocity and the parameter, or the momentum and the parameter.
type Pair<const N: usize, const D: usize> = (SVector<f64, D>, SVector<f64, N>);

impl<G: MatrixLieGroup<N, D>, const N: usize, const D: usize> Body<G, N, D> {
    fn random(random: &mut Random) -> Self {
        let root: SMatrix<f64, D, D> = random.sample();
        Self {
            inertia: SMatrix::identity() + root * root.transpose(),
            fourth: 0.3,
            coupled: (random.sample(), random.sample()),
            weight: random.sample(),
            spring: random.sample(),
            place: along::<G, N, D>(&random.sample(), 0.5),
            spatial: random.sample(),
        }
    }

    fn l(&self, (xi, a): &Pair<N, D>) -> f64 {
        let kinetic = 0.5 * xi.dot(&(self.inertia * xi)) + 0.25 * self.fourth * xi.norm_squared().powi(2);
        let coupled = self.coupled.0.dot(a) * self.coupled.1.dot(xi);
        kinetic + coupled - self.weight.dot(a) - 0.5 * self.spring.dot(a).powi(2)
    }

    /// The momentum `δl/δξ`, (1.14).
    fn momentum(&self, (xi, a): &Pair<N, D>) -> SVector<f64, D> {
        self.inertia * xi + xi * (self.fourth * xi.norm_squared()) + self.coupled.1 * self.coupled.0.dot(a)
    }

    /// The mass matrix `δ²l/δξ²`.
    fn mass(&self, xi: &SVector<f64, D>) -> SMatrix<f64, D, D> {
        let fourth = SMatrix::<f64, D, D>::identity() * xi.norm_squared() + xi * xi.transpose() * 2.0;
        self.inertia + fourth * self.fourth
    }

    /// The force `δl/δa`, in `V`.
    fn force(&self, (xi, a): &Pair<N, D>) -> SVector<f64, N> {
        self.coupled.0 * self.coupled.1.dot(xi) - self.weight - self.spring * self.spring.dot(a)
    }

    /// The velocity of a momentum, by Newton's iteration.
    fn velocity(&self, (momentum, a): &Pair<N, D>) -> SVector<f64, D> {
        let mut xi = SVector::zeros();
        for _ in 0..50 {
            let missed = self.momentum(&(xi, *a)) - momentum;
            xi -= self.mass(&xi).try_inverse().unwrap() * missed;
        }
        xi
    }

    /// The Hamiltonian `h(μ, a) = μ·ξ − l(ξ, a)`, (1.16).
    fn h(&self, state: &Pair<N, D>) -> f64 {
        let xi = self.velocity(state);
        state.0.dot(&xi) - self.l(&(xi, state.1))
    }

    /// The first two lines of (2.2), as rates of velocity and parameter; (1.4) if `l` doesn't depend on `a`.
    fn euler_poincare(&self, state: &Pair<N, D>) -> Pair<N, D> {
        let (xi, a) = state;
        // The rate `ȧ = −ξ·a` of the parameter in the frame of an attitude that moves along ξ.
        let a_rate = G::hat(xi).transpose() * a;
        let force = self.force(state);
        // The diamond `⟨δl/δa ⋄ a, E_k⟩ = ⟨a, E_k·δl/δa⟩`, (2.1).
        let diamond = SVector::<f64, D>::from_fn(|k, _| a.dot(&(G::hat(&axis(k)) * force)));
        let momentum_rate = G::lie_bracket_transpose(xi, &self.momentum(state)) + diamond;
        let explicit = momentum_rate - self.coupled.1 * self.coupled.0.dot(&a_rate);
        (self.mass(xi).try_inverse().unwrap() * explicit, a_rate)
    }

    /// The parameter in the frame of `g_0 exp(q̂)`.
    fn seen(&self, q: &SVector<f64, D>) -> SVector<f64, N> {
        self.spatial.seen_from(&self.place.compose(&along::<G, N, D>(q, 1.0)))
    }

    /// The Lagrangian `L(q, q')` of the chart.
    fn unreduced(&self, q: &SVector<f64, D>, rate: &SVector<f64, D>) -> f64 {
        self.l(&(tangent::<G, N, D>(q) * rate, self.seen(q)))
    }

    /// The momentum `∂L/∂q'`, (1.13).
    fn covector(&self, q: &SVector<f64, D>, rate: &SVector<f64, D>) -> SVector<f64, D> {
        let tangent = tangent::<G, N, D>(q);
        tangent.transpose() * self.momentum(&(tangent * rate, self.seen(q)))
    }

    /// The Hamiltonian `H(q, p)` of the chart, (1.15), with the momentum `r(q, p) = T⁻ᵀ p`.
    fn hamiltonian(&self, q: &SVector<f64, D>, p: &SVector<f64, D>) -> f64 {
        self.h(&(reduced::<G, N, D>(q, p), self.seen(q)))
    }

    /// The acceleration `q''` by the Euler–Lagrange equations, the second statement of theorem 1.1.1.
    fn euler_lagrange(&self, q: &SVector<f64, D>, rate: &SVector<f64, D>) -> SVector<f64, D> {
        let tangent = tangent::<G, N, D>(q);
        let force = SVector::<f64, D>::from_fn(|k, _| derivative(|t| self.unreduced(&(q + axis::<D>(k) * t), rate)));
        let carried = derivative(|t| self.covector(&(q + rate * t), rate));
        let mass = tangent.transpose() * self.mass(&(tangent * rate)) * tangent;
        mass.try_inverse().unwrap() * (force - carried)
    }
}

fn axis<const D: usize>(k: usize) -> SVector<f64, D> {
    SVector::from_fn(|i, _| if i == k { 1.0 } else { 0.0 })
}

/// The tangent `T(q) = Σ (−ad_q)ⁿ/(n+1)!`, so that `g⁻¹ġ = T(q) q'` for `g = exp(q̂)`.
fn tangent<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(q: &SVector<f64, D>) -> SMatrix<f64, D, D> {
    let q = G::hat(q);
    let columns: [SVector<f64, D>; D] = core::array::from_fn(|k| {
        let mut term = G::hat(&axis(k));
        let mut sum = term;
        for n in 1..24_u32 {
            term = (term * q - q * term) / f64::from(n + 1);
            sum += term;
        }
        G::vee(&sum)
    });
    SMatrix::from_columns(&columns)
}

/// The momentum `r(q, p)` of canonical variables in the chart.
fn reduced<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(
    q: &SVector<f64, D>,
    p: &SVector<f64, D>,
) -> SVector<f64, D> {
    tangent::<G, N, D>(q).transpose().try_inverse().unwrap() * p
}

/// The classical Runge–Kutta method, with the values at all nodes.
fn solved<S: Clone>(
    start: S,
    (time, steps): (f64, u32),
    rate: impl Fn(&S) -> S,
    plus: impl Fn(&S, &S, f64) -> S,
) -> Vec<S> {
    let h = time / f64::from(steps);
    let mut nodes = vec![start];
    for _ in 0..steps {
        let z = nodes.last().unwrap();
        let k1 = rate(z);
        let k2 = rate(&plus(z, &k1, 0.5 * h));
        let k3 = rate(&plus(z, &k2, 0.5 * h));
        let k4 = rate(&plus(z, &k3, h));
        let next = plus(&plus(&plus(&plus(z, &k1, h / 6.0), &k2, h / 3.0), &k3, h / 3.0), &k4, h / 6.0);
        nodes.push(next);
    }
    nodes
}

/// The integral `∫ f dt` by Simpson's rule over an even number of intervals.
fn integral(time: f64, values: &[f64]) -> f64 {
    let weight =
        |i: usize| if i == 0 || i + 1 == values.len() { 1.0 } else { 2.0 + 2.0 * f64::from(u8::from(i % 2 == 1)) };
    let intervals = u32::try_from(values.len() - 1).unwrap();
    values.iter().enumerate().map(|(i, value)| weight(i) * value).sum::<f64>() * time / f64::from(3 * intervals)
}

const TIME: f64 = 0.4;
const STEPS: u32 = 100;
/// The error of the classical method and of Simpson's rule with this number of steps.
const FOURTH_ORDER: f64 = 1e-7;

/// A path in the group: configuration, velocity and parameter at the nodes. With `sense = 1` it is the solution of
/// (2.2).
fn path<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>(
    body: &Body<G, N, D>,
    velocity: SVector<f64, D>,
    sense: f64,
) -> Vec<(SMatrix<f64, N, N>, Pair<N, D>)> {
    let start = (body.place.matrix(), (velocity, body.spatial.seen_from(&body.place)));
    let rate = |(g, z): &(SMatrix<f64, N, N>, Pair<N, D>)| {
        let (acceleration, a_rate) = body.euler_poincare(z);
        (g * G::hat(&z.0), (acceleration * sense, a_rate))
    };
    solved(start, (TIME, STEPS), rate, |z, k, h| (z.0 + k.0 * h, (z.1.0 + k.1.0 * h, z.1.1 + k.1.1 * h)))
}

/// Theorems 1.1.1 and 2.1.1: the four statements hold along one path, and along another none does.
fn euler_poincare_reduction<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(111);
    for _ in 0..2 {
        let body = Body::<G, N, D>::random(&mut random);
        let velocity: SVector<f64, D> = random.sample();
        let solution = path(&body, velocity, 1.0);

        // Statement 2: the Euler–Lagrange equations in the chart have the same final configuration and velocity.
        let plus = |z: &(_, _), k: &(_, _), h: f64| (z.0 + k.0 * h, z.1 + k.1 * h);
        let chart = solved(
            (SVector::zeros(), velocity),
            (TIME, STEPS),
            |(q, rate)| (*rate, body.euler_lagrange(q, rate)),
            plus,
        );
        let ((q, rate), (place, (xi, a))) = (chart.last().unwrap(), solution.last().unwrap());
        let end = body.place.compose(&along::<G, N, D>(q, 1.0));
        assert_close(&end.matrix(), place, FOURTH_ORDER * place.norm().max(1.0), "(1.5): ġ = g ξ");
        assert_close(&(tangent::<G, N, D>(q) * rate), xi, FOURTH_ORDER, "Euler–Lagrange and (2.2)");
        assert_close(&body.seen(q), a, FOURTH_ORDER * a.norm().max(1.0), "a = g⁻¹·a_0");

        // Statements 1 and 3: variations that vanish at both ends.
        let (eta, times): (SVector<f64, D>, Vec<f64>) =
            (random.sample(), (0..=STEPS).map(|i| f64::from(i) / f64::from(STEPS)).collect());
        let variation = |t: f64| {
            let (sine, cosine) = (PI * t).sin_cos();
            (eta * (sine * sine), eta * (2.0 * PI / TIME * sine * cosine))
        };
        let statements = |path: &[(SMatrix<f64, N, N>, Pair<N, D>)]| {
            let action = |epsilon: f64| {
                let values: Vec<f64> = path
                    .iter()
                    .zip(&times)
                    .map(|((_, (xi, a)), &t)| {
                        // The velocity of g exp(εη) is Ad_{exp(−εη)} ξ + T(εη) εη'.
                        let (eta, eta_rate) = variation(t);
                        let back = along::<G, N, D>(&eta, -epsilon);
                        let moved = back.matrix() * G::hat(xi) * along::<G, N, D>(&eta, epsilon).matrix();
                        let velocity = G::vee(&moved) + tangent::<G, N, D>(&(eta * epsilon)) * eta_rate * epsilon;
                        body.l(&(velocity, a.seen_from(&along::<G, N, D>(&eta, epsilon))))
                    })
                    .collect();
                integral(TIME, &values)
            };
            let reduced: Vec<f64> = path
                .iter()
                .zip(&times)
                .map(|((_, z), &t)| {
                    let (eta, eta_rate) = variation(t);
                    let xi = eta_rate + G::lie_bracket(&z.0, &eta);
                    // The variation of the parameter is `δa = −η·a`.
                    let a = G::hat(&eta).transpose() * z.1;
                    body.momentum(z).dot(&xi) + body.force(z).dot(&a)
                })
                .collect();
            (derivative(action), integral(TIME, &reduced))
        };
        let (first, third) = statements(&solution);
        assert_small(first.abs(), FOURTH_ORDER, "1: δ∫L dt = 0 on TG");
        assert_small(third.abs(), FOURTH_ORDER, "3: δ∫l dt = 0 for (1.3)");
        // The other path has the same initial velocity, and the opposite acceleration.
        let (first, third) = statements(&path(&body, velocity, -1.0));
        assert_small((first - third).abs(), FOURTH_ORDER, "1 and 3 agree on any path");
        assert_small(1e-4 / first.abs(), 1.0, "another path isn't stationary");
    }
}

/// (1.10), lemma 1.2.1: the canonical bracket of invariant functions is the Lie–Poisson bracket.
fn reduction_of_the_bracket<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(110);
    for _ in 0..10 {
        let (q, p): (SVector<f64, D>, SVector<f64, D>) = (random.sample(), random.sample());
        let functions: [(SMatrix<f64, D, D>, SVector<f64, D>); 2] =
            core::array::from_fn(|_| (random.sample(), random.sample()));
        let value = |i: usize, q: &SVector<f64, D>, p: &SVector<f64, D>| {
            let momentum = reduced::<G, N, D>(q, p);
            0.5 * momentum.dot(&(functions[i].0 * momentum)) + functions[i].1.dot(&momentum)
        };
        let by_place = |i| SVector::<f64, D>::from_fn(|k, _| derivative(|t| value(i, &(q + axis::<D>(k) * t), &p)));
        let by_covector = |i| SVector::<f64, D>::from_fn(|k, _| derivative(|t| value(i, &q, &(p + axis::<D>(k) * t))));
        // The canonical bracket (1.7).
        let canonical = by_place(0).dot(&by_covector(1)) - by_place(1).dot(&by_covector(0));
        let momentum = reduced::<G, N, D>(&q, &p);
        let slope = |i: usize| (functions[i].0 + functions[i].0.transpose()) * momentum * 0.5 + functions[i].1;
        let lie_poisson = G::lie_poisson_bracket(&momentum, &slope(0), &slope(1));
        let allowed = DIFFERENCE * (1.0 + by_place(0).norm()) * (1.0 + by_covector(1).norm());
        assert_small((canonical - lie_poisson).abs(), allowed, "{f∘r, k∘r} = {f, k}∘r");
    }
}

/// Theorem 1.2.2 and lemma 1.3.1: Hamilton's equations (1.9) in the chart reduce to (1.12), and (1.4) is the pull-back
/// of (1.12) by (1.14).
fn legendre_transform<G: MatrixLieGroup<N, D>, const N: usize, const D: usize>() {
    let mut random = Random::new(131);
    for _ in 0..5 {
        let body = Body::<G, N, D>::random(&mut random);
        let (q, xi): (SVector<f64, D>, SVector<f64, D>) = (random.sample::<SVector<f64, D>>() * 0.5, random.sample());
        let a = body.seen(&q);
        let momentum = body.momentum(&(xi, a));
        // The Legendre transforms 𝔽L and 𝔽l agree: `∂L/∂q' = Tᵀ δl/δξ`.
        let rate = tangent::<G, N, D>(&q).try_inverse().unwrap() * xi;
        let p = SVector::<f64, D>::from_fn(|k, _| derivative(|t| body.unreduced(&q, &(rate + axis::<D>(k) * t))));
        let allowed = DIFFERENCE * (1.0 + p.norm());
        assert_close(&reduced::<G, N, D>(&q, &p), &momentum, allowed, "(1.13) and (1.14)");
        let energy = p.dot(&rate) - body.unreduced(&q, &rate);
        assert_small((energy - body.h(&(momentum, a))).abs(), allowed, "(1.15) and (1.16)");

        // The derivatives of (1.16).
        let by_momentum = SVector::<f64, D>::from_fn(|k, _| derivative(|t| body.h(&(momentum + axis::<D>(k) * t, a))));
        let by_parameter = SVector::<f64, N>::from_fn(|k, _| derivative(|t| body.h(&(momentum, a + axis::<N>(k) * t))));
        assert_close(&by_momentum, &xi, allowed, "δh/δμ = ξ");
        assert_close(&by_parameter, &-body.force(&(xi, a)), allowed, "δh/δa = −δl/δa");

        // (1.12), with the parameter: `μ̇ = ad*_{δh/δμ} μ − δh/δa ⋄ a`.
        let diamond = SVector::<f64, D>::from_fn(|k, _| a.dot(&(G::hat(&axis(k)) * by_parameter)));
        let lie_poisson = G::lie_bracket_transpose(&by_momentum, &momentum) - diamond;
        let (acceleration, a_rate) = body.euler_poincare(&(xi, a));
        let pushed = derivative(|t| body.momentum(&(xi + acceleration * t, a + a_rate * t)));
        let scale = 1.0 + lie_poisson.norm() + momentum.norm() * xi.norm();
        assert_close(&pushed, &lie_poisson, DIFFERENCE * scale, "𝔽l carries (1.4) to (1.12)");

        let by_place = SVector::<f64, D>::from_fn(|k, _| derivative(|t| body.hamiltonian(&(q + axis::<D>(k) * t), &p)));
        let by_covector =
            SVector::<f64, D>::from_fn(|k, _| derivative(|t| body.hamiltonian(&q, &(p + axis::<D>(k) * t))));
        let carried = derivative(|t| reduced::<G, N, D>(&(q + by_covector * t), &(p - by_place * t)));
        assert_close(&carried, &lie_poisson, DIFFERENCE * 10.0 * scale, "(1.9) reduces to (1.12)");
    }
}

macro_rules! on_every_group {
    ($($name:ident: $group:ident)+) => {$(
        mod $name {
            use liestep::groups::$group;

            #[test]
            fn theorems_1_1_1_and_2_1_1() {
                super::euler_poincare_reduction::<$group, _, _>();
            }

            #[test]
            fn lemma_1_2_1() {
                super::reduction_of_the_bracket::<$group, _, _>();
            }

            #[test]
            fn theorem_1_2_2_and_lemma_1_3_1() {
                super::legendre_transform::<$group, _, _>();
            }
        }
    )+};
}

on_every_group! {
    so2: SO2
    so3: SO3
    se2: SE2
    se3: SE3
    su2: SU2
    sl2: SL2
    heisenberg: Heisenberg
    r1: R1
    r2: R2
    r3: R3
}
