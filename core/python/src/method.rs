//! A method by the names that Python passes.

use liestep::with::{Method, Scheme};

use crate::failure::Failure;

/// A method: the kind of its scheme, the name of it or the floor of a density, whether sums are compensated, and the largest
/// number of substeps.
pub(crate) type Names = (String, String, bool, u32);

/// The method of these names.
pub(crate) fn method((kind, name, compensated, substeps): &Names) -> Result<Method, Failure> {
    let (scheme, floor) = match kind.as_str() {
        "density" => (Scheme::Step, Some(name.parse().map_err(|error| Failure::setup(&error))?)),
        kind => (Scheme::named(kind, name).map_err(|error| Failure::setup(&error))?, None),
    };
    Ok(Method { scheme, compensated: *compensated, substeps: *substeps, floor })
}
