//! What a simulated accelerometer rounds, against the same motion in pairs of numbers (106 bits).

use schuler_frames::{Geodetic, Gravity, wgs84};

use super::kinds::PLACE;
use crate::trajectory::{Course, Segment, Segments, Sharpness, Truth, Turn};

/// The unevaluated sum of two numbers, the second below half a unit of the last place of the first.
#[derive(Clone, Copy, Debug)]
struct Pair(f64, f64);

/// Sum without error (Knuth).
fn two_sum(a: f64, b: f64) -> Pair {
    let s = a + b;
    let t = s - a;
    Pair(s, (a - (s - t)) + (b - t))
}

/// Product without error (Dekker's by a fused multiplication).
fn two_product(a: f64, b: f64) -> Pair {
    let p = a * b;
    Pair(p, a.mul_add(b, -p))
}

impl From<f64> for Pair {
    fn from(x: f64) -> Self {
        Pair(x, 0.0)
    }
}

impl std::ops::Add for Pair {
    type Output = Pair;
    fn add(self, o: Pair) -> Pair {
        let (s, t) = (two_sum(self.0, o.0), two_sum(self.1, o.1));
        let s = two_sum(s.0, s.1 + t.0);
        two_sum(s.0, s.1 + t.1)
    }
}

impl std::ops::Neg for Pair {
    type Output = Pair;
    fn neg(self) -> Pair {
        Pair(-self.0, -self.1)
    }
}

impl std::ops::Sub for Pair {
    type Output = Pair;
    fn sub(self, o: Pair) -> Pair {
        self + -o
    }
}

impl std::ops::Mul for Pair {
    type Output = Pair;
    fn mul(self, o: Pair) -> Pair {
        let p = two_product(self.0, o.0);
        two_sum(p.0, p.1 + (self.0 * o.1 + self.1 * o.0))
    }
}

impl std::ops::Div for Pair {
    type Output = Pair;
    fn div(self, o: Pair) -> Pair {
        let first = Pair::from(self.0 / o.0);
        let rest = self - first * o;
        let second = Pair::from(rest.0 / o.0);
        let rest = rest - second * o;
        first + second + Pair::from(rest.0 / o.0)
    }
}

fn pair(x: f64) -> Pair {
    x.into()
}

/// Newton's step from the square root of the first number.
fn sqrt(x: Pair) -> Pair {
    let root = pair(x.0.sqrt());
    (root + x / root) * pair(0.5)
}

/// Sine and cosine by their series at a 64th of the angle.
fn sin_cos(x: Pair) -> (Pair, Pair) {
    let small = x * pair(1.0 / 64.0);
    let (mut sin, mut cos, mut term) = (pair(0.0), pair(0.0), pair(1.0));
    for n in 0..20 {
        match n % 4 {
            0 => cos = cos + term,
            1 => sin = sin + term,
            2 => cos = cos - term,
            _ => sin = sin - term,
        }
        term = term * small / pair(f64::from(n) + 1.0);
    }
    for _ in 0..6 {
        (sin, cos) = (pair(2.0) * sin * cos, (cos - sin) * (cos + sin));
    }
    (sin, cos)
}

/// The quintic from 0 to 1 at the part `u`, and its integral from 0.
fn quintic(u: Pair) -> (Pair, Pair) {
    let cube = u * u * u;
    let step = cube * (pair(10.0) - u * (pair(15.0) - pair(6.0) * u));
    (step, cube * u * (pair(2.5) - u * (pair(3.0) - u)))
}

const SPEED: f64 = 80.0;
const HEADING: f64 = 0.3;
const STRAIGHT: f64 = 1000.0;
const RAMP: f64 = 4.0;
/// Rate of heading in the turn, rad/s, and roll of the other flight, rad.
const CHANGE: f64 = 0.06;

/// What happens after the stretch straight on.
#[derive(Clone, Copy, Debug)]
enum What {
    Turns,
    Rolls,
}

