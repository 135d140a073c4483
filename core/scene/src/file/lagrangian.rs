//! The tables of Lagrangians, Hamiltonians, forces and constraints of the file's own: their texts are derived, and their parameters have
//! numbers.

use std::ops::Range;

use liestep::motion::Propagator as _;
use liestep_derivation::{Role, suggestion};
use liestep_late::{Declaration, LateError, Whole};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Deserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use crate::file::mistake::SpanMessage;
use crate::file::parameter::{Parameter, in_value};
use crate::file::quantity::{Number, Scalar};
use crate::file::tables::Document;
use crate::file::words::in_files;

/// The backend of programs: machine code with the feature `machine`, an interpreter without. Results agree to the bit.
#[cfg(feature = "machine")]
pub(crate) type Backend = liestep_machine::Machine;
#[cfg(not(feature = "machine"))]
pub(crate) type Backend = liestep_late::Interpreter;

/// A Lagrangian, a Hamiltonian, a force or a constraint on velocities, with the numbers of its parameters.
#[derive(Clone)]
pub(crate) struct DeclaredTerm {
    pub(crate) declaration: &'static Declaration,
    pub(crate) numbers: Vec<f64>,
    pub(crate) has_a_pace: bool,
    /// The names of the increments of a product's factors; empty for one factor.
    pub(crate) increments: Vec<String>,
    /// The place of its table.
    pub(crate) span: Range<usize>,
}

impl DeclaredTerm {
    /// The inertia of a body's continuous limit at the identity attitude.
    pub(crate) fn inertia(&self) -> Option<Matrix3<f64>> {
        let whole =
            Whole::<Backend>::of(self.declaration, &self.numbers, 1.0, liestep::with::Method::default()).ok()?;
        let momentum = |velocity: Vector3<f64>| {
            let state = whole.start(Matrix3::identity().as_slice(), velocity.as_slice()).ok()?;
            Some(Vector3::from_column_slice(&state[whole.layout().momentum()]))
        };
        let bias = momentum(Vector3::zeros())?;
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| Some(momentum(axis)? - bias));
        let matrix = Matrix3::from_columns(&[x?, y?, z?]);
        Some((matrix + matrix.transpose()) * 0.5)
    }
}

const KEYS: &str = "a Lagrangian has `l_d`, or `l` with `discretise`; it may have a `group` with `generators`, a `pace`, \
                    `advected`, as in `advected = { w = \"up\" }`, and has a key for each parameter";
const KEYS_OF_FORCES: &str = "a force has `work`; it may have `advected`, as in `advected = { w = \"up\" }`, and has a \
                              key for each parameter";
const KEYS_OF_CONSTRAINTS: &str = "a constraint on velocities has `zero`; it may have a `velocity`, a `discretise`, \
                                   `advected`, as in `advected = { w = \"up\" }`, and has a key for each parameter";
const KEYS_OF_HAMILTONIANS: &str = "a Hamiltonian has `h`; it may have a `momentum`, a `group` with `generators`, \
                                    `advected`, as in `advected = { w = \"up\" }`, and has a key for each parameter";
const GROUP: &str = "a group is a name, as \"SE3\", or a table of a product's increments, as `{ F = \"SO3\", d = \"R3\" }`; \
                     one of your own has a name of its own and its `generators`, in a product `{ Own = […] }`";

/// Field name for the energy of a motion with a pace.
const ENERGY: &str = "E_0_of_the_start";

/// Deserialises nothing, as [`take`] removes the tables first. Messages that list all keys need the key.
#[allow(clippy::unnecessary_wraps)] // serde requires a `Result`
pub(crate) fn taken<'de, D: Deserializer<'de>>(_: D) -> Result<Vec<DeclaredTerm>, D::Error> {
    Ok(Vec::new())
}

/// A group as it is declared, and the names of its increments.
#[derive(Clone)]
pub(crate) struct Place {
    group: String,
    generators: String,
    increments: Vec<String>,
}

