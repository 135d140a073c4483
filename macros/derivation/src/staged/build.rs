//! The programs of a step, of its kernel and its derived terms.

use super::sources::{Sources, carried, parameter_kind};
use super::{Array, Constraints, Factor, Operation, Parameter, Program, Source, StagedDeclaration, Stages};
use crate::declared::{Declaration, Role};
use crate::emit;
use crate::expand::Steps;
use crate::judged::{Choice, Equations};
use crate::mathematics::derive::Inverse;
use crate::mathematics::symbolic::Expression;
use crate::program::{Form, Graph, Handover, Node, NodeId, Outputs, along_directions, needed};

pub(super) fn staged(declaration: &Declaration, steps: &Steps) -> StagedDeclaration {
    let Steps { chosen, equations, findings } = steps;
    let Choice { lowered, derived, kernel } = chosen;
    let names = &lowered.names;
    let sources = Sources { declaration, names, directions: Some(&derived.directions) };
    let (graph, stages) = (&kernel.graph, &findings.stages);
    let (constants, none) = (&stages.constants, &Handover::new());
    let program = |handed, outputs: &[NodeId]| program(graph, &sources, handed, outputs);
    let alone = |(graph, outputs): &Outputs| self::program(graph, &sources, none, outputs);
    let derived_term = |form, expression| alone(&kernel.beginning.term(derived, form, expression));
    let (limit_graph, at_rest) = kernel.beginning.limit(derived);
    let is_nonlinear = |equations: &&Equations| equations.derived.inverse == Inverse::Nonlinear;
    let reaction = alone(&(limit_graph.clone(), at_rest[1].clone()));
    let whole = StagedDeclaration {
        name: declaration.item.ident.to_string(),
        role: declaration.role,
        factors: factors(declaration),
        parameters: parameters(declaration),
        carried: (0..declaration.advected.len()).map(|index| carried(declaration, index)).collect(),
        energy: declaration.energy,
        derivation: emit::text(declaration, chosen, equations.as_ref(), findings),
        has_kinetic: derived.limit.has_kinetic,
        has_force: declaration.role == Role::Force,
        parts: [&derived.unknown, &derived.kick_before, &derived.kick_after].map(|part| !part.is_zero()),
        denominators: kernel.denominators,
        has_constant_inertia: !derived.inertia_varies(),
        is_quadratic: !equations.as_ref().is_some_and(|equations| is_nonlinear(&equations)),
        is_self_adjoint: findings.self_adjointness.is_found(),
        in_increment: kernel.in_increment,
        blocks: kernel.ends(&derived.group).into_iter().map(|end| derived.group.component_of(end)).collect(),
        programs: Stages {
            constants: program(none, &constants.keys().copied().collect::<Vec<_>>()),
            kick_before: program(constants, &kernel.kick_before),
            newton_system: program(constants, &stages.system),
            newton_residual: program(constants, &kernel.residual),
            kick_after: program(constants, &kernel.kick_after),
            kick_derivative: kernel.kick_derivative.as_ref().map(|outputs| program(constants, outputs)),
            momentum_jacobian: alone(&findings.jacobian),
            at_rest: alone(&(limit_graph, at_rest.concat())),
            at_velocity: equations.as_ref().filter(is_nonlinear).map(|equations| at_velocity(declaration, equations)),
            lagrangian: equations.as_ref().map(|_| {
                [
                    derived_term(Form::Scalar, &lowered.declared.expression),
                    derived_term(Form::Vector, &derived.right_momentum),
                    derived_term(Form::Vector, &derived.left_momentum),
                    derived_term(Form::Vector, &derived.diamond),
                    derived_term(Form::Vector, &derived.momentum),
                    derived_term(Form::Scalar, &derived.energy),
                ]
            }),
        },
        constraints: Constraints::default(),
    };
    if declaration.role == Role::Nonholonomic { whole.into_constraint(reaction) } else { whole }
}

