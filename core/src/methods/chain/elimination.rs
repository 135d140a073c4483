//! What a step of a chain solves, link by link: outwards where the joints go, inwards what hangs on each link and its
//! elimination, outwards the update.
//!
//! All is in the axes of each link. With `D = F − I`, what is carried outwards is the way `u` of the upper joint, and
//! inwards the momentum `P` beyond the lower one, times `h`:
//!
//! ```text
//! u' = Qᵀ(u + D ρ)        P' = Q (P + m (u + D c))        Q = R_aᵀ R_{a+1}
//! h r = (D J − J Dᵀ)^∨ + m c × u + ρ × P − h a            a = μ + (h/2) w × g s
//! ```
//!
//! For `δF = ẑ F`, with the variation `v` of `u`, and that of the momentum beyond the lower joint as a linear function
//! `Π v + q` of the joint's,
//!
//! ```text
//! B = tr(F J) I − F J − ρ̂ Π (Fρ)^     G = m ĉ + ρ̂ Π     H = Π (Fρ)^ + m (Fc)^     t = ρ × q + h r
//! z = −B⁻¹(G v + t)                    Π' = Q (Π + m I + H B⁻¹ G) Qᵀ               q' = Q (q + H B⁻¹ t)
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

use super::{Link, inertia};

/// What is known of a link while a step is solved.
#[derive(Clone, Copy)]
pub(super) struct Work {
    /// `Q`, from the axes of the next link to these.
    pub(super) next: Matrix3<f64>,
    /// `h a`.
    pub(super) target: Vector3<f64>,
    /// Half the Cayley coordinates of `F`.
    pub(super) half: Vector3<f64>,
    /// `D`.
    pub(super) increment: Matrix3<f64>,
    /// `D ρ`, `D c`.
    pub(super) of_rho: Vector3<f64>,
    pub(super) of_c: Vector3<f64>,
    /// `u`, m.
    pub(super) u: Vector3<f64>,
    /// `P`, kg m.
    pub(super) beyond: Vector3<f64>,
    /// `t`.
    t: Vector3<f64>,
    /// `B⁻¹`, `G`, `H B⁻¹` and `F ρ` where they were last computed.
    inverse: Matrix3<f64>,
    g: Matrix3<f64>,
    k: Matrix3<f64>,
    turned_rho: Vector3<f64>,
    /// `det B`.
    pub(super) determinant: f64,
    /// `z`.
    pub(super) z: Vector3<f64>,
}

impl Work {
    pub(super) fn new() -> Self {
        let (vector, matrix) = (Vector3::zeros(), Matrix3::zeros());
        Self {
            next: Matrix3::identity(),
            target: vector,
            half: vector,
            increment: matrix,
            of_rho: vector,
            of_c: vector,
            u: vector,
            beyond: vector,
            t: vector,
            inverse: matrix,
            g: matrix,
            k: matrix,
            turned_rho: vector,
            determinant: 1.0,
            z: vector,
        }
    }

    /// Whether the link turns by less than 90° and its determinant has the sign that it has at rest.
    pub(super) fn is_wanted(&self) -> bool {
        self.determinant > 0.0 && self.half.norm_squared() < 1.0
    }
}

/// The squares of the lengths of an update and of the unknowns after it, and the largest update of a link.
#[derive(Clone, Copy)]
pub(super) struct Updated {
    pub(super) update: f64,
    pub(super) size: f64,
    pub(super) largest: f64,
}

/// Where the joints go: `D` of each link, and `u`.
pub(super) fn outwards(links: &[Link], work: &mut [Work]) {
    let mut u = Vector3::zeros();
    for (link, work) in links.iter().zip(work) {
        let y = work.half;
        let scale = 2.0 / (1.0 + y.norm_squared());
        work.increment = quadratic(&y) * scale;
        work.of_rho = work.increment * link.rho;
        work.of_c = work.increment * link.c;
        work.u = u;
        u = work.next.tr_mul(&(u + work.of_rho));
    }
}

