//! The word somebody probably meant.

/// The candidate nearest to `word`, if it is near enough to be a slip of the pen.
pub fn similar<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |c: &str| strsim::damerau_levenshtein(&word.to_lowercase(), &c.to_lowercase());
    let (best, candidate) = candidates.into_iter().map(|c| (distance(c), c)).min_by_key(|(d, _)| *d)?;
    // A third of the letters may be wrong; a single letter resembles everything.
    (best <= word.chars().count() / 3 || (best <= 2 && candidate.len() > 4)).then_some(candidate)
}
