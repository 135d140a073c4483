use liestep::mechanics::Each;
use liestep::motion::RightHandSide;
use liestep::{NonstandardInertia, SO3, lagrangian};

#[lagrangian(group = SO3, l_d = ((F - I) * J * (F - I).transpose()).trace() / (2.0 * h))]
#[derive(Clone, Copy)]
struct Body {
    J: NonstandardInertia,
}

fn motion(body: Body) {
    let _ = RightHandSide::new(Each::<2>::of([body, body]));
}

fn main() {}
