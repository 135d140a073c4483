use liestep::{NonstandardInertia, SO3, force, lagrangian};
use nalgebra::Vector3;

#[lagrangian(SO3, ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Nameless {
    J_d: NonstandardInertia,
}

#[lagrangian(group = "SO3", l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Quoted {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, l_d = "((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)")]
struct Text {
    J_d: NonstandardInertia,
}

#[lagrangian(group: SO3, l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Colon {
    J_d: NonstandardInertia,
}

#[lagrangian(group = (SO3), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Parentheses {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, crate = "liestep", l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Crate {
    J_d: NonstandardInertia,
}

#[lagrangian(group = SO3, advected(w = "up"), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Field {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected("w" = up), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Name {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, advected(w = self.up), l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h))]
struct Own {
    J_d: NonstandardInertia,
    up: Vector3<f64>,
}

#[lagrangian(group = SO3, l_d = (F @ J_d).trace() / h)]
struct At {
    J_d: NonstandardInertia,
}

#[lagrangian(
    group = SO3,
    advected(w = up),
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * F.trace
        - h * (F * J_d).transpose.trace()
        - h * F.m33
        - h * F.x
        - h * rho.dot
        - h * rho.w
        - h * m.x
        - h * rho.0,
)]
struct ComponentByMeaning {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
    up: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    l_d = -h * tan(m)
        - h * atan2(m, m)
        - h * trace(F)
        - h * dot(rho, rho)
        - h * tr(F)
        - h * skew(rho)[0]
        - h * abs(m)
        - h * Vector3::new(0.0, 0.0, 1.0)
        - h * inverze(F),
)]
struct FunctionByMeaning {
    m: f64,
    rho: Vector3<f64>,
}

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * m.tan()
        - h * F.log().norm()
        - h * F.inverse().trace()
        - h * m.inverse()
        - h * m.log(2.0)
        - h * F.row(0).norm()
        - h * F.map(m)
        - h * m.acos()
        - h * m.cbrt()
        - h * m.len()
        - h * m.sinh()
        - h * m.powf(2.0)
        - h * rho.exp()
        - h * rho.normalize().x
        - h * rho.hat()
        - h * (F * J_d).try_inverse().trace()
        - h * m.squrt(),
)]
struct MethodByMeaning {
    J_d: NonstandardInertia,
    m: f64,
    rho: Vector3<f64>,
}

const G: f64 = 9.81;

#[lagrangian(
    group = SO3,
    l_d = -h * PI * F.trace()
        - h * G * m
        - h * N
        - h * Id.trace()
        - h * dt
        - h * R.trace()
        - h * i.trace()
        - h * self.m
        - h * self,
)]
struct Body<const N: usize> {
    m: f64,
}

#[force(group = SO3, work = h * c * eta[0] + h * velocity * eta[1] + time + delta * etaa[0])]
struct Push {
    c: f64,
}

#[lagrangian(
    group = SO3,
    l_d = m * F.trace() / h
        - h * (m as f64)
        - h * m?
        - h * m.await
        - h * (m == 1.0)
        - h * (m % 2.0)
        - h * (m ^ 2)
        - h * m**2
        - h * (m << 2)
        - h * (m..m)
        - h * (m = 1.0)
        - h * (!m)
        - h * &mut m,
)]
struct OperatorUnknown {
    m: f64,
}

fn main() {}
