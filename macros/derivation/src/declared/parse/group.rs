//! The group of a declaration: a built-in one by its name, or a user's one by its generators.

use proc_macro2::Span;
use syn::ext::IdentExt as _;
use syn::parse::ParseStream;
use syn::{Ident, Path, PathArguments, Token};

use super::generators::{Generators, generators};
use crate::declared::errors::{Errors, suggestion};
use crate::declared::{Factor, Role};
use crate::mathematics::group::{Group, NAMES, built_in};

/// The name behind `group =`.
pub(super) struct GroupName {
    path: Path,
    /// Whether the name is `Name!`, a group that `matrix_group!` declares.
    is_own: bool,
}

impl GroupName {
    pub(super) fn name(&self) -> String {
        self.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default()
    }

    /// The group of liestep by that name, if there is one.
    pub(super) fn built_in(&self) -> Option<Group> {
        if self.is_own { None } else { built_in(&self.name()) }
    }

    /// Whether the group is one of translations.
    pub(super) fn is_translation(&self) -> bool {
        self.built_in().is_some() && TRANSLATIONS.contains(&self.name().as_str())
    }

    /// Whether the name may be an increment in the place of its group.
    pub(super) fn may_be_an_increment(&self) -> bool {
        let is_misspelled = !suggestion(&self.name(), NAMES).is_empty();
        self.path.get_ident().is_some() && !self.is_own && self.built_in().is_none() && !is_misspelled
    }

    /// Whether the path can't belong to a group of the user's.
    fn is_ours(&self) -> bool {
        let segments = &self.path.segments;
        segments.len() == 1 || segments.first().is_some_and(|first| first.ident == "liestep")
    }
}

/// The advice for the value of `group`.
pub(super) const ONE_OR_SEVERAL: &str =
    "write the name of a group, `group = SO3`, or those of several bodies, `group(F_1 = SO3, F_2 = SO3)`";

/// Reads the name of a group, as `SO3` or `own::Affine!`.
pub(super) fn named(input: ParseStream, errors: &mut Errors) -> syn::Result<GroupName> {
    let span = input.span();
    let mut path: Path = input.parse().map_err(|_| syn::Error::new(span, ONE_OR_SEVERAL))?;
    let is_own = input.parse::<Option<Token![!]>>()?.is_some();
    for segment in &mut path.segments {
        // The generated code writes the scalar itself wherever it needs the type.
        let arguments = std::mem::replace(&mut segment.arguments, PathArguments::None);
        if !arguments.is_empty() {
            let (name, mark) = (&segment.ident, if is_own { "!" } else { "" });
            let message = format!("write `group = {name}{mark}`: the scalar is that of the fields");
            errors.push_over(arguments, message);
        }
    }
    Ok(GroupName { path, is_own })
}

/// The path as written, and the group. After a mistake the path is `None` and the group SO(3), so that the rest can be
/// checked.
pub(super) fn group(
    named: Option<GroupName>,
    matrices: Option<&Generators>,
    is_readable: bool,
    errors: &mut Errors,
) -> (Option<Path>, Group) {
    let stand_in = || (None, built_in("SO3").unwrap_or_else(|| Group::declared(3, Vec::new())));
    let Some(named) = named else {
        // The group may stand in an argument that couldn't be read.
        if is_readable {
            errors.push(Span::call_site(), "the group is missing: write `group = SO3`");
        }
        return stand_in();
    };
    let (name, found) = (named.name(), named.built_in());
    // A mistake of the user's name is reported where the generators are read.
    if let Some(all) = matrices {
        all.check(std::slice::from_ref(&name), errors);
    }
    let found = match (matrices.map(|all| (&all.key, all.matrices(&name))), found) {
        (Some((key, Some(_))), Some(group)) if named.is_ours() => {
            let message = format!(
                "`{name}` has its generators already: remove these, or give a group of your own another name than \
                 liestep's"
            );
            errors.push_decisive(key.span(), message);
            Ok(group)
        }
        (Some((_, Some(matrices))), _) => generators(matrices),
        (_, Some(group)) => Ok(group),
        // The generators may stand in an argument that couldn't be read, or have another name.
        (Some(_), None) => return stand_in(),
        (None, None) if !is_readable => return stand_in(),
        (None, None) => {
            let (near, known) = (suggestion(&name, NAMES), NAMES.join(", "));
            let own = format!(
                "of a group that `matrix_group!` declares write `group = {name}!`, of another give the generators too: \
                 `generators = [[[0.0, -1.0], [1.0, 0.0]]]`"
            );
            let message = format!("the group `{name}` isn't known{near}\nknown: {known}; {own}");
            Err(syn::Error::new_spanned(&named.path, message))
        }
    };
    match found {
        Ok(group) => (Some(named.path), group),
        Err(error) => {
            errors.extend(error);
            stand_in()
        }
    }
}

