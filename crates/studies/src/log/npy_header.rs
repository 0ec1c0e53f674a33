//! The header of an npy file.
//!
//! Its format: six bytes of magic, two of version, the length of the text (2 bytes in version 1, 4 after), and the text:
//! a Python dictionary with `descr`, `fortran_order` and `shape`
//! (numpy.org/doc/stable/reference/generated/numpy.lib.format.html). Read here and not by a crate: those that read it
//! bring a parser generator that wants a C compiler, and their messages have no place.

use std::io::{BufRead, Read};
use std::path::Path;

use super::fault;
use crate::{Diagnostic, Error};

/// What the header says.
pub(super) struct Header {
    /// Bytes before the first row.
    pub start: u64,
    /// Bytes a row.
    pub width: usize,
    pub rows: u64,
    /// The columns.
    pub fields: Vec<Field>,
}

/// A column of the array.
#[derive(Clone, Debug)]
pub(super) struct Field {
    /// Empty where the array has no names.
    pub name: String,
    pub kind: Kind,
    /// Bytes before it in a row.
    pub offset: usize,
}

/// Numbers that are read, all little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    F8,
    F4,
    I8,
    I4,
    I2,
}

const MAGIC: &[u8] = b"\x93NUMPY";
/// A longer header is no header of a table.
const LONGEST: u64 = 1 << 20;
/// More columns than a log has.
const MOST_COLUMNS: u64 = 10_000;
/// A list of tuples in a dictionary, and one level more.
const DEPTH: u8 = 4;
const EXPECTED: &str =
    "a C-ordered array of shape (rows, columns) of little-endian float64, float32, int64, int32 or int16";
const EXAMPLE: &str = "numpy.save('log.npy', numpy.ascontiguousarray(log, dtype='<f8'))";

/// Reads the header of `file` from its `bytes`.
pub(super) fn read(file: &Path, bytes: &mut dyn BufRead) -> Result<Header, Error> {
    let mut take = |size: u64| -> Result<Vec<u8>, Error> {
        let mut part = Vec::new();
        let taken = bytes.take(size).read_to_end(&mut part).map_err(|e| fault::reading(file, 0, e))?;
        match taken as u64 == size {
            true => Ok(part),
            false => Err(Diagnostic::new(file, "the header of the array is cut off").into()),
        }
    };
    let head = take(8)?;
    if !head.starts_with(MAGIC) {
        return Err(Diagnostic::new(file, "neither text nor an npy file")
            .expected("CSV or npy, either also gzipped")
            .into());
    }
    let size = take(if head[6] == 1 { 2 } else { 4 })?;
    let length = size.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte));
    if !matches!(head[6], 1..=3) || length > LONGEST {
        return Err(wrong(file, "an npy version or header that is not known")
            .found(format!("version {}.{}, {length} bytes of header", head[6], head[7]))
            .into());
    }
    let text = String::from_utf8_lossy(&take(length)?).into_owned();
    let mut header = parse(&text).map_err(|problem| {
        wrong(file, problem).found(format!("`{}`", text.trim().chars().take(120).collect::<String>()))
    })?;
    header.start = 8 + size.len() as u64 + length;
    Ok(header)
}

fn wrong(file: &Path, problem: impl Into<String>) -> Diagnostic {
    Diagnostic::new(file, problem).expected(EXPECTED).example(EXAMPLE)
}

fn parse(text: &str) -> Result<Header, String> {
    let unreadable = || "the header of the array cannot be read".to_string();
    let Some(Python::List(entries)) = Parser(text).value(DEPTH) else { return Err(unreadable()) };
    let entry = |name: &str| {
        let mut pairs = entries.as_chunks::<2>().0.iter();
        pairs.find(|pair| pair[0] == Python::Text(name.into())).map(|pair| &pair[1]).ok_or_else(unreadable)
    };
    let Python::List(shape) = entry("shape")? else { return Err(unreadable()) };
    let shape: Vec<u64> = shape.iter().filter_map(Python::number).collect();
    let (rows, columns) = match shape[..] {
        [rows] => (rows, 1),
        [rows, columns] => (rows, columns),
        _ => return Err(format!("an array of {} dimensions", shape.len())),
    };
    if columns > 1 && *entry("fortran_order")? != Python::Word("False".into()) {
        return Err("an array in Fortran order: its rows do not stand together".into());
    }
    let mut fields = Vec::new();
    let mut width = 0;
    let mut push = |name: &str, descr: &str| {
        let kind = Kind::of(descr).ok_or_else(|| format!("numbers of type `{descr}`"))?;
        fields.push(Field { name: name.into(), kind, offset: width });
        width += kind.size();
        Ok::<(), String>(())
    };
    match entry("descr")? {
        Python::Text(descr) => {
            if !(1..=MOST_COLUMNS).contains(&columns) {
                return Err(format!("an array of {columns} columns"));
            }
            for _ in 0..columns {
                push("", descr)?;
            }
        }
        Python::List(records) if columns == 1 => {
            for record in records {
                match record {
                    Python::List(parts) => match &parts[..] {
                        [Python::Text(name), Python::Text(descr)] => push(name, descr)?,
                        _ => return Err("a record field that is no single number".into()),
                    },
                    _ => return Err(unreadable()),
                }
            }
        }
        _ => return Err("a table of records".into()),
    }
    if fields.is_empty() {
        return Err("records without fields".into());
    }
    Ok(Header { start: 0, width, rows, fields })
}

impl Kind {
    fn of(descr: &str) -> Option<Kind> {
        match descr {
            "<f8" => Some(Kind::F8),
            "<f4" => Some(Kind::F4),
            "<i8" => Some(Kind::I8),
            "<i4" => Some(Kind::I4),
            "<i2" => Some(Kind::I2),
            _ => None,
        }
    }

    fn size(self) -> usize {
        match self {
            Kind::F8 | Kind::I8 => 8,
            Kind::F4 | Kind::I4 => 4,
            Kind::I2 => 2,
        }
    }
}

/// What stands in a header. A dictionary is a list of keys and values in turn.
#[derive(Clone, Debug, PartialEq)]
enum Python {
    Text(String),
    Word(String),
    List(Vec<Python>),
}

impl Python {
    fn number(&self) -> Option<u64> {
        match self {
            Python::Word(word) => word.trim_end_matches('L').parse().ok(),
            _ => None,
        }
    }
}

/// What is left of the text.
struct Parser<'a>(&'a str);

impl Parser<'_> {
    fn value(&mut self, depth: u8) -> Option<Python> {
        self.0 = self.0.trim_start();
        let first = self.0.chars().next()?;
        match first {
            '\'' | '"' => {
                let (text, rest) = self.0[1..].split_once(first)?;
                self.0 = rest;
                Some(Python::Text(text.into()))
            }
            '{' | '[' | '(' => {
                self.0 = &self.0[1..];
                let mut list = Vec::new();
                loop {
                    self.0 = self.0.trim_start_matches([' ', '\n', ',', ':']);
                    if let Some(rest) = self.0.strip_prefix(['}', ']', ')']) {
                        self.0 = rest;
                        return Some(Python::List(list));
                    }
                    list.push(self.value(depth.checked_sub(1)?)?);
                }
            }
            _ => {
                let end = self.0.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(self.0.len());
                let (word, rest) = self.0.split_at(end);
                self.0 = rest;
                (!word.is_empty()).then(|| Python::Word(word.into()))
            }
        }
    }
}
