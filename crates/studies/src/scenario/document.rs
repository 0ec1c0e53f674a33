//! A YAML text as a tree of nodes that know their place. The only file that touches the YAML crate.

use std::{
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_yaml::Spanned;

use crate::{Diagnostic, Error, Excerpt};

/// Limits that no scenario written by people reaches, so that a YAML bomb is refused at once.
const MAX_NODES: usize = 20_000;
const MAX_DEPTH: usize = 40;
const MAX_BYTES: usize = 1 << 20;

/// Index of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeId(pub(super) u32);

/// The nodes of one file, parents before children.
#[derive(Debug)]
pub struct Document {
    file: PathBuf,
    text: Arc<str>,
    pub(super) nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
pub(super) struct Node {
    pub value: Value,
    /// The node above, and the step from there to here.
    pub parent: Option<(NodeId, Step)>,
    /// Where the file says it; none for what an override says.
    pub mark: Option<Mark>,
    /// The override that says it.
    pub setting: Option<Arc<str>>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Null,
    Bool(bool),
    Whole(u64),
    Number(f64),
    Text(String),
    List(Vec<NodeId>),
    Map(Vec<(Key, NodeId)>),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Key {
    pub name: String,
    pub mark: Option<Mark>,
}

#[derive(Clone, Debug)]
pub(super) enum Step {
    Key(String),
    Item(usize),
}

/// Line and column from 1, and bytes of the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    line: u64,
    column: u64,
    span: Range<usize>,
}

/// A node, or the key of one: what a message points at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// The value.
    Node(NodeId),
    /// The key with this index in a map.
    Key(NodeId, usize),
}

impl Spot {
    /// Key and value, where a key is meant.
    fn entry(self, document: &Document) -> Option<&(Key, NodeId)> {
        match (
            self,
            &document
                .node(match self {
                    Spot::Node(id) | Spot::Key(id, _) => id,
                })
                .value,
        ) {
            (Spot::Key(_, index), Value::Map(entries)) => entries.get(index),
            _ => None,
        }
    }
}

impl Document {
    /// Reads a YAML text; `file` is what messages call it.
    pub fn parse(file: impl Into<PathBuf>, text: &str) -> Result<Self, Error> {
        let file = file.into();
        let mut document = Document { file, text: text.into(), nodes: Vec::new() };
        if text.len() > MAX_BYTES {
            let problem = format!("the file has {} bytes, a scenario at most {MAX_BYTES}", text.len());
            return Err(Diagnostic::new(&document.file, problem).into());
        }
        let tree = parse_tree(text).map_err(|e| document.yaml_error(&e))?;
        document.add(&tree, None, None);
        Ok(document)
    }

    /// What messages call the file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The whole document.
    pub fn root(&self) -> NodeId {
        NodeId(0)
    }

    pub(super) fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// Adds a parsed tree. With `setting`, the nodes come from an override and have no place in the file.
    pub(super) fn add(
        &mut self,
        tree: &Tree,
        parent: Option<(NodeId, Step)>,
        setting: Option<&Arc<str>>,
    ) -> NodeId {
        let id = NodeId(self.nodes.len() as u32);
        let mark = |location| setting.is_none().then(|| mark(location));
        self.nodes.push(Node {
            value: Value::Null,
            parent,
            mark: mark(&tree.referenced),
            setting: setting.cloned(),
        });
        let value = match &tree.value {
            Parsed::Scalar(value) => value.clone(),
            Parsed::List(items) => {
                let add = |(i, item)| self.add(item, Some((id, Step::Item(i))), setting);
                Value::List(items.iter().enumerate().map(add).collect())
            }
            Parsed::Map(entries) => Value::Map(
                entries
                    .iter()
                    .map(|(key, value)| {
                        let step = Step::Key(key.value.clone());
                        let key = Key { name: key.value.clone(), mark: mark(&key.referenced) };
                        (key, self.add(value, Some((id, step)), setting))
                    })
                    .collect(),
            ),
        };
        self.nodes[id.0 as usize].value = value;
        id
    }

    /// `imu.gyro[0].bias`; empty for the root.
    pub fn path(&self, id: NodeId) -> String {
        match &self.node(id).parent {
            None => String::new(),
            Some((parent, Step::Item(i))) => format!("{}[{i}]", self.path(*parent)),
            Some((parent, Step::Key(key))) => join(&self.path(*parent), key),
        }
    }

    /// A message about a node or key: file, place, path and excerpt are filled in.
    pub fn diagnostic(&self, spot: Spot, problem: impl Into<String>) -> Diagnostic {
        let id = match (spot, spot.entry(self)) {
            (_, Some((_, below))) => *below,
            (Spot::Node(id) | Spot::Key(id, _), None) => id,
        };
        let path = self.path(id);
        let diagnostic = Diagnostic::new(&self.file, problem).path(path);
        if let Some(setting) = &self.node(id).setting {
            return diagnostic.help(format!("set by `--set {setting}`"));
        }
        match self.mark(spot) {
            Some(mark) => self.mark_diagnostic(diagnostic, mark),
            None => diagnostic,
        }
    }

    fn mark_diagnostic(&self, diagnostic: Diagnostic, mark: &Mark) -> Diagnostic {
        let excerpt = Excerpt { text: self.text.clone(), first_line: 1, span: mark.span.clone() };
        Diagnostic { excerpt: Some(excerpt), ..diagnostic.at(mark.line, mark.column) }
    }

    /// Where to point: a collection or an empty value is best shown by its key.
    fn mark(&self, spot: Spot) -> Option<&Mark> {
        if let Some((key, _)) = spot.entry(self) {
            return key.mark.as_ref();
        }
        let (Spot::Node(id) | Spot::Key(id, _)) = spot;
        let node = self.node(id);
        match (&node.value, &node.parent) {
            (Value::Map(_) | Value::List(_) | Value::Null, Some((parent, Step::Key(key)))) => {
                match &self.node(*parent).value {
                    Value::Map(entries) => entries.iter().find(|(k, _)| k.name == *key)?.0.mark.as_ref(),
                    _ => None,
                }
            }
            _ => node.mark.as_ref(),
        }
    }

    fn yaml_error(&self, error: &serde_yaml::Error) -> Error {
        let text = error.without_snippet().to_string();
        let text = text.split(" at line ").next().unwrap_or_default();
        let bomb = text.contains("budget breached") || text.contains("limit exceeded");
        let (problem, help) = match text.split_once("duplicate mapping key: ") {
            Some((_, rest)) => {
                let key = rest.split(',').next().unwrap_or_default();
                (format!("the key `{key}` stands twice"), "keep one of them")
            }
            None if bomb => (
                "the YAML unfolds to far more than a scenario needs".into(),
                "write it without so many aliases (`*name`) or levels",
            ),
            None => (format!("this is not YAML: {text}"), ""),
        };
        let diagnostic = Diagnostic::new(&self.file, problem).help(help);
        match error.location() {
            Some(location) => self.mark_diagnostic(diagnostic, &self.clip(mark(&location))).into(),
            None => diagnostic.into(),
        }
    }

    /// A mark without bytes (the scanner gives none) gets the character at its line and column.
    fn clip(&self, mark: Mark) -> Mark {
        if mark.span.end <= self.text.len() {
            return mark;
        }
        let lines = self.text.split_inclusive('\n');
        let start: usize = lines.clone().take(mark.line as usize - 1).map(str::len).sum();
        let line = lines.clone().nth(mark.line as usize - 1).unwrap_or_default();
        let at = line.char_indices().nth(mark.column as usize - 1).map_or(line.len(), |(i, _)| i);
        let length = line[at..].chars().next().map_or(0, char::len_utf8);
        Mark { span: start + at..start + at + length, ..mark }
    }
}

/// `path.key`.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.into() } else { format!("{path}.{key}") }
}

