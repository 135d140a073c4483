
const EDIT: u32 = 0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    use liestep::groups::LieGroup as _;
    let J = Inertia::from_principal_moments(Vector3::new(3.0, 3.0, 4.0))?;
    let top = Top { J, weight: 9.81, rho: Vector3::z(), up: Vector3::z() };
    let stepper = liestep::Stepper::new(top, 0.01)?;
    let mut state = stepper.start(SO3::identity(), Vector3::new(0.5, 2.0, 12.0))?;
    stepper.step(&mut state)?;
    println!("{EDIT} {:?}", state.momentum());
    Ok(())
}
