//! Parts of a study, made anywhere, and the whole that they are together.

use std::{
    fs,
    ops::Range,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::{
    gather::{Chunks, Gathered},
    open,
    prediction::prediction,
    runs::Chunk,
    scene::Scene,
    state::Identity,
    store::{Digest, Reader, Writer},
};
use crate::{
    Context, Diagnostic, Error, Progress, Record, Scenario,
    record::{Folder, MANIFEST},
    scenario::{MonteCarlo, Study},
};

/// Runs of a part.
const RUNS: &str = "runs.parquet";

/// The scenario as it was read, so that whoever merges needs no other file.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// What messages call it.
    pub file: PathBuf,
    /// Its text.
    pub text: String,
    /// Changes of it, `key.path=value`.
    pub overrides: Vec<String>,
}

/// What is in the folder of a part: `manifest.json`.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    /// Version of this form.
    format: u64,
    identity: Identity,
    /// The first run, and the one after the last.
    runs: [u64; 2],
    /// Of the errors of these runs.
    digest: String,
    origin: Origin,
    files: Vec<String>,
}

/// Which runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// From the first to the one before the last.
    Runs(Range<u64>),
    /// Part `k` of `n`, from 1 on.
    Shard {
        /// Which.
        k: u64,
        /// Of how many.
        n: u64,
    },
}

impl Part {
    /// From `0..500`, `3/8`.
    ///
    /// # Errors
    /// A sentence that says what was expected.
    pub fn parse_runs(text: &str) -> Result<Part, String> {
        let parts = text.split_once("..").and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
        parts
            .filter(|runs| runs.start < runs.end)
            .map(Part::Runs)
            .ok_or_else(|| "expected the first run and the one after the last, as in 0..500".to_string())
    }

    /// From `3/8`.
    ///
    /// # Errors
    /// A sentence that says what was expected.
    pub fn parse_shard(text: &str) -> Result<Part, String> {
        let parts = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        parts
            .filter(|(k, n)| (1..=*n).contains(k))
            .map(|(k, n)| Part::Shard { k, n })
            .ok_or_else(|| "expected which part of how many, from 1 on, as in 3/8".to_string())
    }

    /// The end of a folder's name.
    pub fn name(&self) -> String {
        match self {
            Part::Runs(runs) => format!("runs-{}-{}", runs.start, runs.end),
            Part::Shard { k, n } => format!("shard-{k}-of-{n}"),
        }
    }

    /// The runs of a study of `all` runs.
    fn range(&self, all: u64) -> Range<u64> {
        match *self {
            Part::Runs(ref runs) => runs.clone(),
            Part::Shard { k, n } => {
                // By eights, as runs go side by side, where there are enough of them.
                let unit = if all / n >= 8 { 8 } else { 1 };
                let bound = |k: u64| {
                    let share = (u128::from(all) * u128::from(k) / u128::from(n)) as u64;
                    if k == n { all } else { share / unit * unit }
                };
                bound(k - 1)..bound(k)
            }
        }
    }
}

/// Makes the runs of a part and leaves them in `folder` as `runs.parquet` with a `manifest.json`. Finished runs are kept in
/// `kept` on the way, as [`super::run_kept`] does; a part that is there whole is left as it is. Gives the digest of the runs.
///
/// # Errors
/// As [`super::run_kept`]; the study has no such runs.
pub fn part(
    scenario: &Scenario,
    study: &MonteCarlo,
    origin: &Origin,
    part: &Part,
    (folder, kept): (&Folder, &Path),
    context: &Context,
) -> Result<String, Error> {
    let runs = part.range(study.runs);
    if runs.end > study.runs || runs.is_empty() {
        let fault = Diagnostic::new(&scenario.file, "the study has no such runs")
            .path("monte_carlo.runs")
            .expected(format!("runs within 0..{}", study.runs))
            .found(match part {
                Part::Runs(runs) => format!("{}..{}", runs.start, runs.end),
                Part::Shard { k, n } => format!("shard {k}/{n} of {} runs, which has none", study.runs),
            });
        return Err(fault.into());
    }
    let scene = Scene::new(scenario, study);
    // A job that is submitted again with all others has nothing to do where it is done.
    if let Ok(there) = manifest(folder.path())
        && there.identity == Identity::of(scenario, &scene)
        && (there.runs, &there.origin) == ([runs.start, runs.end], origin)
        && read(folder.path(), &there, |_| {}).is_ok()
    {
        return Ok(there.digest);
    }
    let state = open(scenario, &scene, kept)?;
    // First all of them are made, then they become one file: nothing but whole results is ever seen.
    let mut chunks = Chunks::new(&scene, runs.clone(), Some(&state), context.progress)?;
    while chunks.next()?.is_some() {}
    let times: Vec<f64> = scene.rows.iter().map(|&k| scene.time(k)).collect();
    let mut digest = String::new();
    folder.put(|new| {
        let mut writer = Writer::create(&new.join(RUNS), &times)?;
        let mut chunks = Chunks::new(&scene, runs.clone(), Some(&state), &crate::Silent)?;
        while let Some(chunk) = chunks.next()? {
            writer.add(&chunk)?;
        }
        digest = writer.finish()?;
        let manifest = Manifest {
            format: 1,
            identity: Identity::of(scenario, &scene),
            runs: [runs.start, runs.end],
            digest: digest.clone(),
            origin: origin.clone(),
            files: vec![RUNS.into(), MANIFEST.into()],
        };
        let text = serde_json::to_string_pretty(&manifest).expect("invariant: words and numbers");
        let path = new.join(MANIFEST);
        fs::write(&path, text + "\n").map_err(|source| Error::Write { path, source })
    })?;
    Ok(digest)
}

