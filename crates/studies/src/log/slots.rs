//! What the columns of a log are for: each has a slot in a row of numbers.

use std::path::Path;

use super::{ColumnRef, Columns};
use crate::Diagnostic;

/// Gyros, accelerometers, time.
pub(super) const SLOTS: usize = 7;
pub(super) const TIME: usize = 6;

/// A column and the slot that its numbers go into.
pub(super) struct Wanted<'a> {
    pub slot: usize,
    pub column: &'a ColumnRef,
}

/// Every column that is read, in the order of the slots.
pub(super) fn wanted(columns: &Columns) -> Vec<Wanted<'_>> {
    let triad = |first: usize, list: &'_ [ColumnRef]| -> Vec<usize> { (first..first + list.len()).collect() };
    let slots = [triad(0, &columns.gyro), triad(3, &columns.accel)].concat();
    let time = columns.time.iter().map(|time| Wanted { slot: TIME, column: &time.column });
    let listed = columns.gyro.iter().chain(&columns.accel);
    listed.zip(slots).map(|(column, slot)| Wanted { slot, column }).chain(time).collect()
}

/// The slot of each of the columns `titles` of a log, `None` for one that is not read. A title is empty where the
/// log names none.
pub(super) fn settle(
    file: &Path,
    wanted: &[Wanted<'_>],
    titles: &[String],
) -> Result<Vec<Option<usize>>, Diagnostic> {
    let mut slots = vec![None; titles.len()];
    for Wanted { slot, column } in wanted {
        let place = match column {
            ColumnRef::Number(number) => number.checked_sub(1).filter(|index| *index < titles.len()),
            ColumnRef::Name(name) => titles.iter().position(|title| title == name.trim()),
        };
        let problem = match place {
            None => "the log has no such column",
            Some(index) if slots[index].is_some() => "the column is named twice",
            Some(index) => {
                slots[index] = Some(*slot);
                continue;
            }
        };
        let names = if titles.iter().all(String::is_empty) { "without names".into() } else { list(titles) };
        let columns: Vec<String> = wanted.iter().map(|w| w.column.to_string()).collect();
        return Err(Diagnostic::new(file, problem)
            .path(column.to_string())
            .expected(format!("the columns {}", list(&columns)))
            .found(format!("{} columns: {names}", titles.len())));
    }
    Ok(slots)
}

/// The names of the slots, for messages.
pub(super) fn names(wanted: &[Wanted<'_>]) -> [String; SLOTS] {
    let mut names: [String; SLOTS] = Default::default();
    for Wanted { slot, column } in wanted {
        names[*slot] = column.to_string();
    }
    names
}

fn list(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
