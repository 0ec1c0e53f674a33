//! Serde's view of a [`Document`], so that the written form is plain derived structs and each fault keeps
//! its place.

use std::fmt;

use serde::de::{
    self, Deserialize, DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, MapAccess, SeqAccess,
    VariantAccess, Visitor, value::StrDeserializer,
};
use serde::forward_to_deserialize_any;

use super::document::{Document, NodeId, Spot, Value};
use crate::{Diagnostic, similar::similar};

/// Names under which [`At`] and [`NodeId`] ask for the place of a node.
const AT: &str = "$schuler::At";
const NODE: &str = "$schuler::Node";

/// A value and the node it stands in.
#[derive(Clone, Debug)]
pub struct At<T> {
    /// The value.
    pub value: T,
    /// Its node.
    pub node: NodeId,
}

/// Reads the written form out of a document.
pub fn read<'de, T: Deserialize<'de>>(document: &'de Document) -> Result<T, Diagnostic> {
    let root = NodeDe { document, id: document.root() };
    T::deserialize(root).map_err(|fault| fault.diagnostic(document))
}

/// What serde objects to, with the place once known.
#[derive(Debug)]
struct Fault {
    spot: Option<Spot>,
    problem: String,
    expected: String,
    found: String,
    /// The key whose example would help, below the node that the spot names.
    key: Option<String>,
    help: String,
}

impl Fault {
    fn new(problem: impl Into<String>) -> Self {
        let none = String::new;
        Fault {
            spot: None,
            problem: problem.into(),
            expected: none(),
            found: none(),
            key: None,
            help: none(),
        }
    }

    fn of_words(problem: String, word: &str, expected: &'static [&'static str]) -> Self {
        let near = similar(word, expected.iter().copied());
        let help = near.map(|s| format!("did you mean `{s}`?")).unwrap_or_default();
        Fault { expected: one_of(expected), help, key: near.map(String::from), ..Fault::new(problem) }
    }

    fn at(self, spot: Spot) -> Self {
        Fault { spot: self.spot.or(Some(spot)), ..self }
    }

    fn diagnostic(self, document: &Document) -> Diagnostic {
        let spot = self.spot.unwrap_or(Spot::Node(document.root()));
        let (Spot::Node(node) | Spot::Key(node, _)) = spot;
        let diagnostic = document.diagnostic(spot, self.problem).expected(self.expected).found(self.found);
        let example = document.example_near(node, self.key.as_deref());
        let help =
            [self.help, diagnostic.help.clone()].into_iter().filter(|h| !h.is_empty()).collect::<Vec<_>>();
        diagnostic.example(example).help(help.join("; "))
    }
}

/// `one of a, b, c`.
pub fn one_of(words: &[&str]) -> String {
    match words {
        [] => "nothing".into(),
        [word] => format!("`{word}`"),
        _ => format!("one of `{}`", words.join("`, `")),
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.problem)
    }
}

impl std::error::Error for Fault {}

impl de::Error for Fault {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Fault::new(message.to_string())
    }
    fn invalid_type(found: de::Unexpected, expected: &dyn de::Expected) -> Self {
        let expected = match expected.to_string().as_str() {
            "u64" => "a whole number, zero or more".into(),
            "a string" => "text".into(),
            "a sequence" => "a list".into(),
            text if text.starts_with("struct ") => "a map of keys".into(),
            text => text.replace("an array of length", "a list of"),
        };
        let found = match found {
            de::Unexpected::Unit => "nothing".into(),
            de::Unexpected::Seq => "a list".into(),
            de::Unexpected::Map => "a map".into(),
            de::Unexpected::Bool(value) => value.to_string(),
            de::Unexpected::Unsigned(value) => value.to_string(),
            de::Unexpected::Float(value) => value.to_string(),
            de::Unexpected::Str(text) => format!("`{text}`"),
            other => other.to_string(),
        };
        Fault { expected, found, ..Fault::new("another kind of value belongs here") }
    }
    fn invalid_value(found: de::Unexpected, expected: &dyn de::Expected) -> Self {
        Self::invalid_type(found, expected)
    }
    fn invalid_length(found: usize, expected: &dyn de::Expected) -> Self {
        let expected = expected.to_string().replace("an array of length", "a list of");
        Fault { expected, found: format!("a list of {found}"), ..Fault::new("the list has another length") }
    }
    fn unknown_variant(word: &str, expected: &'static [&'static str]) -> Self {
        Fault::of_words(format!("unknown word `{word}`"), word, expected)
    }
    fn unknown_field(word: &str, expected: &'static [&'static str]) -> Self {
        Fault::of_words(format!("unknown key `{word}`"), word, expected)
    }
    fn missing_field(field: &'static str) -> Self {
        Fault { key: Some(field.into()), ..Fault::new(format!("the key `{field}` is missing")) }
    }
    fn duplicate_field(field: &'static str) -> Self {
        Fault::new(format!("the key `{field}` stands twice"))
    }
}

#[derive(Clone, Copy)]
struct NodeDe<'de> {
    document: &'de Document,
    id: NodeId,
}

