//! Classes of defaults of MJCF: attributes that elements have without saying so.

use std::collections::HashMap;

use roxmltree::Node;

use super::super::xml::{Read, elements, place};

/// The class of elements without another.
const MAIN: &str = "main";

/// Classes by their names.
#[derive(Default)]
pub(super) struct Classes<'a, 'd> {
    classes: HashMap<String, Class<'a, 'd>>,
}

/// The elements of a class by their tags.
#[derive(Default)]
struct Class<'a, 'd> {
    elements: HashMap<&'a str, Vec<Node<'a, 'd>>>,
    /// The class around it.
    around: Option<String>,
}

impl<'a, 'd> Classes<'a, 'd> {
    /// Reads an element `default` of a model; several of them count together.
    pub(super) fn read(&mut self, node: &Node<'a, 'd>, around: Option<&str>) -> Read<()> {
        let name = match (node.attribute("class"), around) {
            (Some(name), _) => name,
            (None, None) => MAIN,
            (None, Some(_)) => return Err((place(node), "a `default` inside of another has a `class`".to_owned())),
        };
        let class = self.classes.entry(name.to_owned()).or_default();
        class.around = around.map(str::to_owned);
        for element in elements(node).filter(|element| !element.has_tag_name("default")) {
            class.elements.entry(element.tag_name().name()).or_default().push(element);
        }
        let name = name.to_owned();
        elements(node)
            .filter(|element| element.has_tag_name("default"))
            .try_for_each(|inner| self.read(&inner, Some(&name)))
    }

    /// An element with the defaults of its own class, or of that of the bodies around it.
    pub(super) fn of(&self, node: Node<'a, 'd>, around: Option<&str>) -> Read<Element<'a, 'd>> {
        let named = node.attribute("class").or(around);
        if let Some(name) = named
            && !self.classes.contains_key(name)
        {
            return Err((place(&node), format!("there is no class `{name}` of defaults")));
        }
        let (mut all, mut next) = (vec![node], Some(named.unwrap_or(MAIN)));
        // A class stands inside of another one, so that the way out ends.
        for _ in 0..=self.classes.len() {
            let Some(Class { elements, around }) = next.and_then(|name| self.classes.get(name)) else { break };
            all.extend(elements.get(node.tag_name().name()).into_iter().flatten().rev());
            next = around.as_deref();
        }
        Ok(Element { all })
    }
}

/// An element, and behind it those whose attributes it has where it says nothing else.
pub(super) struct Element<'a, 'd> {
    all: Vec<Node<'a, 'd>>,
}

impl<'a, 'd> Element<'a, 'd> {
    /// The element itself.
    pub(super) fn node(&self) -> &Node<'a, 'd> {
        &self.all[0]
    }

    /// The element that has this attribute, which is its own or that of a class.
    pub(super) fn with(&self, attribute: &str) -> Option<&Node<'a, 'd>> {
        self.all.iter().find(|node| node.has_attribute(attribute))
    }

    pub(super) fn text(&self, attribute: &str) -> Option<&'a str> {
        self.with(attribute).and_then(|node| node.attribute(attribute))
    }
}
