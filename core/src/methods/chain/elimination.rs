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
//! Matrices are columns in registers, and a step takes as long as what waits for each other: `ρ̂ Q` is there before `Π'` is,
//! and `H adj(B) G` is made while `det B` divides one.
//!
//! `B` is what of the Newton matrix is left of the link once all that hangs on it is eliminated. At the identity `Π` is the
//! mass at the joint that the articulated-body algorithm has, and symmetric.
//!
//! Nothing here depends on the number of links but the length of slices, so it is compiled once.

roots!();

use super::link::Link;
use crate::numbers::{Columns, Register, cross, dot, padded, square};

/// What a link is, as a step takes it: vectors as registers load them.
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

/// What is known of a link while a step is solved.
#[derive(Clone, Copy)]
pub(super) struct Work<R> {
    /// `Q`, from the axes of the next link to these; zero where there is none. `Qᵀ`, and `ρ̂ Q`.
    pub(super) next: Columns<R>,
    back: Columns<R>,
    arm: Columns<R>,
    /// `h a`.
    pub(super) target: R,
    /// Half the Cayley coordinates of `F`, and what they were before an update that may be shortened.
    pub(super) half: R,
    before: R,
    /// The last update, which was taken from `half`, or a part of it.
    pub(super) update: R,
    /// `D`, and `D ρ`, `D m c`.
    pub(super) increment: Columns<R>,
    pub(super) of_rho: R,
    pub(super) of_mc: R,
    /// `u`, m.
    pub(super) u: R,
    /// `B⁻¹ t`.
    t: R,
    /// `B⁻¹`, `B⁻¹ G` and `H` where they were last computed.
    inverse: Columns<R>,
    g: Columns<R>,
    h: Columns<R>,
    /// `det B`.
    pub(super) determinant: f64,
}

#[hot]
impl<R: Register> Work<R> {
    /// Of a link without a neighbour, at rest.
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

    /// Puts the next link, whose attitude is this one's times `next`.
    pub(super) fn place(&mut self, link: &LinkConstants, next: Columns<R>) {
        self.arm = Columns::hat(self.u.of(link.rho)) * next;
        (self.next, self.back) = (next, next.transposed());
    }

    /// Whether the link turns by less than 90° and its determinant has the sign that it has at rest.
    pub(super) fn is_wanted(&self) -> bool {
        self.determinant > 0.0 && square(self.half) < 1.0
    }

    /// The link's momentum times `h`, `m (u + D c)`, kg m.
    pub(super) fn momentum(&self, link: &LinkConstants) -> R {
        self.u * self.u.of([link.m; 4]) + self.of_mc
    }

    /// Turns it, where the way of its upper joint is `u`; returns that of the lower one, as the next link sees it.
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

    /// `t = ρ × q + h r` with `D J`, and `P` beyond.
    fn residual(&self, link: &LinkConstants, dj: &Columns<R>, beyond: R, q: R) -> R {
        let (mc, rho) = (q.of(link.mc), q.of(link.rho));
        let [[_, m21, m31, _], [m12, _, m32, _], [m13, m23, ..]] = dj.entries();
        q.of([m32 - m23, m13 - m31, m21 - m12, 0.0]) + cross(mc, self.u) + cross(rho, q + beyond) - self.target
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
pub(super) fn outwards<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>]) {
    let mut u = zero;
    for (link, work) in links.iter().zip(work) {
        u = work.turn(link, u);
    }
}

/// One of Newton's iterations, from where the joints go to where they go by it; where a link's update is longer than
/// `longest`, all are shortened.
#[hot]
pub(super) fn newton<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>], longest: f64) -> Update {
    let (mut beyond, mut mass, mut q) = (zero, Columns([zero; 3]), zero);
    for (link, work) in links.iter().zip(&mut *work).rev() {
        // From the axes of the next link; at the end all are zero.
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
        // By Cramer's rule; where the determinant is zero nothing is finite.
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

/// Another with the matrix of the last.
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

/// Outwards the update, and where the joints go by it.
#[hot]
fn solved<R: Register>(zero: R, links: &[LinkConstants], work: &mut [Work<R>], longest: f64) -> Update {
    let (mut u, mut v) = (zero, zero);
    // What isn't a number makes the size none either.
    let (mut length, mut size, mut largest) = (0.0, 0.0, 0.0_f64);
    for (link, work) in links.iter().zip(&mut *work) {
        let (y, z) = (work.half, work.g.map(v) + work.t);
        v = work.back.map(v - cross(z, zero.of(link.rho) + work.of_rho));
        // dF F⁻¹ = (2 (I + ŷ) dy/(1 + |y|²))^ = −ẑ, solved for `−dy`.
        work.update = (z - cross(y, z) + y * dot(y, z)) * zero.of([0.5; 4]);
        // What has taken a whole update doesn't tell what it was: of that a rounding of the update is lost, which has no
        // bound.
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

/// The momenta `target` of the velocities `half`.
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

/// The ordinary inertia about a joint, `tr(J) I − J`.
#[hot]
fn inertia<R: Register>(zero: R, nonstandard: Columns<R>) -> Columns<R> {
    let [[m11, ..], [_, m22, ..], [_, _, m33, _]] = nonstandard.entries();
    Columns::multiple(zero, m11 + m22 + m33) - nonstandard
}
