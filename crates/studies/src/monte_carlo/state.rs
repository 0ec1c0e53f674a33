//! Finished runs on the disk, so that a study that was killed goes on where it was.

use std::{
    fs::{self, File},
    io,
    ops::Range,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::{
    runs::Chunk,
    scene::Scene,
    store::{Digest, Reader, Writer},
};
use crate::{Diagnostic, Error, Scenario};

/// Name of the file that says what the runs belong to.
const IDENTITY: &str = "identity.json";

/// What makes the numbers of a run what they are.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// Version of Schuler.
    pub version: String,
    /// Hash of the scenario.
    pub scenario_hash: String,
    /// Master seed.
    pub seed: u64,
    /// Runs of the whole study.
    pub runs: u64,
    /// Rows of each run.
    pub rows: usize,
}

impl Identity {
    /// That of a study.
    pub fn of(scenario: &Scenario, scene: &Scene) -> Identity {
        Identity {
            version: env!("CARGO_PKG_VERSION").into(),
            scenario_hash: scenario.hash.clone(),
            seed: scenario.seed,
            runs: scene.study.runs,
            rows: scene.rows.len(),
        }
    }

    /// The first difference: what, expected, found.
    pub fn differs(&self, other: &Identity) -> Option<(&'static str, String, String)> {
        let pairs = [
            ("version", self.version.clone(), other.version.clone()),
            ("seed", self.seed.to_string(), other.seed.to_string()),
            ("scenario", self.scenario_hash.clone(), other.scenario_hash.clone()),
            ("number of runs", self.runs.to_string(), other.runs.to_string()),
            ("number of rows", self.rows.to_string(), other.rows.to_string()),
        ];
        pairs.into_iter().find(|(_, expected, found)| expected != found)
    }
}

/// A folder of finished runs, consecutive ones in a file.
///
/// A file takes its name when it is whole and on the disk: whenever the program ends, what is there can be used. A file that
/// is damaged all the same does not have the digest that stands in it; its runs are made again.
pub struct State {
    folder: PathBuf,
    times: Vec<f64>,
}

impl State {
    /// The folder, made if it is not there.
    ///
    /// # Errors
    /// It holds something else, or runs of another study; it cannot be written.
    pub fn open(folder: &Path, identity: &Identity, times: Vec<f64>) -> Result<State, Error> {
        let state = State { folder: folder.into(), times };
        fs::create_dir_all(folder).map_err(|source| Error::Write { path: folder.into(), source })?;
        let path = folder.join(IDENTITY);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let mut others = fs::read_dir(folder)
                    .map_err(|source| Error::Read { path: folder.into(), source })?
                    .filter_map(Result::ok)
                    .map(|entry| entry.file_name().to_string_lossy().into_owned())
                    .filter(|name| !name.ends_with(PART));
                if let Some(stranger) = others.next() {
                    return Err(refused(folder, "files that are no unfinished runs are in the way")
                        .found(format!("`{stranger}`"))
                        .into());
                }
                let text = serde_json::to_string_pretty(identity).expect("invariant: words and numbers");
                whole(&path, |path| fs::write(path, text + "\n"))?;
                return Ok(state);
            }
            Err(source) => return Err(Error::Read { path, source }),
        };
        let found: Identity = serde_json::from_str(&text).map_err(|e| {
            refused(folder, "unfinished runs of an unknown kind are in the way").found(format!("{e}"))
        })?;
        match identity.differs(&found) {
            None => Ok(state),
            Some((what, expected, found)) => {
                Err(refused(folder, format!("unfinished runs of another {what} are in the way"))
                    .expected(expected)
                    .found(found)
                    .into())
            }
        }
    }

    /// Which runs are there: a range for each file.
    pub fn ranges(&self) -> Result<Vec<Range<u64>>, Error> {
        let failed = |source| Error::Read { path: self.folder.clone(), source };
        let mut ranges = Vec::new();
        for entry in fs::read_dir(&self.folder).map_err(failed)? {
            let name = entry.map_err(failed)?.file_name();
            let numbers = name
                .to_str()
                .and_then(|name| name.strip_prefix(RUNS)?.strip_suffix(PARQUET)?.split_once('-'));
            if let Some((Ok(first), Ok(last))) = numbers.map(|(a, b)| (a.parse(), b.parse()))
                && first < last
            {
                ranges.push(first..last);
            }
        }
        Ok(ranges)
    }

    /// The runs of a file, if they are undamaged.
    pub fn load(&self, range: &Range<u64>) -> Option<Chunk> {
        let rows = self.times.len();
        let mut reader = Reader::open(&self.path(range), rows).ok()?;
        let mut chunk = reader.next()?.ok()?;
        for more in &mut reader {
            chunk.errors.extend(more.ok()?.errors);
        }
        let mut digest = Digest::default();
        digest.add_chunk(&chunk, rows);
        let all = (range.end - range.start) * rows as u64;
        let whole = chunk.first == range.start && chunk.errors.len() as u64 == all;
        (whole && reader.digest()? == digest.hex()).then_some(chunk)
    }

    /// Keeps runs of `rows` rows each.
    pub fn save(&self, chunk: &Chunk, rows: usize) -> Result<(), Error> {
        let range = chunk.first..chunk.first + (chunk.errors.len() / rows) as u64;
        let (path, part) = (self.path(&range), self.folder.join(format!("{}{PART}", chunk.first)));
        let result = Writer::create(&part, &self.times).and_then(|mut writer| {
            writer.add(chunk)?;
            writer.finish()?;
            settle(&part, &path)
        });
        if result.is_err() {
            let _ = fs::remove_file(&part);
        }
        result.map_err(told)
    }

    fn path(&self, range: &Range<u64>) -> PathBuf {
        self.folder.join(format!("{RUNS}{:010}-{:010}{PARQUET}", range.start, range.end))
    }
}

