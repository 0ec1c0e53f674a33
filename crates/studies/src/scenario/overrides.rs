//! `--set key.path=value`: changes of a document before anything is checked.

use std::sync::Arc;

use super::document::{Document, Key, NodeId, Step, Tree, Value, parse_tree};
use crate::{Diagnostic, Error};

impl Document {
    /// Applies `imu.gyro[0].bias.white.density=0.01 deg/sqrt(h)`; keys that are missing are added.
    pub fn set(&mut self, setting: &str) -> Result<(), Error> {
        let fault = |problem: String| {
            Diagnostic::new("--set", problem)
                .path(setting)
                .expected("a path of keys, `=`, and the new value")
                .example("--set imu.gyro[0].bias.white.density='0.01 deg/sqrt(h)'")
        };
        let (path, value) = setting.split_once('=').ok_or_else(|| fault("there is no `=`".into()))?;
        let steps = steps(path.trim()).ok_or_else(|| fault(format!("`{path}` is no path of keys")))?;
        let tree = parse_tree(value)
            .map_err(|e| fault(format!("`{value}` is not YAML: {}", e.without_snippet())))?;
        let setting = setting.into();
        let mut at = self.root();
        for (i, step) in steps.iter().enumerate() {
            let below = match &self.node(at).value {
                Value::Map(entries) => match step {
                    Step::Key(name) => entries.iter().find(|(k, _)| k.name == *name).map(|(_, id)| *id),
                    Step::Item(_) => None,
                },
                Value::List(items) => match step {
                    Step::Item(index) => items.get(*index).copied(),
                    Step::Key(_) => None,
                },
                _ => None,
            };
            at = match (below, &self.node(at).value, step) {
                (Some(below), ..) => below,
                (None, Value::Map(_) | Value::Null, Step::Key(name)) => self.insert(at, name, &setting),
                (None, ..) => {
                    let reached = self.path(at);
                    let place =
                        if reached.is_empty() { "the scenario".into() } else { format!("`{reached}`") };
                    let what = match &steps[i] {
                        Step::Key(name) => format!("key `{name}`"),
                        Step::Item(index) => format!("entry [{index}]"),
                    };
                    return Err(fault(format!("{place} has no {what}")).into());
                }
            };
        }
        self.replace(at, &tree, &setting);
        Ok(())
    }

    /// A new empty entry of a map.
    fn insert(&mut self, map: NodeId, name: &str, setting: &Arc<str>) -> NodeId {
        let id = NodeId(self.nodes.len() as u32);
        let parent = Some((map, Step::Key(name.into())));
        let node =
            super::document::Node { value: Value::Null, parent, mark: None, setting: Some(setting.clone()) };
        self.nodes.push(node);
        let entry = (Key { name: name.into(), mark: None }, id);
        let map = &mut self.nodes[map.0 as usize];
        match &mut map.value {
            Value::Map(entries) => entries.push(entry),
            _ => map.value = Value::Map(vec![entry]),
        }
        id
    }

    /// Puts `tree` in the place of the node `at`, which keeps its number.
    fn replace(&mut self, at: NodeId, tree: &Tree, setting: &Arc<str>) {
        let parent = self.node(at).parent.clone();
        let new = self.add(tree, parent, Some(setting));
        let mut node = self.nodes[new.0 as usize].clone();
        // The children were hung below `new`; from now on `at` is their parent.
        let children: Vec<NodeId> = match &node.value {
            Value::List(items) => items.clone(),
            Value::Map(entries) => entries.iter().map(|(_, id)| *id).collect(),
            _ => Vec::new(),
        };
        for child in children {
            if let Some((parent, _)) = &mut self.nodes[child.0 as usize].parent {
                *parent = at;
            }
        }
        std::mem::swap(&mut self.nodes[at.0 as usize], &mut node);
    }
}

/// `imu.gyro[0].bias`, `imu.gyro.0.bias` as steps.
fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (key, indices) = part.split_at(part.find('[').unwrap_or(part.len()));
        match key.parse() {
            Ok(index) if !steps.is_empty() => steps.push(Step::Item(index)),
            _ if key.is_empty() => return None,
            _ => steps.push(Step::Key(key.into())),
        }
        let mut indices = indices;
        while !indices.is_empty() {
            let (index, rest) = indices.strip_prefix('[')?.split_once(']')?;
            steps.push(Step::Item(index.parse().ok()?));
            indices = rest;
        }
    }
    Some(steps)
}
