use liestep::{NonstandardInertia, SO3, force, lagrangian};

const G: f64 = 9.81;

#[lagrangian(
    group = SO3,
    l_d = ((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h)
        - h * PI * F.trace()
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
    J_d: NonstandardInertia,
    m: f64,
}

#[force(group = SO3, work = h * c * eta[0] + h * velocity * eta[1] + time + delta * etaa[0])]
struct Push {
    c: f64,
}

fn main() {}
