//! Tables of named columns: numbers in SI, or one of a few words.

/// A table, kept by columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name, which is the stem of its file: `errors`, `trajectory`, `imu`, `summary`.
    pub name: String,
    /// The columns, all of the same length.
    pub columns: Vec<Column>,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Numbers; the unit is the last part of the name (`dn_m`, `v_n_mps`, `phi_n_rad`).
    Number {
        /// Name with unit.
        name: String,
        /// Values, SI.
        values: Vec<f64>,
    },
    /// Words, each kept once.
    Word {
        /// Name.
        name: String,
        /// The different words in order of their first appearance.
        words: Vec<String>,
        /// Index into `words`, one a row.
        codes: Vec<u32>,
    },
}

/// One entry of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// A number, SI.
    Number(f64),
    /// A word.
    Word(&'a str),
}

impl From<f64> for Cell<'_> {
    fn from(value: f64) -> Self {
        Cell::Number(value)
    }
}

impl<'a> From<&'a str> for Cell<'a> {
    fn from(word: &'a str) -> Self {
        Cell::Word(word)
    }
}

impl Column {
    /// Name of the column.
    pub fn name(&self) -> &str {
        match self {
            Column::Number { name, .. } | Column::Word { name, .. } => name,
        }
    }

    /// Rows.
    pub fn len(&self) -> usize {
        match self {
            Column::Number { values, .. } => values.len(),
            Column::Word { codes, .. } => codes.len(),
        }
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Entry of one row. Panics beyond the last.
    pub fn cell(&self, row: usize) -> Cell<'_> {
        match self {
            Column::Number { values, .. } => Cell::Number(values[row]),
            Column::Word { words, codes, .. } => Cell::Word(&words[codes[row] as usize]),
        }
    }

    fn push(&mut self, cell: Cell<'_>) {
        match (self, cell) {
            (Column::Number { values, .. }, Cell::Number(value)) => values.push(value),
            (Column::Word { words, codes, .. }, Cell::Word(word)) => {
                let code = words.iter().position(|w| w == word).unwrap_or_else(|| {
                    words.push(word.into());
                    words.len() - 1
                });
                codes.push(code as u32);
            }
            (column, cell) => panic!("invariant: column {} does not take {cell:?}", column.name()),
        }
    }
}

impl Table {
    /// An empty table. `words` names the columns of words, the others hold numbers.
    ///
    /// ```
    /// use schuler_studies::record::Table;
    /// let mut t = Table::new("errors", &["t_s", "source", "dn_m"], &["source"]);
    /// t.push(&[60.0.into(), "gyro.bias.constant.x".into(), (-0.01).into()]);
    /// assert_eq!(t.numbers("dn_m"), Some(&[-0.01][..]));
    /// ```
    pub fn new(name: &str, columns: &[&str], words: &[&str]) -> Self {
        let column = |&name: &&str| match words.contains(&name) {
            true => Column::Word { name: name.into(), words: Vec::new(), codes: Vec::new() },
            false => Column::Number { name: name.into(), values: Vec::new() },
        };
        Table { name: name.into(), columns: columns.iter().map(column).collect() }
    }

    /// Adds a row, one cell a column. Panics where number and kind of the cells are not those of the columns,
    /// which is a fault of the study and not of its input.
    pub fn push(&mut self, row: &[Cell<'_>]) {
        assert_eq!(
            row.len(),
            self.columns.len(),
            "invariant: a row of table {} has one cell a column",
            self.name
        );
        for (column, cell) in self.columns.iter_mut().zip(row) {
            column.push(*cell);
        }
    }

    /// Rows.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Column::len)
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The column of that name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name() == name)
    }

    /// The values of a column of numbers.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.column(name) {
            Some(Column::Number { values, .. }) => Some(values),
            _ => None,
        }
    }
}

/// The columns that studies write, as the README states them.
pub mod columns {
    use schuler_imu::Unit;

