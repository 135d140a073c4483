//! The printed equations of the thesis for the free body and the heavy top, written by hand, compared with the derived
//! terms and the steps; and its errata: each corrected equation fails as printed.
//!
//! The body has a full `J_d` and its centre of mass off all axes, so that no term vanishes by symmetry.

use checks::random::Random;
use declarations::{FreeBody, FullTop};
use liestep::mechanics::DiscreteLagrangian as _;
use liestep::motion::{DiscreteEulerPoincare, DiscreteLiePoisson};
use liestep::prelude::*;
use nalgebra::{Matrix3, Vector3};

const H: f64 = 0.02;
/// The bound is some products of matrices, relative to `J_d/h`.
const ROUNDING: f64 = 1e-13;

type Vector = Vector3<f64>;
type Matrix = Matrix3<f64>;

/// A body in the notation of the thesis.
struct PrintedBody {
    J_d: Matrix,
    mg: f64,
    rho: Vector,
}

fn top() -> (FullTop, PrintedBody) {
    let J_d = Matrix::new(1.4, 0.2, -0.1, 0.2, 0.9, 0.15, -0.1, 0.15, 0.6);
    let (m, g, rho) = (1.3, 9.81, Vector::new(0.3, 0.2, 0.4));
    let top = FullTop { J_d: NonstandardInertia::new(J_d).unwrap(), m, g, rho, up: Vector::z() };
    (top, PrintedBody { J_d, mg: m * g, rho })
}

/// The vector `M^∨` of the skew part of a matrix.
fn vee(m: &Matrix) -> Vector {
    Vector::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12) * 0.5
}

fn hat(v: &Vector) -> Matrix {
    v.cross_matrix()
}

impl PrintedBody {
    /// The moment `mg w × ρ`.
    fn moment(&self, w: &Vector) -> Vector {
        w.cross(&self.rho) * self.mg
    }

    /// The Lagrangian of section 3.2, `L(R, RΩ̂, w) = ½ tr(Ω̂ J_d Ω̂ᵀ) − mg⟨w, Rρ⟩`.
    fn continuous(&self, r: &Matrix, velocity: &Matrix, w: &Vector) -> f64 {
        0.5 * (velocity * self.J_d * velocity.transpose()).trace() - self.mg * w.dot(&(r * self.rho))
    }

    /// The momentum (3.17), with the factor ½ of the thesis.
    fn momentum_before(&self, f: &Matrix, w: &Vector) -> Matrix {
        let kinetic = (f * self.J_d - self.J_d * f.transpose()) / H;
        (kinetic - (self.rho * w.transpose() - w * self.rho.transpose()) * (0.5 * H * self.mg)) * 0.5
    }

    /// The momentum (3.18).
    fn momentum_after(&self, f: &Matrix, w: &Vector) -> Matrix {
        let kinetic = (self.J_d * f - f.transpose() * self.J_d) / H;
        let weight = f.transpose() * w * self.rho.transpose() - self.rho * w.transpose() * f;
        (kinetic - weight * (0.5 * H * self.mg)) * 0.5
    }

    fn scale(&self) -> f64 {
        self.J_d.norm() / H
    }
}

/// Increments of some tenths of a radian, with advected vectors.
fn steps() -> Vec<(Matrix, Vector)> {
    let mut random = Random::new(316);
    (0..20).map(|_| (*random.rotation_by(0.3).as_matrix(), random.vector())).collect()
}

fn close(what: &str, a: Vector, b: Vector, allowed: f64) {
    assert!((a - b).norm() <= allowed, "{what}: off by {:e}", (a - b).norm());
}

