//! Mechanisms of micrometres and of kilometres: an accuracy is asked for and kept as in one of metres.

use crate::joints::{end, run};

/// A double pendulum of rods of this length, m, under a gravity by which its motion is that of metres on Earth.
fn pendulum(length: f64) -> String {
    let [m, arm, moment, g] = [7800.0 * length.powi(3), 0.5 * length, 7800.0 * length.powi(5) / 12.0, 9.81 * length];
    let rod = |name: &str| {
        format!("[[body]]\nname = \"{name}\"\nm = {m:e}\nmoments = [{moment:e}, {moment:e}, {:e}]\n", 0.1 * moment)
    };
    let pin = |bodies: &str, above: f64, angle: f64| {
        format!(
            "[[joint]]\nkind = \"pin\"\nbodies = {bodies}\nat = [[0, 0, {above:e}], [0, 0, {arm:e}]]\n\
             axes = [[0, 1, 0], [0, 1, 0]]\nangle = {angle}\nrate = 0.5\n"
        )
    };
    let [upper, lower] = [pin("[\"space\", \"upper\"]", 0.0, 0.7), pin("[\"upper\", \"lower\"]", -arm, 0.5)];
    format!(
        "title = \"double pendulum\"\ngravity = {{ g = {g:e}, up = [0, 0, 1] }}\n{}{}{upper}{lower}[run]\naccuracy = 1e-6\nduration = 2\n",
        rod("upper"),
        rod("lower"),
    )
}

#[test]
fn an_accuracy_is_the_same_at_any_size() {
    let run_of = |length: f64| {
        let run = run(&pendulum(length));
        let choice = run.choice().unwrap();
        (choice.steps, choice.chosen().scheme, choice.error, end(&run, 1) / length)
    };
    let (steps, scheme, error, place) = run_of(1.0);
    for length in [1e-6, 1e-4, 1e3] {
        let found = run_of(length);
        println!("{length:e}: {found:?}");
        assert_eq!((found.0, found.1), (steps, scheme), "{length:e} m");
        assert!((found.2 / error - 1.0).abs() < 0.01 && (found.3 - place).amax() < 1e-9, "{length:e} m: {found:?}");
    }
}

/// A resonator of 10 µm swings by 2 µm on its springs: `cos(t √(k/m))`, to the accuracy that is asked for.
#[test]
fn a_resonator_of_micrometres() {
    let text = "title = \"resonator\"\n[[body]]\nname = \"mass\"\nm = 1e-9\nmoments = [1.6e-20, 1.6e-20, 1.6e-20]\n\
                [[joint]]\nkind = \"slider\"\nbodies = [\"space\", \"mass\"]\nat = [[0, 0, 0], [0, 0, 0]]\n\
                axes = [[1, 0, 0], [1, 0, 0]]\nshift = 2e-6\nstiffness = \"1 N/m\"\n\
                [run]\naccuracy = 1e-6\nduration = \"1 ms\"\n";
    let run = run(text);
    let (time, rate) = (1e-3, (1.0_f64 / 1e-9).sqrt());
    let expected = 2e-6 * (rate * time).cos();
    let found = end(&run, 0).x;
    assert!((found - expected).abs() < 2e-5 * 2e-6, "{found:e} {expected:e}");
}
