//! A chaotic asymmetric top: neighbouring motions part by `e^{0.2 t}`, so after some minutes no digit of the state is
//! that of the continuous motion; energy and Casimirs stay all the same.

use declarations::Motion;
use liestep::Stepper;

const H: f64 = 0.02;

/// Parts of the run, whose largest errors are compared.
const PARTS: u64 = 10;

/// The largest errors in each part: of the energy, J, and relative ones of `|w|²` and `p·w`.
fn errors(steps: u64) -> Vec<[f64; 3]> {
    let motion = Motion::read("chaotic");
    let stepper = Stepper::new(motion.top.clone(), H).unwrap();
    let start = stepper.start(motion.attitude, motion.velocity).unwrap();
    let energy = stepper.energy(&start);
    let carrying = stepper.compensated();
    let mut state = carrying.adopt(&start);
    let parts = (0..PARTS).map(|_| {
        let mut worst = [0.0_f64; 3];
        for _ in 0..steps / PARTS {
            carrying.step(&mut state).unwrap();
            let (p, w) = (state.momentum(), state.advected());
            let errors = [
                carrying.energy(&state) - energy,
                w.norm_squared() - 1.0,
                p.dot(&w) / start.momentum().dot(&start.advected()) - 1.0,
            ];
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error.abs());
            }
        }
        worst
    });
    let parts: Vec<_> = parts.collect();
    println!("{steps} steps in tenths: |ΔE|, |w|² and p·w");
    for [energy, length, momentum] in &parts {
        println!("  {energy:.4e} J {length:9.1e} {momentum:9.1e}");
    }
    parts
}

/// `within` is by how much the largest error of the energy may differ from part to part: a shorter one meets fewer of
/// the rare extremes.
fn assert_nothing_grows(parts: &[[f64; 3]], within: f64) {
    let largest = |half: &[[f64; 3]], k: usize| half.iter().map(|errors| errors[k]).fold(0.0, f64::max);
    let (first, second) = parts.split_at(parts.len() / 2);
    let (before, after) = (largest(first, 0), largest(second, 0));
    assert!((after / before - 1.0).abs() < within, "the energy's error: {before:e}, then {after:e}");
    for (k, name) in [(1, "|w|²"), (2, "p·w")] {
        assert!(largest(parts, k) <= 1e-13, "{name}: {:e}", largest(parts, k));
    }
}

#[test]
fn t7_a_chaotic_top_keeps_energy_and_casimirs() {
    assert_nothing_grows(&errors(300_000), 0.03);
}

/// A week of the motion.
#[test]
#[ignore = "thirty million steps"]
fn t7_a_chaotic_top_over_thirty_million_steps() {
    assert_nothing_grows(&errors(30_000_000), 0.01);
}
