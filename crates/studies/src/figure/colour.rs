//! Colours that stay apart for readers with any colour vision.

use super::Style;

/// An opaque colour, red, green and blue from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

impl Colour {
    /// Text and truth curves.
    pub const BLACK: Colour = Colour(0x1a, 0x1a, 0x1a);
    /// Second lines and reference curves.
    pub const GREY: Colour = Colour(0x80, 0x80, 0x80);

    /// Colour number `k` of the palette (it repeats after ten): that of Okabe and Ito (2008) without its yellow, which
    /// is too light for lines on white, and three of Paul Tol's "muted" scheme.
    pub const fn palette(k: usize) -> Colour {
        PALETTE[k % PALETTE.len()]
    }

    /// Colour number `k` of many (it repeats after 18) that stay apart from each other and from black: the palette
    /// without its black, and nine of Kelly's colours of maximum contrast (1965).
    pub const fn many(k: usize) -> Colour {
        const BLACK: usize = 6;
        let k = k % (PALETTE.len() - 1 + MORE.len());
        if k < BLACK {
            PALETTE[k]
        } else if k + 1 < PALETTE.len() {
            PALETTE[k + 1]
        } else {
            MORE[k + 1 - PALETTE.len()]
        }
    }
}

const PALETTE: [Colour; 10] = [
    Colour(0x00, 0x72, 0xb2), // blue
    Colour(0xd5, 0x5e, 0x00), // vermilion
    Colour(0x00, 0x9e, 0x73), // bluish green
    Colour(0xcc, 0x79, 0xa7), // reddish purple
    Colour(0xe6, 0x9f, 0x00), // orange
    Colour(0x56, 0xb4, 0xe9), // sky blue
    Colour(0x1a, 0x1a, 0x1a), // black
    Colour(0x88, 0x22, 0x55), // wine
    Colour(0x99, 0x99, 0x33), // olive
    Colour(0x33, 0x22, 0x88), // indigo
];

const MORE: [Colour; 9] = [
    Colour(0x8d, 0xb6, 0x00), // yellow green
    Colour(0x65, 0x45, 0x22), // yellowish brown
    Colour(0xf9, 0x93, 0x79), // yellowish pink
    Colour(0x2b, 0x3d, 0x26), // olive green
    Colour(0xa1, 0xca, 0xf1), // light blue
    Colour(0xc2, 0xb2, 0x80), // buff
    Colour(0xb3, 0x44, 0x6c), // purplish red
    Colour(0x87, 0x56, 0x92), // purple
    Colour(0xdc, 0xd3, 0x00), // greenish yellow
];

/// Style of series number `k` where the caller chose none: a new one each time the palette is used up, so that forty
/// series differ.
pub(super) fn style_of(k: usize) -> Style {
    [Style::Line, Style::Dashed, Style::DashDot, Style::Dotted][k / PALETTE.len() % 4]
}
