use liestep::constraint;

#[constraint(group(F_1 = SO3, d_1 = R3, F_2 = SO3, d_2 = R3), advected(r = d_2.seen_from(d_1)), zero = r)]
struct NoCopy {}

fn main() {}