/// Removes the tables of one kind from a document, and reads them. A table without a group is on the
/// group of the ones before, and the first one on SO(3).
pub(crate) fn take(
    document: &mut Document<'_>,
    role: Role,
    on: &mut Option<Place>,
) -> Result<Vec<DeclaredTerm>, SpanMessage> {
    let name = role.attribute();
    let Some((key, tables)) = document.get_mut().remove_entry(name) else { return Ok(Vec::new()) };
    let one = |table: &Spanned<DeValue<'_>>, span: Range<usize>, on: &mut Option<Place>| match table.get_ref() {
        DeValue::Table(table) => Text::of(table, span, role, on)?.declared(),
        _ => Err((span, format!("`{name}` is a table"))),
    };
    match tables.get_ref() {
        DeValue::Array(several) => several.iter().map(|table| one(table, table.span(), on)).collect(),
        _ => Ok(vec![one(&tables, key.span(), on)?]),
    }
}

/// A line of a declaration, the value in the file that it is made of, and whether its columns are those of a text.
struct Line {
    text: String,
    at: Range<usize>,
    is_verbatim: bool,
}

/// A table, with its declaration line by line.
struct Text<'t, 'a> {
    table: &'t DeTable<'a>,
    /// The place of its key.
    span: Range<usize>,
    role: Role,
    lines: Vec<Line>,
    parameters: Vec<Parameter>,
    increments: Vec<String>,
    has_a_pace: bool,
}

impl<'t, 'a> Text<'t, 'a> {
    fn of(table: &'t DeTable<'a>, span: Range<usize>, role: Role, on: &mut Option<Place>) -> Result<Self, SpanMessage> {
        let own = [table.get("group"), table.get("generators")];
        let place = match (own, on.clone()) {
            ([None, None], Some(before)) => before,
            ([group, generators], _) => placed(group, generators)?,
        };
        *on = Some(place.clone());
        let group_at = own[0].map_or_else(|| span.clone(), Spanned::span);
        let generators_at = own[1].map_or_else(|| group_at.clone(), Spanned::span);
        let mut text = Self {
            table,
            span,
            role,
            lines: Vec::new(),
            parameters: Vec::new(),
            increments: place.increments,
            has_a_pace: false,
        };
        text.line(&format!("group{},", place.group), group_at);
        text.line(&place.generators, generators_at);
        text.read_head()?;
        text.read_parameters()?;
        Ok(text)
    }

    fn line(&mut self, text: &str, at: Range<usize>) {
        self.lines.push(Line { text: text.replace(['\n', '\r'], " "), at, is_verbatim: false });
    }

    /// The text of a key, with its place.
    fn text(&self, key: &str) -> Result<Option<(String, Range<usize>)>, SpanMessage> {
        let Some(value) = self.table.get(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::String(text) => Ok(Some((text.to_string(), value.span()))),
            _ => Err((value.span(), format!("`{key}` is a text"))),
        }
    }

    /// The message about a Lagrangian without its text, at a misspelt `discretise` if there is one.
    fn incomplete(&self) -> SpanMessage {
        let misspelt = self.table.keys().find_map(|key| {
            let advice = suggestion(key.get_ref(), ["discretise"]);
            (!advice.is_empty() && key.get_ref() != "discretise").then(|| (key.span(), advice))
        });
        misspelt.map_or_else(
            || (self.span.clone(), KEYS.to_owned()),
            |(span, advice)| (span, format!("unknown key{advice}")),
        )
    }

    /// Adds `key(a, b)` for the names of a product's factors, and `key = a` for one.
    fn read_names(&mut self, key: &str, default: Option<&str>) -> Result<(), SpanMessage> {
        let (names, at) = match self.table.get(key) {
            None => (default.map(str::to_owned).into_iter().collect(), self.span.clone()),
            Some(value) => (names(value, key)?, value.span()),
        };
        let is_product = !self.increments.is_empty();
        match names.as_slice() {
            [] => {}
            [one] if !is_product => self.line(&format!("{key} = {one},"), at),
            // The default of a product has no names.
            [_] if is_product && self.table.get(key).is_none() => {}
            several => self.line(&format!("{key}({}),", several.join(", ")), at),
        }
        Ok(())
    }

