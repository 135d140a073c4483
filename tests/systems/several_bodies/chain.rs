//! Three links on ball joints from a fixed pivot, in the minimal form on SO(3)³.
//!
//! ```text
//! l_d = Σ tr((F_a − I) J_a (F_a − I)ᵀ)/2h + Σ_{a<b} x_a·Q_ab y_b/h − (h/2) g Σ w_a·(s_a + F_a s_a)
//! x_a = (F_a − I) ρ_a,  y_b = (F_b − I) s_b
//! ```

use checks::solvers::Badly;
use declarations::motions::{matrix, number, read, vector};
use liestep::groups::{CayleyRetraction, LieGroup as _, Relative, Retraction, SeenFrom};
use liestep::mechanics::{DiscreteLagrangian, Effect, Limit, Regular, SceneVisitor, Term, WithKinetic};
use liestep::methods::CompositionScheme;
use liestep::{NonstandardInertia, SO3, SetupError, StepError, Stepper, lagrangian};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::{End, all, apart, assert_reference, attitudes_of, increments, momentum, part, put, stacked, twice_vee};

type Group = (SO3, SO3, SO3);
type Matrices = (Matrix3<f64>, Matrix3<f64>, Matrix3<f64>);
type Components = SVector<f64, 9>;
type Square = SMatrix<f64, 9, 9>;
type Between<const A: usize, const B: usize> = Relative<A, B, Matrix3<f64>>;
type Up<const A: usize> = SeenFrom<A, Vector3<f64>>;
type Seen = (Up<0>, Up<1>, Up<2>, Between<0, 1>, Between<0, 2>, Between<1, 2>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Chain {
    /// Nonstandard, about the upper joint, with the mass of what hangs below at the lower.
    J: [Matrix3<f64>; 3],
    /// The lower joint, from the upper.
    rho: [Vector3<f64>; 3],
    s: [Vector3<f64>; 3],
    g: f64,
}

const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

fn seen(w: &Seen) -> ([Vector3<f64>; 3], [Matrix3<f64>; 3]) {
    ([w.0.0, w.1.0, w.2.0], [w.3.0, w.4.0, w.5.0])
}

impl Chain {
    /// Of the reference.
    fn read() -> Self {
        let data = &read("several bodies")["chain3"]["parameters"];
        let bodies = data["bodies"].as_array().unwrap();
        let plain = |value: &serde_json::Value| Vector3::from_fn(|k, _| value[k].as_f64().unwrap());
        let (mut J, mut rho, mut s) = ([Matrix3::zeros(); 3], [Vector3::zeros(); 3], [Vector3::zeros(); 3]);
        for (k, body) in bodies.iter().enumerate() {
            let (m, c, moments) = (body["m"].as_f64().unwrap(), plain(&body["c"]), plain(&body["J_cm"]));
            let beyond: f64 = bodies[k + 1..].iter().map(|body| body["m"].as_f64().unwrap()).sum();
            rho[k] = plain(&body["rho"]);
            let own = Matrix3::from_diagonal_element(0.5 * moments.sum()) - Matrix3::from_diagonal(&moments);
            J[k] = own + c * c.transpose() * m + rho[k] * rho[k].transpose() * beyond;
            s[k] = c * m + rho[k] * beyond;
        }
        Self { J, rho, s, g: data["g"].as_f64().unwrap() }
    }

    /// `U_a`, what of the momentum depends on `F`, times `h`.
    fn unknown(&self, f: &Matrices, w: &Seen) -> Components {
        let (f, (_, q)) = (increments([&f.0, &f.1, &f.2]), seen(w));
        let mut u = [0, 1, 2].map(|a| twice_vee(&(f[a].1 * self.J[a])));
        for ((a, b), q) in PAIRS.into_iter().zip(q) {
            u[a] += self.rho[a].cross(&(q * f[b].0 * self.s[b]));
            u[b] += self.s[b].cross(&(q.transpose() * f[a].0 * self.rho[a]));
        }
        stacked(&u)
    }

    /// `h ∂U/∂E_j`.
    fn slope(&self, f: &Matrices, w: &Seen) -> Square {
        let (f, (_, q)) = (increments([&f.0, &f.1, &f.2]), seen(w));
        let mut slope = Square::zeros();
        for (a, (_, f)) in f.iter().enumerate() {
            let p = f * self.J[a];
            put(&mut slope, (a, a), &(Matrix3::from_diagonal_element(p.trace()) - p));
        }
        for ((a, b), q) in PAIRS.into_iter().zip(q) {
            let of_b = q * (f[b].1 * self.s[b]).cross_matrix();
            let of_a = q.transpose() * (f[a].1 * self.rho[a]).cross_matrix();
            put(&mut slope, (a, b), &(-self.rho[a].cross_matrix() * of_b));
            put(&mut slope, (b, a), &(-self.s[b].cross_matrix() * of_a));
        }
        slope
    }

    fn gravity(&self, w: &[Vector3<f64>; 3], half_step: f64) -> Components {
        stacked(&[0, 1, 2].map(|a| w[a].cross(&self.s[a]) * (half_step * self.g)))
    }
}

impl DiscreteLagrangian for Chain {
    const SELF_ADJOINT: bool = true;

    fn l_d(&self, f: &Matrices, w: &Seen, h: f64) -> f64 {
        let (f, (w, q)) = (increments([&f.0, &f.1, &f.2]), seen(w));
        let own = |a: usize| {
            (f[a].0 * self.J[a] * f[a].0.transpose()).trace() / (2.0 * h)
                - 0.5 * h * self.g * w[a].dot(&(self.s[a] + f[a].1 * self.s[a]))
        };
        let pair =
            |((a, b), q): ((usize, usize), Matrix3<f64>)| (f[a].0 * self.rho[a]).dot(&(q * f[b].0 * self.s[b])) / h;
        (0..3).map(own).sum::<f64>() + PAIRS.into_iter().zip(q).map(pair).sum::<f64>()
    }

    fn right_momentum(&self, f: &Matrices, w: &Seen, h: f64) -> Components {
        self.legendre_minus(f, w, h) + self.diamond(f, w, h)
    }

    fn left_momentum(&self, f: &Matrices, w: &Seen, h: f64) -> Components {
        let (f, (w, q)) = (increments([&f.0, &f.1, &f.2]), seen(w));
        let mut p = [0, 1, 2].map(|a| {
            twice_vee(&(self.J[a] * f[a].1)) / h - self.s[a].cross(&(f[a].1.transpose() * w[a])) * (0.5 * h * self.g)
        });
        for ((a, b), q) in PAIRS.into_iter().zip(q) {
            p[a] += self.rho[a].cross(&(f[a].1.transpose() * q * f[b].0 * self.s[b])) / h;
            p[b] += self.s[b].cross(&(f[b].1.transpose() * q.transpose() * f[a].0 * self.rho[a])) / h;
        }
        stacked(&p)
    }

    fn diamond(&self, f: &Matrices, w: &Seen, h: f64) -> Components {
        let (f, (w, q)) = (increments([&f.0, &f.1, &f.2]), seen(w));
        let mut k = [0, 1, 2].map(|a| w[a].cross(&(self.s[a] + f[a].1 * self.s[a])) * (0.5 * h * self.g));
        for ((a, b), q) in PAIRS.into_iter().zip(q) {
            let (x, y) = (f[a].0 * self.rho[a], f[b].0 * self.s[b]);
            k[a] += x.cross(&(q * y)) / h;
            k[b] += y.cross(&(q.transpose() * x)) / h;
        }
        stacked(&k)
    }

    fn legendre_minus(&self, f: &Matrices, w: &Seen, h: f64) -> Components {
        self.unknown(f, w) / h - self.gravity(&seen(w).0, 0.5 * h)
    }

    fn discrete_energy(&self, f: &Matrices, w: &Seen, h: f64) -> f64 {
        // `l_d` is `K/h − h V`.
        let (one, two) = (self.l_d(f, w, h), self.l_d(f, w, 2.0 * h));
        let potential = (one - 2.0 * two) / (3.0 * h);
        (one + h * potential) / h + potential
    }
}

impl Term for Chain {
    type Scalar = f64;
    type Group = Group;
    type Advected = Seen;

    fn validate(&self) -> Result<(), SetupError> {
        Ok(())
    }

    fn advected(&self) -> Seen {
        let up = Vector3::z();
        (SeenFrom(up), SeenFrom(up), SeenFrom(up), Relative::default(), Relative::default(), Relative::default())
    }
}

impl Effect for Chain {
    type Retraction = CayleyRetraction;
    type Kinetic = WithKinetic;
    type Constants = (Self, f64);
    /// `(h/2) a`, and what is seen.
    type StepTerms = (Components, Seen);

    const INERTIA_IS_CONSTANT: bool = false;
    const IS_QUADRATIC: bool = true;
    const DERIVATION: &'static str = "a chain of three links, by hand";

    fn describe(&self, visitor: &mut dyn SceneVisitor<f64>) {
        visitor.term(Self::DERIVATION);
        visitor.parameter("g", self.g);
    }

    fn momentum_jacobian(&self, f: &Matrices, w: &Seen, h: f64) -> Square {
        self.slope(f, w) / h
    }

    fn limit(&self, velocity: Option<&Components>, w: &Seen) -> Limit<Self> {
        let potential: f64 = (0..3).map(|a| self.g * seen(w).0[a].dot(&self.s[a])).sum();
        Limit::quadratic(velocity, self.slope(&Group::identity().matrix(), w), Components::zeros(), potential)
    }

    fn constants(&self, h: f64) -> (Self, f64) {
        (*self, 0.5 * h)
    }

    fn kick_before((chain, half_step): &(Self, f64), w: &Seen) -> Components {
        chain.gravity(&seen(w).0, *half_step)
    }

    fn step_terms((_, half_step): &(Self, f64), a: &Components, w: &Seen) -> (Components, Seen) {
        (a * *half_step, *w)
    }

    fn newton_system(
        (chain, _): &(Self, f64),
        (target, w): &(Components, Seen),
        half: &Components,
    ) -> (Components, Square) {
        let f = <CayleyRetraction as Retraction<Group>>::retract(&(half * 2.0)).matrix();
        let tangent = <CayleyRetraction as Retraction<Group>>::tangent_of_half(half);
        (chain.unknown(&f, w) * 0.5 - target, chain.slope(&f, w) * tangent * 0.5)
    }

    fn kick_after((chain, half_step): &(Self, f64), increment: &Matrices, next: &Seen) -> Components {
        let (w, q) = seen(next);
        let d = [&increment.0, &increment.1, &increment.2].map(|d| -d.transpose());
        let mut kick = chain.gravity(&w, *half_step);
        for ((a, b), q) in PAIRS.into_iter().zip(q) {
            let (x, y) = (d[a] * chain.rho[a], d[b] * chain.s[b]);
            let mut of_a = kick.fixed_rows_mut::<3>(3 * a);
            of_a += x.cross(&(q * y)) / (2.0 * half_step);
            let mut of_b = kick.fixed_rows_mut::<3>(3 * b);
            of_b += y.cross(&(q.transpose() * x)) / (2.0 * half_step);
        }
        kick
    }
}

/// The same as it is typed.
#[lagrangian(
    group(F_1 = SO3, F_2 = SO3, F_3 = SO3),
    advected(
        w_1 = up.seen_from(F_1),
        w_2 = up.seen_from(F_2),
        w_3 = up.seen_from(F_3),
        Q_12 = F_2.seen_from(F_1),
        Q_13 = F_3.seen_from(F_1),
        Q_23 = F_3.seen_from(F_2),
    ),
    l_d = ((F_1 - I) * J_1 * (F_1 - I).transpose()).trace() / (2.0 * h)
        + ((F_2 - I) * J_2 * (F_2 - I).transpose()).trace() / (2.0 * h)
        + ((F_3 - I) * J_3 * (F_3 - I).transpose()).trace() / (2.0 * h)
        + ((F_1 - I) * rho_1).dot(&(Q_12 * ((F_2 - I) * s_2))) / h
        + ((F_1 - I) * rho_1).dot(&(Q_13 * ((F_3 - I) * s_3))) / h
        + ((F_2 - I) * rho_2).dot(&(Q_23 * ((F_3 - I) * s_3))) / h
        - 0.5 * h * g * (w_1.dot(&(s_1 + F_1 * s_1)) + w_2.dot(&(s_2 + F_2 * s_2)) + w_3.dot(&(s_3 + F_3 * s_3))),
)]
struct Declared {
    J_1: NonstandardInertia,
    J_2: NonstandardInertia,
    J_3: NonstandardInertia,
    rho_1: Vector3<f64>,
    rho_2: Vector3<f64>,
    s_1: Vector3<f64>,
    s_2: Vector3<f64>,
    s_3: Vector3<f64>,
    g: f64,
    up: Vector3<f64>,
}

