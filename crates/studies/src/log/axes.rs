//! Sensor axes and body axes.

use schuler_frames::{B, Vec3};

/// Which sensor axis points forward, right and down: a proper rotation of quarter turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMap([(usize, f64); 3]);

/// Why three words are no axis map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AxesError {
    /// A word that is no axis.
    #[error("`{0}` is no axis: expected `x`, `y`, `z`, `-x`, `-y` or `-z`")]
    Unknown(String),
    /// An axis that is named twice.
    #[error("sensor axis `{0}` is named twice: each of x, y, z stands once")]
    Twice(char),
    /// A mirror image, determinant -1: angular rates of a left-handed triad would have the wrong sign.
    #[error("[{0}] is left-handed (determinant -1): a sign or the order of two axes is wrong")]
    Mirror(String),
}

impl AxisMap {
    /// Sensor axes that are body axes already.
    pub const IDENTITY: AxisMap = AxisMap([(0, 1.0), (1, 1.0), (2, 1.0)]);

    /// Sensor axes right, front, up.
    pub const RIGHT_FRONT_UP: AxisMap = AxisMap([(1, 1.0), (0, 1.0), (2, -1.0)]);

    /// From the words for forward, right and down, as in `["y", "x", "-z"]` for sensor axes right-front-up.
    ///
    /// # Errors
    /// [`AxesError`] if a word is no axis, an axis is missing or the three are left-handed.
    ///
    /// ```
    /// use schuler_studies::log::AxisMap;
    /// let map = AxisMap::parse(["y", "x", "-z"]).unwrap();
    /// assert_eq!(map.to_body([1.0, 2.0, 3.0]).as_array(), [2.0, 1.0, -3.0]);
    /// assert!(AxisMap::parse(["y", "x", "z"]).is_err());
    /// ```
    pub fn parse(words: [&str; 3]) -> Result<Self, AxesError> {
        let mut map = [(0, 1.0); 3];
        for (entry, word) in map.iter_mut().zip(words) {
            let (sign, letter) = match word.trim().strip_prefix(['-', '−']) {
                Some(rest) => (-1.0, rest),
                None => (1.0, word.trim().trim_start_matches('+')),
            };
            let axis = match letter.trim() {
                "x" | "X" => 0,
                "y" | "Y" => 1,
                "z" | "Z" => 2,
                _ => return Err(AxesError::Unknown(word.into())),
            };
            *entry = (axis, sign);
        }
        let [(i, a), (j, b), (k, c)] = map;
        if i == j || i == k || j == k {
            return Err(AxesError::Twice(['x', 'y', 'z'][if j == k { j } else { i }]));
        }
        // Even permutations of 0, 1, 2 are those in which each is followed by the next.
        let parity = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
        if parity * a * b * c < 0.0 {
            return Err(AxesError::Mirror(words.join(", ")));
        }
        Ok(AxisMap(map))
    }

    /// The sensor axis (0 to 2) that lies along body axis `body`, in this sense or the other.
    pub fn sensor_axis(&self, body: usize) -> usize {
        self.0[body].0
    }

    /// A vector of sensor axes x, y, z along forward, right, down.
    #[inline]
    pub fn to_body(&self, sensor: [f64; 3]) -> Vec3<B> {
        let [(i, a), (j, b), (k, c)] = self.0;
        Vec3::new(a * sensor[i], b * sensor[j], c * sensor[k])
    }
}
