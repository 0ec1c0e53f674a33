//! The time column of a log, checked against the rate that the scenario states.

/// Shortening or lengthening of an interval, in intervals, up to which a time column may jitter.
const JITTER: f64 = 0.5;

/// Relative difference that the mean rate of a time column may have from the rate stated.
const RATE_TOLERANCE: f64 = 1e-3;

/// Follows the time column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    rate: f64,
    first: f64,
    last: f64,
    /// Rows after the first.
    rows: u64,
}

/// What is wrong with a row's time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ClockFault {
    pub problem: &'static str,
    pub found: String,
}

impl Clock {
    /// A clock whose first row has the time `t` (s), at `rate` rows a second.
    pub fn new(t: f64, rate: f64) -> Self {
        Clock { rate, first: t, last: t, rows: 0 }
    }

    /// The next row has the time `t`.
    #[inline]
    pub fn tick(&mut self, t: f64) -> Result<(), ClockFault> {
        self.rows += 1;
        let intervals = (t - self.last) * self.rate;
        let slip = ((t - self.first) * self.rate - self.rows as f64).abs();
        let regular = (intervals - 1.0).abs() <= JITTER && slip <= JITTER + RATE_TOLERANCE * self.rows as f64;
        if !regular {
            return Err(self.fault(t, intervals));
        }
        self.last = t;
        Ok(())
    }

    #[cold]
    fn fault(&self, t: f64, intervals: f64) -> ClockFault {
        let found = format!("{t} s after {} s: {intervals:.3} intervals of {} s", self.last, 1.0 / self.rate);
        let problem = if intervals < 0.0 {
            "time goes backwards"
        } else if intervals == 0.0 {
            "the same time twice"
        } else if intervals > 1.0 + JITTER {
            "a gap in time"
        } else if intervals < 1.0 - JITTER {
            "an interval that is too short"
        } else {
            let mean = self.rows as f64 / (t - self.first);
            let found = format!("{} rows in {} s: {mean} Hz", self.rows, t - self.first);
            return ClockFault { problem: "rows do not come at the rate stated", found };
        };
        ClockFault { problem, found }
    }
}

/// Length of a GNSS week, s.
const WEEK: f64 = 604_800.0;

/// Seconds of a GNSS week, which begin anew at its end, as a time that goes on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Week {
    last: f64,
    before: f64,
}

impl Week {
    /// The time of a row that has the second `t` of its week.
    pub fn unrolled(&mut self, t: f64) -> f64 {
        if t < self.last - 0.5 * WEEK {
            self.before += WEEK;
        }
        self.last = t;
        t + self.before
    }
}
