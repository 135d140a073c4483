//! Continuous Lagrangians of several bodies.

/// Declarations of two links, and of a body on a cart that moves on a line.
pub(crate) const LINKS: &str = "group(F_1 = SO3, F_2 = SO3), velocity(Omega_1, Omega_2),
    advected(w_1 = up.seen_from(F_1), w_2 = up.seen_from(F_2), Q = F_2.seen_from(F_1)),
    l = 0.5 * (hat(Omega_1) * J_1 * hat(Omega_1).transpose()).trace()
        + 0.5 * (hat(Omega_2) * J_2 * hat(Omega_2).transpose()).trace()
        + (hat(Omega_1) * rho).dot(&(Q * (hat(Omega_2) * s_2))) - g * (w_1.dot(&s_1) + w_2.dot(&s_2))";
pub(crate) const OF_LINKS: &str = "struct Links { J_1: NonstandardInertia, J_2: NonstandardInertia, rho: Vector3<f64>,
    s_1: Vector3<f64>, s_2: Vector3<f64>, g: f64, up: Vector3<f64> }";
pub(crate) const CART: &str = "group(F = SO3, t = R1, d = R3), velocity(Omega, u, v),
    advected(R = F.seen_from(space), x = t.seen_from(space), r = d.seen_from(space), w = up.seen_from(F)),
    l = 0.5 * Omega.dot(&(J * Omega)) * (1.0 + x.powi(2)) + 0.5 * m * (u + v.x).powi(2) + m * v.norm_squared()
        + v.dot(&(R * Omega.cross(&s))) + u * w.dot(&s) - m * (1.0 + r.norm_squared()).sqrt() - x * r.dot(&(R * w))";
pub(crate) const OF_CART: &str = "struct Cart { J: Inertia, m: f64, s: Vector3<f64>, up: Vector3<f64> }";
