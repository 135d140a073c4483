//! The self-check of a force: its share in the momentum equation against the declared virtual work.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::rc::Rc;

use super::{
    Evaluation, Fault, Sample, TOLERANCE, Unconfirmed, Value, compare, confirmed, evaluated, increments, turn,
};
use crate::declared::{Declaration, Name, Tree};
use crate::judged::choose::Chosen;
use crate::mathematics::derive::Derived;
use crate::mathematics::group::Group;
use crate::program::{Graph, components, square};

/// Checks the derived terms of a force. The error is the first that disagrees.
pub(crate) fn force(declaration: &Declaration, tree: &Rc<Tree>, chosen: &Chosen) -> Result<(), Unconfirmed> {
    let Chosen { lowered, derived, .. } = chosen;
    let (mut graph, none) = (Graph::default(), BTreeMap::new());
    let momentum = components(&mut graph, derived, &none, &derived.momentum);
    let jacobian = square(&mut graph, derived, &none, &derived.jacobian);
    let values = |sample: &Sample, f: &Value| {
        let inputs = sample.inputs(f);
        [&momentum, &jacobian].map(|outputs| evaluated(&graph, outputs, &inputs))
    };
    let draws = Sample::draws(declaration, lowered, derived, tree);
    let samples = confirmed(draws, |sample| check(tree, derived, sample, &values(sample, &sample.increment)))?;
    let is_smooth = samples.iter().any(|sample| {
        let identity = Value::identity(derived.group.size);
        values(sample, &identity).iter().flatten().all(|entry| entry.is_finite())
    });
    if is_smooth { Ok(()) } else { Err(Unconfirmed::NotSmooth) }
}

fn check(
    tree: &Rc<Tree>,
    derived: &Derived,
    sample: &Sample,
    [momentum, jacobian]: &[Vec<f64>; 2],
) -> Result<(), Fault> {
    let dimension = derived.group.dimension();
    // −f⁻_k at exp(tE_j) F.
    let expected = |k: usize, j: usize, t: f64| {
        let mut values = sample.values.clone();
        values.extend(increments(&derived.group, &turn(&derived.group, j, t).times(&sample.increment)));
        values.extend(along(&derived.group, k));
        -Evaluation::new(&values).of(tree).first()
    };
    let size = 1.0 + jacobian.iter().chain(momentum).map(|x| x.abs()).sum::<f64>();
    for k in 0..dimension {
        let (found, declared) = (momentum[k], expected(k, 0, 0.0));
        if !declared.is_finite() {
            return Err(Fault::Untold);
        }
        if (found - declared).abs().partial_cmp(&(TOLERANCE * size)) != Some(Ordering::Less) {
            return Err(Fault::Disagrees("force"));
        }
        for j in 0..dimension {
            compare("Newton Jacobian", jacobian[dimension * k + j], &|t| expected(k, j, t), size)?;
        }
    }
    Ok(())
}

/// One along the component `k` at the beginning of a step, and nothing at its end.
fn along(group: &Group, k: usize) -> Vec<(Name, Value)> {
    let (of, own) = group.factor_of(k);
    let factors = group.factors().iter().enumerate();
    let each = factors.flat_map(|(factor, group)| {
        let axis = |is_along| {
            Value::new(group.dimension(), 1, |row, _| f64::from(u8::from(is_along && factor == of && row == own)))
        };
        [(Name::DisplacementBefore(factor), axis(true)), (Name::DisplacementAfter(factor), axis(false))]
    });
    each.collect()
}