fn at_velocity(declaration: &Declaration, equations: &Equations) -> [Program; 3] {
    let sources = Sources { declaration, names: &equations.names, directions: None };
    let derived = &equations.derived;
    let of_rank = |rank, expression: &Expression| {
        let mut graph = Graph::default();
        let outputs = along_directions(&mut graph, derived, rank, expression);
        program(&graph, &sources, &Handover::new(), &outputs)
    };
    [of_rank(0, &derived.lagrangian), of_rank(1, &derived.momentum), of_rank(2, &derived.hessian)]
}

/// The factors of the group.
fn factors(declaration: &Declaration) -> Vec<Factor> {
    let generators = |factor: &crate::mathematics::group::Group| {
        factor.generators.iter().map(|one| one.iter().map(|entry| entry.to_f64()).collect()).collect()
    };
    let factors = declaration.factors.iter().zip(declaration.group.factors());
    factors.map(|(named, own)| Factor { name: named.group_name(), generators: generators(own) }).collect()
}

fn parameters(declaration: &Declaration) -> Vec<Parameter> {
    let fields = declaration.fields.iter();
    fields.map(|field| Parameter { name: field.plain_name(), kind: parameter_kind(field.kind) }).collect()
}

/// The programs of a Hamiltonian, which has no Lagrangian and no momentum equation of its own.
pub(super) fn hamiltonian(declaration: &Declaration, equations: &Equations) -> StagedDeclaration {
    let n = declaration.group.dimension();
    StagedDeclaration {
        name: declaration.item.ident.to_string(),
        role: declaration.role,
        factors: factors(declaration),
        parameters: parameters(declaration),
        carried: (0..declaration.advected.len()).map(|index| carried(declaration, index)).collect(),
        energy: None,
        derivation: emit::text_of_hamiltonian(declaration, equations),
        has_kinetic: true,
        has_force: false,
        parts: [false; 3],
        denominators: 0,
        has_constant_inertia: false,
        is_quadratic: false,
        is_self_adjoint: true,
        in_increment: true,
        blocks: Vec::new(),
        constraints: Constraints::default(),
        programs: Stages { at_velocity: Some(at_velocity(declaration, equations)), ..Stages::zeros(n) },
    }
}

/// The program of these outputs, which reads these constants.
fn program(graph: &Graph, sources: &Sources, constants: &Handover, outputs: &[NodeId]) -> Program {
    let source = |id: NodeId| {
        if let Some(&at) = constants.get(&id) {
            return Some(Source::new(Array::Constants, at));
        }
        match graph.node(id) {
            Node::Input(input) => sources.of(input),
            _ => None,
        }
    };
    let order = needed(graph, outputs, &|id| source(id).is_some());
    let (mut inputs, mut literals, mut made) = ((vec![], vec![]), (vec![], vec![]), vec![]);
    for &id in &order {
        match (source(id), graph.node(id)) {
            (Some(source), _) => inputs.extend([(id, source)]),
            (None, Node::Constant(value)) => literals.extend([(id, value.to_f64())]),
            (None, Node::Input(_)) => {}
            _ => made.push(id),
        }
    }
    let mut registers = vec![0; order.iter().map(|id| id.0 + 1).max().unwrap_or(0)];
    for (&id, at) in inputs.0.iter().chain(&literals.0).chain(&made).zip(0..) {
        registers[id.0] = at;
    }
    let at = |id: NodeId| registers[id.0];
    let operation = |&id: &NodeId| match graph.node(id) {
        Node::Negate(a) => Some(Operation::Negate(at(a))),
        Node::Add(a, b) => Some(Operation::Add(at(a), at(b))),
        Node::Subtract(a, b) => Some(Operation::Subtract(at(a), at(b))),
        Node::Multiply(a, b) => Some(Operation::Multiply(at(a), at(b))),
        Node::Divide(a, b) => Some(Operation::Divide(at(a), at(b))),
        Node::Apply(function, a) => Some(Operation::Apply(function, at(a))),
        // Leaves are no operations.
        Node::Constant(_) | Node::Input(_) => None,
    };
    let operations = made.iter().filter_map(operation).collect();
    let outputs = outputs.iter().map(|&output| at(output)).collect();
    Program { inputs: inputs.1, literals: literals.1, operations, outputs }
}
