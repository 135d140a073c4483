//! Newton's iteration for a step of a chain, in three sweeps: outwards for the displacements of the joints, inwards for
//! the forces and the elimination of each link, outwards for the update.
//!
//! All vectors are in the axes of each link: a large pull along a slim link then doesn't round its small moment. With
//! `D = F − I` and the nonstandard inertia `J` about the upper joint, the outward sweep carries the displacement `u` of
//! that joint, and the inward one the momentum `P` beyond the lower joint, times `h`:
//!
//! ```text
//! u' = Qᵀ(u + D ρ)        P' = Q (P + m (u + D c))        Q = R_aᵀ R_{a+1}
//! h r = (D J − J Dᵀ)^∨ + m c × u + ρ × P − h a            a = μ + (h/2) w × g s
//! ```
//!
//! The update `z` is a variation `δF = −ẑ F`. With the variation `v` of `u`, the variation of the momentum beyond the
//! lower joint is an affine function `Π v + q` of that joint's variation:
//!
//! ```text
//! B = tr(F J) I − F J − ρ̂ Π (Fρ)^     G = m ĉ + ρ̂ Π     H = Π (Fρ)^ + m (Fc)^     t = ρ × q + h r
//! z = B⁻¹(G v + t)                     Π' = Q (Π + m I + H B⁻¹ G) Qᵀ               q' = Q (q + H B⁻¹ t)
//! ```
//!
//! Matrices are columns in registers, and the duration of a step is the longest chain of dependent operations. So
//! `ρ̂ Q` is computed before `Π'` is known, and `H adj(B) G` during the division by `det B`.
//!
//! `B` is the pivot block of the link in the Newton matrix, once all links beyond are eliminated. At the identity `Π`
//! is symmetric: the articulated-body algorithm's mass at the joint.
//!
//! The number of links enters only as the length of slices, so this is compiled once for all chains.

roots!();

use super::link::Link;
use crate::numbers::{Columns, Register, cross, dot, padded, square};

/// The parameters of a link in a step: vectors as registers load them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LinkConstants {
    /// `J` by columns, `m`, `m c` and `ρ` of the [`Link`].
    pub(super) nonstandard: [[f64; 4]; 3],
    pub(super) m: f64,
    pub(super) mc: [f64; 4],
    pub(super) rho: [f64; 4],
}

impl From<&Link> for LinkConstants {
    fn from(link: &Link) -> Self {
        let J_d = link.J_d.as_matrix();
        let nonstandard = [0, 1, 2].map(|k| padded(&J_d.column(k).into_owned()));
        Self { nonstandard, m: link.m, mc: padded(&(link.c * link.m)), rho: padded(&link.rho) }
    }
}

/// The unknowns and intermediate results of a link during a solution.
#[derive(Clone, Copy)]
pub(super) struct Work<R> {
    /// `Q`, from the axes of the next link to these, zero for the last link; then `Qᵀ` and `ρ̂ Q`.
    pub(super) next: Columns<R>,
    back: Columns<R>,
    arm: Columns<R>,
    /// The target `h a` of the momentum equation.
    pub(super) target: R,
    /// Half the Cayley coordinates of `F`, and their value before an update that may be shortened.
    pub(super) half: R,
    before: R,
    /// The last whole update; `half` has been reduced by this, or by a part of it.
    pub(super) update: R,
    /// The increment `D`, and its images `D ρ` and `D m c`.
    pub(super) increment: Columns<R>,
    pub(super) of_rho: R,
    pub(super) of_mc: R,
    /// The displacement `u` of the upper joint, m.
    pub(super) u: R,
    /// The part `B⁻¹ t` of the update.
    t: R,
    /// `B⁻¹`, `B⁻¹ G` and `H` of the last Jacobian.
    inverse: Columns<R>,
    g: Columns<R>,
    h: Columns<R>,
    /// The determinant `det B`.
    pub(super) determinant: f64,
}

