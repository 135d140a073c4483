//! A motion continues from a checkpoint as if it had never stopped, in every format; and only from its own checkpoints.

use checks::random::Random;
use declarations::{FreeBody, HeavyTop, Motion, SixthOrderTop, Top as _};
use liestep::mechanics::{Effect, Scalar};
use liestep::motion::Plan;
use liestep::with::{Checkpoint, CheckpointError, Storable};
use liestep::{SO3, StateOf, Stepper};
use nalgebra::Vector3;
use serde_json::{Value, json};

/// The checkpoint as it is read back from each of the formats.
fn round_trips<T: Storable>(checkpoint: &Checkpoint<T>) -> [Checkpoint<T>; 3] {
    let json = serde_json::to_string_pretty(checkpoint).unwrap();
    let toml = toml::to_string(checkpoint).unwrap();
    let binary = postcard::to_stdvec(checkpoint).unwrap();
    [serde_json::from_str(&json).unwrap(), toml::from_str(&toml).unwrap(), postcard::from_bytes(&binary).unwrap()]
}

/// A motion that is saved after random numbers of steps continues with identical bits.
fn assert_resumes<L, P>(stepper: &Stepper<L, P>, start: StateOf<L, P>, seed: u64)
where
    L: Effect<Scalar: Storable, Group = SO3<Scalar<L>>>,
    P: Plan<L>,
{
    let mut random = Random::new(seed);
    let mut state = start;
    for _ in 0..20 {
        let checkpoint = stepper.checkpoint(&state);
        for stored in round_trips(&checkpoint) {
            assert_eq!(stored, checkpoint);
            let mut resumed = stepper.resume(&stored).unwrap();
            let mut on = state;
            for _ in 0..50 {
                assert_eq!(stepper.step(&mut on), stepper.step(&mut resumed));
            }
            // The text of a float has all its digits and the sign of zero.
            assert_eq!(format!("{on:?}"), format!("{resumed:?}"));
        }
        for _ in 0..workbench::measure::steps_in(random.signed().abs(), 0.01) {
            stepper.step(&mut state).unwrap();
        }
    }
}

#[test]
fn p7_save_and_resume_at_random_steps() {
    let motion = Motion::looping();
    for h in [0.01, 0.06, -0.001, 1e-8, 0.0] {
        let stepper = Stepper::new(motion.top.clone(), h).unwrap();
        assert_resumes(&stepper, stepper.start(motion.attitude, motion.velocity).unwrap(), 7);
    }
    let sixth = Stepper::new(SixthOrderTop::of(&motion.top), 0.01).unwrap();
    assert_resumes(&sixth, sixth.start(motion.attitude, motion.velocity).unwrap(), 9);
    let body = Stepper::new(FreeBody::with_moments([1.0, 2.0, 2.5]), 0.01).unwrap();
    assert_resumes(&body, body.start(SO3::identity(), Vector3::new(0.01, 2.0, 0.02)).unwrap(), 8);
}

#[test]
fn p7_compensation_terms_are_kept() {
    let motion = Motion::looping();
    let plain = Stepper::new(motion.top.clone(), 0.01).unwrap();
    let stepper = plain.clone().compensated();
    let state = stepper.start(motion.attitude, motion.velocity).unwrap();
    assert_resumes(&stepper, state, 10);
    // Neither stepper accepts the other's checkpoint.
    let refused = plain.resume(&stepper.checkpoint(&state)).unwrap_err();
    assert!(
        refused.to_string().contains("\"compensated, its own step\", this stepper's is \"its own step\""),
        "{refused}"
    );
    let without = plain.checkpoint(&plain.adopt(&state));
    assert!(matches!(stepper.resume(&without), Err(CheckpointError::AnotherMethod { .. })));
}

/// A stepper of the looping top, and a checkpoint of it after some steps.
fn checkpoint() -> (Stepper<HeavyTop>, Checkpoint<f64>) {
    let motion = Motion::looping();
    let stepper = Stepper::new(motion.top.clone(), 0.01).unwrap();
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    for _ in 0..100 {
        stepper.step(&mut state).unwrap();
    }
    let checkpoint = stepper.checkpoint(&state);
    (stepper, checkpoint)
}