impl Declared {
    fn read() -> Self {
        let Chain { J, rho: [rho_1, rho_2, _], s: [s_1, s_2, s_3], g } = Chain::read();
        let [J_1, J_2, J_3] = J.map(|J| NonstandardInertia::new(J).unwrap());
        Self { J_1, J_2, J_3, rho_1, rho_2, s_1, s_2, s_3, g, up: Vector3::z() }
    }
}

/// Where it starts, and the first and the last link two seconds later.
fn motion() -> (Group, Components, [End; 2]) {
    let states = &read("several bodies")["chain3"]["states"];
    let (start, end) = (&states[0]["bodies"], &states[1]["bodies"]);
    let attitudes = all(start, |body| SO3::try_from(matrix(&body["R"])).unwrap());
    let velocity = stacked(&all(start, |body| vector(&body["Omega_body"])));
    let ends = [0, 2].map(|k| (matrix(&end[k]["R"]), vector(&end[k]["Omega_body"])));
    ((attitudes[0], attitudes[1], attitudes[2]), velocity, ends)
}

/// To rounding, against a step of 30 digits.
#[test]
fn golden_step() {
    let golden = &read("several bodies")["golden steps"]["chain3"];
    let (start, mu) = (attitudes_of(&golden["R0"]), momentum(&golden["mu0"]));
    let h = number(&golden["h"]);
    let ends = [after(Chain::read(), h, &start, mu), after(Declared::read(), h, &start, mu)];
    for (end, found) in ends {
        let expected: Components = momentum(&golden["mu1"]);
        let errors = [apart(&end, &attitudes_of(&golden["R1"])), (found - expected).norm() / expected.norm()];
        println!("{errors:?}");
        assert!(errors.iter().all(|&error| error < 1e-14), "{errors:?}");
    }
    // What goes like 1/h in the diamond loses no digit where the step is small.
    for h in [1e-2, 1e-4, 1e-5] {
        let [written, typed] = [after(Chain::read(), h, &start, mu), after(Declared::read(), h, &start, mu)];
        let error = (typed.1 - written.1).norm() / mu.norm();
        println!("{error:e} at {h}");
        assert!(error < 1e-14, "{error:e} at {h}");
    }
}