    fn read_head(&mut self) -> Result<(), SpanMessage> {
        if let Some((pace, at)) = self.text("pace")?.filter(|_| self.role == Role::Lagrangian) {
            // The energy comes first, so that any number of advected vectors can follow.
            self.line(&format!("given(E_0 = {ENERGY}), pace = {{ {pace} }},"), at);
            self.has_a_pace = true;
        }
        if let Some(value) = self.table.get("advected") {
            self.line(&advected(value)?, value.span());
        }
        let (key, (expression, at)) = if self.role == Role::Force {
            self.read_names("displacement", None)?;
            ("work", self.text("work")?.ok_or_else(|| (self.span.clone(), KEYS_OF_FORCES.to_owned()))?)
        } else if self.role == Role::Nonholonomic {
            self.read_names("velocity", Some("Omega"))?;
            if let Some((discretise, at)) = self.text("discretise")? {
                self.line(&format!("discretise = {discretise},"), at);
            }
            ("zero", self.text("zero")?.ok_or_else(|| (self.span.clone(), KEYS_OF_CONSTRAINTS.to_owned()))?)
        } else if self.role == Role::Hamiltonian {
            self.read_names("momentum", Some("mu"))?;
            ("h", self.text("h")?.ok_or_else(|| (self.span.clone(), KEYS_OF_HAMILTONIANS.to_owned()))?)
        } else {
            match (self.text("l_d")?, self.text("l")?, self.text("discretise")?) {
                (Some(l_d), None, None) => ("l_d", l_d),
                (None, Some(l), Some((discretise, at))) => {
                    self.read_names("velocity", Some("Omega"))?;
                    self.line(&format!("discretise = {discretise},"), at);
                    ("l", l)
                }
                _ => return Err(self.incomplete()),
            }
        };
        self.line(&format!("{key} ="), at.clone());
        // Its first line is the attribute's.
        let before = "\n".repeat(1 + self.lines.len());
        let lines =
            expression.split('\n').map(|line| Line { text: line.to_owned(), at: at.clone(), is_verbatim: true });
        self.lines.extend(lines);
        Declaration::lex(&(before + &expression)).map_err(|error| self.mistake(error))
    }

    fn read_parameters(&mut self) -> Result<(), SpanMessage> {
        let known: &[&str] = match self.role {
            Role::Force => &["group", "generators", "work", "displacement", "advected"],
            Role::Nonholonomic => &["group", "generators", "zero", "velocity", "discretise", "advected"],
            Role::Hamiltonian => &["group", "generators", "h", "momentum", "advected"],
            _ => &["group", "generators", "l_d", "l", "velocity", "discretise", "pace", "advected"],
        };
        let mut own: Vec<_> = self.table.iter().filter(|(key, _)| !known.contains(&key.get_ref().as_ref())).collect();
        // The reader sorts keys by the alphabet; the file's order determines the roundings.
        own.sort_by_key(|(key, _)| key.span().start);
        for (key, value) in own {
            if !is_name(key.get_ref()) {
                let message = format!("`{}` is no name of a parameter: letters, digits and _ make one", key.get_ref());
                return Err((key.span(), message));
            }
            self.parameters.push(Parameter::of(key.get_ref(), value)?);
        }
        if self.has_a_pace {
            self.parameters.push(Parameter { name: ENERGY.to_owned(), kind: "f64".to_owned(), numbers: vec![0.0] });
        }
        Ok(())
    }