impl<'de> NodeDe<'de> {
    fn value(self) -> &'de Value {
        &self.document.node(self.id).value
    }

    fn visit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match self.value() {
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::Whole(value) => visitor.visit_u64(*value),
            Value::Number(value) => visitor.visit_f64(*value),
            Value::Text(value) => visitor.visit_borrowed_str(value),
            Value::List(items) => visitor.visit_seq(Items { document: self.document, items: items.iter() }),
            Value::Map(_) => visitor.visit_map(Entries { map: self, next: 0 }),
        }
    }
}

impl<'de> Deserializer<'de> for NodeDe<'de> {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.visit(visitor).map_err(|fault| fault.at(Spot::Node(self.id)))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match name {
            AT => visitor.visit_seq(Place { node: self, step: 0 }),
            NODE => visitor.visit_u32(self.id.0),
            _ => visitor.visit_newtype_struct(self),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        let access = match self.value() {
            Value::Text(word) => {
                Variant { word, key: Spot::Node(self.id), body: None, document: self.document }
            }
            Value::Map(entries) if entries.len() == 1 => {
                let (key, body) = &entries[0];
                Variant {
                    word: &key.name,
                    key: Spot::Key(self.id, 0),
                    body: Some(*body),
                    document: self.document,
                }
            }
            _ => {
                let fault = Fault::new("a word, or a map of one key, belongs here");
                return Err(Fault { expected: one_of(words), ..fault.at(Spot::Node(self.id)) });
            }
        };
        visitor.visit_enum(access).map_err(|fault| fault.at(Spot::Node(self.id)))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq
        tuple tuple_struct map struct identifier ignored_any
    }
}

struct Items<'de> {
    document: &'de Document,
    items: std::slice::Iter<'de, NodeId>,
}

impl<'de> SeqAccess<'de> for Items<'de> {
    type Error = Fault;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Fault> {
        self.items.next().map(|&id| seed.deserialize(NodeDe { document: self.document, id })).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len())
    }
}

struct Entries<'de> {
    map: NodeDe<'de>,
    next: usize,
}

impl<'de> Entries<'de> {
    fn entry(&self, index: usize) -> Option<(&'de str, NodeId)> {
        match self.map.value() {
            Value::Map(entries) => entries.get(index).map(|(key, id)| (key.name.as_str(), *id)),
            _ => None,
        }
    }
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Fault;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Fault> {
        let Some((name, _)) = self.entry(self.next) else { return Ok(None) };
        let spot = Spot::Key(self.map.id, self.next);
        self.next += 1;
        seed.deserialize(de::value::BorrowedStrDeserializer::new(name))
            .map(Some)
            .map_err(|f: Fault| f.at(spot))
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Fault> {
        let (_, id) = self.entry(self.next - 1).expect("invariant: serde asks for a value after its key");
        seed.deserialize(NodeDe { document: self.map.document, id })
    }
}

/// `word` or `word: body`.
struct Variant<'de> {
    document: &'de Document,
    word: &'de str,
    key: Spot,
    body: Option<NodeId>,
}

impl<'de> Variant<'de> {
    fn body(&self) -> Result<NodeDe<'de>, Fault> {
        let id = self
            .body
            .ok_or_else(|| Fault::new(format!("`{}` needs its settings", self.word)).at(self.key))?;
        Ok(NodeDe { document: self.document, id })
    }
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = Fault;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), Fault> {
        let word: StrDeserializer<'_, Fault> = self.word.into_deserializer();
        Ok((seed.deserialize(word).map_err(|f| f.at(self.key))?, self))
    }
}

impl<'de> VariantAccess<'de> for Variant<'de> {
    type Error = Fault;

    fn unit_variant(self) -> Result<(), Fault> {
        match self.body {
            None => Ok(()),
            Some(_) => {
                Err(Fault::new(format!("`{}` stands alone, without settings", self.word)).at(self.key))
            }
        }
    }
    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Fault> {
        seed.deserialize(self.body()?)
    }
    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Fault> {
        self.body()?.deserialize_any(visitor)
    }
    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        self.body()?.deserialize_any(visitor)
    }
}

/// The two elements of an [`At`]: node, then value.
struct Place<'de> {
    node: NodeDe<'de>,
    step: u8,
}

impl<'de> SeqAccess<'de> for Place<'de> {
    type Error = Fault;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Fault> {
        self.step += 1;
        match self.step {
            1 => seed.deserialize(self.node.id.0.into_deserializer()).map(Some),
            _ => seed.deserialize(self.node).map(Some),
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AtVisitor<T>(std::marker::PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for AtVisitor<T> {
            type Value = At<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a node of a document")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<At<T>, A::Error> {
                let node = access.next_element()?.map(NodeId);
                let value = access.next_element()?;
                node.zip(value)
                    .map(|(node, value)| At { node, value })
                    .ok_or_else(|| de::Error::custom("invariant: a place has two elements"))
            }
        }
        deserializer.deserialize_newtype_struct(AT, AtVisitor(std::marker::PhantomData))
    }
}

impl<'de> Deserialize<'de> for NodeId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NodeVisitor;
        impl Visitor<'_> for NodeVisitor {
            type Value = NodeId;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a node of a document")
            }
            fn visit_u32<E>(self, id: u32) -> Result<NodeId, E> {
                Ok(NodeId(id))
            }
        }
        deserializer.deserialize_newtype_struct(NODE, NodeVisitor)
    }
}