/// Attitudes and momenta one step later.
fn after<E: Regular<Scalar = f64, Group = Group>>(
    chain: E,
    h: f64,
    start: &[SO3],
    momentum: Components,
) -> ([SO3; 3], Components) {
    let stepper = Stepper::new(chain, h).unwrap();
    let mut state = stepper.start_with_momentum((start[0], start[1], start[2]), momentum).unwrap();
    stepper.step(&mut state).unwrap();
    assert_eq!(state.momentum_of::<2>(), part(&state.momentum(), 2));
    let end = state.attitude();
    ([end.0, end.1, end.2], state.momentum())
}

/// The order, and the errors of unreduced steps.
#[test]
fn trajectory() {
    let (attitude, velocity, [first, last]) = motion();
    let errors = [(0.02, 100), (0.01, 200), (0.005, 400), (0.0025, 800)].map(|(h, steps)| {
        let stepper = Stepper::new(Chain::read(), h).unwrap();
        let mut state = stepper.start(attitude, velocity).unwrap();
        let before = (vertical(&state), stepper.energy(&state));
        stepper.run(&mut state, steps).unwrap();
        assert!((vertical(&state) - before.0).abs() < 1e-12, "{}", vertical(&state) - before.0);
        // Of second order, as the step is; steps of 0.01 s keep it within 0.04 J.
        let off = (stepper.energy(&state) - before.1).abs();
        println!("energy off by {off:.2e} at {h}");
        assert!(off < 0.04 * (h / 0.01).powi(2), "{off:e} {h}");
        let attitude = (state.attitude().0.as_matrix() - first.0).amax();
        (attitude, (part(&stepper.velocity(&state), 2) - last.1).amax())
    });
    assert_reference(&errors);
}

