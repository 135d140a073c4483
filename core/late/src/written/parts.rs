//! The parts of a whole step that every language writes.

use liestep::__private::{log_ratio_series, stumpff_series};
use liestep_derivation::whole::{MatrixFactor, Programs, WholeStep};
use liestep_derivation::{Function, Program};

use super::language::own_functions;
use crate::declaration::Declaration;
use crate::error::LateError;

/// A step with the declaration that it is of.
pub(super) struct Parts<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) step: WholeStep,
}

impl<'a> Parts<'a> {
    pub(super) fn of(declaration: &'a Declaration) -> Result<Self, LateError> {
        Ok(Self { declaration, step: WholeStep::of(declaration)? })
    }

    /// Whether the velocity of a momentum and the energy are programs: where the continuous limit is quadratic.
    pub(super) const fn has_limit(&self) -> bool {
        self.step.programs.hessian.is_none()
    }

    /// The programs that a step calls, by the names of their functions; those that a declaration lacks are empty.
    pub(super) fn programs(&self) -> Vec<(&'static str, Option<&Program>)> {
        let Programs { velocity, momentum, energy, .. } = &self.step.programs;
        let programs = &self.step.programs;
        let mut all = vec![
            ("constants", Some(&programs.constants)),
            ("target", Some(&programs.target)),
            ("iterate", Some(&programs.iterate)),
            ("again", Some(&programs.again)),
            ("finish", Some(&programs.finish)),
            ("safe", programs.safe.as_ref()),
            ("seen", Some(&programs.seen)),
            ("restored", Some(&programs.restored)),
            ("defect_of", Some(&programs.defect)),
            ("rest", Some(&programs.rest)),
        ];
        if self.has_limit() {
            all.extend([("velocity_of", velocity), ("momentum_of", momentum), ("energy_of", energy)].map(with));
        }
        all
    }

    /// The sizes of arrays, by their names.
    pub(super) fn sizes(&self) -> Vec<(&'static str, usize)> {
        let WholeStep { sizes, programs, factors } = &self.step;
        let parameters: usize = self.declaration.parameters.iter().map(|parameter| parameter.kind.len()).sum();
        vec![
            ("PARAMETERS", parameters.max(1)),
            ("CONSTANTS", programs.constants.outputs.len().max(1)),
            ("ENTRIES", sizes.entries),
            ("N", sizes.n),
            ("CARRIED", sizes.carried),
            ("ADVECTED", sizes.carried.max(1)),
            ("DETS", sizes.dets),
            ("NEAR", sizes.near),
            ("ATTITUDES", sizes.attitudes),
            ("RESTORED", programs.restored.outputs.len().max(1)),
            ("IS_WHOLE", usize::from(factors.len() == 1)),
            ("VARIES", usize::from(programs.safe.is_some())),
        ]
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
            self.programs().iter().filter_map(|(_, program)| *program).flat_map(own_functions).collect();
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

const fn with<'p>((name, program): (&'static str, &'p Program)) -> (&'static str, Option<&'p Program>) {
    (name, Some(program))
}
