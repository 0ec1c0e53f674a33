//! A record as a folder, all of it or nothing.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::Record;
use crate::{Diagnostic, Error, scenario::Formats};

/// Lists the files of a run: by this a folder of an earlier run, and what in it is the run's own, are known.
const SUMMARY: &str = "summary.json";
/// The same of a folder of runs that are to be merged.
pub const MANIFEST: &str = "manifest.json";
const FIGURES: &str = "figures";
/// Begin of the name of the empty folder that is made and taken away to see whether one can be made.
const PROBE: &str = ".schuler-probe-";
const EXPECTED: &str = "a new folder, an empty one, or one with nothing but the files of an earlier run, \
                        where new files can be made";
const HELP: &str = "choose another folder with --out DIR";

/// A place for the results of a run, checked before the run begins.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    /// Whether a part of a study, which only another part may replace, is in nobody's way.
    for_part: bool,
}

impl Folder {
    /// Checks that `path` can become the folder of a run: it is absent, empty or holds nothing but the files
    /// that an earlier run lists in its summary, and new files can be made. Nothing is left on the disk. Where a program was
    /// killed while it put new results in the place of earlier ones, those are there again.
    ///
    /// # Errors
    /// [`Error::Input`] that says what is in the way; a part of a study is.
    pub fn check(path: impl Into<PathBuf>) -> Result<Self, Error> {
        Folder { path: path.into(), for_part: false }.checked()
    }

    /// As [`Folder::check`], for a part of a study: it may take the place of a part.
    ///
    /// # Errors
    /// As [`Folder::check`].
    pub fn check_for_part(path: impl Into<PathBuf>) -> Result<Self, Error> {
        Folder { path: path.into(), for_part: true }.checked()
    }

    fn checked(self) -> Result<Self, Error> {
        let folder = self;
        let target = folder.target();
        if !target.exists() {
            // Fails where there is nothing to give back.
            let _ = fs::rename(beside(&target, "old"), &target);
        }
        folder.usable().map_err(|(problem, found)| {
            Diagnostic::new(&folder.path, problem).expected(EXPECTED).found(found).help(HELP)
        })?;
        Ok(folder)
    }

    /// Where the results will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the record: first into a folder beside the target, which takes its place when complete.
    /// Of what was there, only the files that the earlier run lists go.
    ///
    /// # Errors
    /// [`Error::Write`], [`Error::Input`] or [`Error::Figure`]; then nothing has changed.
    pub fn write(&self, record: &Record, formats: Formats) -> Result<(), Error> {
        self.put(|part| fill(part, record, formats))
    }

    /// As [`Folder::write`] with whatever `fill` puts into the new folder; its [`MANIFEST`] lists the files.
    pub(crate) fn put(&self, fill: impl FnOnce(&Path) -> Result<(), Error>) -> Result<(), Error> {
        let target = self.target();
        let part = beside(&target, "part");
        let made = absent_above(&target);
        let new = |source| Error::Write { path: part.clone(), source };
        let begun = cleared(&part).and_then(|()| fs::create_dir_all(&part)).map_err(new);
        let result = begun.and_then(|()| fill(&part)).and_then(|()| {
            // Somebody may have put a file there while the study ran.
            Folder { path: self.path.clone(), for_part: self.for_part }.checked()?;
            replace(&target, &part).map_err(|source| Error::Write { path: self.path.clone(), source })
        });
        if result.is_err() {
            let _ = fs::remove_dir_all(&part);
            // Folders made on the way; one that is not empty stays.
            for folder in made {
                let _ = fs::remove_dir(folder);
            }
        }
        result
    }

    /// A link stays, what it leads to is replaced.
    fn target(&self) -> PathBuf {
        fs::canonicalize(&self.path).unwrap_or_else(|_| self.path.clone())
    }

