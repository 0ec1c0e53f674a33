//! A new term costs one file and at most six lines elsewhere.

use std::fs;
use std::path::Path;

use schuler_imu::TERMS;

fn sources(dir: &Path, out: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push((path.display().to_string(), fs::read_to_string(&path).unwrap()));
        }
    }
}

/// Lines of the library that name a term's module or type, outside of its file.
#[test]
fn a_term_is_one_file_and_a_few_lines() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    for term in TERMS {
        let name = term.name();
        let own = format!("term/{name}.rs");
        assert!(files.iter().any(|(path, _)| path.ends_with(&own)), "{own} is missing");
        let elsewhere: usize = files
            .iter()
            .filter(|(path, _)| !path.ends_with(&own))
            .flat_map(|(_, text)| text.lines())
            .filter(|line| line.contains(&format!("mod {name};")) || line.contains(&format!("{name}::")))
            .count();
        assert!(elsewhere <= 6, "{name} takes {elsewhere} lines elsewhere");
    }
}
