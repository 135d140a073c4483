//! Growth of rounding errors like `√N`; with compensated sums they scale with the changes of a step instead of the
//! state.

use std::sync::OnceLock;

use checks::random::Random;
use declarations::{HeavyTop, Motion};
use liestep::motion::{self, OwnStep};
use liestep::prelude::*;
use liestep::with::CompensatedSums;
use nalgebra::{SVector, Vector3};
use workbench::measure::{order, relative, steps_in};

type TopMotion = motion::Motion<SO3, Vector3<f64>>;

/// The six entries of `RRᵀ − I`, `|w|² − 1`, and the change of `p·w` relative to `|p|`.
fn defects(state: &TopMotion, vertical: f64) -> SVector<f64, 8> {
    let (w, r) = (state.advected(), state.attitude().matrix());
    let gram = r * r.transpose();
    let casimirs = [w.norm_squared() - 1.0, (state.momentum().dot(&w) - vertical) / state.momentum().norm()];
    SVector::from([
        gram.m11 - 1.0,
        gram.m22 - 1.0,
        gram.m33 - 1.0,
        gram.m12,
        gram.m23,
        gram.m31,
        casimirs[0],
        casimirs[1],
    ])
}

#[allow(clippy::cast_precision_loss)] // a few motions
/// Root mean squares of the defects of orthogonality and of the two Casimirs.
fn sizes(defects: &[SVector<f64, 8>]) -> [f64; 3] {
    [(0, 6), (6, 1), (7, 1)].map(|(first, count)| {
        let squared: f64 = defects.iter().map(|defects| defects.rows(first, count).norm_squared()).sum();
        (squared / (defects.len() * count) as f64).sqrt()
    })
}

const DECADES: [u64; 5] = [100, 1_000, 10_000, 100_000, 1_000_000];

/// The growth for 24 motions at a step of .01 with plain sums, which two tests use.
fn plain_growth() -> &'static [[f64; 3]] {
    static GROWTH: OnceLock<Vec<[f64; 3]>> = OnceLock::new();
    GROWTH.get_or_init(|| growth(0.01, 24, false))
}

/// The sizes of the defects over a number of motions, for each decade of steps.
fn growth(h: f64, motions: u64, compensated: bool) -> Vec<[f64; 3]> {
    let mut random = Random::new(6);
    let stepper = Stepper::new(HeavyTop::asymmetric(), h).unwrap();
    let mut found = vec![Vec::new(); DECADES.len()];
    for _ in 0..motions {
        let start = stepper.start(random.rotation(), random.vector() * 4.0).unwrap();
        let vertical = start.momentum().dot(&start.advected());
        let carrying = stepper.clone().compensated();
        let (mut plain, mut kept) = (start, carrying.adopt(&start));
        let mut done = 0;
        for (decade, steps) in DECADES.into_iter().enumerate() {
            for _ in done..steps {
                if compensated {
                    carrying.step(&mut kept).unwrap();
                } else {
                    stepper.step(&mut plain).unwrap();
                }
            }
            done = steps;
            found[decade].push(defects(if compensated { &kept } else { &plain }, vertical));
        }
    }
    found.iter().map(|defects| sizes(defects)).collect()
}

/// The exponent of the growth of each size; NaN, which fails every bound, unless each decade has a size above zero.
#[allow(clippy::cast_precision_loss)] // a million
fn exponents(growth: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let points: Vec<_> = DECADES.iter().zip(growth).map(|(n, sizes)| (*n as f64, sizes[k])).collect();
        let all_count = points.len() == DECADES.len() && points.iter().all(|(_, size)| *size > 0.0);
        if all_count { order(&points, 0.0) } else { f64::NAN }
    })
}

fn print(title: &str, growth: &[[f64; 3]]) {
    println!("{title}: ‖RRᵀ − I‖, |w|², p·w grow like N to the {:.2?}", exponents(growth));
    for (steps, sizes) in DECADES.iter().zip(growth) {
        println!("{steps:>9} steps {:9.1e} {:9.1e} {:9.1e}", sizes[0], sizes[1], sizes[2]);
    }
}