    fn declared(self) -> Result<DeclaredTerm, SpanMessage> {
        let lines: Vec<&str> = self.lines.iter().map(|line| line.text.as_str()).collect();
        let fields: Vec<String> = self.parameters.iter().map(|one| format!("{}: {}", one.name, one.kind)).collect();
        let name = match self.role {
            Role::Force => "Force",
            Role::Nonholonomic => "Nonholonomic",
            Role::Hamiltonian => "Hamiltonian",
            _ => "Lagrangian",
        };
        let (attribute, lines) = (self.role.attribute(), lines.join("\n"));
        let whole = format!("#[{attribute}(\n{lines}\n)]\nstruct {name} {{ {} }}", fields.join(", "));
        let declaration = Declaration::parse(&whole).map_err(|error| self.mistake(error))?;
        let numbers = self.parameters.into_iter().flat_map(|one| one.numbers).collect();
        let (increments, has_a_pace, span) = (self.increments, self.has_a_pace, self.span);
        Ok(DeclaredTerm { declaration, numbers, has_a_pace, increments, span })
    }

    /// The first mistake of the text, with its place in the file and in the words of files.
    fn mistake(&self, error: LateError) -> SpanMessage {
        let LateError::Mistakes(mistakes) = error else { return (self.span.clone(), in_files(&error.to_string())) };
        let Some(first) = mistakes.into_iter().next() else { return (self.span.clone(), KEYS.to_owned()) };
        (self.place(&first), in_files(&first.message))
    }

    /// The place of a mistake: that of its column in a text, of the key or the value that it names, or of the value
    /// that its line is made of.
    fn place(&self, mistake: &liestep_late::Mistake) -> Range<usize> {
        let named = mistake.message.split('`').nth(1);
        let of_key = || Some(self.table.get_key_value(named?)?.0.span());
        // The first line is that of the attribute, and the last ones have the parameters.
        let Some(line) = mistake.line.checked_sub(2).and_then(|line| self.lines.get(line)) else {
            let expression = self.lines.last().filter(|_| mistake.line > 1).map(|line| line.at.clone());
            return of_key().or(expression).unwrap_or_else(|| self.span.clone());
        };
        if line.is_verbatim {
            return self.within(mistake, line).unwrap_or_else(|| line.at.clone());
        }
        let of_advected = || {
            let DeValue::Table(all) = self.table.get("advected")?.get_ref() else { return None };
            let has = |value: &&Spanned<DeValue<'_>>| {
                value.get_ref().as_str().zip(named).is_some_and(|(text, name)| text.contains(name))
            };
            all.iter().map(|(_, value)| value).find(has).map(Spanned::span)
        };
        of_key().or_else(of_advected).unwrap_or_else(|| line.at.clone())
    }

    /// The place of a column of the expression.
    fn within(&self, mistake: &liestep_late::Mistake, line: &Line) -> Option<Range<usize>> {
        let of_expression: Vec<&Line> = self.lines.iter().filter(|line| line.is_verbatim).collect();
        let length: usize = of_expression.iter().map(|line| line.text.len() + 1).sum::<usize>() - 1;
        let first = self.lines.iter().position(|line| line.is_verbatim)?;
        let own = mistake.line - 2 - first;
        let before: usize = of_expression[..own].iter().map(|line| line.text.len() + 1).sum();
        let within: usize = line.text.chars().take(mistake.column.checked_sub(1)?).map(char::len_utf8).sum();
        // The opening quotation marks are as long as the closing ones.
        let marks = line.at.len().checked_sub(length)?.div_ceil(2);
        let start = line.at.start + marks + before + within;
        (start < line.at.end).then_some(start..line.at.end)
    }
}

/// Whether it is a name in a declaration.
fn is_name(text: &str) -> bool {
    let is_letter = |letter: char| letter.is_alphabetic() || letter == '_';
    text.starts_with(is_letter) && text.chars().all(|letter| is_letter(letter) || letter.is_ascii_digit())
}

/// The names in a list, or in a text with commas.
fn names(value: &Spanned<DeValue<'_>>, key: &str) -> Result<Vec<String>, SpanMessage> {
    let wrong = |span| (span, format!("`{key}` is a name, or a list of names for the factors of a product"));
    let name = |text: &str, span: Range<usize>| {
        let text = text.trim();
        if is_name(text) { Ok(text.to_owned()) } else { Err(wrong(span)) }
    };
    match value.get_ref() {
        DeValue::String(text) => text.split(',').map(|one| name(one, value.span())).collect(),
        DeValue::Array(list) => {
            list.iter().map(|one| name(one.get_ref().as_str().unwrap_or_default(), one.span())).collect()
        }
        _ => Err(wrong(value.span())),
    }
}

