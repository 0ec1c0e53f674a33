//! The parser of quantities and units.

use schuler_imu::Unit;

use super::{Quantity, symbols::SYMBOLS};

/// Why a text is no quantity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UnitError {
    /// Does not begin with a number.
    #[error("does not begin with a number")]
    NoNumber,
    /// Infinite, not a number, or too large for a double.
    #[error("the number is not finite")]
    NotFinite,
    /// A symbol that is no unit, with the nearest one that is.
    #[error("unknown unit `{symbol}`")]
    UnknownSymbol {
        /// The symbol.
        symbol: String,
        /// One of similar spelling.
        similar: Option<&'static str>,
    },
    /// The unit does not follow the grammar.
    #[error("the unit breaks off at `{rest}`")]
    Syntax {
        /// What is left there; `end` at the end.
        rest: String,
    },
    /// The powers of the unit leave the range of a unit, or the root of an odd quarter power of time was taken.
    #[error("no quantity has such a unit")]
    Power,
}

/// Parses `0.01 deg/h`; a bare number has the unit one.
pub fn parse_quantity(text: &str) -> Result<Quantity, UnitError> {
    let text = text.trim();
    let (number, rest) = text.split_at(number_length(text));
    let number: f64 = number.parse().map_err(|_| UnitError::NoNumber)?;
    let (factor, unit) = match rest.trim() {
        "" => (Factor::ONE, Unit::ONE),
        rest => parse_factor(rest)?,
    };
    let value = number * factor.up / factor.down;
    if !value.is_finite() {
        return Err(UnitError::NotFinite);
    }
    Ok(Quantity { value, unit })
}

/// Parses `deg/sqrt(h)` into its factor to SI and its unit.
pub fn parse_unit(text: &str) -> Result<(f64, Unit), UnitError> {
    let (factor, unit) = parse_factor(text.trim())?;
    Ok((factor.up / factor.down, unit))
}

/// Longest unit: a bound on the depth of brackets, so that no text exhausts the stack.
const MAX_UNIT: usize = 100;

fn parse_factor(text: &str) -> Result<(Factor, Unit), UnitError> {
    if text.len() > MAX_UNIT {
        return Err(UnitError::Syntax { rest: text.chars().take(20).collect() });
    }
    let mut parser = Parser { rest: text };
    let (factor, powers) = parser.product()?;
    match parser.rest {
        "" => Ok((factor, powers.unit()?)),
        _ => Err(parser.syntax()),
    }
}

/// Length of the decimal number at the beginning of `text`. The `e` of an exponent needs digits after it.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut n = usize::from(text.starts_with(['+', '-']));
    n += digits(n);
    if text[n..].starts_with('.') {
        n += 1 + digits(n + 1);
    }
    if text[n..].starts_with(['e', 'E']) {
        let sign = usize::from(text[n + 1..].starts_with(['+', '-']));
        match digits(n + 1 + sign) {
            0 => {}
            exponent => n += 1 + sign + exponent,
        }
    }
    n
}

/// A factor to SI as a quotient.
#[derive(Clone, Copy)]
struct Factor {
    up: f64,
    down: f64,
}

impl Factor {
    const ONE: Factor = Factor { up: 1.0, down: 1.0 };

    fn map(self, f: impl Fn(f64) -> f64) -> Factor {
        Factor { up: f(self.up), down: f(self.down) }
    }
}

/// Exponents in quarters, wide enough for every text of sane length, so that the root of `s^(1/2)` is
/// refused at the end and not in the middle.
#[derive(Clone, Copy, Default)]
struct Powers([i32; 4]);

impl Powers {
    fn of(unit: Unit) -> Powers {
        Powers(
            [unit.metre.into(), unit.radian.into(), i32::from(unit.half_seconds), unit.kelvin.into()]
                .map(|p| p * 4),
        )
    }

    fn map(self, f: impl Fn(i32) -> Option<i32>) -> Result<Powers, UnitError> {
        let mut powers = self;
        for p in &mut powers.0 {
            *p = f(*p).ok_or(UnitError::Power)?;
        }
        Ok(powers)
    }

