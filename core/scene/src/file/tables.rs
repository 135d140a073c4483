//! The text of a file as tables: TOML with the place of each key and value.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::file::mistake::SpanMessage;

/// The tables of a text.
pub(crate) type Document<'a> = Spanned<DeTable<'a>>;

/// The place of a value, or of the innermost table on the way to it that exists.
pub(crate) fn span(document: &Document<'_>, keys: &[&str]) -> Range<usize> {
    let mut span = document.span();
    let mut table = Some(document.get_ref());
    for key in keys {
        let Some(value) = table.and_then(|table| table.get(*key)) else { break };
        span = value.span();
        table = value.get_ref().as_table();
    }
    span
}

/// Whether a table of the document has this key.
pub(crate) fn has(document: &Document<'_>, table: &str, key: &str) -> bool {
    document.get_ref().get(table).and_then(|table| table.get_ref().get(key)).is_some()
}

/// The keys that lead to a value.
pub(crate) type Keys = Vec<Spanned<String>>;

/// The values of nested tables; a table ends the nesting unless `leads_on`.
pub(crate) fn ends<'t, 'a>(
    table: &'t DeTable<'a>,
    leads_on: &dyn Fn(&DeTable<'a>) -> bool,
) -> Vec<(Keys, &'t Spanned<DeValue<'a>>)> {
    let mut all = Vec::new();
    for (key, value) in table {
        let first = Spanned::new(key.span(), key.get_ref().to_string());
        match value.get_ref() {
            DeValue::Table(inner) if leads_on(inner) => {
                let behind = |(keys, value): (Keys, _)| ([vec![first.clone()], keys].concat(), value);
                all.extend(ends(inner, leads_on).into_iter().map(behind));
            }
            _ => all.push((vec![first], value)),
        }
    }
    all
}

/// Keys as written, with dots.
pub(crate) fn dotted(keys: &[Spanned<String>]) -> String {
    keys.iter().map(|key| key.get_ref().as_str()).collect::<Vec<_>>().join(".")
}

/// The names by which tables of a key are called: their own, or the key and their numbers, as `joint-1`.
fn names(entries: &DeArray<'_>, key: &str) -> Vec<String> {
    let own = |entry: &Spanned<DeValue<'_>>| entry.get_ref().get("name")?.get_ref().as_str().map(str::to_owned);
    let name = |(number, entry)| own(entry).unwrap_or_else(|| format!("{key}-{}", number + 1));
    entries.iter().enumerate().map(name).collect()
}

/// Sets the value of these keys, in new tables where they don't exist. A table among several of one key is found
/// by its name.
pub(crate) fn set<'a>(
    table: &mut DeTable<'a>,
    keys: &[Spanned<String>],
    value: Spanned<DeValue<'a>>,
) -> Result<(), SpanMessage> {
    let [key, rest @ ..] = keys else { return Ok(()) };
    let name = || Spanned::new(key.span(), key.get_ref().clone().into());
    if rest.is_empty() {
        table.insert(name(), value);
        return Ok(());
    }
    let inner = table.entry(name()).or_insert_with(|| Spanned::new(key.span(), DeValue::Table(DeTable::new())));
    match inner.get_mut() {
        DeValue::Table(inner) => set(inner, rest, value),
        DeValue::Array(entries) => {
            let [name, rest @ ..] = rest else { return Ok(()) };
            let (span, key, name) = (name.span(), key.get_ref().as_str(), name.get_ref().as_str());
            let names = names(entries, key);
            // The columns of a wheel without a name have `wheel_1`.
            let is_called = |own: &String| own == name || *own == name.replacen('_', "-", 1);
            let found = names.iter().position(is_called).and_then(|at| entries.get_mut(at));
            match found.map(Spanned::get_mut) {
                Some(DeValue::Table(_)) if rest.is_empty() => {
                    Err((span, format!("a key is missing behind `{name}`, as in `{key}.{name}.KEY`")))
                }
                Some(DeValue::Table(table)) => set(table, rest, value),
                _ => Err((span, format!("no `{key}` is called `{name}`, but {}", names.join(", ")))),
            }
        }
        _ => Err((key.span(), format!("`{}` isn't a table", key.get_ref()))),
    }
}

/// A number and its unit.
pub(crate) fn measured(value: &DeValue<'_>) -> Option<(f64, String)> {
    let (number, unit) = match value {
        DeValue::Integer(number) if number.radix() == 10 => (number.as_str().to_owned(), String::new()),
        DeValue::Float(number) => (number.as_str().to_owned(), String::new()),
        DeValue::String(text) => {
            let (number, unit) = text.trim().split_once(' ')?;
            (number.to_owned(), unit.trim().to_owned())
        }
        _ => return None,
    };
    let number: f64 = number.parse().ok()?;
    (number.is_finite() && !unit.contains(['"', '\\']) && !unit.chars().any(char::is_control)).then_some((number, unit))
}
