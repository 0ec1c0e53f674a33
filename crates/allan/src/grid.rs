/// Which averaging factors m (averaging time tau = m tau0) to estimate at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Grid {
    /// 1, 2, 4, 8, …
    Octave,
    /// n per octave, rounded to whole numbers, each once.
    PerOctave(u32),
    /// 1, 10, 100, …
    Decade,
    /// n per decade, rounded to whole numbers, each once.
    PerDecade(u32),
    /// Every factor.
    All,
    /// Exactly these, sorted, each once.
    Factors(Vec<usize>),
}

impl Grid {
    /// The averaging factors from 1 to `max`, increasing.
    #[must_use]
    pub fn factors(&self, max: usize) -> Vec<usize> {
        match self {
            Grid::Octave => geometric(2.0, 1, max),
            Grid::PerOctave(n) => geometric(2.0, *n, max),
            Grid::Decade => geometric(10.0, 1, max),
            Grid::PerDecade(n) => geometric(10.0, *n, max),
            Grid::All => (1..=max).collect(),
            Grid::Factors(factors) => {
                let mut m: Vec<usize> = factors.iter().copied().filter(|m| (1..=max).contains(m)).collect();
                m.sort_unstable();
                m.dedup();
                m
            }
        }
    }
}

fn geometric(base: f64, per: u32, max: usize) -> Vec<usize> {
    let per = per.max(1);
    let mut out: Vec<usize> = (0u32..)
        // Whole powers are exact: only the fraction of a power goes through `powf`.
        .map(|i| {
            (base.powi((i / per) as i32) * base.powf(f64::from(i % per) / f64::from(per))).round() as usize
        })
        .take_while(|m| *m <= max)
        .collect();
    out.dedup();
    out
}