#[test]
fn p7_another_scene_is_refused() {
    let (_, stored) = checkpoint();
    let body = Stepper::new(FreeBody::with_moments([3.0, 3.0, 4.0]), 0.01).unwrap();
    assert_eq!(body.resume(&stored), Err(CheckpointError::AnotherScene));
}

#[test]
fn p7_other_parameters_are_refused_by_name() {
    let (stepper, stored) = checkpoint();
    let top = stepper.scene();
    let refused = |top: HeavyTop, h: f64| Stepper::new(top, h).unwrap().resume(&stored).unwrap_err();
    // Only `m g` enters the equations; a different field is refused all the same.
    let error = refused(HeavyTop { m: 2.0, g: top.g / 2.0, ..top.clone() }, 0.01);
    assert_eq!(error, CheckpointError::AnotherParameter { field: "m", stored: 1.0, own: 2.0 });
    assert!(error.to_string().starts_with("parameter `m` is 1e0 in the checkpoint and 2e0 here"), "{error}");
    let others = [
        ("g", HeavyTop { g: f64::from_bits(top.g.to_bits() + 1), ..top.clone() }),
        ("rho", HeavyTop { rho: -top.rho, ..top.clone() }),
        ("up", HeavyTop { up: Vector3::x(), ..top.clone() }),
        ("J_d", HeavyTop { J_d: HeavyTop::asymmetric().J_d, ..top.clone() }),
    ];
    for (name, other) in others {
        let error = refused(other, 0.01);
        assert!(matches!(error, CheckpointError::AnotherParameter { field, .. } if field == name), "{name}: {error}");
    }
    let error = refused(top.clone(), 0.02);
    assert_eq!(error, CheckpointError::AnotherStep { stored: 0.01, own: 0.02 });
    assert!(error.to_string().contains("1e-2 s in the checkpoint and 2e-2 s here"), "{error}");
}

/// The checkpoint with an edited value.
fn edited(stored: &Checkpoint<f64>, edit: impl FnOnce(&mut Value)) -> Checkpoint<f64> {
    let mut value = serde_json::to_value(stored).unwrap();
    edit(&mut value);
    serde_json::from_value(value).unwrap()
}

#[test]
fn p7_a_density_around_collocation_is_kept() {
    let motion = Motion::looping();
    let stepper = Stepper::collocated::<2>(motion.top.clone(), 0.01).unwrap().with_density(|_, _| 0.0);
    let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
    stepper.run(&mut state, 10).unwrap();
    let stored = stepper.checkpoint(&state);
    assert_eq!(stepper.resume(&stored).unwrap(), state);
    let scaled = stepper.resume(&edited(&stored, |value| value["attitude"][4] = json!(0.5))).unwrap_err();
    assert!(matches!(scaled, CheckpointError::NotInGroup { .. }), "{scaled}");
}

