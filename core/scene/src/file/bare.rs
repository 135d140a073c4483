//! Angles by numbers alone, where degrees may be meant: limits of joints, values of events and histograms. They are in rad.

use toml::Spanned;
use toml::de::DeValue;

use crate::file::column::Column;
use crate::file::mistake::SpanMessage;
use crate::file::quantity::{round, short};
use crate::file::tables::{Document, measured};

/// The remark about an angle by a number alone, rad.
pub(crate) fn read_as_rad(angle: f64) -> String {
    let [written, degrees] = [short(angle), round(angle.to_degrees())];
    format!(
        "angles by numbers alone are in rad, so this is {degrees} deg: write \"{written} rad\", or \"{written} deg\" if that is meant"
    )
}

/// The first angle of limits and events that is a number alone and not zero, with the remark about it; these are all columns.
pub(crate) fn bare_angle(document: &Document<'_>, columns: &[Column]) -> Option<SpanMessage> {
    let tables = |key: &str| {
        let tables = document.get_ref().get(key).and_then(|tables| tables.get_ref().as_array());
        tables.into_iter().flatten()
    };
    let bare = |value: &Spanned<DeValue<'_>>| {
        let (number, unit) = measured(value.get_ref())?;
        (unit.is_empty() && number != 0.0).then(|| (value.span(), read_as_rad(number)))
    };
    let of_joint = |joint: &Spanned<DeValue<'_>>| {
        let joint = joint.get_ref();
        let turns = joint.get("kind")?.get_ref().as_str()? == "pin";
        let limits = joint.get("limits").filter(|_| turns)?.get_ref();
        ["from", "to"].into_iter().find_map(|key| bare(limits.get(key)?))
    };
    let of_event = |event: &Spanned<DeValue<'_>>| {
        let event = event.get_ref();
        let name = event.get("column").and_then(|name| name.get_ref().as_str());
        let is_angle = name.is_some_and(|name| columns.iter().any(|column| column.unit(name) == Some("rad")));
        event.get("tilt").and_then(bare).or_else(|| bare(event.get("value").filter(|_| is_angle)?))
    };
    tables("joint").find_map(of_joint).or_else(|| tables("event").find_map(of_event))
}
