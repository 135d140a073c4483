//! A toy top in a game's loop: drawn at the times of the frames, stepped at times of its own.
//!
//! ```text
//! cargo run --release -p liestep-examples --example frame-times
//! ```
//!
//! It is the toy of the guide's chapter on recording, which explains why its steps are divided and why the frames don't
//! change its motion. The displayed state is a part of a step ahead of the last full one. An engine would call
//! `advance` with the time of its frame, and draw the body with the quaternion.

use std::error::Error;
use std::thread::sleep;
use std::time::{Duration, Instant};

use liestep::effects::{Gravity, RigidBody};
use liestep::motion::{Integrator, Motion};
use liestep::nalgebra::{UnitQuaternion, Vector3};
use liestep::recording::Frames;
use liestep::{NonstandardInertia, SO3, Stepper};

/// The length of a step, s.
const STEP: f32 = 1.0 / 60.0;

/// The motion of a toy in single precision, as in games.
type Motion32 = Motion<SO3<f32>, ((), Vector3<f32>)>;

/// A toy of 50 g, with its centre of mass 3 cm above the tip, tilted by 0.2 rad.
fn toy() -> Result<Frames<impl Integrator<Scalar = f32, Motion = Motion32, State: PartialEq> + Clone>, Box<dyn Error>> {
    // The nonstandard inertia J_d about the tip, kg m².
    let inertia = NonstandardInertia::from_diagonal(Vector3::new(1e-5, 1e-5, 5.5e-5))?;
    let gravity = Gravity { m: 0.05, g: 9.81, rho: Vector3::new(0.0, 0.0, 0.03), up: Vector3::z() };
    let stepper = Stepper::new(RigidBody { J_d: inertia } + gravity, STEP)?.or_substeps(64);
    let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.2, 0.0, 0.0));
    let state = stepper.start(tilted, Vector3::new(0.0, 0.0, 300.0))?;
    Ok(Frames::new(stepper, state))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut toy = toy()?;
    let mut last = Instant::now();
    for frame in 0_u64..180 {
        // The duration of a game's other work in a frame, which is sometimes longer.
        sleep(Duration::from_millis(if frame % 50 == 49 { 120 } else { 7 + frame % 7 }));
        let elapsed = last.elapsed();
        last += elapsed;
        let shown: UnitQuaternion<f32> = toy.advance(elapsed.as_secs_f64())?.attitude().into();
        if frame % 15 == 0 {
            let axis = shown * Vector3::z();
            let (tilt, round) = (axis.z.acos().to_degrees(), axis.x.atan2(-axis.y).to_degrees());
            let (time, steps) = (toy.time(), toy.state().steps());
            println!("{time:5.2} s, {steps:3} steps: tilted by {tilt:4.1}°, gone round to {round:6.1}°");
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{STEP, toy};
    use liestep::motion::Integrator as _;
    use liestep::nalgebra::{UnitQuaternion, Vector3};

    /// The frames have three rates, one of them uneven, with late frames, slow motion and pauses.
    #[test]
    fn no_frame_changes_the_motion() {
        let uneven = |frame: u32| match frame % 40 {
            7 => 0.13,
            11..20 => 0.25 / 60.0,
            30 => 0.0,
            _ => f64::from(frame % 5) * 0.009,
        };
        let rates: [(u32, &dyn Fn(u32) -> f64); 3] = [(288, &|_| 1.0 / 144.0), (60, &|_| 1.0 / 30.0), (120, &uneven)];
        for (count, elapsed) in rates {
            let mut frames = toy().unwrap();
            let (start, integrator) = (frames.state().clone(), frames.integrator().clone());
            let (mut reference, mut time, mut largest) = (start, 0.0, 0.0_f32);
            let mut before: Option<(f64, Vector3<f32>)> = None;
            for frame in 0..count {
                time += elapsed(frame);
                let shown: UnitQuaternion<f32> = frames.advance(elapsed(frame)).unwrap().attitude().into();
                // The displayed time is less than a step ahead of the last full one, up to rounding.
                let ahead = frames.time() - f64::from(integrator.time(frames.state()));
                assert!((frames.time() - time).abs() < 1e-5 && (-1e-5..f64::from(STEP) + 1e-5).contains(&ahead));
                while reference.steps() < frames.state().steps() {
                    integrator.step(&mut reference).unwrap();
                }
                assert!(&reference == frames.state(), "frame {frame}");
                let axis = shown * Vector3::z();
                let tilt = axis.z.acos();
                assert!((0.15..0.35).contains(&tilt), "{tilt}");
                largest = largest.max(axis.x.atan2(-axis.y).abs());
                // The displayed motion is continuous.
                if let Some((earlier, position)) = before {
                    let way = f64::from((axis - position).norm());
                    assert!(way < 3.0 * (time - earlier) + 1e-4, "frame {frame}: {way}");
                }
                before = Some((time, axis));
            }
            assert!(time > 1.9 && largest > 1.0);
        }
    }
}
