//! The description of a unit as XML.

use std::fmt::Write as _;

use super::Fmi;
use super::variables::{Part, Variable};
use crate::run::model::Model;

/// A text in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

impl Part {
    /// Causality, variability, and what is said of the initial value.
    const fn attributes(self) -> [&'static str; 3] {
        match self {
            Self::Time => ["independent", "continuous", ""],
            Self::Parameter => ["parameter", "tunable", "exact"],
            Self::Input => ["input", "discrete", ""],
            Self::Start => ["parameter", "fixed", "exact"],
            Self::Output => ["output", "discrete", "calculated"],
        }
    }
}

fn listed(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" ")
}

/// The attributes of a variable, or of a number of it.
fn attributes(variable: &Variable, name: &str, place: usize) -> String {
    let [causality, variability, initial] = variable.part.attributes();
    let initial = if initial.is_empty() { String::new() } else { format!(" initial=\"{initial}\"") };
    let name = escaped(name);
    format!(
        "name=\"{name}\" valueReference=\"{place}\" causality=\"{causality}\" variability=\"{variability}\"{initial}"
    )
}

fn unit(variable: &Variable) -> String {
    if variable.unit.is_empty() { String::new() } else { format!(" unit=\"{}\"", escaped(&variable.unit)) }
}

/// The names of a variable's numbers where each is a variable of its own.
fn names(variable: &Variable) -> Vec<String> {
    let (rows, columns) = variable.shape;
    let name = |at: usize| match (rows, columns) {
        (1, 1) => variable.name.clone(),
        (_, 1) => format!("{}[{}]", variable.name, at + 1),
        _ => format!("{}[{},{}]", variable.name, at / columns + 1, at % columns + 1),
    };
    (0..variable.len()).map(name).collect()
}

/// The variables of FMI 3.0.
fn lists(variables: &[Variable]) -> String {
    let mut text = String::new();
    for variable in variables {
        let (rows, columns) = variable.shape;
        let dimensions = [rows, columns].into_iter().take(1 + usize::from(columns > 1));
        let dimensions = dimensions.filter(|_| variable.len() > 1).map(|size| format!("<Dimension start=\"{size}\"/>"));
        let dimensions: String = dimensions.collect();
        let start = &variable.start;
        let start = if start.is_empty() { String::new() } else { format!(" start=\"{}\"", listed(start)) };
        let (own, unit) = (attributes(variable, &variable.name, variable.place), unit(variable));
        let _ = writeln!(text, "<Float64 {own}{unit}{start}>{dimensions}</Float64>");
    }
    text
}

/// The variables of FMI 2.0, a number each.
fn numbers(variables: &[Variable]) -> String {
    let mut text = String::new();
    for variable in variables {
        for (at, name) in names(variable).iter().enumerate() {
            let start = variable.start.get(at).map_or_else(String::new, |start| format!(" start=\"{start:?}\""));
            let (own, unit) = (attributes(variable, name, variable.place + at), unit(variable));
            let _ = writeln!(text, "<ScalarVariable {own}><Real{unit}{start}/></ScalarVariable>");
        }
    }
    text
}

/// The outputs and what isn't known at the start, by place, or by number of the variable.
fn structure(variables: &[Variable], fmi: Fmi) -> String {
    let outputs = || variables.iter().filter(|variable| variable.part == Part::Output);
    if fmi == Fmi::Three {
        let of = |kind: &str| {
            outputs().map(|one| format!("<{kind} valueReference=\"{}\"/>", one.place)).collect::<Vec<_>>().concat()
        };
        return of("Output") + &of("InitialUnknown");
    }
    // Every number is a variable, and they are numbered from one.
    let all = outputs().flat_map(|one| one.place + 1..one.place + 1 + one.len());
    let unknowns = all.map(|index| format!("<Unknown index=\"{index}\"/>")).collect::<Vec<_>>().concat();
    format!("<Outputs>{unknowns}</Outputs><InitialUnknowns>{unknowns}</InitialUnknowns>")
}

/// The description of a unit with a name, a title and a token.
pub(super) fn description(
    model: &Model,
    (name, title, token): (&str, &str, &str),
    variables: &[Variable],
    fmi: Fmi,
) -> String {
    let (step, end) = (model.step, model.step * f64::from(model.steps));
    let mut units: Vec<&str> = variables.iter().map(|one| one.unit.as_str()).filter(|unit| !unit.is_empty()).collect();
    units.sort_unstable();
    units.dedup();
    let units: Vec<_> = units.iter().map(|unit| format!("<Unit name=\"{}\"/>", escaped(unit))).collect();
    let units = units.concat();
    let (version, of_token, own, files) = match fmi {
        Fmi::Three => (
            "3.0",
            "instantiationToken",
            format!("canSerializeFMUState=\"true\" canGetAndSetFMUState=\"true\" fixedInternalStepSize=\"{step:?}\""),
            String::new(),
        ),
        Fmi::Two => (
            "2.0",
            "guid",
            "canSerializeFMUstate=\"true\" canGetAndSetFMUstate=\"true\"".to_owned(),
            format!("<SourceFiles><File name=\"{name}.c\"/></SourceFiles>"),
        ),
    };
    let described = if fmi == Fmi::Three { lists(variables) } else { numbers(variables) };
    let (title, generator) = (escaped(title), concat!("liestep ", env!("CARGO_PKG_VERSION")));
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"{version}\" modelName=\"{name}\" description=\"{title}\" {of_token}=\"{token}\" \
         generationTool=\"{generator}\" variableNamingConvention=\"structured\">\n\
         <CoSimulation modelIdentifier=\"{name}\" canHandleVariableCommunicationStepSize=\"true\" {own}>{files}</CoSimulation>\n\
         <UnitDefinitions>{units}</UnitDefinitions>\n\
         <DefaultExperiment startTime=\"0\" stopTime=\"{end:?}\" stepSize=\"{step:?}\"/>\n\
         <ModelVariables>\n{described}</ModelVariables>\n<ModelStructure>{}</ModelStructure>\n</fmiModelDescription>\n",
        structure(variables, fmi)
    )
}

/// The file of FMI 3.0 that says how the source is compiled.
pub(super) fn build(name: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n\
         <BuildConfiguration modelIdentifier=\"{name}\" description=\"without contraction of products and sums\">\n\
         <SourceFileSet language=\"C99\" compilerOptions=\"-ffp-contract=off\"><SourceFile name=\"{name}.c\"/></SourceFileSet>\n\
         <Library name=\"m\"/>\n</BuildConfiguration>\n</fmiBuildDescription>\n"
    )
}
