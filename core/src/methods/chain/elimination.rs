//! What a step of a chain solves, link by link: outwards where the joints go, inwards what hangs on each link and its
//! elimination, outwards the update.
//!
//! All is in the axes of each link: what pulls along one then doesn't round what turns it. With `D = F − I` and the
//! nonstandard inertia `J` about the upper joint, what is carried outwards is the way `u` of that joint, and inwards the
//! momentum `P` beyond the lower one, times `h`:
//!
//! ```text
//! u' = Qᵀ(u + D ρ)        P' = Q (P + m (u + D c))        Q = R_aᵀ R_{a+1}
//! h r = (D J − J Dᵀ)^∨ + m c × u + ρ × P − h a            a = μ + (h/2) w × g s
//! ```
//!
//! For `δF = −ẑ F`, as an update is taken away, with the variation `v` of `u`, and that of the momentum beyond the lower
//! joint as a linear function `Π v + q` of the joint's,
//!
//! ```text
//! B = tr(F J) I − F J − ρ̂ Π (Fρ)^     G = m ĉ + ρ̂ Π     H = Π (Fρ)^ + m (Fc)^     t = ρ × q + h r
//! z = B⁻¹(G v + t)                     Π' = Q (Π + m I + H B⁻¹ G) Qᵀ               q' = Q (q + H B⁻¹ t)
//! ```
//!
//! `B` is what of the Newton matrix is left of the link once all that hangs on it is eliminated. At the identity `Π` is the
//! mass at the joint that the articulated-body algorithm has, and symmetric.
//!
//! Nothing here depends on the number of links but the length of slices, so it is compiled once.

use nalgebra::{Matrix3, Vector3};

// Roots and powers without a standard library.
#[cfg(not(feature = "std"))]
use nalgebra::ComplexField as _;

use super::link::Link;
use crate::groups::{CayleyRetraction, Retraction, SO3};
use crate::numbers::adjugate_3;

/// What a link is, as a step takes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LinkConstants {
    /// `J`, `m`, `m c` and `ρ` of the [`Link`].
    pub(super) nonstandard: Matrix3<f64>,
    pub(super) m: f64,
    pub(super) mc: Vector3<f64>,
    pub(super) rho: Vector3<f64>,
}

impl From<&Link> for LinkConstants {
    fn from(link: &Link) -> Self {
        Self { nonstandard: *link.J_d.as_matrix(), m: link.m, mc: link.c * link.m, rho: link.rho }
    }
}

/// What is known of a link while a step is solved; at first of one without a neighbour, at rest.
#[derive(Clone, Copy, Default)]
pub(super) struct Work {
    /// `Q`, from the axes of the next link to these; zero where there is none.
    pub(super) next: Matrix3<f64>,
    /// `h a`.
    pub(super) target: Vector3<f64>,
    /// Half the Cayley coordinates of `F`, and what they were before an update that may be shortened.
    pub(super) half: Vector3<f64>,
    before: Vector3<f64>,
    /// The last update, which was taken from `half`, or a part of it.
    pub(super) update: Vector3<f64>,
    /// `D`, and `D ρ`, `D m c`.
    pub(super) increment: Matrix3<f64>,
    pub(super) of_rho: Vector3<f64>,
    pub(super) of_mc: Vector3<f64>,
    /// `u`, m.
    pub(super) u: Vector3<f64>,
    /// `B⁻¹ t`.
    t: Vector3<f64>,
    /// `B⁻¹`, `B⁻¹ G` and `H` where they were last computed.
    inverse: Matrix3<f64>,
    g: Matrix3<f64>,
    h: Matrix3<f64>,
    /// `det B`.
    pub(super) determinant: f64,
}

impl Work {
    /// Whether the link turns by less than 90° and its determinant has the sign that it has at rest.
    pub(super) fn is_wanted(&self) -> bool {
        self.determinant > 0.0 && self.half.norm_squared() < 1.0
    }

    /// The link's momentum times `h`, `m (u + D c)`, kg m.
    #[hot]
    pub(super) fn momentum(&self, link: &LinkConstants) -> Vector3<f64> {
        self.u * link.m + self.of_mc
    }

    /// Turns it, where the way of its upper joint is `u`; returns that of the lower one, as the next link sees it.
    #[hot]
    fn turn(&mut self, link: &LinkConstants, u: Vector3<f64>) -> Vector3<f64> {
        self.increment = <CayleyRetraction as Retraction<SO3>>::increment_of_half(&self.half);
        self.of_rho = self.increment * link.rho;
        self.of_mc = self.increment * link.mc;
        self.u = u;
        self.next.tr_mul(&(u + self.of_rho))
    }

    /// `(D J − J Dᵀ)^∨ + m c × u + ρ × P − h a` with `D J`, and `P` beyond.
    #[hot]
    fn residual(&self, link: &LinkConstants, dj: &Matrix3<f64>, beyond: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(dj.m32 - dj.m23, dj.m13 - dj.m31, dj.m21 - dj.m12)
            + link.mc.cross(&self.u)
            + link.rho.cross(beyond)
            - self.target
    }
}

/// The squares of the lengths of an update, before it was shortened, and of the unknowns after it; whether it is whole.
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) length: f64,
    pub(super) size: f64,
    pub(super) is_whole: bool,
}

/// Where the joints go.
#[hot]
pub(super) fn outwards(links: &[LinkConstants], work: &mut [Work]) {
    let mut u = Vector3::zeros();
    for (link, work) in links.iter().zip(work) {
        u = work.turn(link, u);
    }
}

