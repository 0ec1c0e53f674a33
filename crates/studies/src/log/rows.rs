//! A text as rows of fields.

use std::io::{self, BufRead, Read};

/// A longer row is no row of numbers: a file without line feeds must not fill the memory.
const LONGEST: u64 = 1 << 16;

/// Reads line by line. Empty lines and lines that begin with `#` are skipped.
pub(super) struct Rows {
    text: Box<dyn BufRead + Send>,
    line: Vec<u8>,
    number: u64,
    /// Between two fields: the first of comma, semicolon and tab that the first row has.
    separator: u8,
}

impl Rows {
    pub fn new(text: Box<dyn BufRead + Send>) -> Self {
        Rows { text, line: Vec::new(), number: 0, separator: b',' }
    }

    /// Goes to the next row; false at the end of the text.
    pub fn advance(&mut self) -> io::Result<bool> {
        loop {
            self.line.clear();
            let taken = self.text.by_ref().take(LONGEST).read_until(b'\n', &mut self.line)?;
            self.number += 1;
            if taken == 0 {
                return Ok(false);
            }
            if taken as u64 == LONGEST {
                return Err(io::Error::other("a row of more than 64 kB: is this a text file?"));
            }
            while let [.., b'\n' | b'\r'] = self.line[..] {
                self.line.pop();
            }
            if self.number == 1 && self.line.starts_with(b"\xef\xbb\xbf") {
                // The byte order mark that some programs write.
                self.line.drain(..3);
            }
            if !self.line.trim_ascii().is_empty() && self.line[0] != b'#' {
                return Ok(true);
            }
        }
    }

    /// Settles what separates fields, from the current row.
    pub fn settle_separator(&mut self) {
        let found = [b',', b';', b'\t'].into_iter().find(|s| self.line.contains(s));
        self.separator = found.unwrap_or(b',');
    }

    pub fn separator(&self) -> u8 {
        self.separator
    }

    /// Number of the current line, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// The current row without its line end.
    pub fn line(&self) -> &[u8] {
        &self.line
    }

    /// The fields of the current row, as they stand.
    pub fn fields(&self) -> impl Iterator<Item = &[u8]> {
        self.line.split(|b| *b == self.separator)
    }
}
