//! The parts of a whole step that every language writes.

use liestep::__private::{log_ratio_series, stumpff_series};
use liestep_derivation::whole::{Form, MatrixFactor, Programs, WholeStep};
use liestep_derivation::{Function, Program};

use super::language::own_functions;
use crate::declaration::Declaration;
use crate::emitted::{Emitted, emitted};
use crate::error::LateError;

/// The sums of a step in C: rounded, or compensated, where rounding takes from attitude, momentum and advected parameters
/// nothing that isn't added to their next changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Sums {
    Rounded,
    Compensated,
}

/// A step with the declaration that it is of.
pub(super) struct Parts<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) step: WholeStep,
    pub(super) sums: Sums,
    emitted: Emitted,
}

impl<'a> Parts<'a> {
    pub(super) fn of(declaration: &'a Declaration, sums: Sums) -> Result<Self, LateError> {
        let refused = |beside| Err(LateError::Compensated { beside });
        let changes = match sums {
            Sums::Rounded => None,
            Sums::Compensated if !declaration.constraints.each.is_empty() => {
                return refused("constraints on velocities");
            }
            Sums::Compensated if declaration.energy.is_some() => return refused("a pace"),
            Sums::Compensated => Some(WholeStep::changes(declaration)?),
        };
        let step = WholeStep::of(declaration)?;
        let Programs { velocity, momentum, energy, .. } = &step.programs;
        let limit = [("velocity_of", velocity), ("momentum_of", momentum), ("energy_of", energy)];
        let limit = if has_limit(&step) { &limit[..] } else { &[] };
        let more: Vec<_> = changes.iter().map(|program| ("changes", program)).chain(limit.iter().copied()).collect();
        let mut emitted = emitted(&step, &more);
        for (name, _) in &mut emitted.programs {
            // A driver has a variable of this name.
            if *name == "defect" {
                *name = "defect_of";
            }
        }
        Ok(Self { declaration, step, sums, emitted })
    }

    /// Whether the velocity of a momentum and the energy are programs: where the continuous limit is quadratic.
    pub(super) const fn has_limit(&self) -> bool {
        has_limit(&self.step)
    }

    /// The programs that a step calls, by the names of their functions; those that a declaration lacks are empty.
    pub(super) fn programs(&self) -> impl Iterator<Item = (&'static str, Option<&Program>)> {
        self.emitted.programs.iter().map(|(name, program)| (*name, program.as_ref()))
    }

    /// The constants that the programs read, of all constants of a step.
    pub(super) fn constants(&self, all: &[f64]) -> Vec<f64> {
        self.emitted.constants.iter().map(|&at| all[at]).collect()
    }

    /// The number of outputs of a program, at least one, as no language has an array of none.
    fn outputs(&self, name: &str) -> usize {
        let program = self.programs().find(|(found, _)| *found == name).and_then(|(_, program)| program);
        program.map_or(0, |program| program.outputs.len()).max(1)
    }

    /// The sizes of arrays, by their names.
    pub(super) fn sizes(&self) -> Vec<(&'static str, usize)> {
        let WholeStep { sizes, programs, factors } = &self.step;
        let parameters: usize = self.declaration.parameters.iter().map(|parameter| parameter.kind.len()).sum();
        let mut sizes = vec![
            ("PARAMETERS", parameters.max(1)),
            ("CONSTANTS", self.outputs("constants")),
            ("ENTRIES", sizes.entries),
            ("N", sizes.n),
            ("CARRIED", sizes.carried),
            ("ADVECTED", sizes.carried.max(1)),
            ("DETS", sizes.dets),
            ("NEAR", sizes.near),
            ("ATTITUDES", sizes.attitudes),
            ("ROTATIONS", factors.iter().filter(|factor| factor.form == Form::Rotation).count()),
            ("RESTORED", self.outputs("restored")),
            ("IS_WHOLE", usize::from(factors.len() == 1)),
            ("VARIES", usize::from(programs.safe.is_some())),
        ];
        sizes.extend((self.sums == Sums::Compensated).then(|| ("CHANGES", self.outputs("changes"))));
        sizes
    }

    /// A number of each factor that is restored.
    pub(super) fn restored(&self, number: fn(&MatrixFactor) -> usize) -> Vec<String> {
        let restored = self.step.factors.iter().filter(|factor| factor.is_restored());
        restored.map(|factor| number(factor).to_string()).collect()
    }

    /// The functions of the exponential and the logarithm that the programs have, by their names and orders, with the
    /// coefficients of their series.
    pub(super) fn series(&self) -> Vec<(&'static str, u8, String)> {
        let mut used: Vec<Function> =
            self.programs().filter_map(|(_, program)| program).flat_map(own_functions).collect();
        used.sort_unstable();
        used.dedup();
        let listed = |series: &[f64]| series.iter().map(|one| format!("{one:?}")).collect::<Vec<_>>().join(", ");
        let series = used.into_iter().filter_map(|function| match function {
            Function::Stumpff(k) => Some(("stumpff", k, listed(&stumpff_series(k.into())))),
            Function::LogRatio(k) => Some(("log_ratio", k, listed(&log_ratio_series(k.into())))),
            _ => None,
        });
        series.collect()
    }
}

/// Whether the continuous limit is quadratic: only then the velocity of a momentum is a program.
const fn has_limit(step: &WholeStep) -> bool {
    step.programs.hessian.is_none()
}
