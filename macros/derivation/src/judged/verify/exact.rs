//! The comparison of all identities at as many random points as their degrees require.

use super::degree::{self, Content, Degree, Largest, SPARE};
use super::identities::{Identities, Same};
use super::number::Number;
use super::residue::Residue;
use super::sample::{Element, Sample};
use super::series::Series;
use super::{Objection, Sureness, reversal};

/// The number of points if degrees give no bound.
pub(super) const POINTS: u32 = 3;

impl Identities<'_> {
    /// The bound on the probability of a wrong result, and whether the Lagrangian or the force is its own adjoint at all points, as
    /// defined by [`reversal`].
    pub fn confirmed(&self) -> Result<(Sureness, [bool; 3]), Objection> {
        let (group, mut reversed) = (&self.of.declaration.group, [true; 3]);
        let of_field = |seed: u64| {
            let mut number = Residue::stream(seed);
            Some((Element::by_cayley(group, &mut number)?, number))
        };
        if of_field(1).is_none() {
            confirmed(POINTS, false, |seed| {
                let mut number = Residue::stream(seed);
                let element = Element::by_exponentials(group, || Series::constant(number()) * Series::STEP);
                self.holds_at(element, || Series::constant(number()), reversal::at, &mut reversed)
            })?;
            return Ok((Sureness::Series, reversed));
        }
        let sureness = certified(
            self.content(),
            |same| self.degrees(same),
            |seed| {
                let (element, number) = of_field(seed).ok_or(Objection::NoValue)?;
                self.holds_at(element, number, reversal::in_the_field, &mut reversed)
            },
        )?;
        Ok((sureness, reversed))
    }

    /// Compares all identities and the reversal at one point, while the functions of its stream are set.
    fn holds_at<T: Number>(
        &self,
        element: Element<T>,
        mut number: impl FnMut() -> T,
        reversal: fn(&Sample<T>) -> [bool; 3],
        reversed: &mut [bool; 3],
    ) -> Result<(), Objection> {
        let sample = Sample::at(self.of, element, &mut number);
        self.hold(&sample, number, &mut same)?;
        reversed.iter_mut().zip(reversal(&sample)).for_each(|(all, here)| *all &= here);
        Ok(())
    }

    fn degrees(&self, same: &mut Same<Degree>) -> Result<(), Objection> {
        let (declaration, mut number) = (self.of.declaration, Degree::stream());
        let attitudes = degree::transforms(declaration);
        let (element, degree) = degree::element(&declaration.group, attitudes, &mut number);
        let mut sample = Sample::at(self.of, element, &mut number);
        degree::set_attitudes(declaration, &mut sample.values, degree, &mut number);
        same("adjoint", sample.declared(), sample.reversed())?;
        self.hold(&sample, number, same)
    }
}

/// Compares two numbers.
pub(super) fn same<T: Number>(term: &'static str, found: T, expected: T) -> Result<(), Objection> {
    match (found.is_defined(), expected.is_defined()) {
        (_, false) => Err(Objection::NoValue),
        (false, true) => Err(Objection::Undefined(term)),
        _ if (found - expected).is_zero() => Ok(()),
        _ => Err(Objection::Disagrees(term)),
    }
}

/// Compares at as many points as the degrees require, and returns the bound on the probability of a wrong result.
pub(super) fn certified(
    content: Content,
    degrees: impl FnOnce(&mut Same<Degree>) -> Result<(), Objection>,
    point: impl FnMut(u64) -> Result<(), Objection>,
) -> Result<Sureness, Objection> {
    let mut largest = Largest::default();
    let compared = degrees(&mut |_, found, expected| {
        largest.compared(found, expected);
        Ok(())
    });
    let found = compared.ok().and_then(|()| largest.points(content.functions));
    // All points may lack a value if a divisor vanishes in the field alone.
    confirmed(found.map_or(POINTS, |(points, _)| points), content.has_multiple, point)?;
    Ok(match found {
        _ if content.has_multiple => Sureness::Multiple,
        Some((_, exponent)) => Sureness::Certified(exponent),
        None => Sureness::TooHigh,
    })
}

/// Whether the derivation agrees with the declaration at that many points. Points without values don't count, unless
/// `may_be_none` allows that no point has one.
fn confirmed(
    count: u32,
    may_be_none: bool,
    mut point: impl FnMut(u64) -> Result<(), Objection>,
) -> Result<(), Objection> {
    let (mut left, mut nothing) = (count, Objection::NoValue);
    for seed in 1..=u64::from(count + SPARE) {
        match point(seed) {
            Ok(()) => left -= 1,
            Err(Objection::NoValue) => {}
            Err(unconfirmed @ Objection::Undefined(_)) => nothing = unconfirmed,
            Err(unconfirmed) => return Err(unconfirmed),
        }
        if left == 0 {
            return Ok(());
        }
    }
    if may_be_none { Ok(()) } else { Err(nothing) }
}
