//! Leaves of the written form that have their own look in YAML, and the JSON Schema of the whole.

use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings, json_schema};
use schuler_imu::{Instrument, PROCESSES, ProcessKind, TERMS, Term};
use serde::{Deserialize, de};
use serde_json::{Map, Value as Json, json};

use super::{de::At, document::NodeId, written};
use crate::units;

/// A scalar of YAML that may be a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// A number without unit.
    Bare(f64),
    /// Text.
    Text(String),
}

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ScalarVisitor;
        impl de::Visitor<'_> for ScalarVisitor {
            type Value = Scalar;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a quantity: a number and its unit")
            }
            fn visit_u64<E>(self, value: u64) -> Result<Scalar, E> {
                Ok(Scalar::Bare(value as f64))
            }
            fn visit_f64<E>(self, value: f64) -> Result<Scalar, E> {
                Ok(Scalar::Bare(value))
            }
            fn visit_str<E>(self, value: &str) -> Result<Scalar, E> {
                Ok(Scalar::Text(value.into()))
            }
        }
        deserializer.deserialize_any(ScalarVisitor)
    }
}

/// A column of a log.
#[derive(Clone, Debug)]
pub enum Title {
    /// Name in the header.
    Name(String),
    /// Number from 1.
    Number(u64),
}

impl<'de> Deserialize<'de> for Title {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TitleVisitor;
        impl de::Visitor<'_> for TitleVisitor {
            type Value = Title;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("the name of a column, or its number from 1")
            }
            fn visit_u64<E>(self, number: u64) -> Result<Title, E> {
                Ok(Title::Number(number))
            }
            fn visit_str<E>(self, name: &str) -> Result<Title, E> {
                Ok(Title::Name(name.into()))
            }
        }
        deserializer.deserialize_any(TitleVisitor)
    }
}

/// One quantity, or a list.
#[derive(Clone, Debug)]
pub enum OneOrMore {
    /// One for all.
    One(Scalar),
    /// One each.
    More(Vec<At<Scalar>>),
}

impl<'de> Deserialize<'de> for OneOrMore {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMoreVisitor;
        impl<'de> de::Visitor<'de> for OneOrMoreVisitor {
            type Value = OneOrMore;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a quantity with its unit, or a list of them")
            }
            fn visit_u64<E>(self, value: u64) -> Result<OneOrMore, E> {
                Ok(OneOrMore::One(Scalar::Bare(value as f64)))
            }
            fn visit_f64<E>(self, value: f64) -> Result<OneOrMore, E> {
                Ok(OneOrMore::One(Scalar::Bare(value)))
            }
            fn visit_str<E>(self, value: &str) -> Result<OneOrMore, E> {
                Ok(OneOrMore::One(Scalar::Text(value.into())))
            }
            fn visit_seq<A: de::SeqAccess<'de>>(self, access: A) -> Result<OneOrMore, A::Error> {
                Deserialize::deserialize(de::value::SeqAccessDeserializer::new(access)).map(OneOrMore::More)
            }
        }
        deserializer.deserialize_any(OneOrMoreVisitor)
    }
}

/// One map, or a list of them.
#[derive(Debug)]
pub struct OneOrList<T>(pub Vec<T>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrList<T> {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrListVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> de::Visitor<'de> for OneOrListVisitor<T> {
            type Value = OneOrList<T>;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a map of keys, or a list of them")
            }
            fn visit_map<A: de::MapAccess<'de>>(self, access: A) -> Result<OneOrList<T>, A::Error> {
                let one = Deserialize::deserialize(de::value::MapAccessDeserializer::new(access))?;
                Ok(OneOrList(vec![one]))
            }
            fn visit_seq<A: de::SeqAccess<'de>>(self, access: A) -> Result<OneOrList<T>, A::Error> {
                Deserialize::deserialize(de::value::SeqAccessDeserializer::new(access)).map(OneOrList)
            }
        }
        deserializer.deserialize_any(OneOrListVisitor(PhantomData))
    }
}

/// Error sources of an instrument, each `- term: { process: { parameter: … } }`, read against the registries.
#[derive(Debug, Default, Deserialize)]
#[serde(transparent)]
pub struct Sources(pub Vec<NodeId>);

impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        T::schema_name()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<T>()
    }
}

impl JsonSchema for Scalar {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Quantity".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number with its unit, or a number alone where the quantity has no dimension.",
            "type": ["string", "number"],
            "examples": ["0.01 deg/h", "0.003 deg/sqrt(h)", "50 ug", "100 ppm", "24 h"],
        })
    }
}

impl JsonSchema for Title {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Column".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Name of a column in the header of the log, or its number from 1.",
            "anyOf": [{ "type": "string" }, { "type": "integer", "minimum": 1 }],
        })
    }
}

impl JsonSchema for OneOrMore {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Quantities".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<Scalar>();
        json_schema!({
            "description": "One quantity for all axes, or a list with one each.",
            "anyOf": [one, { "type": "array", "items": one }],
        })
    }
}

impl<T: JsonSchema> JsonSchema for OneOrList<T> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("{}OrList", T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        json_schema!({
            "description": "One, or a list.",
            "anyOf": [one, { "type": "array", "items": one }],
        })
    }
}

impl JsonSchema for Sources {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Sources".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let quantities = generator.subschema_for::<OneOrMore>();
        let processes: Vec<Json> = PROCESSES.iter().map(|p| process_schema(*p, &quantities)).collect();
        let terms: Vec<Json> = TERMS.iter().map(|t| term_schema(*t, &processes)).collect();
        json_schema!({
            "description": "Error sources: a term whose coefficients follow a process.",
            "type": "array",
            "items": { "oneOf": terms },
        })
    }
}

fn term_schema(term: &dyn Term, processes: &[Json]) -> Json {
    let on: Vec<&str> = term.instruments().iter().map(|i| i.name()).collect();
    let description = format!("{} ({}). {}", term.doc(), term.formula(), on.join(" and "));
    one_key(term.name(), &description, json!({ "oneOf": processes }))
}

fn process_schema(process: &dyn ProcessKind, quantities: &Schema) -> Json {
    let form = |form: &schuler_imu::process::Form| {
        let properties: Map<String, Json> = form
            .iter()
            .map(|p| {
                let example = units::example(p.unit_for(Instrument::Gyro.unit()));
                let mut schema =
                    Map::from_iter([("description".into(), json!(format!("{}, e.g. {example}", p.doc)))]);
                schema.insert("allOf".into(), json!([quantities]));
                (p.name.into(), Json::Object(schema))
            })
            .collect();
        let required: Vec<&str> = form.iter().map(|p| p.name).collect();
        json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
    };
    let forms: Vec<Json> = process.forms().iter().map(form).collect();
    one_key(process.name(), process.doc(), json!({ "oneOf": forms }))
}

fn one_key(name: &str, description: &str, body: Json) -> Json {
    json!({
        "description": description,
        "type": "object",
        "properties": { name: body },
        "required": [name],
        "additionalProperties": false,
    })
}

/// JSON Schema (draft 2020-12) of the scenario format, as text that ends with a line feed. Editors that know
/// YAML complete keys and words with it; units and ranges are checked by `schuler check`.
pub fn json_schema() -> String {
    let generator = SchemaSettings::draft2020_12().into_generator();
    let schema = generator.into_root_schema_for::<written::Scenario>();
    let mut text = serde_json::to_string_pretty(&schema).expect("invariant: a schema is a JSON value");
    text.push('\n');
    text
}