/// Items 1 to 3 of section 3.2.1, (3.17) and (3.18); `p = 2 Π̂^∨`.
#[test]
fn derived_terms_as_printed() {
    let (top, printed) = top();
    let PrintedBody { J_d, mg, rho } = &printed;
    for (f, w) in steps() {
        let (f_t, allowed) = (f.transpose(), ROUNDING * printed.scale());
        let left =
            ((J_d * f - f_t * J_d) / H - (f_t * w * rho.transpose() - rho * w.transpose() * f) * (0.5 * H * mg)) * 0.5;
        close("item 1", top.left_momentum(&f, &w, H), vee(&left) * 2.0, allowed);
        let right =
            ((f * J_d - J_d * f_t) / H - (w * rho.transpose() * f_t - f * rho * w.transpose()) * (0.5 * H * mg)) * 0.5;
        close("item 2", top.right_momentum(&f, &w, H), vee(&right) * 2.0, allowed);
        let diamond = (w * rho.transpose() - rho * w.transpose() + w * rho.transpose() * f_t - f * rho * w.transpose())
            * (-0.25 * H * mg);
        close("item 3", top.diamond(&f, &w, H), vee(&diamond) * 2.0, allowed);
        close("(3.17)", top.legendre_minus(&f, &w, H), vee(&printed.momentum_before(&f, &w)) * 2.0, allowed);
        close("(3.18)", top.legendre_plus(&f, &w, H), vee(&printed.momentum_after(&f, &w)) * 2.0, allowed);
        // Equation (1.31), for the same body without gravity.
        let free = FreeBody { J_d: top.J_d };
        let momentum = (f * J_d - J_d * f_t) / (2.0 * H);
        close("(1.31)", free.legendre_minus(&f, &(), H), vee(&momentum) * 2.0, allowed);
    }
}

/// The trapezoidal rule with `Ω̂_i = R_iᵀ(R_{i+1} − R_i)/h` discretises `L` to (3.13), with the spatial `e₃` in it.
#[test]
fn trapezoidal_rule_gives_3_13() {
    let (top, printed) = top();
    let mut random = Random::new(313);
    for (f, _) in steps() {
        let r = *random.rotation().as_matrix();
        let (next, velocity) = (r * f, r.transpose() * (r * f - r) / H);
        let (e3, w) = (Vector::z(), r.transpose() * Vector::z());
        let rule =
            |w: &Vector| 0.5 * H * (printed.continuous(&r, &velocity, w) + printed.continuous(&next, &velocity, w));
        let l_d = top.l_d(&f, &w, H);
        assert!((rule(&e3) - l_d).abs() <= ROUNDING * printed.scale(), "{:e}", rule(&e3) - l_d);
        // Erratum: the printed argument `w_i` gives another number.
        assert!((rule(&w) - l_d).abs() > 1e-4, "{:e}", rule(&w) - l_d);
        // The Lagrangian of [LML05] differs off the group only.
        let potential = printed.mg * (w.dot(&printed.rho) + w.dot(&(f * printed.rho)));
        let theirs = ((Matrix::identity() - f) * printed.J_d).trace() / H - 0.5 * H * potential;
        assert!((theirs - l_d).abs() <= ROUNDING * printed.scale(), "{:e}", theirs - l_d);
    }
}

/// Equations (3.14) to (3.16) as printed, from the flow on increments.
#[test]
fn flow_on_increments_as_printed() {
    let (top, PrintedBody { J_d, mg, rho }) = top();
    let flow = DiscreteEulerPoincare::new(top, H).unwrap();
    let mut random = Random::new(317);
    let (mut f, mut w) = (random.rotation_by(0.1), random.direction());
    for _ in 0..100 {
        let (next, seen) = flow.step(&f, &w).unwrap();
        let (before, after) = (*f.as_matrix(), *next.as_matrix());
        close("(3.15)", seen, before.transpose() * w, 1e-15);
        let left = (J_d * after.transpose() - before.transpose() * J_d - after * J_d + J_d * before) / H;
        let right = (before.transpose() * w * rho.transpose() - rho * w.transpose() * before) * (H * mg);
        let missed = (left - right).norm() * H;
        assert!(missed <= ROUNDING, "(3.16): off by {missed:e}");
        assert!((left + right).norm() * H > 1e-5, "the right side counts");
        // The equation of \[LML05\]: F⁺J_d − J_dF⁺ᵀ − J_dF + FᵀJ_d = h² S(M⁺).
        let theirs = after * J_d - J_d * after.transpose() - J_d * before + before.transpose() * J_d;
        let missed = (theirs - hat(&(seen.cross(&rho) * mg)) * (H * H)).norm();
        assert!(missed <= ROUNDING, "[LML05]: off by {missed:e}");
        (f, w) = (next, seen);
    }
}

