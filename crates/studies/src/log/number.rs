//! Decimal numbers at the start of a row, fast where that is exact.

/// Powers of ten that `f64` has exactly.
const EXACT: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// The number that `text` begins with and the bytes it takes, correctly rounded; `None` where that cannot be told by
/// one multiplication or division, so that the caller must ask the standard library.
///
/// A mantissa below 2^53 and a power of ten up to 22 are both exact in `f64`, so their product or quotient is rounded
/// once (Clinger 1990). Numbers of logs are nearly all of this kind.
#[inline]
pub(super) fn leading(text: &[u8]) -> Option<(f64, usize)> {
    let mut at = 0;
    let negative = match text.first() {
        Some(b'-') => {
            at = 1;
            true
        }
        _ => false,
    };
    let mut mantissa: u64 = 0;
    let mut digits = 0;
    let mut power: i32 = 0;
    while let Some(digit @ 0..=9) = text.get(at).map(|b| b.wrapping_sub(b'0')) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        digits += 1;
        at += 1;
    }
    if text.get(at) == Some(&b'.') {
        at += 1;
        let fraction = at;
        while let Some(digit @ 0..=9) = text.get(at).map(|b| b.wrapping_sub(b'0')) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
            at += 1;
        }
        digits += at - fraction;
        power = -((at - fraction) as i32);
    }
    // Up to nineteen digits the sum did not wrap.
    if digits == 0 || digits > 19 || mantissa >= 1 << 53 {
        return None;
    }
    if let Some(b'e' | b'E') = text.get(at) {
        at += 1;
        let down = match text.get(at) {
            Some(sign @ (b'-' | b'+')) => {
                at += 1;
                *sign == b'-'
            }
            _ => false,
        };
        let first = at;
        let mut exponent: i32 = 0;
        while let Some(digit @ 0..=9) = text.get(at).map(|b| b.wrapping_sub(b'0')) {
            exponent = (exponent * 10 + i32::from(digit)).min(1000);
            at += 1;
        }
        if at == first {
            return None;
        }
        power += if down { -exponent } else { exponent };
    }
    let scale = *EXACT.get(power.unsigned_abs() as usize)?;
    let size = if power < 0 { mantissa as f64 / scale } else { mantissa as f64 * scale };
    Some((if negative { -size } else { size }, at))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::leading;

    /// The standard library rounds correctly; what `leading` gives must be the same bits, or nothing.
    fn same(text: &str) -> bool {
        match leading(text.as_bytes()) {
            Some((value, used)) => {
                text[..used].parse::<f64>().is_ok_and(|oracle| oracle.to_bits() == value.to_bits())
            }
            None => true,
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn equals_the_standard_library(text in "-?[0-9]{0,19}(\\.[0-9]{0,12})?([eE][-+]?[0-9]{1,3})?[,x ]?") {
            prop_assert!(same(&text), "{}", text);
        }

        #[test]
        fn equals_it_on_printed_numbers(value in any::<f64>(), decimals in 0..18_usize) {
            let printed = [
                format!("{value}"),
                format!("{value:.decimals$e}"),
                format!("{:.decimals$}", value % 1e6),
            ];
            for text in printed {
                prop_assert!(same(&text), "{}", text);
            }
        }
    }

    #[test]
    fn takes_the_usual_forms_itself() {
        for (text, value) in [
            ("0", 0.0),
            ("-12,", -12.0),
            ("8.627579352e-02,", 0.08627579352),
            ("1.5E3", 1500.0),
            ("-.5", -0.5),
        ] {
            let (found, used) = leading(text.as_bytes()).unwrap();
            assert_eq!((found, used), (value, text.trim_end_matches(',').len()), "{text}");
        }
        for text in ["", "-", "nan", "e5", "1e", ",", "+1"] {
            assert_eq!(leading(text.as_bytes()), None, "{text}");
        }
    }
}