    /// `errors.csv`: position, velocity and attitude error, computed minus true, local north-east-down.
    pub const ERRORS: [&str; 12] = [
        "t_s",
        "source",
        "way",
        "dn_m",
        "de_m",
        "dd_m",
        "dv_n_mps",
        "dv_e_mps",
        "dv_d_mps",
        "phi_n_rad",
        "phi_e_rad",
        "phi_d_rad",
    ];
    /// `trajectory.csv`.
    pub const TRAJECTORY: [&str; 10] = [
        "t_s",
        "lat_rad",
        "lon_rad",
        "h_m",
        "v_n_mps",
        "v_e_mps",
        "v_d_mps",
        "roll_rad",
        "pitch_rad",
        "yaw_rad",
    ];
    /// `truth.csv`: state at `t_s`, instantaneous rate against inertial space and specific force, in body axes.
    pub const TRUTH: [&str; 16] = [
        "t_s",
        "lat_rad",
        "lon_rad",
        "h_m",
        "v_n_mps",
        "v_e_mps",
        "v_d_mps",
        "roll_rad",
        "pitch_rad",
        "yaw_rad",
        "omega_x_radps",
        "omega_y_radps",
        "omega_z_radps",
        "f_x_mps2",
        "f_y_mps2",
        "f_z_mps2",
    ];
    /// `position.csv`: measured position of an antenna, and the standard deviation of its noise.
    pub const POSITION_AID: [&str; 7] =
        ["t_s", "lat_rad", "lon_rad", "h_m", "sigma_n_m", "sigma_e_m", "sigma_d_m"];
    /// `velocity.csv`: measured velocity of an antenna.
    pub const VELOCITY_AID: [&str; 7] =
        ["t_s", "v_n_mps", "v_e_mps", "v_d_mps", "sigma_n_mps", "sigma_e_mps", "sigma_d_mps"];
    /// `height.csv`: measured height.
    pub const HEIGHT_AID: [&str; 3] = ["t_s", "h_m", "sigma_d_m"];
    /// `heading.csv`: measured heading.
    pub const HEADING_AID: [&str; 3] = ["t_s", "yaw_rad", "sigma_rad"];
    /// `imu.csv` with increments over the interval that ends at `t_s`.
    pub const INCREMENTS: [&str; 7] =
        ["t_s", "dtheta_x_rad", "dtheta_y_rad", "dtheta_z_rad", "dv_x_mps", "dv_y_mps", "dv_z_mps"];
    /// `imu.csv` with means over the interval that ends at `t_s`.
    pub const RATES: [&str; 7] =
        ["t_s", "omega_x_radps", "omega_y_radps", "omega_z_radps", "f_x_mps2", "f_y_mps2", "f_z_mps2"];
    /// `imu_errors.csv`: measured minus true, means over the interval that ends at `t_s`.
    pub const IMU_ERRORS: [&str; 7] =
        ["t_s", "domega_x_radps", "domega_y_radps", "domega_z_radps", "df_x_mps2", "df_y_mps2", "df_z_mps2"];
    /// `imu_flags.csv`: what the readout did to the sample that ends at `t_s`, 1 where it did.
    pub const IMU_FLAGS: [&str; 13] = [
        "t_s",
        "gyro_saturated_x_count",
        "gyro_saturated_y_count",
        "gyro_saturated_z_count",
        "gyro_dropped_count",
        "gyro_repeated_count",
        "gyro_stuck_count",
        "accel_saturated_x_count",
        "accel_saturated_y_count",
        "accel_saturated_z_count",
        "accel_dropped_count",
        "accel_repeated_count",
        "accel_stuck_count",
    ];
    /// `allan.csv`: Allan deviation of the IMU errors at the averaging time `t_s`.
    pub const ALLAN: [&str; 8] = [
        "t_s",
        "source",
        "adev_omega_x_radps",
        "adev_omega_y_radps",
        "adev_omega_z_radps",
        "adev_f_x_mps2",
        "adev_f_y_mps2",
        "adev_f_z_mps2",
    ];
    /// `log.csv`: what a recorded log says by itself, for the whole of it (`source` is `log`) and for its alignment
    /// window (`window`): end, number of samples, norms of mean rate and mean specific force, and their components.
    pub const LOG: [&str; 11] = [
        "t_s",
        "source",
        "samples_count",
        "omega_radps",
        "f_mps2",
        "omega_x_radps",
        "omega_y_radps",
        "omega_z_radps",
        "f_x_mps2",
        "f_y_mps2",
        "f_z_mps2",
    ];
    /// `consistency.csv` of an alignment: mean NEES a degree of freedom with its 99 % band, and the square of the heading error
    /// over that of its own standard deviation with its band; of a filter the mean NIS a degree of freedom of the updates since the row
    /// before, with its band.
    pub const CONSISTENCY: [&str; 11] = [
        "t_s",
        "source",
        "nees_ratio",
        "nees_low_ratio",
        "nees_high_ratio",
        "heading_ratio",
        "heading_low_ratio",
        "heading_high_ratio",
        "nis_ratio",
        "nis_low_ratio",
        "nis_high_ratio",
    ];
    /// `windows.csv` of an alignment of a log: the attitude at the end of each window, the method's own standard deviations of phi
    /// and its limits.
    pub const WINDOWS: [&str; 11] = [
        "t_s",
        "source",
        "roll_rad",
        "pitch_rad",
        "yaw_rad",
        "sigma_n_rad",
        "sigma_e_rad",
        "sigma_d_rad",
        "limit_n_rad",
        "limit_e_rad",
        "limit_d_rad",
    ];
    /// `budget.csv`: standard deviations of the nine navigation errors; the root of the sum of the horizontal variances, the
    /// radii that hold 50 % and 95 % of the horizontal position errors and of the errors in space, and the shares of the
    /// horizontal variance and of the heading's.
    pub const BUDGET: [&str; 19] = [
        "t_s",
        "source",
        "way",
        "dn_m",
        "de_m",
        "dd_m",
        "dv_n_mps",
        "dv_e_mps",
        "dv_d_mps",
        "phi_n_rad",
        "phi_e_rad",
        "phi_d_rad",
        "horizontal_m",
        "cep_m",
        "r95_m",
        "sep_m",
        "spherical_r95_m",
        "share_ratio",
        "heading_share_ratio",
    ];
    /// `requirement_horizontal.csv` and the like, one for each limit: the radius of the required probability, of a source alone
    /// and of all; its derivative by the relative size of the source and that over the radius; the factor by which the source
    /// may grow; and which number of the scenario that is, its SI unit, its value, and the value with which the requirement is
    /// just met, the last also in the unit of a data sheet. All axes of an entry together are a row as well (`gyro.bias.constant`),
    /// before the total. Radius and derivative in metres, [metres a second or radians](required).
    pub const REQUIREMENT: [&str; 11] = [
        "t_s",
        "source",
        "radius_m",
        "derivative_m",
        "part_ratio",
        "may_grow_ratio",
        "parameter",
        "unit",
        "value",
        "limit",
        "limit_shown",
    ];
    /// `agreement.csv`: variances of the last row by runs beside the covariance: how many were judged, how many are outside their
    /// 99 % band, the least and the largest over the covariance; the probability (at most) that chance leaves one as far out as
    /// the furthest, and that so many sources have one outside; and by how much columns are off covariance at most, at any row and
    /// of any error, in standard deviations of the total. The last row is of all together.
    pub const AGREEMENT: [&str; 9] = [
        "t_s",
        "source",
        "judged_count",
        "outside_count",
        "least_ratio",
        "largest_ratio",
        "worst_chance_ratio",
        "count_chance_ratio",
        "columns_off_ratio",
    ];