#[hot]
impl<R: Register> Work<R> {
    /// A link at rest without neighbours.
    pub(super) fn none(zero: R) -> Self {
        let none = Columns([zero; 3]);
        Self {
            next: none,
            back: none,
            arm: none,
            target: zero,
            half: zero,
            before: zero,
            update: zero,
            increment: none,
            of_rho: zero,
            of_mc: zero,
            u: zero,
            t: zero,
            inverse: none,
            g: none,
            h: none,
            determinant: 0.0,
        }
    }

    /// Sets the relative attitude `next` of the next link.
    pub(super) fn place(&mut self, link: &LinkConstants, next: Columns<R>) {
        self.arm = Columns::hat(self.u.of(link.rho)) * next;
        (self.next, self.back) = (next, next.transposed());
    }

    /// Whether the link turns by less than 90° and its determinant has the same sign as at rest, as on the branch of
    /// the identity.
    pub(super) fn is_wanted(&self) -> bool {
        self.determinant > 0.0 && square(self.half) < 1.0
    }

    /// The link's momentum times `h`, `m (u + D c)`, kg m.
    pub(super) fn momentum(&self, link: &LinkConstants) -> R {
        self.u * self.u.of([link.m; 4]) + self.of_mc
    }

    /// Computes the increment from `half` and the displacement `u` of the upper joint; returns that of the lower joint,
    /// in the axes of the next link.
    fn turn(&mut self, link: &LinkConstants, u: R) -> R {
        // D = s (ŷ + y yᵀ − |y|² I), s = 2/(1 + |y|²).
        let (half, squared) = (self.half, dot(self.half, self.half));
        let scale = u.of([2.0; 4]) / (u.of([1.0; 4]) + squared);
        let part = half * scale;
        let [x, y, z, _] = half.entries();
        let dyad = Columns([part * part.of([x; 4]), part * part.of([y; 4]), part * part.of([z; 4])]);
        self.increment = dyad + Columns::hat(part) - Columns::multiple(u, (squared * scale).entries()[0]);
        self.of_rho = self.increment.map(u.of(link.rho));
        self.of_mc = self.increment.map(u.of(link.mc));
        self.u = u;
        self.back.map(u + self.of_rho)
    }

    /// The right-hand side `t = ρ × q + h r`, from `dj = D J` and the momentum `P` beyond.
    fn residual(&self, link: &LinkConstants, dj: &Columns<R>, beyond: R, q: R) -> R {
        let (mc, rho) = (q.of(link.mc), q.of(link.rho));
        let [[_, m21, m31, _], [m12, _, m32, _], [m13, m23, ..]] = dj.entries();
        q.of([m32 - m23, m13 - m31, m21 - m12, 0.0]) + cross(mc, self.u) + cross(rho, q + beyond) - self.target
    }
}

/// The squared lengths of an update before it was shortened and of the unknowns after it, and whether it was applied
/// whole.
#[derive(Clone, Copy)]
pub(super) struct Update {
    pub(super) length: f64,
    pub(super) size: f64,
    pub(super) is_whole: bool,
}

/// The outward sweep: increments and displacements of all joints.
#[hot]
pub(super) fn outwards<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>]) {
    let mut u = zero;
    for (link, work) in links.iter().zip(work) {
        u = work.turn(link, u);
    }
}

/// One Newton iteration and the outward sweep after it. If a link's update is longer than `longest`, all updates are
/// scaled down.
#[hot]
pub(super) fn newton<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>], longest: f64) -> Update {
    let (mut beyond, mut mass, mut q) = (zero, Columns([zero; 3]), zero);
    for (link, work) in links.iter().zip(&mut *work).rev() {
        // The quantities of the next link are transformed to these axes; at the end of the chain they are zero.
        beyond = work.next.map(beyond);
        q = work.next.map(q);
        let turned = mass * work.back;
        mass = work.next * turned;

        let nonstandard = Columns(link.nonstandard.map(|column| zero.of(column)));
        let dj = work.increment * nonstandard;
        let (rho, mc) = (zero.of(link.rho), zero.of(link.mc));
        let (turned_rho, turned_mc) = (rho + work.of_rho, mc + work.of_mc);
        let g = work.arm * turned;
        let b = inertia(zero, dj + nonstandard) - g.cross_rows(turned_rho);
        let h = mass.cross_rows(turned_rho) + Columns::hat(turned_mc);
        // Cramer's rule; a determinant of zero leads to numbers that aren't finite.
        let [x, y, z] = b.0;
        let rows = [cross(y, z), cross(z, x), cross(x, y)];
        let (adjugate, determinant) = (Columns(rows).transposed(), dot(x, rows[0]));
        let divisor = zero.of([1.0; 4]) / determinant;
        let g = adjugate * (g + Columns::hat(mc));
        mass = mass + Columns::multiple(zero, link.m) + (h * g).scaled(divisor);
        let inverse = adjugate.scaled(divisor);
        let t = inverse.map(work.residual(link, &dj, beyond, q));
        q = q + h.map(t);
        beyond = beyond + work.momentum(link);
        (work.inverse, work.g, work.h, work.t) = (inverse, g.scaled(divisor), h, t);
        work.determinant = determinant.entries()[0];
    }
    solved(zero, links, work, longest)
}

