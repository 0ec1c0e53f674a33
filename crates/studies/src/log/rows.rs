//! A text as rows of fields.

use std::io::{self, BufRead, Read};
use std::ops::Range;

use super::message;

/// A longer row is no row of numbers: a file without line feeds must not fill the memory.
const LONGEST: u64 = 1 << 16;

/// Separates fields by runs of blanks and tabs.
pub(super) const BLANK: u8 = b' ';

/// Reads line by line. Empty lines and lines that begin with `#`, `%` or `$` are skipped, but for messages that hold a
/// sample of an IMU: of them the row is what they carry.
pub(super) struct Rows {
    text: Box<dyn BufRead + Send>,
    line: Vec<u8>,
    /// The part of the line that is the row.
    row: Range<usize>,
    number: u64,
    /// Between two fields: the first of comma, semicolon and tab that the first row has, or blanks.
    separator: u8,
    /// Whether the message that the row is of fits its checksum.
    whole: bool,
}

impl Rows {
    pub fn new(text: Box<dyn BufRead + Send>) -> Self {
        Rows { text, line: Vec::new(), row: 0..0, number: 0, separator: b',', whole: true }
    }

    /// Goes to the next row; false at the end of the text.
    pub fn advance(&mut self) -> io::Result<bool> {
        loop {
            self.line.clear();
            let taken = self.text.by_ref().take(LONGEST).read_until(b'\n', &mut self.line)?;
            self.number += 1;
            if taken == 0 {
                self.row = 0..0;
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
            self.row = 0..self.line.len();
            match self.line.first() {
                Some(b'#' | b'%' | b'$') => {
                    if let Some(body) = message::body(&self.line) {
                        self.row = body;
                        self.whole = message::is_whole(&self.line);
                        return Ok(true);
                    }
                }
                Some(_) if !self.line.trim_ascii().is_empty() => return Ok(true),
                _ => {}
            }
        }
    }

    /// Settles what separates fields, from the current row. Blanks do so in a row of numbers alone: names may have some.
    pub fn settle_separator(&mut self) {
        let row = self.line();
        let found = [b',', b';', b'\t'].into_iter().find(|s| row.contains(s));
        self.separator = found.unwrap_or_else(|| {
            let mut words = row.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            let number =
                |word: &[u8]| std::str::from_utf8(word).is_ok_and(|word| word.parse::<f64>().is_ok());
            if words.clone().count() > 1 && words.all(number) { BLANK } else { b',' }
        });
    }

    pub fn separator(&self) -> u8 {
        self.separator
    }

    /// Number of the current line, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// The current row without its line end and without what a message has around it.
    pub fn line(&self) -> &[u8] {
        &self.line[self.row.clone()]
    }

    /// The whole line that the current row is of, and where in it the row begins.
    pub fn around(&self) -> (&[u8], usize) {
        (&self.line, self.row.start)
    }

    /// Whether the current row is as its message was sent.
    pub fn is_whole(&self) -> bool {
        self.whole
    }

    /// Where the fields of the current row stand in it.
    pub fn spans(&self) -> impl Iterator<Item = Range<usize>> {
        let (row, blank) = (self.line(), self.separator == BLANK);
        let mut at = if blank { blanks(row) } else { 0 };
        let mut done = false;
        std::iter::from_fn(move || {
            if done {
                return None;
            }
            let start = at;
            let end = row[start..].iter().position(|b| self.ends(*b)).map_or(row.len(), |len| start + len);
            at = if blank { end + blanks(&row[end..]) } else { end + 1 };
            done = if blank { at >= row.len() } else { end >= row.len() };
            Some(start..end)
        })
    }

    /// Whether a field ends before this byte.
    #[inline]
    pub fn ends(&self, byte: u8) -> bool {
        byte == self.separator || (self.separator == BLANK && byte == b'\t')
    }

    /// The fields of the current row, as they stand.
    pub fn fields(&self) -> impl Iterator<Item = &[u8]> {
        self.spans().map(|span| &self.line()[span])
    }
}

/// Number of blanks and tabs that `text` begins with.
pub(super) fn blanks(text: &[u8]) -> usize {
    text.iter().take_while(|b| matches!(b, b' ' | b'\t')).count()
}