/// `ŷ + ŷ²`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn quadratic(y: &Vector3<f64>) -> Matrix3<f64> {
    let (xx, yy, zz) = (y.x * y.x, y.y * y.y, y.z * y.z);
    let (xy, xz, yz) = (y.x * y.y, y.x * y.z, y.y * y.z);
    Matrix3::new(-(yy + zz), xy - y.z, xz + y.y, xy + y.z, -(xx + zz), yz - y.x, xz - y.y, yz + y.x, -(xx + yy))
}

/// The momentum beyond each joint.
pub(super) fn momenta(links: &[Link], work: &mut [Work]) {
    let mut beyond = Vector3::zeros();
    for (link, work) in links.iter().zip(work).rev() {
        work.beyond = work.next * beyond;
        beyond = work.beyond + (work.u + work.of_c) * link.m;
    }
}

/// Eliminates from the end to the pivot, with the residual `h r` of each link.
#[cfg_attr(not(debug_assertions), inline(always))]
fn eliminate(links: &[Link], work: &mut [Work], residual: impl Fn(&Link, &Work) -> (Vector3<f64>, Matrix3<f64>)) {
    let (mut beyond, mut mass, mut q) = (Vector3::zeros(), Matrix3::zeros(), Vector3::zeros());
    for (link, work) in links.iter().zip(work).rev() {
        // From the axes of the next link; at the end all are zero.
        let turn = work.next;
        work.beyond = turn * beyond;
        q = turn * q;
        mass = turn * mass * turn.transpose();

        let (r, own) = residual(link, work);
        let (rho, c, m) = (link.rho, link.c, link.m);
        let (turned_rho, turned_c) = (rho + work.of_rho, c + work.of_c);
        let g = cross_columns(&rho, &mass);
        let b = own - cross_rows(&g, &turned_rho);
        let g = add_hat(&g, &(c * m));
        let h = add_hat(&cross_rows(&mass, &turned_rho), &(turned_c * m));
        let (inverse, determinant) = inverted(&b);
        let k = h * inverse;
        let t = rho.cross(&q) + r;
        mass += k * g;
        mass.m11 += m;
        mass.m22 += m;
        mass.m33 += m;
        q += k * t;
        beyond = work.beyond + (work.u + work.of_c) * m;
        (work.inverse, work.g, work.k, work.t) = (inverse, g, k, t);
        (work.turned_rho, work.determinant) = (turned_rho, determinant);
    }
}

/// `(D J − J Dᵀ)^∨ + m c × u + ρ × P − h a`, and `tr(F J) I − F J`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn momentum_equation(link: &Link, work: &Work) -> (Vector3<f64>, Matrix3<f64>) {
    let nonstandard = link.J_d.as_matrix();
    let dj = work.increment * nonstandard;
    (residual(link, work, &dj), inertia(&(dj + nonstandard)))
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn residual(link: &Link, work: &Work, dj: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(dj.m32 - dj.m23, dj.m13 - dj.m31, dj.m21 - dj.m12)
        + link.c.cross(&work.u) * link.m
        + link.rho.cross(&work.beyond)
        - work.target
}

/// One of Newton's iterations.
pub(super) fn newton(links: &[Link], work: &mut [Work], longest: f64) -> Updated {
    outwards(links, work);
    eliminate(links, work, momentum_equation);
    solved(work, longest)
}

/// Another with the matrix of the last.
pub(super) fn simplified(links: &[Link], work: &mut [Work]) -> Updated {
    outwards(links, work);
    let (mut beyond, mut q) = (Vector3::zeros(), Vector3::zeros());
    for (link, work) in links.iter().zip(work.iter_mut()).rev() {
        work.beyond = work.next * beyond;
        q = work.next * q;
        let dj = work.increment * link.J_d.as_matrix();
        work.t = link.rho.cross(&q) + residual(link, work, &dj);
        q += work.k * work.t;
        beyond = work.beyond + (work.u + work.of_c) * link.m;
    }
    solved(work, f64::INFINITY)
}

