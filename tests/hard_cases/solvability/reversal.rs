//! (3.13) is self-adjoint, `l_d(F, w, h) = −l_d(F⁻¹, F⁻¹·w, −h)`, so the step of `−h` undoes that of `h`; that of zero
//! is the identity.

use checks::random::Random;
use declarations::HeavyTop;
use liestep::groups::LieGroup as _;
use liestep::motion::DiscreteLiePoisson;
use workbench::measure::relative;

#[test]
fn s5_negative_step_is_the_inverse_map() {
    let mut random = Random::new(5);
    for h in [0.1, 0.01, 1e-6] {
        let [there, back] = [h, -h].map(|h| DiscreteLiePoisson::new(HeavyTop::asymmetric(), h).unwrap());
        for _ in 0..50 {
            let (momentum, w) = (random.vector() * 5.0, random.direction());
            let step = there.step(&momentum, &w, &nalgebra::Vector3::zeros()).unwrap();
            let returned = back.step(&step.momentum, &step.advected, &-step.coordinates).unwrap();
            // Some roundings of two steps.
            assert!(relative(&returned.momentum, &momentum) < 2e-15);
            assert!(relative(&returned.advected, &w) < 2e-15);
            assert!(relative(&returned.element().matrix(), &step.element().inverse().matrix()) < 2e-15);
        }
    }
}