/// One simplified iteration, with the last Jacobian.
#[hot]
pub(super) fn simplified<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>]) -> Update {
    let (mut beyond, mut q) = (zero, zero);
    for (link, work) in links.iter().zip(&mut *work).rev() {
        beyond = work.next.map(beyond);
        q = work.next.map(q);
        let dj = work.increment * Columns(link.nonstandard.map(|column| zero.of(column)));
        work.t = work.inverse.map(work.residual(link, &dj, beyond, q));
        q = q + work.h.map(work.t);
        beyond = beyond + work.momentum(link);
    }
    solved(zero, links, work, f64::INFINITY)
}

/// The outward sweep of the update, and the displacements of the joints after it.
#[hot]
fn solved<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>], longest: f64) -> Update {
    let (mut u, mut v) = (zero, zero);
    // A NaN in any unknown makes `size` NaN.
    let (mut length, mut size, mut largest) = (0.0, 0.0, 0.0_f64);
    for (link, work) in links.iter().zip(&mut *work) {
        let (y, z) = (work.half, work.g.map(v) + work.t);
        v = work.back.map(v - cross(z, zero.of(link.rho) + work.of_rho));
        // dF F⁻¹ = (2 (I + ŷ) dy/(1 + |y|²))^ = −ẑ, solved for `−dy`.
        work.update = (z - cross(y, z) + y * dot(y, z)) * zero.of([0.5; 4]);
        // `half + update` wouldn't restore the old value: its rounding error is relative to the update, however long.
        (work.before, work.half) = (y, y - work.update);
        u = work.turn(link, u);
        let squared = square(work.update);
        length += squared;
        largest = largest.max(squared);
        size += square(work.half);
    }
    let is_whole = largest <= longest * longest;
    if !is_whole {
        let part = zero.of([longest / largest.sqrt(); 4]);
        size = 0.0;
        for work in &mut *work {
            work.half = work.before - work.update * part;
            size += square(work.half);
        }
        outwards(zero, links, work);
    }
    Update { length, size, is_whole }
}

/// Computes `target` for the velocities in `half`: their momenta, by the inertia of the chain.
pub(super) fn momenta_of_velocities<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>]) {
    let (mut u, mut beyond) = (zero, zero);
    for (link, work) in links.iter().zip(&mut *work) {
        work.u = u;
        (work.of_rho, work.of_mc) = (cross(work.half, zero.of(link.rho)), cross(work.half, zero.of(link.mc)));
        u = work.back.map(u + work.of_rho);
    }
    for (link, work) in links.iter().zip(&mut *work).rev() {
        beyond = work.next.map(beyond);
        let of_joints = cross(zero.of(link.mc), work.u) + cross(zero.of(link.rho), beyond);
        let inertia = inertia(zero, Columns(link.nonstandard.map(|column| zero.of(column))));
        work.target = inertia.map(work.half) + of_joints;
        beyond = beyond + work.momentum(link);
    }
}

/// The inertia `tr(J) I − J` about a joint.
#[hot]
fn inertia<R: Register>(zero: R, nonstandard: Columns<R>) -> Columns<R> {
    let [[m11, ..], [_, m22, ..], [_, _, m33, _]] = nonstandard.entries();
    Columns::multiple(zero, m11 + m22 + m33) - nonstandard
}
