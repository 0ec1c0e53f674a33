//! Any motion with a vibration on top.

use schuler_frames::{B, E, Rot, Vec3};

use super::{Kinematics, Place, Stance, SwayAxes, Trajectory, sway};

/// A trajectory whose body is shaken: sums of sines in roll, pitch and yaw against the body axes that it would
/// have without, and in position along these axes (`n` along x, `e` along y, `d` along z).
#[derive(Debug)]
pub struct Shaken {
    carrier: Box<dyn Trajectory>,
    axes: SwayAxes,
    /// Of the shaking.
    fastest: f64,
}

impl Shaken {
    /// `carrier`, shaken.
    pub fn new(carrier: Box<dyn Trajectory>, axes: SwayAxes) -> Self {
        let fastest = axes.fastest();
        Shaken { carrier, axes, fastest }
    }
}

impl Trajectory for Shaken {
    fn at(&self, t: f64) -> Kinematics {
        let carrier = self.carrier.at(t);
        let (omega, alpha) = (carrier.omega_eb_b, carrier.alpha_eb_b);
        let c_et = carrier.position.c_et();
        let c_eb: Rot<E, B> = c_et * carrier.c_tb;

        let [x, y, z] = [&self.axes.n, &self.axes.e, &self.axes.d].map(|sines| sway::sum(sines, t));
        let l = Vec3::<B>::new(x.value(), y.value(), z.value());
        let l_dot = Vec3::<B>::new(x.rate(), y.rate(), z.rate());
        let l_dot2 = Vec3::<B>::new(x.acceleration(), y.acceleration(), z.acceleration());
        let r_e = carrier.position.as_ecef() + c_eb * l;
        let v_e = c_et * carrier.v_t + c_eb * (l_dot + omega.cross(l));
        let a_b = l_dot2 + omega.cross(l_dot) * 2.0 + alpha.cross(l) + omega.cross(omega.cross(l));
        let a_e = c_et * carrier.a_t + c_eb * a_b;
        let place = Place::from_e(r_e, v_e, a_e);

        let [roll, pitch, yaw] = [&self.axes.roll, &self.axes.pitch, &self.axes.yaw];
        let shake = Stance::from_euler(sway::sum(roll, t), sway::sum(pitch, t), sway::sum(yaw, t));
        let turned: Rot<B, B> = Rot::claim(shake.c_tb.as_quaternion());
        let omega = turned.inverse() * omega;
        let alpha = turned.inverse() * alpha;
        Kinematics {
            position: place.position,
            v_t: place.v_t,
            a_t: place.a_t,
            c_tb: place.position.c_et().inverse() * (c_eb * turned),
            omega_eb_b: omega + shake.omega_tb_b,
            alpha_eb_b: alpha + shake.alpha_tb_b - shake.omega_tb_b.cross(omega),
        }
    }

    fn joints(&self) -> &[f64] {
        self.carrier.joints()
    }

    fn duration(&self) -> Option<f64> {
        self.carrier.duration()
    }

    fn fastest(&self, t: f64) -> f64 {
        self.carrier.fastest(t) + self.fastest
    }

    fn vibration(&self) -> [f64; 3] {
        self.carrier.vibration()
    }
}