#[test]
fn p7_what_is_no_state_of_the_scene_is_refused() {
    let (stepper, stored) = checkpoint();
    let refused = |edit: fn(&mut Value)| stepper.resume(&edited(&stored, edit)).unwrap_err();
    assert_eq!(
        refused(|value| value["momentum"] = json!([1.0, 2.0])),
        CheckpointError::WrongSize { what: "momentum", found: 2, expected: 3 }
    );
    assert_eq!(
        refused(|value| value["attitude"] = json!(vec![0.5; 1000])),
        CheckpointError::WrongSize { what: "attitude", found: 1000, expected: 9 }
    );
    assert_eq!(refused(|value| value["format"] = json!(1)), CheckpointError::AnotherFormat { found: 1, known: 4 });
    assert_eq!(
        refused(|value| value["kept"] = json!([1.0, 2.0])),
        CheckpointError::WrongSize { what: "kept", found: 2, expected: 11 }
    );
    // The number of increments in the guess, which is a number in the file.
    assert_eq!(refused(|value| value["kept"][6] = json!(2.5)), CheckpointError::Altered);
    let scaled = refused(|value| value["attitude"][4] = json!(0.5));
    assert!(matches!(scaled, CheckpointError::NotInGroup { defect } if defect > 1e-3), "{scaled}");
    let elsewhere = refused(|value| value["advected"] = json!([0.0, 0.0, 1.0]));
    assert!(matches!(elsewhere, CheckpointError::NotAdvected { distance } if distance > 1e-3), "{elsewhere}");
    // A change of one digit, which only the digest can detect.
    for name in ["momentum", "kept"] {
        let mut value = serde_json::to_value(&stored).unwrap();
        value[name][0] = json!(f64::from_bits(value[name][0].as_f64().unwrap().to_bits() ^ 1));
        assert_eq!(stepper.resume(&serde_json::from_value(value).unwrap()), Err(CheckpointError::Altered), "{name}");
    }
    assert_eq!(refused(|value| value["steps"] = json!(101)), CheckpointError::Altered);
}

/// JSON has no NaN, but TOML has.
#[test]
fn p7_what_is_not_finite_is_refused() {
    let (stepper, stored) = checkpoint();
    for what in ["attitude", "momentum", "advected", "kept"] {
        for number in ["nan", "inf", "-inf"] {
            let mut table: toml::Table = toml::to_string(&stored).unwrap().parse().unwrap();
            table[what][0] = toml::Value::Float(number.parse().unwrap());
            let read: Checkpoint<f64> = toml::from_str(&table.to_string()).unwrap();
            assert_eq!(stepper.resume(&read), Err(CheckpointError::NonFinite { what }));
        }
    }
}

/// Every truncated file, and every file with a changed byte, is an error of the parser or of the stepper.
#[test]
fn p7_damaged_files_are_refused() {
    let (stepper, stored) = checkpoint();
    let (json, toml) = (serde_json::to_string(&stored).unwrap(), toml::to_string(&stored).unwrap());
    let binary = postcard::to_stdvec(&stored).unwrap();
    for end in 0..json.len() {
        assert!(serde_json::from_str::<Checkpoint<f64>>(&json[..end]).is_err(), "JSON up to {end}");
    }
    for end in 0..binary.len() {
        assert!(postcard::from_bytes::<Checkpoint<f64>>(&binary[..end]).is_err(), "binary up to {end}");
    }
    // A text truncated within its last line may still be valid TOML, but its digest isn't valid.
    for end in 0..toml.trim_end().len() {
        let read = toml::from_str::<Checkpoint<f64>>(&toml[..end]);
        assert!(read.is_err() || stepper.resume(&read.unwrap()).is_err(), "TOML up to {end}");
    }
    for (place, bit) in (0..binary.len()).flat_map(|place| (0..8).map(move |bit| (place, bit))) {
        let mut damaged = binary.clone();
        damaged[place] ^= 1 << bit;
        if let Ok(read) = postcard::from_bytes::<Checkpoint<f64>>(&damaged) {
            assert!(stepper.resume(&read).is_err(), "bit {bit} of byte {place}");
        }
    }
    assert!(serde_json::from_str::<Checkpoint<f64>>("").is_err());
    assert!(postcard::from_bytes::<Checkpoint<f64>>(&[0xff; 100]).is_err());
}

#[test]
fn p7_unknown_and_missing_names_are_refused() {
    let (_, stored) = checkpoint();
    let mut value = serde_json::to_value(&stored).unwrap();
    value["velocity"] = json!([0.0, 0.0, 0.0]);
    assert!(serde_json::from_value::<Checkpoint<f64>>(value).unwrap_err().to_string().contains("velocity"));
    let mut value = serde_json::to_value(&stored).unwrap();
    value.as_object_mut().unwrap().remove("kept");
    assert!(serde_json::from_value::<Checkpoint<f64>>(value).unwrap_err().to_string().contains("kept"));
}
