//! From millions of points to what the eye can see, and from a line to its dashes.

use super::canvas::Point;
use super::map::Map;

/// Width of a column in points within which a run of points is reduced to first, lowest, highest and last: finer than
/// a drawn pixel's neighbourhood can show.
const COLUMN: f64 = 0.3;

/// Pieces of the curve in points, without gaps, cut to the rectangle of the panel.
pub(super) fn pieces(points: &[[f64; 2]], x: &Map, y: &Map) -> Vec<Vec<Point>> {
    let mut all = Vec::new();
    let mut piece = Reducer::default();
    for p in points {
        match (x.at(p[0]), y.at(p[1])) {
            (Some(px), Some(py)) => piece.push((px, py)),
            _ => all.extend(piece.take()),
        }
    }
    all.extend(piece.take());
    all.iter().flat_map(|line| cut(line, x.points, y.points)).collect()
}

/// Keeps the first, lowest, highest and last point of each run within a column, in their order.
#[derive(Default)]
struct Reducer {
    line: Vec<Point>,
    /// Number of the column and the run's first point, lowest, highest and last.
    run: Option<(i64, [Point; 4])>,
    /// The lowest came before the highest.
    rising: bool,
}

impl Reducer {
    fn push(&mut self, p: Point) {
        let column = (p.0 / COLUMN).floor() as i64;
        match &mut self.run {
            Some((c, [_, low, high, last])) if *c == column => {
                if p.1 < low.1 {
                    *low = p;
                    self.rising = false;
                }
                if p.1 > high.1 {
                    *high = p;
                    self.rising = true;
                }
                *last = p;
            }
            _ => {
                self.flush();
                self.run = Some((column, [p; 4]));
            }
        }
    }

    fn flush(&mut self) {
        if let Some((_, [first, low, high, last])) = self.run.take() {
            let (a, b) = if self.rising { (low, high) } else { (high, low) };
            for p in [first, a, b, last] {
                if self.line.last() != Some(&p) {
                    self.line.push(p);
                }
            }
        }
    }

    fn take(&mut self) -> Option<Vec<Point>> {
        self.flush();
        let line = std::mem::take(&mut self.line);
        (!line.is_empty()).then_some(line)
    }
}

/// The parts of a line inside a rectangle (Liang and Barsky 1984). A single point inside stays a single point.
fn cut(line: &[Point], xs: [f64; 2], ys: [f64; 2]) -> Vec<Vec<Point>> {
    let (left, right) = (xs[0].min(xs[1]), xs[0].max(xs[1]));
    let (top, bottom) = (ys[0].min(ys[1]), ys[0].max(ys[1]));
    let inside = |p: &Point| p.0 >= left && p.0 <= right && p.1 >= top && p.1 <= bottom;
    if line.iter().all(inside) {
        return vec![line.to_vec()];
    }
    let mut parts: Vec<Vec<Point>> = Vec::new();
    for pair in line.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let (dx, dy) = (x1 - x0, y1 - y0);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (p, q) in [(-dx, x0 - left), (dx, right - x0), (-dy, y0 - top), (dy, bottom - y0)] {
            match p {
                0.0 if q < 0.0 => leave = -1.0,
                0.0 => {}
                p if p < 0.0 => enter = enter.max(q / p),
                p => leave = leave.min(q / p),
            }
        }
        if enter > leave {
            continue;
        }
        let at = |u: f64| (x0 + u * dx, y0 + u * dy);
        match parts.last_mut() {
            Some(part) if enter == 0.0 && part.last() == Some(&pair[0]) => part.push(at(leave)),
            _ => parts.push(vec![at(enter), at(leave)]),
        }
    }
    parts
}

/// The strokes of a dashed line: `pattern` is lengths of stroke, gap, stroke, gap, … in points.
pub(super) fn dashes(line: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let mut strokes: Vec<Vec<Point>> = Vec::new();
    let (mut phase, mut left) = (0, pattern[0]);
    let mut stroke: Vec<Point> = line.first().copied().into_iter().collect();
    for pair in line.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let mut length = (to.0 - from.0).hypot(to.1 - from.1);
        while length > left {
            let u = left / length;
            from = (from.0 + u * (to.0 - from.0), from.1 + u * (to.1 - from.1));
            length -= left;
            if phase % 2 == 0 {
                stroke.push(from);
                strokes.push(std::mem::take(&mut stroke));
            } else {
                stroke = vec![from];
            }
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
        }
        left -= length;
        if phase % 2 == 0 {
            stroke.push(to);
        }
    }
    if phase % 2 == 0 && stroke.len() > 1 {
        strokes.push(stroke);
    }
    strokes
}

#[cfg(test)]
mod tests {
    use super::super::Scale;
    use super::*;

    fn map(low: f64, high: f64) -> Map {
        Map { low, high, scale: Scale::Linear, points: [0.0, 100.0] }
    }

    #[test]
    fn extremes_of_a_million_points_survive() {
        let mut points: Vec<[f64; 2]> = (0..1_000_000).map(|k| [k as f64, (k % 7) as f64]).collect();
        points[500_003][1] = 90.0;
        points[700_001][1] = -50.0;
        let line = pieces(&points, &map(0.0, 1e6), &map(-100.0, 100.0)).concat();
        assert!(line.len() < 4 * 340, "{} points left", line.len());
        let highest = line.iter().map(|p| p.1).fold(f64::MIN, f64::max);
        let lowest = line.iter().map(|p| p.1).fold(f64::MAX, f64::min);
        assert_eq!((lowest, highest), (25.0, 95.0));
    }

    #[test]
    fn a_gap_breaks_the_line() {
        let points = [[0.0, 1.0], [1.0, 2.0], [2.0, f64::NAN], [3.0, 1.0], [4.0, 1.0]];
        assert_eq!(pieces(&points, &map(0.0, 4.0), &map(0.0, 4.0)).len(), 2);
    }

    #[test]
    fn lines_end_at_the_edge() {
        let parts = cut(&[(-50.0, 50.0), (150.0, 50.0), (150.0, 200.0)], [0.0, 100.0], [0.0, 100.0]);
        assert_eq!(parts, [[(0.0, 50.0), (100.0, 50.0)]]);
    }

    #[test]
    fn dashes_cover_their_share() {
        let line: Vec<Point> = (0..=100).map(|k| (k as f64, 0.0)).collect();
        let length: f64 = dashes(&line, &[6.0, 4.0]).iter().map(|s| s[s.len() - 1].0 - s[0].0).sum();
        assert!((length - 60.0).abs() < 1e-9);
    }
}
