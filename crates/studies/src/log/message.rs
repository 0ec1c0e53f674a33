//! RAWIMU messages of a NovAtel receiver in ASCII: the row that they carry, and their checksum.
//!
//! ```text
//! %RAWIMUSA,week,seconds;week,seconds,status,z accel,-y accel,x accel,z gyro,-y gyro,x gyro*checksum
//! #RAWIMUA,port,…,version;week,seconds,status,z accel,-y accel,x accel,z gyro,-y gyro,x gyro*checksum
//! ```
//!
//! as the manual of the OEM7 receivers has them (docs.novatel.com, SPAN logs RAWIMUS and RAWIMU).

use std::ops::Range;

/// The messages that hold a sample as counts.
const NAMES: [&[u8]; 2] = [b"%RAWIMUSA,", b"#RAWIMUA,"];

/// Fields of the body from 1: seconds of the week, gyro x, -y, z, accelerometer x, -y, z.
pub const FIELDS: [usize; 7] = [2, 9, 8, 7, 6, 5, 4];

/// Where the body of `line` stands, if that is such a message.
pub(super) fn body(line: &[u8]) -> Option<Range<usize>> {
    if !NAMES.iter().any(|name| line.starts_with(name)) {
        return None;
    }
    let start = line.iter().position(|b| *b == b';')? + 1;
    let end = line[start..].iter().position(|b| *b == b'*').map_or(line.len(), |len| start + len);
    Some(start..end)
}

/// Whether the checksum at the end of `line` is that of what it stands behind; a message without one is taken as it is.
pub(super) fn is_whole(line: &[u8]) -> bool {
    let Some(star) = line.iter().position(|b| *b == b'*') else { return true };
    let written = std::str::from_utf8(line[star + 1..].trim_ascii());
    written.ok().and_then(|hex| u32::from_str_radix(hex, 16).ok()) == Some(checksum(&line[1..star]))
}

/// CRC-32 with the polynomial of Ethernet, bits reflected, beginning with zero and not inverted at the end: NovAtel's.
fn checksum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |crc, byte| TABLE[usize::from(crc as u8 ^ byte)] ^ (crc >> 8))
}

/// The checksum of each byte.
const TABLE: [u32; 256] = {
    let mut table = [0; 256];
    let mut n = 0;
    while n < 256 {
        let mut crc = n as u32;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0xEDB8_8320 } else { crc >> 1 };
            bit += 1;
        }
        table[n] = crc;
        n += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of the manual (docs.novatel.com/OEM7, RAWIMUS and RAWIMUSX), which show their checksums.
    #[test]
    fn the_manuals_examples_are_whole() {
        let short = b"%RAWIMUSA,2209,491612.254;2209,491612.253588,ea5afe00,329303960,-2512321,4410363,309705,607017,-1009773*1fb76c28";
        assert!(is_whole(short));
        assert_eq!(&short[body(short).unwrap()][..11], b"2209,491612");
        let extended = b"%RAWIMUSXA,2209,491674.014;04,41,2209,491674.013699,ea59fe00,329308016,-2706935,4508389,196192,417138,-1000837*038422a7";
        assert!(is_whole(extended));
        assert_eq!(body(extended), None);
        let mut damaged = *short;
        damaged[60] ^= 1;
        assert!(!is_whole(&damaged));
    }
}