fn mark(location: &serde_yaml::Location) -> Mark {
    let span = location.span();
    let range = match (span.byte_offset(), span.byte_len()) {
        (Some(offset), Some(len)) => offset as usize..(offset + len) as usize,
        _ => usize::MAX..usize::MAX,
    };
    Mark { line: location.line(), column: location.column(), span: range }
}

/// A value as the YAML crate hands it over.
pub(super) type Tree = Spanned<Parsed>;

pub(super) enum Parsed {
    Scalar(Value),
    List(Vec<Tree>),
    Map(Vec<(Spanned<String>, Tree)>),
}

pub(super) fn parse_tree(text: &str) -> Result<Tree, serde_yaml::Error> {
    let options = serde_yaml::options! {
        // YAML 1.2: `y` is the name of an axis and no boolean.
        strict_booleans: true,
        budget: serde_yaml::budget! { max_nodes: MAX_NODES, max_depth: MAX_DEPTH },
        with_snippet: false,
    };
    serde_yaml::from_str_with_options(text, options)
}

impl<'de> Deserialize<'de> for Parsed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AnyValue)
    }
}

struct AnyValue;

impl<'de> Visitor<'de> for AnyValue {
    type Value = Parsed;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a YAML value")
    }
    fn visit_bool<E>(self, value: bool) -> Result<Parsed, E> {
        Ok(Parsed::Scalar(Value::Bool(value)))
    }
    fn visit_u64<E>(self, value: u64) -> Result<Parsed, E> {
        Ok(Parsed::Scalar(Value::Whole(value)))
    }
    fn visit_i64<E>(self, value: i64) -> Result<Parsed, E> {
        Ok(Parsed::Scalar(u64::try_from(value).map_or(Value::Number(value as f64), Value::Whole)))
    }
    fn visit_f64<E>(self, value: f64) -> Result<Parsed, E> {
        Ok(Parsed::Scalar(Value::Number(value)))
    }
    fn visit_str<E>(self, value: &str) -> Result<Parsed, E> {
        Ok(Parsed::Scalar(Value::Text(value.into())))
    }
    fn visit_unit<E>(self) -> Result<Parsed, E> {
        Ok(Parsed::Scalar(Value::Null))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Parsed, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = access.next_element()? {
            items.push(item);
        }
        Ok(Parsed::List(items))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Parsed, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = access.next_entry()? {
            entries.push(entry);
        }
        Ok(Parsed::Map(entries))
    }
}