/// The factors of a product, with their increments.
pub(super) fn product(
    named: Vec<(Ident, GroupName)>,
    matrices: Option<&Generators>,
    errors: &mut Errors,
) -> (Vec<Factor>, Group) {
    let own = own_groups(&named, matrices, errors);
    // Generators may stand in an argument that couldn't be read, or have another name.
    let is_readable = errors.is_empty();
    let (mut factors, mut groups): (Vec<Factor>, Vec<Group>) = (Vec::new(), Vec::new());
    for (increment, named) in named {
        let name = increment.unraw().to_string();
        if factors.iter().any(|other| other.name == name) {
            let message = format!("`{name}` is declared twice: each factor has its own increment");
            errors.push_decisive(increment.span(), message);
            continue;
        }
        if factors.len() == MOST_FACTORS {
            let message = format!(
                "at most {MOST_FACTORS} factors are declared together: declare what one body or two have as terms of \
                 their own, and put them at the places of a system of many, `Each::<N>::of([…]) + Along::<N>::of([…])`"
            );
            errors.push_decisive(increment.span(), message);
            break;
        }
        let known = factor(&named, &own).or_else(|| {
            if is_readable && own.iter().all(|(own, _)| *own != named.name()) {
                errors.push_over(&named.path, unknown_factor(&named));
            }
            None
        });
        let path = known.is_some().then_some(named.path);
        // A stand-in after a mistake lets the rest be checked.
        groups.extend(known.or_else(|| built_in("SO3")));
        factors.push(Factor { name, place: increment.span(), path });
    }
    (factors, Group::product(groups))
}

/// The user's groups among factors, by their names; `None` for one whose generators are mistaken, which has been reported.
fn own_groups(
    factors: &[(Ident, GroupName)],
    matrices: Option<&Generators>,
    errors: &mut Errors,
) -> Vec<(String, Option<Group>)> {
    let Some(matrices) = matrices else { return Vec::new() };
    let is_own =
        |named: &GroupName| named.built_in().is_none() || (!named.is_ours() && matrices.has_name(&named.name()));
    let names: Vec<String> = factors.iter().filter(|(_, named)| is_own(named)).map(|(_, named)| named.name()).collect();
    matrices.check(&names, errors);
    let mut groups: Vec<(String, Option<Group>)> = Vec::new();
    for name in names {
        if let (Some(matrices), true) = (matrices.matrices(&name), groups.iter().all(|(known, _)| *known != name)) {
            let group = generators(matrices).map_err(|error| errors.extend(error)).ok();
            groups.push((name, group));
        }
    }
    groups
}

/// The group of a factor; `None` where it isn't known.
fn factor(named: &GroupName, own: &[(String, Option<Group>)]) -> Option<Group> {
    if let Some((_, group)) = own.iter().find(|(own, _)| *own == named.name()) {
        return group.clone();
    }
    named.built_in().map(|group| if named.is_translation() { group.added() } else { group })
}

fn unknown_factor(named: &GroupName) -> String {
    let name = named.name();
    let near = if named.is_own { String::new() } else { suggestion(&name, NAMES) };
    if !near.is_empty() {
        return format!("the group `{name}` isn't known{near}");
    }
    let known = NAMES.join(", ");
    format!(
        "the group `{name}` isn't known\nknown: {known}; of a group of your own give the generators too: \
         `generators({name} = [[[0.0, -1.0], [1.0, 0.0]]])`"
    )
}

/// The groups whose increments are vectors, which are added.
const TRANSLATIONS: [&str; 3] = ["R1", "R2", "R3"];

/// The limit on factors: more would make the derived code grow without bound.
const MOST_FACTORS: usize = 4;

/// Reports increments, of one body or of several, whose names have another meaning.
pub(super) fn check_increments(role: Role, factors: &[Factor], taken: &TakenNames, errors: &mut Errors) {
    // An increment without a name is `F`, which no other name can be.
    for Factor { name, place, .. } in factors.iter().filter(|factor| factor.name != "F") {
        let meaning = if Role::Lagrangian.reserved(true).contains(&name.as_str()) {
            &format!("already has a meaning in {}", role.definite())
        } else if name == "space" {
            "is what isn't a body, as in `seen_from(space)`"
        } else if taken.fields.contains(name) {
            "is a field already"
        } else if taken.advected.contains(name) {
            "is advected already"
        } else if taken.velocities.contains(name) {
            "is a velocity or a displacement already"
        } else {
            continue;
        };
        errors.push_decisive(*place, format!("`{name}` {meaning}: choose another name for the increment"));
    }
}

/// Names that other parts of the declaration have.
pub(super) struct TakenNames {
    pub(super) fields: Vec<String>,
    pub(super) advected: Vec<String>,
    pub(super) velocities: Vec<String>,
}