/// A walk of independent roundings has the exponent ½, a systematic error has 1. The root mean square of 24 motions has
/// an uncertainty of a seventh, and so the exponent over four decades one of some hundredths.
#[test]
fn t3_rounding_grows_like_the_square_root_of_the_steps() {
    let plain = plain_growth();
    print("plain", plain);
    for exponent in exponents(plain) {
        assert!((exponent - 0.5).abs() < 0.1, "the exponent {exponent}");
    }
}

/// The angle of a step is .04 here: increments are by that factor smaller than the sums.
#[test]
fn t3_compensated_sums_lose_a_tenth_at_common_steps() {
    let (plain, compensated) = (plain_growth(), growth(0.01, 24, true));
    print("compensated", &compensated);
    for k in 0..3 {
        let (plain, compensated) = (plain[4][k], compensated[4][k]);
        assert!(compensated < 0.1 * plain, "size {k} after 10⁶ steps: {compensated:e} against {plain:e}");
    }
}

/// At a small step the defects don't grow: after 10⁶ steps they are those of a matrix rounded to `f64`.
#[test]
fn t3_compensated_sums_lose_nothing_at_small_steps() {
    let (plain, compensated) = (growth(1e-4, 8, false), growth(1e-4, 8, true));
    print("compensated", &compensated);
    let [orthogonality, length, momentum] = compensated[4];
    assert!(orthogonality < 3e-16 && length < 4e-16 && momentum < 4e-16, "{:?}", compensated[4]);
    assert!(plain[4].iter().zip(compensated[4]).all(|(plain, compensated)| compensated < 0.02 * plain));
}

/// A million steps of `h = 10⁻⁸`: the momentum is compared with a thousand steps of `10⁻⁵`, whose own error is below
/// `10⁻¹¹ h²`.
#[test]
fn t4_tiny_steps() {
    let motion = Motion::looping();
    let end = |h: f64| {
        let stepper = Stepper::new(motion.top.clone(), h).unwrap().compensated();
        let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
        for _ in 0..steps_in(0.01, h) {
            stepper.step(&mut state).unwrap();
        }
        state
    };
    // Richardson's extrapolation of the order 2 leaves an error of the order of h⁴.
    let (coarse, fine) = (end(2e-5), end(1e-5));
    let expected = fine.momentum() + (fine.momentum() - coarse.momentum()) / 3.0;
    let error = relative(&end(1e-8).momentum(), &expected);
    println!("relative error of the momentum {error:e}");
    assert!(error < 5e-16, "{error:e}");
}

fn compensated(top: HeavyTop, h: f64) -> Stepper<HeavyTop, CompensatedSums<OwnStep<HeavyTop>>> {
    Stepper::new(top, h).unwrap().compensated()
}

#[test]
fn s5_zero_step_and_the_inverse_map() {
    let motion = Motion::looping();
    let standing = compensated(motion.top.clone(), 0.0);
    let mut state = standing.start(motion.attitude, motion.velocity).unwrap();
    let before = state;
    standing.step(&mut state).unwrap();
    assert_eq!(state.momentum(), before.momentum());
    assert_eq!(state.attitude(), before.attitude());

    let [there, back] = [1e-5, -1e-5].map(|h| compensated(motion.top.clone(), h));
    for _ in 0..1_000_000 {
        there.step(&mut state).unwrap();
    }
    for _ in 0..1_000_000 {
        back.step(&mut state).unwrap();
    }
    let error = relative(&state.momentum(), &before.momentum())
        .max(relative(&state.attitude().matrix(), &before.attitude().matrix()));
    println!("a million steps there and back: {error:e}");
    assert!(error < 1e-14, "{error:e}");
}

#[test]
fn s2_a_refused_step_leaves_state_and_carry_alone() {
    let motion = Motion::looping();
    let mut state = {
        let stepper = compensated(motion.top.clone(), 0.01);
        let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
        stepper.step(&mut state).unwrap();
        state
    };
    let before = state;
    assert!(compensated(motion.top, 0.1).step(&mut state).is_err());
    assert_eq!(format!("{before:?}"), format!("{state:?}"));
}
