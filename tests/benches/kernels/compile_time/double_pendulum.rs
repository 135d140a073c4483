
const EDIT: u32 = 0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    use liestep::groups::LieGroup as _;
    let stepper = liestep::Stepper::new(DoublePendulum::asymmetric(), 0.01)?;
    let velocity = nalgebra::Vector6::new(0.5, 2.0, 1.0, -0.3, 0.2, 0.4);
    let mut state = stepper.start((SO3::identity(), SO3::identity()), velocity)?;
    stepper.step(&mut state)?;
    println!("{EDIT} {:?}", state.momentum());
    Ok(())
}
