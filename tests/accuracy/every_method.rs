//! Properties of every method: its order, the inverse map by steps of `−h`, and conserved momenta.

use checks::order::{TOPS, assert_order, counts};
use checks::random::Random;
use declarations::{HeavyTop, Motion};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::{AnyStepper, Integrator as _};
use liestep::prelude::*;
use nalgebra::Vector3;
use workbench::measure::relative;

/// Steppers of a top by each method, with their names.
pub(crate) fn all(top: &HeavyTop, h: f64) -> Vec<(String, AnyStepper<SO3, Vector3<f64>>)> {
    let (top, flow) = (|| top.clone(), ExactBody::new(&top.ordinary_inertia()));
    let own = ("its own step".to_owned(), Stepper::new(top(), h).unwrap().into_any());
    let compensated = ("compensated".to_owned(), Stepper::new(top(), h).unwrap().compensated().into_any());
    let composed = CompositionScheme::ALL
        .into_iter()
        .filter(|scheme| scheme.base() == 2)
        .map(|scheme| (scheme.name().to_owned(), Stepper::composed(top(), h, scheme).unwrap().into_any()));
    let split = SplittingScheme::ALL.into_iter().map(|scheme| {
        (format!("exact, {}", scheme.name()), Stepper::split(top(), h, flow, scheme).unwrap().into_any())
    });
    let processed = ProcessedScheme::ALL.into_iter().map(|scheme| {
        (format!("exact, {}", scheme.name()), Stepper::processed(top(), h, flow, scheme).unwrap().into_any())
    });
    let collocated = [
        ("2 stages".to_owned(), Stepper::collocated::<1>(top(), h).unwrap().into_any()),
        ("4 stages".to_owned(), Stepper::collocated::<2>(top(), h).unwrap().into_any()),
        ("8 stages".to_owned(), Stepper::collocated::<4>(top(), h).unwrap().into_any()),
    ];
    [own, compensated].into_iter().chain(composed).chain(split).chain(processed).chain(collocated).collect()
}

#[test]
fn s5_a_step_of_the_negative_length_is_the_inverse_map() {
    let mut random = Random::new(22);
    for (top, h) in
        [HeavyTop::thesis(), HeavyTop::asymmetric()].iter().flat_map(|top| [0.1, 0.01, 1e-6].map(|h| (top, h)))
    {
        for ((name, there), (_, back)) in all(top, h).into_iter().zip(all(top, -h)) {
            let mut worst = 0.0_f64;
            for _ in 0..10 {
                let before = there.start(random.rotation(), random.vector()).unwrap();
                let mut state = before.clone();
                there.step(&mut state).unwrap();
                let mut state = back.adopt(&state);
                back.step(&mut state).unwrap();
                let attitude = relative(&state.attitude().matrix(), &before.attitude().matrix());
                let seen = relative(&state.advected(), &before.advected());
                worst = worst.max(attitude).max(seen).max(relative(&state.momentum(), &before.momentum()));
            }
            // The bound is some roundings per stage.
            println!("{name}, h = {h}: {worst:.1e}");
            assert!(worst < 2e-14, "{name}, h = {h}: {worst:e}");
        }
    }
}

/// The orders on the tops of the thesis, and with a fourth number on the asymmetric one: by steps from the coarsest to
/// some times shorter ones. The other orders are measured in long numbers, or in other ways.
#[test]
fn methods_have_their_orders() {
    let table: [(&str, u32, f64, &[u32]); 14] = [
        ("Suzuki 4", 4, 2.0, &[1000, 1000, 1000, 160]),
        ("Kahan-Li 6", 6, 1.5, &[800, 800, 800, 160]),
        ("Kahan-Li 8", 8, 1.3, &[600, 600, 600, 140]),
        ("exact, Strang", 2, 2.0, &[200; 3]),
        ("exact, near-integrable (4, 2)", 2, 2.0, &[200; 3]),
        ("exact, Nyström 6-4", 4, 1.4, &[500; 3]),
        ("exact, Nyström 11-6", 6, 1.4, &[100, 100, 100, 60]),
        ("exact, Nyström 14-6", 6, 1.4, &[80; 3]),
        ("exact, Kahan-Li 8", 8, 1.2, &[160, 80, 110, 80]),
        ("exact, force gradient 2-4", 4, 1.5, &[200, 200, 200, 100]),
        ("exact, force gradient 4-4", 4, 1.5, &[200; 3]),
        ("exact, force gradient 5-6", 6, 1.3, &[100, 100, 100, 60]),
        ("2 stages", 4, 1.5, &[1500, 800, 1500, 160]),
        ("4 stages", 8, 1.25, &[240, 120, 260, 70]),
    ];
    for (name, order, ratio, coarsest) in table {
        for (motion, coarsest) in TOPS.iter().zip(coarsest) {
            assert_order((name, order), (motion, 10.0), &counts(*coarsest, ratio, 5), |motion, h, steps| {
                let (_, stepper) = all(&motion.top, h).into_iter().find(|(own, _)| own == name).unwrap();
                let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
                stepper.run(&mut state, steps.into()).unwrap();
                (state.attitude(), stepper.velocity(&state))
            });
        }
    }
}

/// The invariants over two hundred thousand steps: the momentum about the vertical, that along the axis of symmetry,
/// the length of the advected vector, and the orthogonality of attitudes.
#[test]
fn methods_keep_the_momenta() {
    let motion = Motion::looping();
    for (name, stepper) in all(&motion.top, 0.04) {
        let mut state = stepper.start(motion.attitude, motion.velocity).unwrap();
        let kept = |state: &liestep::motion::AnyState<SO3, Vector3<f64>>| {
            [state.momentum_along(&Vector3::z()), state.momentum().z, state.advected().norm()]
        };
        let before = kept(&state);
        stepper.run(&mut state, 200_000).unwrap();
        let off = kept(&state).iter().zip(before).map(|(now, before)| (now / before - 1.0).abs()).fold(0.0, f64::max);
        println!("{name}: {off:.1e}, orthogonality {:.1e}", state.orthogonality_defect());
        assert!(off < 2e-12 && state.orthogonality_defect() < 2e-12, "{name}: {off:e}");
    }
}
