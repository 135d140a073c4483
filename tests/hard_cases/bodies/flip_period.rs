//! Dzhanibekov's body, `J = (1, 2, 3)` turning about its middle axis: two flips bring the body momentum back to where
//! it was. Their time is `4K(k)/ω` with
//!
//! ```text
//! ω² = (J_3 − J_2)(|p|² − 2H J_1)/(J_1 J_2 J_3),      k² = (J_2 − J_1)(2H J_3 − |p|²)/((J_3 − J_2)(|p|² − 2H J_1))
//! ```

use declarations::FreeBody;
use declarations::SixthOrderBody;
use liestep::effects::PrincipalBody;
use liestep::groups::LieGroup as _;
use liestep::mechanics::{DiagonalNonstandardInertia, Inertia};
use liestep::methods::{CompositionScheme, PreprocessedOrder};
use liestep::{SO3, Stepper};
use nalgebra::Vector3;
use workbench::measure::{four_halvings, order};

/// `4K/ω` of the motion below to 16 digits, s.
const TWO_FLIPS: f64 = 19.001_635_511_000_25;
/// Points that a passage is interpolated from, half of them on either side.
const POINTS: usize = 10;

fn moments() -> Vector3<f64> {
    Vector3::new(1.0, 2.0, 3.0)
}

fn velocity() -> Vector3<f64> {
    Vector3::new(0.01, 2.0, 0.02)
}

/// When a monotone function passes zero, from its values at the times `0, 1, …`: Neville's interpolation of the time as
/// a function of the value. Near the passage `p_2` is a hyperbolic tangent, and the remainder is below rounding for
/// steps up to 0.02 s.
#[allow(clippy::cast_precision_loss)] // ten points
fn passage(values: &[f64]) -> f64 {
    let mut times: Vec<f64> = (0..values.len()).map(|k| k as f64).collect();
    for span in 1..values.len() {
        for k in 0..values.len() - span {
            let (low, high) = (values[k], values[k + span]);
            times[k] = (high * times[k] - low * times[k + 1]) / (high - low);
        }
    }
    times[0]
}

/// The time of two flips: from one passage of the second component through zero to the next but one. `next` makes a
/// step and returns that component.
#[allow(clippy::cast_precision_loss)] // some thousand steps
fn two_flips(h: f64, mut next: impl FnMut() -> f64) -> f64 {
    let mut values = vec![next()];
    let mut passages = Vec::new();
    while passages.len() < 3 {
        values.push(next());
        assert!((values.len() as f64) * h < 3.0 * TWO_FLIPS, "no passages");
        let (start, end) = (values.len().saturating_sub(POINTS), values.len());
        if end >= POINTS && values[start + POINTS / 2 - 1] * values[start + POINTS / 2] < 0.0 {
            passages.push(h * (start as f64 + passage(&values[start..end])));
        }
    }
    passages[2] - passages[0]
}

fn relative_error(h: f64, next: impl FnMut() -> f64) -> f64 {
    two_flips(h, next) / TWO_FLIPS - 1.0
}

#[test]
fn b7_the_time_of_two_flips_at_second_order() {
    let errors = four_halvings(0.02).map(|h| {
        let stepper = Stepper::new(FreeBody::with_moments(moments().into()), h).unwrap();
        let mut state = stepper.start(SO3::identity(), velocity()).unwrap();
        let error = relative_error(h, || {
            stepper.step(&mut state).unwrap();
            state.momentum().y
        });
        (h, error.abs())
    });
    let order = order(&errors, 1e-11);
    println!("order {order:.4}, {errors:?}");
    assert!((order - 2.0).abs() < 0.05, "order {order}, {errors:?}");
}

#[test]
fn b7_the_time_of_two_flips_of_the_sixth_order_body() {
    let stepper =
        Stepper::new(SixthOrderBody { J: Inertia::from_principal_moments(moments()).unwrap() }, 0.01).unwrap();
    let mut state = stepper.start(SO3::identity(), velocity()).unwrap();
    let error = relative_error(0.01, || {
        stepper.step(&mut state).unwrap();
        state.momentum().y
    });
    println!("relative error {error:e}");
    assert!(error.abs() < 1e-12, "{error:e}");
}

/// Near the intermediate axis roundings grow: those of some 30 000 stages to 2e-12, a half of the time to more than
/// 1.4e-12. One step size would say little, so it is a mean of neighbouring ones that is right to 1e-12.
#[test]
fn b7_the_time_of_two_flips_of_a_composition() {
    let body = FreeBody::with_moments(moments().into());
    let errors: Vec<f64> = (0..27)
        .map(|k| {
            let h = 0.02 * (1.0 - 0.001 * f64::from(k));
            let composed = Stepper::composed(body.clone(), h, CompositionScheme::SOFRONIOU_SPALETTA_10).unwrap();
            let mut state = composed.start(SO3::identity(), velocity()).unwrap();
            relative_error(h, || {
                composed.step(&mut state).unwrap();
                state.momentum().y
            })
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / 27.0;
    let mut sizes: Vec<f64> = errors.iter().map(|error| error.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let (median, largest) = (sizes[13], sizes[26]);
    println!("mean of the relative errors {mean:e}; of their sizes the median {median:e}, the largest {largest:e}");
    assert!(mean.abs() < 1e-12 && median < 2e-12 && largest < 1e-11, "{errors:?}");
}

#[test]
fn b7_the_time_of_two_flips_of_the_preprocessed_body() {
    let body = DiagonalNonstandardInertia::from_principal_moments(moments()).unwrap();
    let stepper = Stepper::preprocessed(PrincipalBody { J_d: body }, 0.01, PreprocessedOrder::Ten).unwrap();
    let mut state = stepper.start(SO3::identity(), velocity()).unwrap();
    let error = relative_error(0.01, || {
        stepper.step(&mut state).unwrap();
        state.momentum().y
    });
    println!("relative error {error:e}");
    assert!(error.abs() < 1e-12, "{error:e}");
}
