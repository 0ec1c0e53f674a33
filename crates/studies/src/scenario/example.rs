//! Working examples for messages, quoted from `example.yaml` and `example_motion.yaml` by the path of the key.

use super::document::{Document, NodeId, Step, Value};

impl Document {
    /// The keys of `spot` as an example shows them, or those of the nearest node above that it has.
    pub(super) fn example_near(&self, id: NodeId, key: Option<&str>) -> String {
        let mut steps: Vec<Step> = key.map(|k| Step::Key(k.into())).into_iter().collect();
        let mut at = id;
        while let Some((parent, step)) = &self.node(at).parent {
            steps.push(step.clone());
            at = *parent;
        }
        let below = |example: Document| example.nearest(&steps);
        // What is below a motion has an example of its own: a motion itself is one word or one of its kinds.
        let kinds = example(include_str!("example_motion.yaml"))
            .and_then(below)
            .filter(|(depth, text)| *depth > 1 || !text.starts_with("motion:"));
        let found = kinds.or_else(|| example(include_str!("example.yaml")).and_then(below));
        found.map(|(_, text)| text).unwrap_or_default()
    }

    /// The deepest node on the way of `steps`, which are the last first: how deep it lies, and its text.
    fn nearest(&self, steps: &[Step]) -> Option<(usize, String)> {
        let mut found = None;
        let mut node = self.root();
        for (depth, step) in steps.iter().rev().enumerate() {
            let below = match (&self.node(node).value, step) {
                (Value::Map(entries), Step::Key(key)) => {
                    entries.iter().find(|(k, _)| k.name == *key).map(|(k, id)| (k.name.clone(), *id))
                }
                (Value::List(items), Step::Item(_)) => items.first().map(|id| (String::new(), *id)),
                _ => None,
            };
            let Some((key, id)) = below else { break };
            node = id;
            let text = self.flow(id);
            found = Some((depth + 1, if key.is_empty() { text } else { format!("{key}: {text}") }));
        }
        found
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

fn example(text: &str) -> Option<Document> {
    Document::parse("example.yaml", text).ok()
}
