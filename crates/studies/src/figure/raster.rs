//! PNG: drawn at three times the size and averaged down, because the library's bitmaps are not anti-aliased.

use std::path::Path;

use plotters::prelude::{BitMapBackend, Color, DrawingBackend, RGBColor};

use super::canvas::{Anchor, Canvas, Pen, Point, Type};
use super::{Colour, FigureError, PIXELS_PER_POINT, decimate, font};

/// Drawn pixels per side of a pixel of the file.
const OVERSAMPLING: usize = 3;

struct Raster<'a> {
    backend: BitMapBackend<'a>,
    size: (i32, i32),
    /// Drawn pixels per point.
    scale: f64,
}

/// Draws with `draw` and writes the file.
pub(super) fn png(
    (w, h): (u32, u32),
    path: &Path,
    draw: impl FnOnce(&mut dyn Canvas) -> Result<(), FigureError>,
) -> Result<(), FigureError> {
    let pixels = |n: u32| (f64::from(n) * PIXELS_PER_POINT).round() as usize;
    let (w, h) = (pixels(w), pixels(h));
    let (fine_w, fine_h) = (w * OVERSAMPLING, h * OVERSAMPLING);
    let mut fine = vec![255_u8; fine_w * fine_h * 3];
    let mut canvas = Raster {
        backend: BitMapBackend::with_buffer(&mut fine, (fine_w as u32, fine_h as u32)),
        size: (fine_w as i32, fine_h as i32),
        scale: PIXELS_PER_POINT * OVERSAMPLING as f64,
    };
    draw(&mut canvas)?;
    drop(canvas);
    let image = average(&fine, w, h);
    let failed = |e: &dyn std::fmt::Display| FigureError::Write { path: path.into(), reason: e.to_string() };
    let mut file = BitMapBackend::new(path, (w as u32, h as u32));
    file.blit_bitmap((0, 0), (w as u32, h as u32), &image).map_err(|e| failed(&e))?;
    file.present().map_err(|e| failed(&e))
}

/// Box filter over squares of `OVERSAMPLING` pixels, RGB, row by row.
fn average(fine: &[u8], w: usize, h: usize) -> Vec<u8> {
    const N: usize = OVERSAMPLING;
    let mut sums = vec![0_u16; w * 3];
    let mut image = Vec::with_capacity(w * h * 3);
    for rows in fine.chunks_exact(w * N * 3 * N) {
        sums.fill(0);
        for row in rows.chunks_exact(w * N * 3) {
            for (sum, square) in sums.chunks_exact_mut(3).zip(row.chunks_exact(3 * N)) {
                for pixel in square.chunks_exact(3) {
                    for c in 0..3 {
                        sum[c] += u16::from(pixel[c]);
                    }
                }
            }
        }
        let half = (N * N / 2) as u16;
        image.extend(sums.iter().map(|s| ((s + half) / (N * N) as u16) as u8));
    }
    image
}

fn refused(e: impl std::fmt::Display) -> FigureError {
    FigureError::Drawing(e.to_string())
}

fn rgb(Colour(r, g, b): Colour) -> RGBColor {
    RGBColor(r, g, b)
}

