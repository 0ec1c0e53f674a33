//! Units as exponents of metre, radian, second and kelvin.

use core::fmt;
use core::ops::{Div, Mul};

/// A derived SI unit: m^a · rad^b · s^(c/2) · K^d.
///
/// Time has half exponents because noise densities need them (rad/s·sqrt(s) is the SI form of
/// deg/sqrt(h)). The radian is kept as a dimension of its own so that an angular rate (rad/s) and a
/// frequency (1/s) are told apart; where a pure number is wanted, an angle is accepted too
/// ([`Unit::accepts`]): a small misalignment is both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Unit {
    /// Exponent of the metre.
    pub metre: i8,
    /// Exponent of the radian.
    pub radian: i8,
    /// Twice the exponent of the second.
    pub half_seconds: i8,
    /// Exponent of the kelvin.
    pub kelvin: i8,
}

impl Unit {
    /// A pure number.
    pub const ONE: Unit = Unit::new(0, 0, 0, 0);
    /// Metre.
    pub const METRE: Unit = Unit::new(1, 0, 0, 0);
    /// Radian.
    pub const RADIAN: Unit = Unit::new(0, 1, 0, 0);
    /// Second.
    pub const SECOND: Unit = Unit::new(0, 0, 2, 0);
    /// Hertz, 1/s.
    pub const HERTZ: Unit = Unit::new(0, 0, -2, 0);
    /// Kelvin.
    pub const KELVIN: Unit = Unit::new(0, 0, 0, 1);
    /// Angular rate, rad/s.
    pub const RATE: Unit = Unit::new(0, 1, -2, 0);
    /// Specific force, m/s².
    pub const FORCE: Unit = Unit::new(1, 0, -4, 0);

    /// m^`metre` · rad^`radian` · s^(`half_seconds`/2) · K^`kelvin`.
    pub const fn new(metre: i8, radian: i8, half_seconds: i8, kelvin: i8) -> Unit {
        Unit { metre, radian, half_seconds, kelvin }
    }

    /// Product of two units.
    pub const fn times(self, o: Unit) -> Unit {
        Unit::new(
            self.metre + o.metre,
            self.radian + o.radian,
            self.half_seconds + o.half_seconds,
            self.kelvin + o.kelvin,
        )
    }

    /// Quotient of two units.
    pub const fn over(self, o: Unit) -> Unit {
        Unit::new(
            self.metre - o.metre,
            self.radian - o.radian,
            self.half_seconds - o.half_seconds,
            self.kelvin - o.kelvin,
        )
    }

    /// This unit times s^(`halves`/2).
    pub const fn times_half_seconds(self, halves: i8) -> Unit {
        Unit::new(self.metre, self.radian, self.half_seconds + halves, self.kelvin)
    }

    /// Whether a quantity in `other` may stand where this unit is wanted: equal units, or an angle
    /// (over the same power of time) where a pure number is wanted. Not for frequencies: 1 rad/s is
    /// not 1 Hz, so compare those for equality.
    pub const fn accepts(self, other: Unit) -> bool {
        let free = self.metre == 0 && self.radian == 0 && self.kelvin == 0;
        self.metre == other.metre
            && self.half_seconds == other.half_seconds
            && self.kelvin == other.kelvin
            && (self.radian == other.radian || (free && other.radian == 1))
    }
}

impl Mul for Unit {
    type Output = Unit;
    fn mul(self, o: Unit) -> Unit {
        self.times(o)
    }
}

impl Div for Unit {
    type Output = Unit;
    fn div(self, o: Unit) -> Unit {
        self.over(o)
    }
}

/// SI text such as `rad/s`, `m/s^2`, `rad/sqrt(s)`, `m/s/sqrt(s)`; `1` for a pure number.
impl fmt::Display for Unit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let whole = [
            ("m", self.metre),
            ("rad", self.radian),
            ("s", self.half_seconds / 2),
            ("sqrt(s)", self.half_seconds % 2),
            ("K", self.kelvin),
        ];
        let mut first = true;
        for (symbol, power) in whole.iter().filter(|(_, p)| *p > 0) {
            write!(out, "{}{symbol}", if first { "" } else { "*" })?;
            write_power(out, *power)?;
            first = false;
        }
        if first {
            write!(out, "1")?;
        }
        for (symbol, power) in whole.iter().filter(|(_, p)| *p < 0) {
            write!(out, "/{symbol}")?;
            write_power(out, -power)?;
        }
        Ok(())
    }
}

fn write_power(out: &mut fmt::Formatter<'_>, power: i8) -> fmt::Result {
    if power == 1 { Ok(()) } else { write!(out, "^{power}") }
}
