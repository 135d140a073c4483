//! All identities at random points, as many as are needed.

use std::rc::Rc;

use super::degree::{self, Content, Degree, Largest, SPARE};
use super::identities::{Identities, Same};
use super::number::Number;
use super::residue::Residue;
use super::sample::{Element, Sample};
use super::series::Series;
use super::{Fault, Sureness, Unconfirmed, reversal};
use crate::declared::lower::Lowered;
use crate::declared::{Declaration, Role, Tree};

/// Compared without a bound.
pub(super) const POINTS: u32 = 3;

/// Of a declaration.
pub(super) struct Check<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) lowered: &'a Lowered,
    pub(super) tree: &'a Rc<Tree>,
    pub(super) identities: Identities<'a>,
}

impl Check<'_> {
    /// How sure the check is, and whether the Lagrangian is its own adjoint at all points, as [`reversal`] has it.
    pub(super) fn confirmed(&self) -> Result<(Sureness, [bool; 3]), Unconfirmed> {
        let (group, mut reversed) = (&self.declaration.group, [true; 3]);
        let of_field = |seed: u64| {
            let mut number = Residue::stream(seed);
            Some((Element::by_cayley(group, &mut number)?, number))
        };
        if of_field(1).is_none() {
            confirmed(POINTS, |seed| {
                let mut number = Residue::stream(seed);
                let element = Element::by_exponentials(group, || Series::constant(number()) * Series::STEP);
                self.holds_at(element, || Series::constant(number()), reversal::at, &mut reversed)
            })?;
            return Ok((Sureness::Series, reversed));
        }
        let sureness = certified(
            self.identities.content(),
            |same| self.degrees(same),
            |seed| {
                let (element, number) = of_field(seed).ok_or(Fault::Untold)?;
                self.holds_at(element, number, reversal::in_the_field, &mut reversed)
            },
        )?;
        Ok((sureness, reversed))
    }

    pub(super) fn sample<T: Number>(&self, element: Element<T>, number: &mut impl FnMut() -> T) -> Sample<'_, T> {
        Sample::with_numbers(self.declaration, self.lowered, self.identities.derived, element, number)
    }

    /// Reversal is asked while the stand-ins are those of the point.
    fn holds_at<T: Number>(
        &self,
        element: Element<T>,
        mut number: impl FnMut() -> T,
        reversal: fn(&Sample<T>, &Rc<Tree>) -> [bool; 3],
        reversed: &mut [bool; 3],
    ) -> Result<(), Fault> {
        let sample = self.sample(element, &mut number);
        self.identities.hold(&sample, number, &mut same)?;
        if self.declaration.role != Role::Force {
            reversed.iter_mut().zip(reversal(&sample, self.tree)).for_each(|(all, here)| *all &= here);
        }
        Ok(())
    }

    fn degrees(&self, same: &mut Same<Degree>) -> Result<(), Fault> {
        let (declaration, mut number) = (self.declaration, Degree::stream());
        let attitudes = degree::attitudes(declaration).count();
        let (element, degree) = degree::element(&declaration.group, attitudes, &mut number);
        let mut sample = self.sample(element, &mut number);
        degree::set_attitudes(declaration, &mut sample.values, degree, &mut number);
        same("adjoint", sample.declared(self.tree), sample.reversed(self.tree))?;
        self.identities.hold(&sample, number, same)
    }

    /// Whether the momentum and its Jacobian have values where a step begins: in the field nothing but a division by zero
    /// and a root or a logarithm of zero hasn't.
    pub(super) fn is_smooth(&self) -> bool {
        let mut number = Residue::stream(1);
        let sample = self.sample(Element::identity(&self.declaration.group), &mut number);
        self.identities.are_smooth_at_identity(&sample)
    }
}

/// Whether both are one number.
pub(super) fn same<T: Number>(term: &'static str, found: T, expected: T) -> Result<(), Fault> {
    match (found.is_defined(), expected.is_defined()) {
        (_, false) => Err(Fault::Untold),
        (false, true) => Err(Fault::NoValue(term)),
        _ if (found - expected).is_zero() => Ok(()),
        _ => Err(Fault::Disagrees(term)),
    }
}

/// Compares at as many points as the degrees of what is compared ask for, and says how sure that is.
pub(super) fn certified(
    content: Content,
    degrees: impl FnOnce(&mut Same<Degree>) -> Result<(), Fault>,
    point: impl FnMut(u64) -> Result<(), Fault>,
) -> Result<Sureness, Unconfirmed> {
    let mut largest = Largest::default();
    let compared = degrees(&mut |_, found, expected| {
        largest.compared(found, expected);
        Ok(())
    });
    let found = compared.ok().and_then(|()| largest.points(content.functions));
    confirmed(found.map_or(POINTS, |(points, _)| points), point)?;
    Ok(match found {
        _ if content.has_multiple => Sureness::Multiple,
        Some((_, exponent)) => Sureness::Certified(exponent),
        None => Sureness::TooHigh,
    })
}

/// Whether what was derived agrees with the declaration at that many points. A point without values is no agreement.
fn confirmed(count: u32, mut point: impl FnMut(u64) -> Result<(), Fault>) -> Result<(), Unconfirmed> {
    let (mut left, mut nothing) = (count, Unconfirmed::NoValue);
    for seed in 1..=u64::from(count + SPARE) {
        match point(seed) {
            Ok(()) => left -= 1,
            Err(Fault::Untold) => {}
            Err(Fault::NoValue(term)) => nothing = Unconfirmed::Disagrees(term),
            Err(Fault::Disagrees(term)) => return Err(Unconfirmed::Disagrees(term)),
        }
        if left == 0 {
            return Ok(());
        }
    }
    Err(nothing)
}