    fn unit(self) -> Result<Unit, UnitError> {
        let mut whole = [0; 4];
        for (w, p) in whole.iter_mut().zip(self.0) {
            let exact = (p % 4 == 0).then_some(p / 4).ok_or(UnitError::Power)?;
            *w = i8::try_from(exact).map_err(|_| UnitError::Power)?;
        }
        let [metre, radian, half_seconds, kelvin] = whole;
        Ok(Unit { metre, radian, half_seconds, kelvin })
    }
}

struct Parser<'a> {
    rest: &'a str,
}

impl Parser<'_> {
    fn syntax(&self) -> UnitError {
        let rest = if self.rest.is_empty() { "end" } else { self.rest };
        UnitError::Syntax { rest: rest.into() }
    }

    fn take(&mut self, token: &str) -> bool {
        let found = self.rest.strip_prefix(token);
        self.rest = found.unwrap_or(self.rest);
        found.is_some()
    }

    fn skip_spaces(&mut self) {
        self.rest = self.rest.trim_start();
    }

    /// factor { ("*" | "·" | " " | "/") factor }
    fn product(&mut self) -> Result<(Factor, Powers), UnitError> {
        let (mut factor, mut powers) = self.power()?;
        loop {
            self.skip_spaces();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok((factor, powers));
            }
            let over = self.take("/");
            if !over && !self.take("*") {
                self.take("·");
            }
            self.skip_spaces();
            let (f, p) = self.power()?;
            let (up, down) = if over { (f.down, f.up) } else { (f.up, f.down) };
            factor = Factor { up: factor.up * up, down: factor.down * down };
            for (a, b) in powers.0.iter_mut().zip(p.0) {
                *a = if over { a.checked_sub(b) } else { a.checked_add(b) }.ok_or(UnitError::Power)?;
            }
        }
    }

    /// atom [ "^" integer | "²" | "³" ]
    fn power(&mut self) -> Result<(Factor, Powers), UnitError> {
        let (factor, powers) = self.atom()?;
        let exponent = if self.take("²") {
            2
        } else if self.take("³") {
            3
        } else if self.take("^") {
            let end = usize::from(self.rest.starts_with('-'));
            let end = end + self.rest[end..].bytes().take_while(u8::is_ascii_digit).count();
            let exponent = self.rest[..end].parse::<i8>().map_err(|_| self.syntax())?;
            self.rest = &self.rest[end..];
            exponent
        } else {
            return Ok((factor, powers));
        };
        Ok((factor.map(|x| x.powi(exponent.into())), powers.map(|p| p.checked_mul(exponent.into()))?))
    }

    /// "sqrt(" product ")" | "√" atom | "(" product ")" | symbol
    fn atom(&mut self) -> Result<(Factor, Powers), UnitError> {
        if self.take("√") {
            let (factor, powers) = self.atom()?;
            return root(factor, powers);
        }
        let sqrt = self.take("sqrt(");
        if sqrt || self.take("(") {
            let (factor, powers) = self.product()?;
            return match (self.take(")"), sqrt) {
                (false, _) => Err(self.syntax()),
                (true, false) => Ok((factor, powers)),
                (true, true) => root(factor, powers),
            };
        }
        self.symbol()
    }

    fn symbol(&mut self) -> Result<(Factor, Powers), UnitError> {
        let end =
            self.rest.find(|c: char| "/*·^²³()√".contains(c) || c.is_whitespace()).unwrap_or(self.rest.len());
        let (symbol, rest) = self.rest.split_at(end);
        if symbol.is_empty() {
            return Err(self.syntax());
        }
        // U+03BC, the Greek letter, beside U+00B5, the micro sign: keyboards give either.
        let spelled = symbol.replace('μ', "µ");
        let Some(&(_, up, down, unit)) = SYMBOLS.iter().find(|s| s.0 == spelled) else {
            let similar = crate::similar::similar(&spelled, SYMBOLS.iter().map(|s| s.0));
            return Err(UnitError::UnknownSymbol { symbol: symbol.into(), similar });
        };
        self.rest = rest;
        Ok((Factor { up, down }, Powers::of(unit)))
    }
}

fn root(factor: Factor, powers: Powers) -> Result<(Factor, Powers), UnitError> {
    Ok((factor.map(f64::sqrt), powers.map(|p| (p % 2 == 0).then_some(p / 2))?))
}