    /// [`REQUIREMENT`] with the names of radius and derivative in the unit of what is required.
    pub const fn required(radius: &'static str, derivative: &'static str) -> [&'static str; 11] {
        let mut names = REQUIREMENT;
        names[2] = radius;
        names[3] = derivative;
        names
    }

    /// `monte_carlo.csv`: a figure (`way`) of the errors of all runs, as it was found (`source` is `estimate`), the ends of its
    /// 99 % confidence interval (`low`, `high`), and what covariance predicts (`predicted`). `mean`, `sd` and `rms` are of the
    /// errors with their sign, `q50` to `q99` the magnitudes that 50 % to 99 % of the runs do not exceed; of the horizontal
    /// distance `sd` and `rms` are roots of the sum of both variances or mean squares, and `mean` is the length of the mean.
    pub const MONTE_CARLO: [&str; 13] = [
        "t_s",
        "source",
        "way",
        "dn_m",
        "de_m",
        "dd_m",
        "dv_n_mps",
        "dv_e_mps",
        "dv_d_mps",
        "phi_n_rad",
        "phi_e_rad",
        "phi_d_rad",
        "horizontal_m",
    ];
    /// `exceedance.csv`: how many runs are beyond a threshold (`source`), their share, its 99 % confidence interval, and what
    /// covariance predicts of it.
    pub const EXCEEDANCE: [&str; 8] = [
        "t_s",
        "source",
        "beyond_count",
        "runs_count",
        "beyond_ratio",
        "beyond_low_ratio",
        "beyond_high_ratio",
        "beyond_predicted_ratio",
    ];
    /// `nees.csv` of a Monte Carlo: normalized error squared against the predicted covariance, a degree of freedom, with
    /// its 99 % band, and how many degrees of freedom a run has.
    pub const RUNS_NEES: [&str; 5] =
        ["t_s", "nees_ratio", "nees_low_ratio", "nees_high_ratio", "freedom_count"];
    /// `sigmas.csv` of a navigation with a filter: its own standard deviations of position, velocity and attitude.
    pub const SIGMAS: [&str; 10] = [
        "t_s",
        "sigma_n_m",
        "sigma_e_m",
        "sigma_d_m",
        "sigma_n_mps",
        "sigma_e_mps",
        "sigma_d_mps",
        "sigma_phi_n_rad",
        "sigma_phi_e_rad",
        "sigma_phi_d_rad",
    ];
    /// `updates.csv` of a navigation with a filter, a row for each kind of measurement (`source`): scalar measurements
    /// offered and refused, and mean normalized innovation squared of a scalar with its 99 % band.
    pub const UPDATES: [&str; 6] =
        ["source", "rows_count", "refused_count", "nis_ratio", "nis_low_ratio", "nis_high_ratio"];
    /// `innovations.csv`: of each scalar measurement (`source`) computed minus measured, its predicted standard deviation
    /// and their ratio, the normalized innovation squared of the whole measurement, and whether the gate let it pass. The
    /// first two are in m, m/s, rad or rad/s.
    pub const INNOVATIONS: [&str; 7] =
        ["t_s", "source", "innovation", "sigma", "normalized_ratio", "nis", "accepted"];
    /// `states.csv`: the filter's estimate of each state of the error sources (`source`) and its standard deviation, SI.
    pub const STATES: [&str; 4] = ["t_s", "source", "estimate", "sigma"];
    /// `nees.csv`: normalized error squared of the navigation errors against the reference, a degree of freedom.
    pub const NEES: [&str; 2] = ["t_s", "nees_ratio"];
    /// `way` of `errors.csv`: of a drift study, then of an alignment; then of a budget (with `exact`) and of a Monte Carlo.
    pub const WAYS: [&str; 20] = [
        "nonlinear",
        "half_difference",
        "linear",
        "exact",
        "single_axis",
        "run",
        "rms",
        "sigma",
        "limit",
        "navigated",
        "covariance",
        "columns",
        "adjoint",
        "monte_carlo",
        "mean",
        "sd",
        "q50",
        "q90",
        "q95",
        "q99",
    ];

    /// Whether a column holds counts, which are whole numbers.
    pub fn is_count(name: &str) -> bool {
        name.ends_with("_count")
    }

    /// The unit that the last part of a column's name states.
    pub fn unit(name: &str) -> Option<Unit> {
        match name.rsplit_once('_')?.1 {
            "count" | "ratio" => Some(Unit::ONE),
            "s" => Some(Unit::SECOND),
            "m" => Some(Unit::METRE),
            "mps" => Some(Unit::METRE.over(Unit::SECOND)),
            "mps2" => Some(Unit::FORCE),
            "rad" => Some(Unit::RADIAN),
            "radps" => Some(Unit::RATE),
            _ => None,
        }
    }
}