/// Along the vertical the momentum of all.
fn vertical(motion: &liestep::motion::Motion<Group, Seen>) -> f64 {
    let spatial = motion.spatial_momentum();
    (0..3).map(|body| part(&spatial, body).z).sum()
}

/// It is kept by increments that miss their equation by far, over a hundred thousand steps.
#[test]
fn vertical_momentum_of_steps_solved_badly() {
    let ((attitude, velocity, _), chain) = (motion(), Chain::read());
    let stepper = Stepper::new(Badly(chain), 0.01).unwrap();
    let mut state = stepper.start(attitude, velocity).unwrap();
    let (before, mut most, mut least) = (vertical(&state), 0.0_f64, f64::INFINITY);
    for _ in 0..100_000 {
        let last = state;
        stepper.step(&mut state).unwrap();
        let f = last.attitude().inverse().compose(&state.attitude()).matrix();
        let missed = chain.legendre_minus(&f, &last.advected(), 0.01) - last.momentum();
        least = least.min(missed.norm() / last.momentum().norm());
        most = most.max((vertical(&state) - before).abs());
    }
    println!("momentum {most:.1e}, (2.7) missed by {least:.1e} at least");
    assert!(most < 2e-12 && least > 1e-6, "{most:e} {least:e}");
}

/// Compositions, compensated sums and checkpoints go around a product as around a group.
#[test]
fn what_goes_around_a_step_goes_around_a_product() {
    let (attitude, velocity, [end, _]) = motion();
    let composed = Stepper::composed(Chain::read(), 0.02, CompositionScheme::KAHAN_LI_8).unwrap();
    let mut precise = composed.start(attitude, velocity).unwrap();
    composed.run(&mut precise, 100).unwrap();
    let error = (precise.attitude().0.as_matrix() - end.0).norm();
    println!("of order 8: {error:.1e}");
    assert!(error < 1e-6, "{error:e}");

    let plain = Stepper::new(Chain::read(), 0.01).unwrap();
    let compensated = plain.clone().compensated();
    let mut state = plain.start(attitude, velocity).unwrap();
    let mut carried = compensated.start(attitude, velocity).unwrap();
    for _ in 0..100 {
        compensated.step(&mut carried).unwrap();
        plain.step(&mut state).unwrap();
    }
    assert!((carried.momentum() - state.momentum()).norm() < 1e-12);

    let saved = serde_json::to_string(&plain.checkpoint(&state)).unwrap();
    let mut resumed = plain.resume(&serde_json::from_str(&saved).unwrap()).unwrap();
    plain.run(&mut resumed, 10).unwrap();
    plain.run(&mut state, 10).unwrap();
    assert_eq!(resumed, state);

    let back = plain.inverse().unwrap();
    let mut there = plain.start(attitude, velocity).unwrap();
    let before = *there;
    plain.run(&mut there, 20).unwrap();
    let mut returned = back.adopt(&there);
    back.run(&mut returned, 20).unwrap();
    assert!((returned.momentum() - before.momentum()).norm() < 1e-12);
}

/// What a step can't do leaves the state, and says why; where the chain starts with a velocity that isn't a number it
/// doesn't start.
#[test]
fn a_step_that_is_too_long() {
    let (attitude, velocity, _) = motion();
    let stepper = Stepper::new(Chain::read(), 1.0).unwrap();
    let mut state = stepper.start(attitude, velocity * 3.0).unwrap();
    let before = state;
    let error = stepper.step(&mut state).unwrap_err();
    println!("{error}");
    assert!(matches!(error, StepError::BeyondSolvable { largest, .. } if largest > 1e-3 && largest < 1.0));
    assert_eq!(state, before);
}

/// A link without mass: no momentum determines its velocity. It is the last of the three, and all of its axes are lost.
#[test]
fn a_singular_inertia_is_seen_at_the_start() {
    let mut chain = Chain::read();
    (chain.J[2], chain.s[2]) = (Matrix3::zeros(), Vector3::zeros());
    let stepper = Stepper::new(chain, 0.01).unwrap();
    let (attitude, velocity, _) = motion();
    let error = stepper.start(attitude, velocity).unwrap_err();
    assert!(matches!(error, SetupError::SingularKinetic { body: Some(2), .. }), "{error}");
}
