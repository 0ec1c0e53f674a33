//! The embedded font: widths and glyphs.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont};

/// Family name for SVG viewers, most similar first.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

fn font(bold: bool) -> FontRef<'static> {
    let bytes: &[u8] = if bold {
        include_bytes!("fonts/DejaVuSans-Bold-subset.ttf")
    } else {
        include_bytes!("fonts/DejaVuSans-subset.ttf")
    };
    FontRef::try_from_slice(bytes).expect("invariant: the embedded font is a valid TrueType file")
}

/// `ab_glyph` scales by the height of the face; here sizes are those of the em.
fn scale(font: &FontRef, em: f64) -> PxScale {
    let units = font.units_per_em().expect("invariant: the embedded font states its em");
    PxScale::from(em as f32 * font.height_unscaled() / units)
}

/// Width of `text` at em size `em`, in the unit of `em`.
pub(super) fn width(text: &str, em: f64, bold: bool) -> f64 {
    let font = font(bold);
    let scaled = font.as_scaled(scale(&font, em));
    text.chars().map(|c| f64::from(scaled.h_advance(font.glyph_id(c)))).sum()
}

/// Calls `pixel(x, y, coverage)` for every pixel of `text` set at em size `em` (pixels) from the baseline origin.
pub(super) fn draw(text: &str, em: f64, bold: bool, mut pixel: impl FnMut(i32, i32, f32)) {
    let font = font(bold);
    let scale = scale(&font, em);
    let mut x = 0.0;
    for c in text.chars() {
        let id = font.glyph_id(c);
        let advance = font.as_scaled(scale).h_advance(id);
        let glyph = id.with_scale_and_position(scale, ab_glyph::point(x, 0.0));
        if let Some(outline) = font.outline_glyph(glyph) {
            let corner = outline.px_bounds().min;
            outline.draw(|i, j, coverage| {
                pixel(corner.x as i32 + i as i32, corner.y as i32 + j as i32, coverage)
            });
        }
        x += advance;
    }
}

/// Breaks `text` at spaces into lines no wider than `room`; a longer word stands alone.
pub(super) fn wrap(text: &str, em: f64, bold: bool, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line, em, bold) + width(" ", em, bold) + width(word, em, bold) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

/// `text`, shortened with an ellipsis until it is no wider than `room`.
pub(super) fn fit(text: &str, em: f64, bold: bool, room: f64) -> String {
    if width(text, em, bold) <= room {
        return text.to_string();
    }
    let mut kept: Vec<char> = text.chars().collect();
    while kept.pop().is_some() {
        let short: String = kept.iter().collect::<String>().trim_end().to_string() + "…";
        if width(&short, em, bold) <= room {
            return short;
        }
    }
    String::new()
}
