//! Properties of every method: its order, the inverse map by steps of `−h`, and conserved momenta.

use checks::order::{TOPS, assert_order, counts};
use checks::random::Random;
use declarations::{HeavyTop, Motion};
use liestep::methods::{CompositionScheme, ExactBody, ProcessedScheme, SplittingScheme};
use liestep::motion::{GroupState, GroupStepper, Integrator as _};
use liestep::prelude::*;
use liestep::with::{Method, Scheme};
use nalgebra::Vector3;
use workbench::measure::relative;

/// Steppers of a top by each method, with their names.
pub(crate) fn all(top: &HeavyTop, h: f64) -> Vec<(String, GroupStepper<SO3, Vector3<f64>>)> {
    let (top, flow) = (|| top.clone(), ExactBody::new(&top.ordinary_inertia()));
    let own = ("step".to_owned(), Stepper::new(top(), h).unwrap().into_any());
    let compensated = ("step, compensated".to_owned(), Stepper::new(top(), h).unwrap().compensated().into_any());
    let composed = CompositionScheme::ALL.into_iter().filter(|scheme| scheme.base() == 2).map(|scheme| {
        (Scheme::Composition(scheme).to_string(), Stepper::composed(top(), h, scheme).unwrap().into_any())
    });
    let split = SplittingScheme::ALL.into_iter().map(|scheme| {
        (Scheme::Splitting(scheme).to_string(), Stepper::split(top(), h, flow, scheme).unwrap().into_any())
    });
    let processed = ProcessedScheme::ALL.into_iter().map(|scheme| {
        (Scheme::Processed(scheme).to_string(), Stepper::processed(top(), h, flow, scheme).unwrap().into_any())
    });
    let collocated = [
        ("2 stages".to_owned(), Stepper::collocated::<1>(top(), h).unwrap().into_any()),
        ("collocation 4".to_owned(), Stepper::collocated::<2>(top(), h).unwrap().into_any()),
        ("collocation 8".to_owned(), Stepper::collocated::<4>(top(), h).unwrap().into_any()),
    ];
    let all = [own, compensated].into_iter().chain(composed).chain(split).chain(processed).chain(collocated);
    all.map(|(name, stepper)| (name, stepper.on_group().unwrap())).collect()
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
        ("composition Suzuki 4", 4, 2.0, &[1000, 1000, 1000, 160]),
        ("composition Kahan-Li 6", 6, 1.5, &[800, 800, 800, 160]),
        ("composition Kahan-Li 8", 8, 1.3, &[600, 600, 600, 140]),
        ("splitting Strang", 2, 2.0, &[200; 3]),
        ("splitting near-integrable (4, 2)", 2, 2.0, &[200; 3]),
        ("splitting Nyström 6-4", 4, 1.4, &[500; 3]),
        ("splitting Nyström 11-6", 6, 1.4, &[100, 100, 100, 60]),
        ("splitting Nyström 14-6", 6, 1.4, &[80; 3]),
        ("splitting Kahan-Li 8", 8, 1.2, &[160, 80, 110, 80]),
        ("splitting force gradient 2-4", 4, 1.5, &[200, 200, 200, 100]),
        ("splitting force gradient 4-4", 4, 1.5, &[200; 3]),
        ("splitting force gradient 5-6", 6, 1.3, &[100, 100, 100, 60]),
        ("2 stages", 4, 1.5, &[1500, 800, 1500, 160]),
        ("collocation 4", 8, 1.25, &[240, 120, 260, 70]),
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
        let kept = |state: &GroupState<SO3, Vector3<f64>>| {
            [state.momentum_along(&Vector3::z()), state.momentum().z, state.advected().norm()]
        };
        let before = kept(&state);
        stepper.run(&mut state, 200_000).unwrap();
        let off = kept(&state).iter().zip(before).map(|(now, before)| (now / before - 1.0).abs()).fold(0.0, f64::max);
        println!("{name}: {off:.1e}, orthogonality {:.1e}", state.orthogonality_defect());
        assert!(off < 2e-12 && state.orthogonality_defect() < 2e-12, "{name}: {off:e}");
    }
}

/// A method by its text makes the steps of the typed stepper, to the bit.
#[test]
fn methods_by_their_texts_are_the_typed_ones() {
    let motion = Motion::read("looping A");
    let top = HeavyTop::asymmetric();
    for (name, typed) in all(&top, 0.04).into_iter().filter(|(name, _)| name != "2 stages") {
        let method: Method = name.parse().unwrap();
        assert_eq!(method.to_string(), name);
        let chosen = method.stepper(top.clone(), 0.04).unwrap();
        let ends = [typed.any().clone(), chosen].map(|stepper| {
            let mut state = stepper.start_at(motion.attitude, motion.velocity).unwrap();
            stepper.run(&mut state, 20).unwrap();
            state.numbers().iter().map(|number| number.to_bits()).collect::<Vec<_>>()
        });
        assert_eq!(ends[0], ends[1], "{name}");
    }
    let refused: SetupError = "exact".parse::<Method>().unwrap().stepper(top, 0.04).unwrap_err();
    assert_eq!(refused.to_string(), "the method is for a body without a potential; take a splitting");
}
