//! Working examples for messages, quoted from `example.yaml` by the path of the key.

use super::document::{Document, NodeId, Step, Value};

impl Document {
    /// The keys of `spot` as an example shows them, or those of the nearest node above that it has.
    pub(super) fn example_near(&self, id: NodeId, key: Option<&str>) -> String {
        let Some(example) = example() else { return String::new() };
        let mut steps: Vec<Step> = key.map(|k| Step::Key(k.into())).into_iter().collect();
        let mut at = id;
        while let Some((parent, step)) = &self.node(at).parent {
            steps.push(step.clone());
            at = *parent;
        }
        let mut found = None;
        let mut node = example.root();
        for step in steps.iter().rev() {
            let below = match (&example.node(node).value, step) {
                (Value::Map(entries), Step::Key(key)) => {
                    entries.iter().find(|(k, _)| k.name == *key).map(|(k, id)| (k.name.clone(), *id))
                }
                (Value::List(items), Step::Item(_)) => items.first().map(|id| (String::new(), *id)),
                _ => None,
            };
            let Some((key, id)) = below else { break };
            node = id;
            let text = example.flow(id);
            found = Some(if key.is_empty() { text } else { format!("{key}: {text}") });
        }
        found.unwrap_or_default()
    }

    /// A node in flow style.
    fn flow(&self, id: NodeId) -> String {
        match &self.node(id).value {
            Value::Null => "~".into(),
            Value::Bool(value) => value.to_string(),
            Value::Whole(value) => value.to_string(),
            Value::Number(value) => value.to_string(),
            Value::Text(text) => text.clone(),
            Value::List(items) => {
                let items: Vec<String> = items.iter().map(|item| self.flow(*item)).collect();
                format!("[{}]", items.join(", "))
            }
            Value::Map(entries) => {
                let entries: Vec<String> = entries
                    .iter()
                    .map(|(key, value)| format!("{}: {}", key.name, self.flow(*value)))
                    .collect();
                format!("{{ {} }}", entries.join(", "))
            }
        }
    }
}

fn example() -> Option<Document> {
    Document::parse("example.yaml", include_str!("example.yaml")).ok()
}
