//! Tables as CSV: a header line, then one row a line, numbers with the shortest digits that read back.
//! Zero has no sign, and a count has no decimals.

use std::io::{self, Write};

use super::{Cell, Table, columns};

impl Table {
    /// Writes the table. Where a number is not finite the entry is empty.
    pub fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        let mut line = Vec::new();
        for (i, column) in self.columns.iter().enumerate() {
            separate(&mut line, i);
            word(&mut line, column.name());
        }
        line.push(b'\n');
        let mut buffer = zmij::Buffer::new();
        for row in 0..self.len() {
            for (i, column) in self.columns.iter().enumerate() {
                separate(&mut line, i);
                match column.cell(row) {
                    Cell::Number(x) if x.is_finite() && columns::is_count(column.name()) => {
                        line.extend_from_slice(format!("{x:.0}").as_bytes())
                    }
                    // A sum with 0 has no negative zero.
                    Cell::Number(x) if x.is_finite() => {
                        line.extend_from_slice(buffer.format_finite(x + 0.0).as_bytes())
                    }
                    Cell::Number(_) => {}
                    Cell::Word(text) => word(&mut line, text),
                }
            }
            line.push(b'\n');
            if line.len() > 1 << 16 {
                out.write_all(&line)?;
                line.clear();
            }
        }
        out.write_all(&line)
    }
}

fn separate(line: &mut Vec<u8>, index: usize) {
    if index > 0 {
        line.push(b',');
    }
}

/// A word, in quotes where it holds a separator (RFC 4180).
fn word(line: &mut Vec<u8>, text: &str) {
    if text.contains([',', '"', '\n', '\r']) {
        line.push(b'"');
        line.extend_from_slice(text.replace('"', "\"\"").as_bytes());
        line.push(b'"');
    } else {
        line.extend_from_slice(text.as_bytes());
    }
}
