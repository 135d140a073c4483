//! All identities at random points, as many as are needed.

use super::degree::{self, Content, Degree, Largest, SPARE};
use super::identities::{Identities, Same};
use super::number::Number;
use super::residue::Residue;
use super::sample::{Element, Sample};
use super::series::Series;
use super::{Objection, Sureness, reversal};
use crate::declared::Role;

/// Compared without a bound.
pub(super) const POINTS: u32 = 3;

impl Identities<'_> {
    /// How sure the check is, and whether the Lagrangian is its own adjoint at all points, as [`reversal`] has it.
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

    /// Reversal is asked while the stand-ins are those of the point.
    fn holds_at<T: Number>(
        &self,
        element: Element<T>,
        mut number: impl FnMut() -> T,
        reversal: fn(&Sample<T>) -> [bool; 3],
        reversed: &mut [bool; 3],
    ) -> Result<(), Objection> {
        let sample = Sample::at(self.of, element, &mut number);
        self.hold(&sample, number, &mut same)?;
        if self.of.declaration.role != Role::Force {
            reversed.iter_mut().zip(reversal(&sample)).for_each(|(all, here)| *all &= here);
        }
        Ok(())
    }

    fn degrees(&self, same: &mut Same<Degree>) -> Result<(), Objection> {
        let (declaration, mut number) = (self.of.declaration, Degree::stream());
        let attitudes = degree::attitudes(declaration).count();
        let (element, degree) = degree::element(&declaration.group, attitudes, &mut number);
        let mut sample = Sample::at(self.of, element, &mut number);
        degree::set_attitudes(declaration, &mut sample.values, degree, &mut number);
        same("adjoint", sample.declared(), sample.reversed())?;
        self.hold(&sample, number, same)
    }
}

/// Whether both are one number.
pub(super) fn same<T: Number>(term: &'static str, found: T, expected: T) -> Result<(), Objection> {
    match (found.is_defined(), expected.is_defined()) {
        (_, false) => Err(Objection::NoValue),
        (false, true) => Err(Objection::Undefined(term)),
        _ if (found - expected).is_zero() => Ok(()),
        _ => Err(Objection::Disagrees(term)),
    }
}

/// Compares at as many points as the degrees of what is compared ask for, and says how sure that is.
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
    // Nothing may have a value where a divisor is zero in the field alone.
    confirmed(found.map_or(POINTS, |(points, _)| points), content.has_multiple, point)?;
    Ok(match found {
        _ if content.has_multiple => Sureness::Multiple,
        Some((_, exponent)) => Sureness::Certified(exponent),
        None => Sureness::TooHigh,
    })
}

/// Whether what was derived agrees with the declaration at that many points; a point without values is no agreement, unless
/// there may be none.
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