/// One of Newton's iterations, from where the joints go to where they go by it; where a link's update is longer than
/// `longest`, all are shortened.
#[hot]
pub(super) fn newton(links: &[LinkConstants], work: &mut [Work], longest: f64) -> Update {
    let (mut beyond, mut mass, mut q) = (Vector3::zeros(), Matrix3::zeros(), Vector3::zeros());
    for (link, work) in links.iter().zip(&mut *work).rev() {
        // From the axes of the next link; at the end all are zero.
        let turn = work.next;
        beyond = turn * beyond;
        q = turn * q;
        mass = turn * mass * turn.transpose();

        let dj = work.increment * link.nonstandard;
        let own = inertia(&(dj + link.nonstandard));
        let (turned_rho, turned_mc) = (link.rho + work.of_rho, link.mc + work.of_mc);
        let g = Matrix3::from_columns(&[0, 1, 2].map(|k| link.rho.cross(&mass.column(k))));
        let b = own - cross_rows(&g, &turned_rho);
        let g = add_hat(&g, &link.mc);
        let h = add_hat(&cross_rows(&mass, &turned_rho), &turned_mc);
        // By Cramer's rule; where the determinant is zero nothing is finite.
        let (adjugate, determinant) = adjugate_3(&b);
        let inverse = adjugate * (1.0 / determinant);
        let g = inverse * g;
        let t = inverse * (link.rho.cross(&q) + work.residual(link, &dj, &beyond));
        mass += h * g;
        mass.m11 += link.m;
        mass.m22 += link.m;
        mass.m33 += link.m;
        q += h * t;
        beyond += work.momentum(link);
        (work.inverse, work.g, work.h, work.t, work.determinant) = (inverse, g, h, t, determinant);
    }
    solved(links, work, longest)
}

/// Another with the matrix of the last.
#[hot]
pub(super) fn simplified(links: &[LinkConstants], work: &mut [Work]) -> Update {
    let (mut beyond, mut q) = (Vector3::zeros(), Vector3::zeros());
    for (link, work) in links.iter().zip(&mut *work).rev() {
        beyond = work.next * beyond;
        q = work.next * q;
        let dj = work.increment * link.nonstandard;
        work.t = work.inverse * (link.rho.cross(&q) + work.residual(link, &dj, &beyond));
        q += work.h * work.t;
        beyond += work.momentum(link);
    }
    solved(links, work, f64::INFINITY)
}

/// Outwards the update, and where the joints go by it.
#[hot]
fn solved(links: &[LinkConstants], work: &mut [Work], longest: f64) -> Update {
    // What has taken a whole update doesn't tell what it was: of that a rounding of the update is lost, which has no bound.
    if longest.is_finite() {
        for work in work.iter_mut() {
            work.before = work.half;
        }
    }
    let (mut u, mut v) = (Vector3::zeros(), Vector3::zeros());
    for (link, work) in links.iter().zip(&mut *work) {
        let (y, z) = (work.half, work.g * v + work.t);
        v = work.next.tr_mul(&(v - z.cross(&(link.rho + work.of_rho))));
        // dF F⁻¹ = (2 (I + ŷ) dy/(1 + |y|²))^ = −ẑ, solved for `−dy`.
        work.update = (z - y.cross(&z) + y * y.dot(&z)) * 0.5;
        work.half -= work.update;
        u = work.turn(link, u);
    }
    let largest = work.iter().map(|work| work.update.norm_squared()).fold(0.0, f64::max);
    if largest > longest * longest {
        let part = longest / largest.sqrt();
        for work in work.iter_mut() {
            work.half = work.before - work.update * part;
        }
        outwards(links, work);
    }
    // What isn't a number makes the size none either.
    let (mut update, mut size) = (0.0, 0.0);
    for work in work {
        update += work.update.norm_squared();
        size += work.half.norm_squared();
    }
    Update { length: update, size, is_whole: largest <= longest * longest }
}

/// The momenta `target` of the velocities `half`.
pub(super) fn momenta_of_velocities(links: &[LinkConstants], work: &mut [Work]) {
    let (mut u, mut beyond) = (Vector3::zeros(), Vector3::zeros());
    for (link, work) in links.iter().zip(&mut *work) {
        (work.of_rho, work.of_mc, work.u) = (work.half.cross(&link.rho), work.half.cross(&link.mc), u);
        u = work.next.tr_mul(&(u + work.of_rho));
    }
    for (link, work) in links.iter().zip(&mut *work).rev() {
        beyond = work.next * beyond;
        work.target = inertia(&link.nonstandard) * work.half + link.mc.cross(&work.u) + link.rho.cross(&beyond);
        beyond += work.momentum(link);
    }
}

/// The ordinary inertia about a joint, `tr(J) I − J`.
#[hot]
fn inertia(nonstandard: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(nonstandard.trace()) - nonstandard
}

/// `M â`: each row times `a`.
#[hot]
fn cross_rows(m: &Matrix3<f64>, a: &Vector3<f64>) -> Matrix3<f64> {
    let [x, y, z] = [0, 1, 2].map(|k| m.column(k).into_owned());
    Matrix3::from_columns(&[y * a.z - z * a.y, z * a.x - x * a.z, x * a.y - y * a.x])
}

/// `M + â`.
#[hot]
fn add_hat(m: &Matrix3<f64>, a: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(m.m11, m.m12 - a.z, m.m13 + a.y, m.m21 + a.z, m.m22, m.m23 - a.x, m.m31 - a.y, m.m32 + a.x, m.m33)
}
