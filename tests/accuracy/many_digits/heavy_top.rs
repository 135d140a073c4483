//! The steps and flows of a heavy top, of which compositions and splittings consist.

use nalgebra::{Matrix3, Vector3};
use num_traits::{One as _, Zero as _};

use super::motion::Motion;
use super::{DoubleDouble, Matrix, Vector, free_body, hat, long};

/// The state of a top.
#[derive(Clone)]
pub(crate) struct Top<'a> {
    motion: &'a Motion,
    pub(crate) attitude: Matrix,
    pub(crate) momentum: Vector,
    /// The vertical in the body frame.
    pub(crate) w: Vector,
}

impl<'a> Top<'a> {
    /// The state at the start of a motion.
    pub(crate) fn at_start_of(motion: &'a Motion) -> Self {
        let w = motion.attitude.transpose() * motion.up;
        Self { motion, attitude: motion.attitude, momentum: motion.momentum(), w }
    }

    pub(crate) fn velocity(&self) -> Vector {
        self.motion.velocity_of(&self.momentum)
    }

    /// A step of (3.13): half a kick, its own drift, half a kick.
    pub(crate) fn step(&mut self, h: DoubleDouble) {
        self.kick(h * long(0.5));
        self.drift_of_the_step(h);
        self.kick(h * long(0.5));
    }

    /// The turn that satisfies (3.17).
    pub(crate) fn drift_of_the_step(&mut self, h: DoubleDouble) {
        let turn = self.turn(&(self.momentum * h));
        self.move_by(&turn);
    }

    /// The potential's flow.
    pub(crate) fn kick(&mut self, time: DoubleDouble) {
        self.momentum += self.motion.torque(&self.w) * time;
    }

    /// A kick with the flow of `U = −½ τ·J⁻¹τ`: as `τ = w × l`, its gradient is `J⁻¹τ × l`, and its torque `w ×` that.
    pub(crate) fn kick_with_gradient(&mut self, time: DoubleDouble, gradient: DoubleDouble) {
        let velocity = self.motion.velocity_of(&self.motion.torque(&self.w));
        self.momentum += self.w.cross(&velocity.cross(&self.motion.lever)) * gradient;
        self.kick(time);
    }

    /// The free body's flow by the series of its equations.
    pub(crate) fn drift_by_series(&mut self, time: DoubleDouble) {
        let inverse_moments = self.motion.moments.map(|moment| DoubleDouble::one() / moment);
        let (increment, _) = free_body::turn(&inverse_moments, &self.momentum, time);
        self.move_by(&(increment + Matrix::identity()));
    }

    /// The free flow of a symmetric body, `F = exp(h p/J_1) exp(−h (1/J_1 − 1/J_3) p_3 E_3)`.
    pub(crate) fn drift(&mut self, time: DoubleDouble) {
        let (j1, j3) = (self.motion.moments.x, self.motion.moments.z);
        assert_eq!(j1, self.motion.moments.y, "the body isn't symmetric");
        let about_axis = self.momentum.z * (DoubleDouble::one() / j3 - DoubleDouble::one() / j1);
        let turn = rotation(&(self.momentum * (time / j1))) * rotation(&(Vector::z() * (about_axis * time)));
        self.move_by(&turn);
    }

