//! Errors about a key that has no place in its table. They point to the key, not to the table.

use std::convert::Infallible;

use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess};

struct Refusal(&'static str);

impl<'de> DeserializeSeed<'de> for Refusal {
    type Value = Infallible;

    fn deserialize<D: Deserializer<'de>>(self, _: D) -> Result<Infallible, D::Error> {
        Err(D::Error::custom(self.0))
    }
}

/// Refuses the key that was read last, with the place of its value.
pub(crate) fn refuse<'de, T, M: MapAccess<'de>>(table: &mut M, why: &'static str) -> Result<T, M::Error> {
    match table.next_value_seed(Refusal(why))? {}
}
