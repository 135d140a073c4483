//! Random sums in files: neither the order of tables nor the names of parameters change a motion.

use std::fmt::Write as _;

use liestep_scene::{Sample, Scene};

/// Marsaglia's xorshift.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 >> 32).unwrap() % bound
    }

    fn number(&mut self) -> f64 {
        f64::from(u32::try_from(self.below(1 << 20)).unwrap()) / f64::from(1 << 19) - 1.0
    }

    fn vector(&mut self) -> String {
        format!("[{:?}, {:?}, {:?}]", self.number(), self.number(), self.number())
    }

    fn direction(&mut self) -> &'static str {
        ["[1, 0, 0]", "[0, 0.6, 0.8]", "[0.48, 0.6, -0.64]"][self.below(3)]
    }

    fn shuffled<T>(&mut self, mut all: Vec<T>) -> Vec<T> {
        for end in (1..all.len()).rev() {
            all.swap(end, self.below(end + 1));
        }
        all
    }
}

/// An effect of the library with random numbers.
fn effect(name: usize, random: &mut Random) -> String {
    let (one, other) = (random.vector(), random.vector());
    match name {
        0 => format!("[gravity]\nm = 1.3\ng = 2.1\nrho = {one}\nup = {}\n", random.direction()),
        1 => format!("[gravity_gradient]\nGM = 2\nr = 3\ndirection = {}\n", random.direction()),
        2 => format!("[dipole]\nmoment = {one}\nfield = {other}\n"),
        3 => format!("[spring]\nk = 0.7\nlength = 0.4\nat = {one}\nanchor = [2, 0.1, -0.3]\n"),
        4 => format!("[rotor]\nspin = {one}\n"),
        5 => "[drag]\nc = 0.3\n".to_owned(),
        6 => format!("[air_drag]\nc = 0.2\nair = {one}\n"),
        7 => format!("[torque]\ntorque = {one}\n"),
        8 => format!("[thrust]\nat = {one}\nthrust = {other}\n"),
        _ => format!("[magnetic_damping]\nk = 0.3\nfield = {one}\n"),
    }
}

/// A body of the library, or a Lagrangian of the file's own.
fn body(own: bool, names: [&str; 3]) -> String {
    let [m, g, rho] = names;
    if own {
        format!(
            "[lagrangian]\nl_d = \"((F - I) * J_d * (F - I).transpose()).trace() / (2.0 * h) - 0.5 * h * {m} * {g} * w.dot(&({rho} + F * {rho}))\"\n\
             advected = {{ w = \"up\" }}\nJ_d = {{ moments = [2, 3, 4] }}\n{m} = 1.2\n{g} = 0.8\n{rho} = [0.1, 0.3, 0.9]\nup = [0, 0.6, 0.8]\n"
        )
    } else {
        "[body]\nmoments = [2, 3, 4]\n".to_owned()
    }
}

/// A force with parameters of these names. It has names of `let` that could clash with renamed parameters.
fn force(names: [&str; 3]) -> String {
    let [m, g, rho] = names;
    format!(
        "[force]\nwork = \"{{ let {m}_2 = 2.0; let f = |{g}_2: f64| {g}_2 * {g}; h * {m} * {m}_2 * f(0.5) * {rho}.dot(&(eta + eta_next)) / 2 }}\"\n\
         {m} = 0.7\n{g} = 1.9\n{rho} = [0.2, -0.4, 0.6]\n"
    )
}

/// The state after a few steps.
fn end(parts: &[String]) -> Sample {
    let mut text = "title = \"sum\"\n".to_owned();
    for part in parts {
        text.write_str(part).unwrap();
    }
    let file = Scene::parse("sum.toml", &text).unwrap_or_else(|mistake| panic!("{mistake}\n{text}"));
    let run = file.run().unwrap_or_else(|mistake| panic!("{mistake}\n{text}"));
    run.samples().last().unwrap().clone()
}

/// Random sums agree to the bit in two other orders of their tables. A force whose parameters share their names with
/// others agrees to rounding with one whose names are unique.
fn sums(count: usize) {
    const RUN: &str =
        "[start]\neuler = [0.3, 0.5, 0.1]\nvelocity = [0.4, 0.9, 1.7]\n[run]\nstep = 0.02\nduration = 0.1\n";
    let mut random = Random(7);
    for number in 0..count {
        let (own, has_force) = (random.below(3) == 0, random.below(2) == 0);
        let mut parts = vec![body(own, ["m", "g", "rho"]), RUN.to_owned()];
        // A Lagrangian of the file's own replaces all effects.
        let effects = if own { 0 } else { 1 + random.below(4) };
        let names = random.shuffled((0..10).collect());
        parts.extend(names[..effects].iter().map(|name| effect(*name, &mut random)));
        if own || has_force {
            parts.push(force(["m", "g", "rho"]));
        }
        let expected = end(&parts);
        for _ in 0..2 {
            parts = random.shuffled(parts);
            assert_eq!(end(&parts), expected, "{number}: {parts:?}");
        }
        if let Some(part) = parts.iter_mut().find(|part| part.starts_with("[force]")) {
            *part = force(["mu", "gamma", "arm"]);
            let renamed = end(&parts);
            let apart = (renamed.bodies[0].velocity - expected.bodies[0].velocity).norm();
            assert!(apart < 1e-14, "{number}: {apart:e}, {parts:?}");
        }
    }
}

#[test]
fn random_sums() {
    sums(100);
}

#[test]
#[ignore = "a minute: cargo test -p liestep-cli --test program -- --ignored five_hundred_sums"]
fn five_hundred_sums() {
    sums(500);
}