/// Takes a folder of finished runs away, if there is one: what says whose they are goes last. Whenever the program ends, what
/// is left can be opened again.
///
/// # Errors
/// It cannot be removed.
pub fn remove(folder: &Path) -> Result<(), Error> {
    remove_by(folder, |path| match fs::symlink_metadata(path)?.is_dir() {
        true => fs::remove_dir_all(path),
        false => fs::remove_file(path),
    })
}

fn remove_by(folder: &Path, mut take: impl FnMut(&Path) -> io::Result<()>) -> Result<(), Error> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries.and_then(|entries| entries.map(|e| Ok(e?.path())).collect::<io::Result<Vec<_>>>()),
    };
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |source| Error::Write { path, source }
    };
    let (last, others): (Vec<_>, Vec<_>) =
        entries.map_err(failed(folder))?.into_iter().partition(|path| path.ends_with(IDENTITY));
    for path in others.iter().chain(&last) {
        take(path).map_err(failed(path))?;
    }
    fs::remove_dir(folder).map_err(failed(folder))
}

/// Begin and end of the name of a file of runs.
const RUNS: &str = "runs-";
const PARQUET: &str = ".parquet";
/// End of the name of a file that is not whole yet.
const PART: &str = ".part";

/// Writes a file that is there as a whole or not at all.
fn whole(path: &Path, write: impl FnOnce(&Path) -> io::Result<()>) -> Result<(), Error> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(PART);
    let part = path.with_file_name(name);
    write(&part)
        .and_then(|()| File::open(&part)?.sync_all())
        .map_err(|source| Error::Write { path: path.into(), source })
        .and_then(|()| settle(&part, path))
        .inspect_err(|_| drop(fs::remove_file(&part)))
        .map_err(told)
}

/// Where there is no room, also what can be done.
fn told(error: Error) -> Error {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    match error {
        Error::Write { path, source }
            if matches!(source.kind(), StorageFull | QuotaExceeded | FileTooLarge) =>
        {
            let text = format!("{source}; make room and start again: it goes on with the runs that are kept");
            Error::Write { path, source: io::Error::new(source.kind(), text) }
        }
        other => other,
    }
}

/// Gives a file its name, and waits until the folder knows it.
fn settle(part: &Path, path: &Path) -> Result<(), Error> {
    fs::rename(part, path)
        .and_then(|()| match path.parent() {
            // Where folders cannot be opened (Windows), renaming is all there is.
            Some(folder) => File::open(folder).map_or(Ok(()), |folder| folder.sync_all()),
            None => Ok(()),
        })
        .map_err(|source| Error::Write { path: path.into(), source })
}

fn refused(folder: &Path, problem: impl Into<String>) -> Diagnostic {
    Diagnostic::new(folder, problem)
        .help("take the folder away to begin anew, or choose another place with --out DIR")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ended after any number of its steps, the removal leaves what the same study opens and another refuses.
    #[test]
    fn a_removal_that_is_cut_off_leaves_what_can_be_opened() {
        let folder = std::env::temp_dir().join(format!("schuler-removal-{}", std::process::id()));
        let of = |seed| Identity { version: "1".into(), scenario_hash: "a".into(), seed, runs: 30, rows: 1 };
        let chunk = |first| Chunk { first, errors: vec![[1.0; 9]; 10] };
        for kept in 0..=4_u64 {
            let state = State::open(&folder, &of(1), vec![0.0]).unwrap();
            for first in [0, 10, 20] {
                state.save(&chunk(first), 1).unwrap();
            }
            let mut removed = 0;
            let result = remove_by(&folder, |path| {
                removed += 1;
                if removed > kept { Err(io::ErrorKind::Interrupted.into()) } else { fs::remove_file(path) }
            });
            assert_eq!(result.is_ok(), kept == 4, "{kept}");
            if kept < 4 {
                assert!(State::open(&folder, &of(2), vec![0.0]).is_err(), "{kept}");
            }
            let state = State::open(&folder, &of(1), vec![0.0]).unwrap();
            let ranges = state.ranges().unwrap();
            assert_eq!(ranges.len() as u64, 3_u64.saturating_sub(kept));
            assert!(ranges.iter().all(|range| state.load(range) == Some(chunk(range.start))));
            remove(&folder).unwrap();
            assert!(!folder.exists());
        }
        remove(&folder).unwrap();
    }
}
