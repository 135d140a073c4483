//! The same scenes from files: a compiled body, and beside it a program that is interpreted.

use liestep_scene::Mistake;

/// The tables of a file beside the body.
pub(crate) const FILES: [(&str, &str); 11] = [
    ("body", ""),
    ("body + gravity", "[gravity]\nm = 1\ng = 9.81\nrho = [0.3, 0.2, 0.4]\nup = [0, 0, 1]"),
    ("body + gravity gradient", "[gravity_gradient]\nGM = 1\nr = 1\ndirection = [0, 0, 1]"),
    ("body + dipole", "[dipole]\nmoment = [0.3, 0.2, 0.4]\nfield = [0, 0, 1]"),
    ("body + spring", "[spring]\nk = 1\nlength = 0.5\nat = [0.3, 0.2, 0.4]\nanchor = [0, 0, 1]"),
    ("body + rotor", "[rotor]\nspin = [0.1, 0.2, 0.3]"),
    ("body + torque", "[torque]\ntorque = [1e-4, 2e-4, 3e-4]"),
    ("body + thrust", "[thrust]\nat = [0.3, 0.2, 0.4]\nthrust = [1e-4, 2e-4, 3e-4]"),
    ("body + drag", "[drag]\nc = 1e-3"),
    ("body + magnetic damping", "[magnetic_damping]\nk = 1e-3\nfield = [0.3, 0.2, 0.4]"),
    ("Cayley body", "[body]\nmoments = [2, 3, 4.5]\nkinetic = \"cayley\""),
];

/// Makes steps of a file's scene, and keeps no state between.
pub(crate) fn run(tables: &str, steps: u32) -> Result<(), Mistake> {
    let body = if tables.contains("[body]") { "" } else { "[body]\nmoments = [2, 3, 4.5]\n" };
    let text = format!(
        "title = \"bench\"\n{body}{tables}\n[start]\neuler = [0, 0.8, 0]\nvelocity = [0.5, 2, 12]\n\
         [run]\nstep = 0.01\nduration = 1e6\n[output]\nevery = 1000000\n"
    );
    liestep_scene::parse("bench.toml", &text)?.first(steps).map(|_| ())
}