/// The study that parts are together, in whatever order they are given: the record of one process, to the last bit.
///
/// # Errors
/// A folder is no part, is damaged, or belongs to another study; runs are missing or stand twice.
pub fn merge(folders: &[PathBuf], progress: &dyn Progress) -> Result<(Scenario, Record), Error> {
    let mut parts: Vec<(&PathBuf, Manifest)> =
        folders.iter().map(|folder| Ok((folder, manifest(folder)?))).collect::<Result<_, Error>>()?;
    parts.sort_by_key(|(_, manifest)| manifest.runs);
    let Some((folder, first)) = parts.first() else {
        return Err(Diagnostic::new("merge", "nothing to merge").expected("folders of parts").into());
    };
    let Origin { file, text, overrides } = &first.origin;
    let scenario = Scenario::load(file, text, overrides)?;
    let Study::MonteCarlo(study) = &scenario.study else {
        return Err(refused(folder, "its scenario is no `study: monte_carlo`").into());
    };
    let scene = Scene::new(&scenario, study);
    let identity = Identity::of(&scenario, &scene);
    let mut next = 0;
    for (folder, manifest) in &parts {
        if let Some((what, expected, found)) = identity.differs(&manifest.identity) {
            return Err(refused(folder, format!("a part of another {what}"))
                .expected(expected)
                .found(found)
                .into());
        }
        let Origin { file, text, overrides } = &manifest.origin;
        // The first part alone says what is merged: the others' words are compared with it by what they hash to.
        let said = Scenario::load(file, text, overrides)?.hash;
        if said != manifest.identity.scenario_hash {
            return Err(refused(folder, "the scenario in its manifest is not the one of its runs")
                .expected(manifest.identity.scenario_hash.clone())
                .found(said)
                .into());
        }
        let [start, end] = manifest.runs;
        if start != next {
            let problem = if start < next {
                "runs of this part stand twice"
            } else {
                "runs before this part are missing"
            };
            return Err(refused(folder, problem)
                .expected(format!("a part from run {next} on"))
                .found(format!("runs {start}..{end}"))
                .into());
        }
        next = end;
    }
    if next != study.runs {
        let last = parts.last().map_or(folder, |(folder, _)| folder);
        return Err(refused(last, "runs after this part are missing")
            .expected(format!("parts up to run {}", study.runs))
            .found(format!("the last is {}", next - 1))
            .into());
    }
    let mut gathered = Gathered::new(&scene, prediction(&scene));
    progress.begin("parts", parts.len() as u64);
    for (folder, manifest) in &parts {
        read(folder, manifest, |chunk| gathered.add(chunk))?;
        progress.advance(1);
    }
    let mut record = gathered.record(&scenario);
    record.judge(&scenario);
    Ok((scenario, record))
}

fn manifest(folder: &Path) -> Result<Manifest, Error> {
    let path = folder.join(MANIFEST);
    let text = fs::read_to_string(&path).map_err(|source| Error::Read { path: path.clone(), source })?;
    let manifest: Manifest = serde_json::from_str(&text)
        .map_err(|e| Diagnostic::new(&path, "this is not the manifest of a part").found(e.to_string()))?;
    match manifest.format {
        1 if manifest.identity.rows > 0 => Ok(manifest),
        other => {
            Err(refused(folder, "a part of an unknown form").expected("1").found(other.to_string()).into())
        }
    }
}

/// Every run of a part, compared with what its manifest says.
fn read(folder: &Path, manifest: &Manifest, mut take: impl FnMut(&Chunk)) -> Result<(), Error> {
    let path = folder.join(RUNS);
    let rows = manifest.identity.rows;
    let damaged = |found: String| {
        Diagnostic::new(&path, "the runs of this part are damaged or incomplete")
            .expected(format!(
                "the runs {}..{} with the digest of the manifest",
                manifest.runs[0], manifest.runs[1]
            ))
            .found(found)
            .help("make the part again")
    };
    let mut digest = Digest::default();
    let mut next = manifest.runs[0];
    for chunk in Reader::open(&path, rows).map_err(damaged)? {
        let chunk = chunk.map_err(damaged)?;
        if chunk.first != next {
            return Err(damaged(format!("run {} in place of {next}", chunk.first)).into());
        }
        next += (chunk.errors.len() / rows) as u64;
        digest.add_chunk(&chunk, rows);
        take(&chunk);
    }
    if next != manifest.runs[1] || digest.hex() != manifest.digest {
        return Err(damaged(format!("runs up to {next}, digest {}", digest.hex())).into());
    }
    Ok(())
}

fn refused(folder: &Path, problem: impl Into<String>) -> Diagnostic {
    Diagnostic::new(folder, problem)
}
