//! The methods that a file can name: a text, as [`Scheme`] reads it, or a table of a kind and a name.

use std::fmt;

use liestep::with::{Scheme, UnknownMethod};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// A scheme by its kind.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ByKind {
    #[serde(deserialize_with = "composition")]
    Composition(Scheme),
    #[serde(deserialize_with = "splitting")]
    Splitting(Scheme),
    #[serde(deserialize_with = "processed")]
    Processed(Scheme),
    #[serde(deserialize_with = "collocation")]
    Collocation(Scheme),
}

macro_rules! by_kind {
    ($($kind:ident: $type:ty),+) => {$(
        fn $kind<'de, D: Deserializer<'de>>(source: D) -> Result<Scheme, D::Error> {
            let name = <$type>::deserialize(source)?.to_string();
            Scheme::named(stringify!($kind), &name).map_err(Error::custom)
        }
    )+};
}

by_kind! { composition: String, splitting: String, processed: String, collocation: i64 }

struct AnyForm;

impl<'de> Visitor<'de> for AnyForm {
    type Value = Scheme;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a method: \"step\", or a table of a kind and a name")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Scheme, E> {
        text.parse().map_err(|unknown: UnknownMethod| E::custom(unknown))
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Scheme, M::Error> {
        let (ByKind::Composition(scheme)
        | ByKind::Splitting(scheme)
        | ByKind::Processed(scheme)
        | ByKind::Collocation(scheme)) = ByKind::deserialize(MapAccessDeserializer::new(map))?;
        Ok(scheme)
    }
}

/// The scheme of the key `method`.
pub(crate) fn scheme<'de, D: Deserializer<'de>>(source: D) -> Result<Scheme, D::Error> {
    source.deserialize_any(AnyForm)
}

/// The kind of method in words, with an article.
pub(crate) const fn kind(scheme: &Scheme) -> &'static str {
    match scheme {
        Scheme::Step => "a step",
        Scheme::Exact => "the exact motion",
        Scheme::Composition(_) => "a composition",
        Scheme::Splitting(_) | Scheme::Processed(_) => "a splitting",
        Scheme::Collocation(_) => "a collocation",
    }
}
