//! A scene as a unit of other simulations: source, description and archive, by the standard FMI.
//!
//! `mod → {description → variables, archive}`. The source is the step in C, the unit around it, which has no standard, and the
//! functions of one.

mod archive;
mod description;
mod variables;

use liestep_late::{Sums, c, prefix};

use crate::file::mistake::Mistake;
use crate::file::scene::Scene;
use crate::run::make::Stop;
use crate::run::model::Model;

pub use archive::archive;

/// A version of the standard FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fmi {
    /// 2.0, whose variables are numbers.
    Two,
    /// 3.0, whose variables may be lists and matrices.
    Three,
}

/// The files of a unit for co-simulation.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fmu {
    /// The name of its source and its binary: an identifier of C.
    pub name: String,
    /// The source, C99 that needs nothing but the standard library.
    pub source: String,
    /// The folder of binaries of x86-64 Linux in its archive.
    pub binaries: &'static str,
    /// The path and the bytes of each file of its archive, the source among them.
    pub files: Vec<(String, Vec<u8>)>,
}

const UNIT: &str = include_str!("unit.c");
const FUNCTIONS: [&str; 2] = [include_str!("fmi2.c"), include_str!("fmi3.c")];

impl Scene {
    /// The scene as a unit for co-simulation: the step with its numbers as parameters, a torque as an input, and the start; a
    /// communication step is a whole number of steps. Rows have the bits of [`run`](Self::run).
    ///
    /// # Errors
    ///
    /// A [`Mistake`] of the kind [`Run`](crate::Kind::Run) where the scene's step isn't one of equal steps by constant
    /// numbers, and for several bodies.
    pub fn fmu(&self, name: &str, fmi: Fmi) -> Result<Fmu, Mistake> {
        let file = &self.file;
        let wrong = |why: String| file.mistake(Stop::Other(format!("the scene is no unit: {why}")));
        let model = Model::of(file).map_err(wrong)?;
        let name = identifier(name);
        let step = c(model.declaration, Sums::Rounded).map_err(|error| wrong(error.to_string()))?;
        let token = format!("liestep-{name}-{:016x}", digest(&step));
        let variables = variables::variables(&model, file.group.unit_of_energy());
        let described = description::description(&model, (&name, self.title(), &token), &variables, fmi);
        let source = step + &unit(&model, &variables, &token, fmi);
        let mut files = vec![
            ("modelDescription.xml".to_owned(), described.into_bytes()),
            (format!("sources/{name}.c"), source.clone().into_bytes()),
        ];
        if fmi == Fmi::Three {
            files.push(("sources/buildDescription.xml".to_owned(), description::build(&name).into_bytes()));
        }
        let binaries = if fmi == Fmi::Three { "binaries/x86_64-linux" } else { "binaries/linux64" };
        Ok(Fmu { name, source, binaries, files })
    }
}

/// The name as an identifier of C.
fn identifier(name: &str) -> String {
    let letters: String = name.chars().map(|one| if one.is_ascii_alphanumeric() { one } else { '_' }).collect();
    if letters.starts_with(|one: char| one.is_ascii_alphabetic()) { letters } else { format!("scene_{letters}") }
}

/// FNV-1a of a text, by which a unit of another text is told.
fn digest(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The unit and its functions, behind the text of its step.
fn unit(model: &Model, variables: &[variables::Variable], token: &str, fmi: Fmi) -> String {
    let of = prefix(model.declaration);
    let list = |numbers: &[f64]| numbers.iter().map(|one| format!("{one:?}")).collect::<Vec<_>>().join(", ");
    let places: Vec<_> = variables.iter().map(|variable| format!("{}, ", variable.place)).collect();
    let places = places.concat();
    let mut values = vec![0.0];
    values.extend(&model.numbers);
    // A declaration without parameters has one that nothing reads.
    values.extend(model.numbers.is_empty().then_some(0.0));
    values.extend(model.attitude.iter().chain(if model.is_by_momentum { &model.momentum } else { &model.velocity }));
    let advances = if model.gammas.len() == 1 {
        "$step(next.stages, &next.state)"
    } else {
        "$compose(next.stages, unit_gamma, STAGES, &next.state)"
    };
    let functions = FUNCTIONS[usize::from(fmi == Fmi::Three)];
    let text = UNIT.to_owned() + functions;
    text.replace("UNIT_ADVANCES", advances)
        .replace("STAGE_COUNT", &model.gammas.len().to_string())
        .replace("STEP_SIZE", &format!("{:?}", model.step))
        .replace("GAMMAS", &list(&model.gammas))
        .replace("START_VALUES", &list(&values))
        .replace("IS_BY_MOMENTUM", if model.is_by_momentum { "1" } else { "0" })
        .replace("{PLACES VALUES}", &format!("{{{places}VALUES}}"))
        .replace("TOKEN", token)
        .replace('$', &format!("{of}_"))
        .replace('@', &format!("{}_", of.to_uppercase()))
}
