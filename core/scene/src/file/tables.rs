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

/// The table among several of a key with this `name`; one without is called by the key and its number, as `joint-1`.
fn called<'t, 'a>(entries: &'t mut DeArray<'a>, key: &str, name: &str) -> Option<&'t mut DeTable<'a>> {
    let tables = entries.iter_mut().enumerate().filter_map(|(number, entry)| match entry.get_mut() {
        DeValue::Table(table) => Some((number, table)),
        _ => None,
    });
    let is_called = |(number, table): &(usize, &mut DeTable<'a>)| match table.get("name") {
        Some(own) => own.get_ref().as_str() == Some(name),
        None => name == format!("{key}-{}", number + 1),
    };
    tables.into_iter().find(is_called).map(|(_, table)| table)
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
            let unknown = || (name.span(), format!("no `{}` is called `{}`", key.get_ref(), name.get_ref()));
            set(called(entries, key.get_ref(), name.get_ref()).ok_or_else(unknown)?, rest, value)
        }
        _ => Err((key.span(), format!("`{}` isn't a table", key.get_ref()))),
    }
}