impl Raster<'_> {
    /// Fills the pixels whose centres lie in `x0..x1` × `y0..y1` (drawn pixels).
    fn fill(
        &mut self,
        (x0, x1): (f64, f64),
        (y0, y1): (f64, f64),
        colour: RGBColor,
        opacity: f64,
    ) -> Result<(), FigureError> {
        // The centre k + 1/2 lies inside if x0 <= k + 1/2 < x1; the library leaves out the second corner's row and
        // column, and swaps corners that come in the wrong order.
        let edge = |x: f64, n: i32| (x - 0.5).ceil().clamp(0.0, f64::from(n)) as i32;
        let (i0, i1) = (edge(x0, self.size.0), edge(x1, self.size.0));
        let (j0, j1) = (edge(y0, self.size.1), edge(y1, self.size.1));
        if i0 >= i1 || j0 >= j1 {
            return Ok(());
        }
        self.backend.draw_rect((i0, j0), (i1, j1), &colour.mix(opacity), true).map_err(refused)
    }

    /// A stroke between two points as spans across its steeper direction; the library's own wide lines are polygons
    /// with whole-numbered corners, which shows in flat curves.
    fn segment(&mut self, a: Point, b: Point, width: f64, colour: RGBColor) -> Result<(), FigureError> {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length = dx.hypot(dy);
        if length == 0.0 {
            return Ok(());
        }
        let flat = dx.abs() >= dy.abs();
        let (along, across, slope, limit) = if flat {
            ((a.0, b.0), a.1, dy / dx, self.size.0)
        } else {
            ((a.1, b.1), a.0, dx / dy, self.size.1)
        };
        let half = 0.5 * width * length / if flat { dx.abs() } else { dy.abs() };
        let (from, to) = (along.0.min(along.1), along.0.max(along.1));
        let first = (from - 0.5).ceil().max(0.0) as i32;
        let last = (to - 0.5).ceil().min(f64::from(limit)) as i32;
        for k in first..last {
            let middle = across + (f64::from(k) + 0.5 - along.0) * slope;
            let (span, step) = ((middle - half, middle + half), (f64::from(k), f64::from(k) + 1.0));
            if flat {
                self.fill(step, span, colour, 1.0)?;
            } else {
                self.fill(span, step, colour, 1.0)?;
            }
        }
        Ok(())
    }

    fn spot(&mut self, (x, y): Point, radius: f64, colour: RGBColor) -> Result<(), FigureError> {
        for j in (y - radius).floor() as i32..=(y + radius).ceil() as i32 {
            let middle = f64::from(j) + 0.5;
            let half = (radius * radius - (middle - y).powi(2)).max(0.0).sqrt();
            self.fill((x - half, x + half), (f64::from(j), f64::from(j) + 1.0), colour, 1.0)?;
        }
        Ok(())
    }

    fn solid(&mut self, line: &[Point], pen: Pen) -> Result<(), FigureError> {
        let width = (pen.width * self.scale).max(1.0);
        for (k, pair) in line.windows(2).enumerate() {
            let (a, b) = (self.pixels(pair[0]), self.pixels(pair[1]));
            self.segment(a, b, width, rgb(pen.colour))?;
            if k > 0 {
                self.spot(a, 0.5 * width, rgb(pen.colour))?;
            }
        }
        Ok(())
    }

    fn pixels(&self, (x, y): Point) -> Point {
        (x * self.scale, y * self.scale)
    }
}

impl Canvas for Raster<'_> {
    fn polyline(&mut self, line: &[Point], pen: Pen) -> Result<(), FigureError> {
        if pen.pattern.is_empty() {
            return self.solid(line, pen);
        }
        decimate::dashes(line, pen.pattern).iter().try_for_each(|dash| self.solid(dash, pen))
    }

    fn band(&mut self, band: &[(f64, f64, f64)], colour: Colour, opacity: f64) -> Result<(), FigureError> {
        // Column by column, so that no pixel is covered twice where two pieces meet.
        for pair in band.windows(2) {
            let ((x0, top0, low0), (x1, top1, low1)) = (pair[0], pair[1]);
            let (from, to) = (x0 * self.scale, x1 * self.scale);
            let first = (from - 0.5).ceil().max(0.0) as i32;
            let last = (to - 0.5).ceil().min(f64::from(self.size.0)) as i32;
            for k in first..last {
                let u = (f64::from(k) + 0.5 - from) / (to - from);
                let (top, low) = (top0 + u * (top1 - top0), low0 + u * (low1 - low0));
                let column = (f64::from(k), f64::from(k) + 1.0);
                self.fill(column, (top * self.scale, low * self.scale), rgb(colour), opacity)?;
            }
        }
        Ok(())
    }

    fn disc(&mut self, centre: Point, radius: f64, colour: Colour) -> Result<(), FigureError> {
        self.spot(self.pixels(centre), radius * self.scale, rgb(colour))
    }

    fn rect(&mut self, from: Point, to: Point, colour: Colour) -> Result<(), FigureError> {
        let (a, b) = (self.pixels(from), self.pixels(to));
        self.fill((a.0, b.0), (a.1, b.1), rgb(colour), 1.0)
    }

    fn text(&mut self, text: &str, kind: Type, at: Point) -> Result<(), FigureError> {
        let em = kind.size * self.scale;
        let shift = match kind.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * font::width(text, em, kind.bold),
            Anchor::End => -font::width(text, em, kind.bold),
        };
        let (x, y) = self.pixels(at);
        let (x, y) = if kind.upwards { (x, y - shift) } else { (x + shift, y) };
        let (x, y) = (x.round() as i32, y.round() as i32);
        let (w, h) = self.size;
        let mut result = Ok(());
        font::draw(text, em, kind.bold, |i, j, coverage| {
            let (px, py) = if kind.upwards { (x + j, y - i) } else { (x + i, y + j) };
            if result.is_ok() && (0..w).contains(&px) && (0..h).contains(&py) {
                let colour = rgb(kind.colour).mix(f64::from(coverage.min(1.0)));
                result = self.backend.draw_pixel((px, py), colour.to_backend_color()).map_err(refused);
            }
        });
        result
    }
}
