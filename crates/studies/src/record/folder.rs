//! A record as a folder, all of it or nothing.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::Record;
use crate::{Error, scenario::Formats};

/// What a run leaves in its folder beside `*.csv`: by this a folder of an earlier run is known.
const SUMMARY: &str = "summary.json";
const FIGURES: &str = "figures";

/// A place for the results of a run, checked before the run begins.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Checks that `path` can become the folder of a run: it is absent, empty or of an earlier run, and its
    /// parent takes new folders. Nothing is left on the disk.
    ///
    /// # Errors
    /// [`Error::Write`] that says what is in the way.
    pub fn check(path: impl Into<PathBuf>) -> Result<Self, Error> {
        let folder = Folder { path: path.into() };
        let write = |source| Error::Write { path: folder.path.clone(), source };
        if let Some(stranger) = stranger(&folder.path).map_err(write)? {
            let text = format!(
                "there is `{}`, which is of no run; choose another folder with --out",
                stranger.to_string_lossy()
            );
            return Err(write(io::Error::new(io::ErrorKind::AlreadyExists, text)));
        }
        // The nearest folder that exists must take a new one.
        let mut above = folder.path.parent();
        while let Some(parent) = above.filter(|p| !p.as_os_str().is_empty() && !p.exists()) {
            above = parent.parent();
        }
        let above = above.filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let probe = above.join(format!(".schuler-probe-{}", std::process::id()));
        fs::create_dir(&probe).and_then(|()| fs::remove_dir(&probe)).map_err(write)?;
        Ok(folder)
    }

    /// Where the results will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the record: first into a folder beside the target, which takes its place when complete.
    ///
    /// # Errors
    /// [`Error::Write`] or [`Error::Figure`]; then nothing has changed.
    pub fn write(&self, record: &Record, formats: Formats) -> Result<(), Error> {
        let part = self.beside("part");
        let result = fill(&part, record, formats).and_then(|()| {
            self.replace(&part).map_err(|source| Error::Write { path: self.path.clone(), source })
        });
        if result.is_err() {
            let _ = fs::remove_dir_all(&part);
        }
        result
    }

    /// `out/.name.part-123`.
    fn beside(&self, what: &str) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        self.path.with_file_name(format!(".{name}.{what}-{}", std::process::id()))
    }

    fn replace(&self, part: &Path) -> io::Result<()> {
        if !self.path.exists() {
            return fs::rename(part, &self.path);
        }
        let old = self.beside("old");
        fs::rename(&self.path, &old)?;
        if let Err(error) = fs::rename(part, &self.path) {
            fs::rename(&old, &self.path)?;
            return Err(error);
        }
        fs::remove_dir_all(&old)
    }
}

/// An entry of an existing folder that no run has written, or the path itself where it is no folder.
fn stranger(path: &Path) -> io::Result<Option<std::ffi::OsString>> {
    let entries = match fs::read_dir(path) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(_) if path.is_file() => return Ok(path.file_name().map(Into::into)),
        Err(error) => return Err(error),
    };
    let names: Vec<std::ffi::OsString> =
        entries.map(|e| e.map(|e| e.file_name())).collect::<Result<_, _>>()?;
    let ours = |name: &std::ffi::OsString| {
        name == SUMMARY
            || name == FIGURES
            || Path::new(name).extension().is_some_and(|e| e == "csv" || e == "yaml")
    };
    // Without a summary even a CSV may be anybody's.
    let run = names.iter().any(|name| name == SUMMARY);
    Ok(names.into_iter().find(|name| !run || !ours(name)))
}

fn fill(part: &Path, record: &Record, formats: Formats) -> Result<(), Error> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |source| Error::Write { path, source }
    };
    fs::create_dir_all(part).map_err(failed(part))?;
    let mut files = Vec::new();
    if formats.csv {
        for table in &record.tables {
            let name = format!("{}.csv", table.name);
            let path = part.join(&name);
            let mut file = fs::File::create(&path).map_err(failed(&path))?;
            table.write_csv(&mut file).map_err(failed(&path))?;
            files.push(name);
        }
    }
    for (name, text) in &record.texts {
        let path = part.join(name);
        fs::write(&path, text).map_err(failed(&path))?;
        files.push(name.clone());
    }
    let mut draw = |extension: &str, write: &dyn Fn(&crate::figure::Figure, &Path) -> Result<(), _>| {
        for (stem, figure) in &record.figures {
            let name = format!("{FIGURES}/{stem}.{extension}");
            let failed =
                |e: crate::figure::FigureError| Error::Figure { figure: name.clone(), reason: e.to_string() };
            write(figure, &part.join(&name)).map_err(failed)?;
            files.push(name);
        }
        Ok::<(), Error>(())
    };
    if (formats.png || formats.svg) && !record.figures.is_empty() {
        let path = part.join(FIGURES);
        fs::create_dir(&path).map_err(failed(&path))?;
    }
    if formats.png {
        draw("png", &|figure, path| figure.write_png(path))?;
    }
    if formats.svg {
        draw("svg", &|figure, path| figure.write_svg(path))?;
    }
    files.push(SUMMARY.into());
    let path = part.join(SUMMARY);
    fs::write(&path, record.summary_json(&files)).map_err(failed(&path))
}