/// Specific force in b at the part `u` of the ramp, at this position.
fn force(what: What, u: Pair, position: Geodetic) -> [Pair; 3] {
    let (step, passed) = quintic(u);
    let (heading, rate, roll) = match what {
        What::Turns => (pair(HEADING) + pair(CHANGE) * pair(RAMP) * passed, pair(CHANGE) * step, pair(0.0)),
        What::Rolls => (pair(HEADING), pair(0.0), pair(CHANGE) * step),
    };
    let ((s, c), (sr, cr)) = (sin_cos(heading), sin_cos(roll));
    let v = [pair(SPEED) * c, pair(SPEED) * s];
    // What depends on the position needs no pairs: a nanometre makes 3e-15 m/s².
    let (sl, cl) = position.lat.sin_cos();
    let (north, south) = (wgs84::r_n(sl) + position.h, wgs84::r_m(sl) + position.h);
    let g = Gravity::Normal.gravity_t(position);
    // omega_et + 2 omega_ie in t, and its product with the velocity.
    let omega = [
        v[1] / pair(north) + pair(2.0 * wgs84::OMEGA * cl),
        -(v[0] / pair(south)),
        -(v[1] / pair(north) * pair(sl / cl)) - pair(2.0 * wgs84::OMEGA * sl),
    ];
    let f_n = -(v[1] * rate) - omega[2] * v[1] - pair(g[0]);
    let f_e = v[0] * rate + omega[2] * v[0] - pair(g[1]);
    let f_d = omega[0] * v[1] - omega[1] * v[0] - pair(g[2]);
    let right = c * f_e - s * f_n;
    [c * f_n + s * f_e, cr * right + sr * f_d, cr * f_d - sr * right]
}

/// Its integral over the interval by three nodes of Gauss and Legendre, whose error at 1 ms is 1e-23 of it.
fn reference(what: What, truth: &Truth, t: f64, dt: f64) -> [Pair; 3] {
    let apart = sqrt(pair(0.15));
    let nodes = [(pair(0.5) - apart, 5.0), (pair(0.5), 8.0), (pair(0.5) + apart, 5.0)];
    let mut sum = [pair(0.0); 3];
    for (node, weight) in nodes {
        let passed = (pair(t) - pair(STRAIGHT)) + node * pair(dt);
        let position = truth.trajectory().at(t + node.0 * dt).position;
        let f = force(what, passed / pair(RAMP), position);
        for (sum, f) in sum.iter_mut().zip(f) {
            *sum = *sum + f * pair(weight) * pair(dt) / pair(18.0);
        }
    }
    sum
}

/// A thousand seconds into a flight, at 1 kHz, through the ramp of a flat turn and through a roll: 1e-12 m/s².
#[test]
fn of_an_accelerometer_on_segments() {
    let turn = Turn { sharpness: Sharpness::Rate(CHANGE), ramp: RAMP, flat: true };
    for (what, segment) in [
        (What::Turns, Segment::Turn { angle: 2.0, turn }),
        (What::Rolls, Segment::Roll { to: CHANGE, duration: RAMP }),
    ] {
        let start = Course { position: PLACE, speed: SPEED, heading: HEADING, climb: 0.0, roll: 0.0 };
        let flight =
            Segments::new(start, &[Segment::Straight { duration: STRAIGHT }, segment], Gravity::Normal);
        let truth = Truth::new(flight.expect("a flight"), Gravity::Normal);
        let dt = 1e-3;
        let mut worst = 0f64;
        for k in 0..(RAMP / dt) as u32 {
            let t = STRAIGHT + f64::from(k) * dt;
            let found = truth.increments(t, dt).dv;
            for (axis, exact) in reference(what, &truth, t, dt).into_iter().enumerate() {
                let error = pair(found[axis]) - exact;
                worst = worst.max((error.0 + error.1).abs() / dt);
            }
        }
        assert!(worst < 1e-12, "{what:?}: {worst:e} m/s²");
    }
}

/// The pairs hold more digits than are asked of them: sin² + cos² = 1, (1/3) 3 = 1, (2^1/2)² = 2.
#[test]
fn pairs_are_exact() {
    let off = |x: Pair, y: f64| (x - pair(y)).0.abs();
    for k in 0..20 {
        let (s, c) = sin_cos(pair(0.37) * pair(f64::from(k) - 9.5));
        assert!(off(s * s + c * c, 1.0) < 1e-28, "{k}");
        assert!((s.0 - (0.37 * (f64::from(k) - 9.5)).sin()).abs() < 1e-15);
    }
    assert!(off(pair(1.0) / pair(3.0) * pair(3.0), 1.0) < 1e-31);
    assert!(off(sqrt(pair(2.0)) * sqrt(pair(2.0)), 2.0) < 1e-30);
}