    /// What is wrong with the folder, and what was found; `Ok` where it can be used.
    fn usable(&self) -> Result<(), (String, String)> {
        let refused = |path: &Path| {
            let path = path.display().to_string();
            move |error: io::Error| ("cannot write the results here".to_string(), format!("{path}: {error}"))
        };
        if self.path.symlink_metadata().is_ok() {
            if !self.path.is_dir() {
                return Err(("cannot write the results here".into(), "a file that is no folder".into()));
            }
            let files = files(&self.path).map_err(refused(&self.path))?;
            if !self.for_part && files.iter().any(|name| name == MANIFEST) {
                return Err((
                    "the folder holds a part of a study, which would be lost".into(),
                    format!("`{MANIFEST}`"),
                ));
            }
            let own = own(&self.path);
            if let Some(stranger) = files.iter().find(|name| !own.contains(*name)) {
                return Err((
                    "the folder holds a file that is not from an earlier run and would be lost".into(),
                    format!("`{stranger}`"),
                ));
            }
            for inside in [self.path.clone(), self.path.join(FIGURES)] {
                if inside.is_dir() {
                    probe(&inside).map_err(refused(&inside))?;
                }
            }
        }
        // The nearest folder that exists must take a new one.
        let target = self.target();
        let absent = absent_above(&target);
        let above = match absent.last() {
            Some(absent) => absent.parent(),
            None => target.parent(),
        };
        let above = above.filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        probe(above).map_err(refused(above))
    }
}

/// `out/.name.part`: the same in every process, so that the next one finds what a killed one left.
fn beside(path: &Path, what: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{what}"))
}

/// Takes away what a killed program had begun to write.
fn cleared(part: &Path) -> io::Result<()> {
    match fs::remove_dir_all(part) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// The folders above `path` that do not exist, the nearest first.
fn absent_above(path: &Path) -> Vec<PathBuf> {
    let above = path.ancestors().skip(1).filter(|p| !p.as_os_str().is_empty());
    above.take_while(|p| !p.exists()).map(Path::to_path_buf).collect()
}

/// Makes an entry in a folder and takes it away.
fn probe(folder: &Path) -> io::Result<()> {
    let probe = folder.join(format!("{PROBE}{}", std::process::id()));
    fs::create_dir(&probe).and_then(|()| fs::remove_dir(&probe))
}

fn replace(target: &Path, part: &Path) -> io::Result<()> {
    if !target.exists() {
        return fs::rename(part, target);
    }
    let old = beside(target, "old");
    if old.exists() {
        retire(&old)?;
    }
    fs::rename(target, &old)?;
    if let Err(error) = fs::rename(part, target) {
        fs::rename(&old, target)?;
        return Err(error);
    }
    retire(&old)
}

/// Takes the files of an earlier run away, one by one and by name: what nobody listed cannot go. The list itself goes last, so
/// that who is killed meanwhile can be followed.
fn retire(old: &Path) -> io::Result<()> {
    let own = own(old);
    let (lists, others): (Vec<_>, Vec<_>) = files(old)?
        .into_iter()
        .filter(|name| own.contains(name))
        .partition(|name| [SUMMARY, MANIFEST].contains(&name.as_str()));
    for name in others.iter().chain(&lists) {
        let path = old.join(name);
        if path.is_dir() { fs::remove_dir(path)? } else { fs::remove_file(path)? }
    }
    fs::remove_dir(old)
}

/// Every entry of a folder and of its figures, as a summary lists them; the folder of figures last. A probe whose maker was
/// killed is none of them and goes.
fn files(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    let mut figures = false;
    for entry in entries(folder)? {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name == FIGURES && entry.file_type()?.is_dir() {
            figures = true;
        } else {
            names.push(name);
        }
    }
    if figures {
        for entry in entries(&folder.join(FIGURES))? {
            names.push(format!("{FIGURES}/{}", entry.file_name().to_string_lossy()));
        }
        names.push(FIGURES.into());
    }
    Ok(names)
}

fn entries(folder: &Path) -> io::Result<Vec<fs::DirEntry>> {
    let mut entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
    entries.retain(|entry| {
        let probe = entry.file_name().to_string_lossy().starts_with(PROBE);
        !(probe && fs::remove_dir(entry.path()).is_ok())
    });
    Ok(entries)
}

/// What the summary in a folder lists, with itself and the folder of figures; nothing where there is no such summary.
fn own(folder: &Path) -> Vec<String> {
    #[derive(serde::Deserialize)]
    struct Summary {
        files: Vec<String>,
    }
    let listed = [SUMMARY, MANIFEST].into_iter().find_map(|name| {
        let text = fs::read_to_string(folder.join(name)).ok()?;
        Some((serde_json::from_str::<Summary>(&text).ok()?.files, name))
    });
    let Some((mut files, name)) = listed else { return Vec::new() };
    if files.iter().any(|name| name.starts_with("figures/")) {
        files.push(FIGURES.into());
    }
    files.push(name.into());
    files
}

fn fill(part: &Path, record: &Record, formats: Formats) -> Result<(), Error> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |source| Error::Write { path, source }
    };
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