    /// The turn `exp ξ̂` of a discrete kinetic energy `κ(ξ)/h`, a polynomial of degree six or less: its momentum `p` at
    /// the beginning satisfies `∇κ(ξ) = h (I − a ξ̂ + b ξ̂²) p` with `a = (1 − cos θ)/θ²`, `b = (θ − sin θ)/θ³`, `θ = |ξ|`.
    pub(crate) fn drift_of_polynomial(&mut self, h: DoubleDouble, kinetic: impl Fn(&Vector, &Vector) -> DoubleDouble) {
        let moments = &self.motion.moments;
        let mut xi = self.velocity() * h;
        for _ in 0..100 {
            // Differences of six points are exact for these degrees, at any distance.
            let apart = 0.125;
            let gradient = Vector3::from_fn(|k, _| {
                let at = |x: f64| kinetic(moments, &(xi + Vector::ith(k, long(x * apart))));
                let odd = |x: f64| at(x) - at(-x);
                (odd(1.0) * long(45.0) - odd(2.0) * long(9.0) + odd(3.0)) / long(60.0 * apart)
            });
            let (hat, [_, a, b]) = (hat(&xi), coefficients(xi.dot(&xi)));
            let pulled = self.momentum - hat * self.momentum * a + hat * hat * self.momentum * b;
            let update = self.motion.velocity_of(&(pulled * h - gradient));
            xi += update;
            if update.map(DoubleDouble::rounded).norm() < 1e-29 {
                return self.move_by(&rotation(&xi));
            }
        }
        panic!("no solution for {:?}", self.momentum);
    }

    fn move_by(&mut self, turn: &Matrix) {
        self.attitude *= turn;
        self.momentum = turn.transpose() * self.momentum;
        self.w = turn.transpose() * self.w;
    }

    /// The rotation `F` with `(F J_d − J_d Fᵀ)^∨ = b`, by Newton's iteration for the imaginary part of its quaternion.
    ///
    /// The Jacobian is in doubles, so an iteration gains sixteen digits at most.
    pub(crate) fn turn(&self, b: &Vector) -> Matrix {
        let nonstandard = Matrix::from_diagonal(&self.motion.nonstandard);
        let inertia = Matrix3::from_diagonal(&self.motion.moments.map(DoubleDouble::rounded));
        let mut q = Vector::zeros();
        for _ in 0..20 {
            let real = (DoubleDouble::one() - q.dot(&q)).sqrt();
            let turn = of_quaternion(real, &q);
            let moved = turn * nonstandard;
            let skew = moved - moved.transpose();
            let residual = Vector3::new(skew.m32, skew.m13, skew.m21) - b;
            let (s, v) = (real.rounded(), q.map(DoubleDouble::rounded));
            let jv = inertia * v;
            let slope = (inertia * s - jv * v.transpose() / s + v.cross_matrix() * inertia - jv.cross_matrix()) * 2.0;
            let inverse = slope.try_inverse().expect("a step that can be solved").map(DoubleDouble::from);
            let update = inverse * residual;
            q -= update;
            let size = |v: &Vector| v.map(DoubleDouble::rounded).norm();
            if size(&update) <= 1e-24 * size(&q) {
                // The next update would be below the last digit.
                return of_quaternion((DoubleDouble::one() - q.dot(&q)).sqrt(), &q);
            }
        }
        panic!("no solution for {b:?}");
    }
}

/// The rotation of a unit quaternion.
pub(crate) fn of_quaternion(real: DoubleDouble, imaginary: &Vector) -> Matrix {
    let hat = hat(imaginary);
    Matrix::identity() + (hat * real + hat * hat) * long(2.0)
}

/// The rotation `exp(v̂)`.
fn rotation(v: &Vector) -> Matrix {
    let (hat, [odd, even, _]) = (hat(v), coefficients(v.dot(v)));
    Matrix::identity() + hat * odd + hat * hat * even
}

/// `sin θ/θ`, `(1 − cos θ)/θ²` and `(θ − sin θ)/θ³` for `θ²`, by their series `Σ (−θ²)ᵏ/(2k + n)!`.
fn coefficients(squared: DoubleDouble) -> [DoubleDouble; 3] {
    let mut sums = [DoubleDouble::zero(); 3];
    let mut term = DoubleDouble::one();
    let mut next = 2.0;
    while term.rounded().abs() > 1e-40 {
        let second = term / long(next);
        let third = second / long(next + 1.0);
        sums = [sums[0] + term, sums[1] + second, sums[2] + third];
        term = -third * squared;
        next += 2.0;
    }
    sums
}