/// Outwards the update; where one is longer than `longest`, all are shortened.
fn solved(work: &mut [Work], longest: f64) -> Updated {
    let mut v = Vector3::zeros();
    let mut largest = 0.0_f64;
    let mut update = 0.0;
    for work in work.iter_mut() {
        let (y, z) = (work.half, -(work.inverse * (work.g * v + work.t)));
        v = work.next.tr_mul(&(v + z.cross(&work.turned_rho)));
        // dF F⁻¹ = (2 (I + ŷ) dy/(1 + |y|²))^, solved for `dy`.
        work.z = (z - y.cross(&z) + y * y.dot(&z)) * 0.5;
        let square = work.z.norm_squared();
        update += square;
        // What isn't a number makes the size none either.
        largest = largest.max(square);
    }
    let part = if largest > longest * longest { longest / largest.sqrt() } else { 1.0 };
    let mut size = 0.0;
    for work in work.iter_mut() {
        work.half += work.z * part;
        size += work.half.norm_squared();
    }
    Updated { update, size, largest }
}

/// The velocities `z` of the momenta `target` at rest, `F = I`.
pub(super) fn velocities(links: &[Link], work: &mut [Work]) {
    for work in work.iter_mut() {
        (work.half, work.increment) = (Vector3::zeros(), Matrix3::zeros());
        (work.of_rho, work.of_c, work.u) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
    }
    eliminate(links, work, |link, work| (-work.target, inertia(link.J_d.as_matrix())));
    let mut v = Vector3::zeros();
    for work in work {
        work.z = -(work.inverse * (work.g * v + work.t));
        v = work.next.tr_mul(&(v + work.z.cross(&work.turned_rho)));
    }
}

/// The momenta `target` of the velocities `z`.
pub(super) fn momenta_of_velocities(links: &[Link], work: &mut [Work]) {
    let mut u = Vector3::zeros();
    for (link, work) in links.iter().zip(work.iter_mut()) {
        (work.of_rho, work.of_c, work.u) = (work.z.cross(&link.rho), work.z.cross(&link.c), u);
        u = work.next.tr_mul(&(u + work.of_rho));
    }
    momenta(links, work);
    for (link, work) in links.iter().zip(work) {
        work.target =
            inertia(link.J_d.as_matrix()) * work.z + link.c.cross(&work.u) * link.m + link.rho.cross(&work.beyond);
    }
}

/// `â M`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn cross_columns(a: &Vector3<f64>, m: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::new(
        a.y * m.m31 - a.z * m.m21,
        a.y * m.m32 - a.z * m.m22,
        a.y * m.m33 - a.z * m.m23,
        a.z * m.m11 - a.x * m.m31,
        a.z * m.m12 - a.x * m.m32,
        a.z * m.m13 - a.x * m.m33,
        a.x * m.m21 - a.y * m.m11,
        a.x * m.m22 - a.y * m.m12,
        a.x * m.m23 - a.y * m.m13,
    )
}

/// `M â`: each row times `a`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn cross_rows(m: &Matrix3<f64>, a: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(
        m.m12 * a.z - m.m13 * a.y,
        m.m13 * a.x - m.m11 * a.z,
        m.m11 * a.y - m.m12 * a.x,
        m.m22 * a.z - m.m23 * a.y,
        m.m23 * a.x - m.m21 * a.z,
        m.m21 * a.y - m.m22 * a.x,
        m.m32 * a.z - m.m33 * a.y,
        m.m33 * a.x - m.m31 * a.z,
        m.m31 * a.y - m.m32 * a.x,
    )
}

/// `M + â`.
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_hat(m: &Matrix3<f64>, a: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(m.m11, m.m12 - a.z, m.m13 + a.y, m.m21 + a.z, m.m22, m.m23 - a.x, m.m31 - a.y, m.m32 + a.x, m.m33)
}

/// The inverse, by Cramer's rule, and the determinant. Where it is zero nothing is finite.
#[cfg_attr(not(debug_assertions), inline(always))]
fn inverted(m: &Matrix3<f64>) -> (Matrix3<f64>, f64) {
    let (adjugate, determinant) = crate::numbers::adjugate_3(m);
    (adjugate * (1.0 / determinant), determinant)
}