/// The group of a table: `= SE3` with its generators, or `(F = SO3, d = R3)`.
fn placed(
    group: Option<&Spanned<DeValue<'_>>>,
    generators: Option<&Spanned<DeValue<'_>>>,
) -> Result<Place, SpanMessage> {
    let name = |value: &Spanned<DeValue<'_>>| match value.get_ref().as_str() {
        Some(name) if is_name(name) => Ok(name.to_owned()),
        _ => Err((value.span(), GROUP.to_owned())),
    };
    let mut increments = Vec::new();
    let group = match group.map(|group| (group, group.get_ref())) {
        None => "= SO3".to_owned(),
        Some((_, DeValue::Table(factors))) if !factors.is_empty() => {
            let mut factors: Vec<_> = factors.iter().collect();
            factors.sort_by_key(|(key, _)| key.span().start);
            let mut pairs = Vec::new();
            for (increment, group) in factors {
                if !is_name(increment.get_ref()) {
                    return Err((increment.span(), GROUP.to_owned()));
                }
                pairs.push(format!("{} = {}", increment.get_ref(), name(group)?));
                increments.push(increment.get_ref().to_string());
            }
            format!("({})", pairs.join(", "))
        }
        Some((group, _)) => format!("= {}", name(group)?),
    };
    let generators = match generators.map(|value| (value, value.get_ref())) {
        None => String::new(),
        Some((_, DeValue::Table(groups))) => {
            let mut groups: Vec<_> = groups.iter().collect();
            groups.sort_by_key(|(name, _)| name.span().start);
            let one = |(name, value): (&Spanned<_>, _)| Ok(format!("{} = {}", name.get_ref(), matrices(value)?));
            let each = groups.into_iter().map(one).collect::<Result<Vec<_>, SpanMessage>>()?;
            format!("generators({}),", each.join(", "))
        }
        Some((value, _)) => format!("generators = {},", matrices(value)?),
    };
    Ok(Place { group, generators, increments })
}

/// A list of matrices, each row by row.
fn matrices(value: &Spanned<DeValue<'_>>) -> Result<String, SpanMessage> {
    let list = Vec::<Vec<Vec<Scalar<Number>>>>::deserialize(ValueDeserializer::from(value.clone()))
        .map_err(|error| in_value(value, &error))?;
    let row = |row: &Vec<Scalar<Number>>| {
        format!("[{}]", row.iter().map(|entry| format!("{:?}", entry.value)).collect::<Vec<_>>().join(", "))
    };
    let matrix = |rows: &Vec<Vec<_>>| format!("[{}]", rows.iter().map(row).collect::<Vec<_>>().join(", "));
    Ok(format!("[{}]", list.iter().map(matrix).collect::<Vec<_>>().join(", ")))
}

/// The argument `advected(w = up, Q = F_2.seen_from(F_1)),`.
fn advected(value: &Spanned<DeValue<'_>>) -> Result<String, SpanMessage> {
    let wrong = |span| (span, "`advected` are texts by names, as `{ w = \"up\" }`".to_owned());
    let DeValue::Table(all) = value.get_ref() else { return Err(wrong(value.span())) };
    let mut all: Vec<_> = all.iter().collect();
    all.sort_by_key(|(_, field)| field.span().start);
    let pair = |(name, field): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
        let text = field.get_ref().as_str().ok_or_else(|| wrong(field.span()))?;
        Ok(format!("{} = {text}", name.get_ref()))
    };
    let pairs = all.into_iter().map(pair).collect::<Result<Vec<_>, SpanMessage>>()?;
    Ok(if pairs.is_empty() { String::new() } else { format!("advected({}),", pairs.join(", ")) })
}
