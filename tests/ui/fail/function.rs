use liestep::lagrangian;

#[lagrangian(group = SO3, l_d = F.trace() / h)]
fn top() {}

fn main() {}