/// The momentum and the attitude: [LML05] in its Hamiltonian form, (3.19) and (3.20).
#[test]
fn momentum_in_space_as_printed() {
    let (top, printed) = top();
    let flow = DiscreteLiePoisson::new(top, H).unwrap();
    let mut random = Random::new(319);
    let (mut r, mut p, mut missed) = (*random.rotation().as_matrix(), random.vector(), 0.0_f64);
    for _ in 0..100 {
        let w = r.transpose() * Vector::z();
        let step = flow.step(&p, &w, &Vector::zeros()).unwrap();
        let f = *step.element().as_matrix();
        let (next, after) = (r * f, step.momentum);
        let allowed = ROUNDING * printed.scale();

        let theirs = (f * printed.J_d - printed.J_d * f.transpose()) / H;
        close("[LML05], h S(Π + (h/2) M)", vee(&theirs), p + printed.moment(&w) * (0.5 * H), allowed);
        let kicks = f.transpose() * printed.moment(&w) + printed.moment(&step.advected);
        close("[LML05], Π⁺", after, f.transpose() * p + kicks * (0.5 * H), allowed);

        let e3 = Vector::z();
        let change = ((next * printed.rho).cross(&e3) + (r * printed.rho).cross(&e3)) * (-0.5 * H * printed.mg);
        close("(3.19)", next * after - r * p, change, allowed);
        assert!((e3.dot(&(next * after - r * p))).abs() <= allowed, "(3.20)");
        // Erratum: the momenta of (3.17) and (3.18), without the factor two, change by half of that.
        let [before_hat, after_hat] = [printed.momentum_before(&f, &w), printed.momentum_after(&f, &w)];
        let halves = next * vee(&after_hat) - r * vee(&before_hat);
        close("(3.19) with h/4", halves, change * 0.5, allowed);
        assert!((halves - change).norm() > 0.4 * change.norm(), "one letter for two momenta");
        // Erratum: a matrix is transformed to space by conjugation, and not as in the line before (3.19).
        let conjugated = next * after_hat * next.transpose() - r * before_hat * r.transpose();
        close("the line before (3.19)", vee(&conjugated), change * 0.5, allowed);
        let line = next.transpose() * after_hat - r.transpose() * before_hat;
        missed = missed.max((vee(&line) - change * 0.5).norm());
        (r, p) = (next, after);
    }
    assert!(missed > 0.01, "the printed line: {missed:e}");
}

/// Erratum: the matrix in the trace is `J_d`, and the inertia is `tr(J_d) I − J_d`.
#[test]
fn matrix_in_the_trace() {
    let (_, PrintedBody { J_d, .. }) = top();
    let velocity = Vector::new(0.4, -1.1, 0.7);
    let trace = 0.5 * (hat(&velocity) * J_d * hat(&velocity).transpose()).trace();
    let inertia = Matrix::identity() * J_d.trace() - J_d;
    assert!((trace - 0.5 * velocity.dot(&(inertia * velocity))).abs() < 1e-15);
    assert!((trace - 0.5 * velocity.dot(&(J_d * velocity))).abs() > 0.1);
}

/// Erratum: the third line of the diamond in section 3.2.1, with its sign and its exponent.
#[test]
fn third_line_of_the_diamond() {
    let (top, PrintedBody { mg, rho, .. }) = top();
    for (f, w) in steps() {
        let line = |sign: f64| {
            Vector::from_fn(|k, _| {
                let xi = Vector::ith(k, 1.0);
                w.dot(&(xi.cross(&rho) + xi.cross(&(f * rho)) * sign)) * (-0.5 * H * mg)
            })
        };
        let diamond = top.diamond(&f, &w, H);
        close("exp(sξ)ρ + exp(sξ)Fρ", diamond, line(1.0), 1e-15);
        // The printed exp(sρ)Fρ has no derivative along ξ at all; with that corrected, the sign is still wrong.
        for sign in [-1.0, 0.0] {
            assert!((diamond - line(sign)).norm() > 1e-4, "{sign}: {:e}", (diamond - line(sign)).norm());
        }
    }
}
