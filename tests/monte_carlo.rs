//! A Monte Carlo that is killed, cut into parts, and run by other people's engines.

use std::{
    collections::BTreeMap,
    fs,
    path::Path,
    process::{Command, Output, Stdio},
    thread::sleep,
    time::Duration,
};

use crate::cli::{Place, text};

const SCENARIO: &str = "\
schuler: 1
study: monte_carlo
title: Many runs
start: { position: { lat: 45 deg, lon: 0 deg, h: 0 m } }
motion: static
duration: 40 s
imu:
  rate: 100 Hz
  gyro: [{ bias: { white: { density: 0.1 deg/sqrt(h) } } }, { bias: { constant: { sigma: 1 deg/h } } }]
  accel: [{ bias: { gauss_markov: { sigma: 1 mg, tau: 10 s } } }]
monte_carlo: { runs: 1000, initial_sigmas: { tilt: [1 arcmin, 1 arcmin] }, thresholds: [{ name: far, quantity: horizontal_m, limit: 10 m }] }
mechanization: { frame: t, vertical: held, gravity: somigliana }
output: { every: 4 s, formats: [csv, svg] }
";

fn place(name: &str) -> Place {
    let place = Place::new(&format!("monte-carlo-{name}"));
    fs::write(place.0.join("a.yaml"), SCENARIO).expect("a scenario");
    place
}

fn command(place: &Place, arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("schuler"));
    command.current_dir(&place.0).args(arguments).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn succeeds(place: &Place, arguments: &[&str]) {
    let output = command(place, arguments).output().expect("it starts");
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
}

fn refused(place: &Place, arguments: &[&str], messages: &[&str]) {
    let output = place.schuler(arguments);
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
    for message in messages {
        assert!(error.contains(message), "{arguments:?}: `{message}` is not in: {error}");
    }
}

/// Every file of a result, but for the command that was typed.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.is_dir() {
            all.extend(files(&path).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            let bytes = fs::read(&path).expect("a file");
            let bytes = match name.as_str() {
                "summary.json" => {
                    let lines: Vec<String> = text(&bytes)
                        .lines()
                        .filter(|l| !l.contains("\"command\""))
                        .map(String::from)
                        .collect();
                    lines.join("\n").into_bytes()
                }
                _ => bytes,
            };
            all.insert(name, bytes);
        }
    }
    all
}

fn same(place: &Place, a: &str, b: &str) {
    let (a, b) = (files(&place.0.join(a)), files(&place.0.join(b)));
    assert!(a.len() > 5 && a.keys().eq(b.keys()), "{:?} {:?}", a.keys(), b.keys());
    for (name, bytes) in &a {
        assert!(bytes == &b[name], "{name} differs");
    }
}

/// Killed twenty times at moments of a fixed sequence, then left alone: nothing is lost and nothing changes.
#[test]
fn killed_and_started_again_it_ends_with_the_same_bytes() {
    let place = place("kill");
    // Many short runs: there is something to lose every few milliseconds.
    let short = ["--set", "monte_carlo.runs=3000", "--set", "duration=12 s"];
    let run = |out: &str| command(&place, &[&["run", "a.yaml", "--out", out][..], &short].concat());
    assert!(run("whole").status().expect("it starts").success());
    let mut x: u64 = 7;
    let (mut kills, mut went_on) = (0, 0);
    for round in 0..40 {
        let out = format!("killed-{round}");
        loop {
            x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let mut child = run(&out).spawn().expect("it starts");
            if kills < 20 {
                sleep(Duration::from_millis(20 + (x >> 33) % 400));
            } else {
                let _ = child.wait();
            }
            let finished = child.try_wait().expect("a child").is_some();
            let _ = child.kill();
            let output = child.wait_with_output().expect("it ends");
            if finished {
                assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
                break;
            }
            kills += 1;
            let kept = place.0.join(format!("{out}.partial"));
            went_on += usize::from(fs::read_dir(kept).is_ok_and(|entries| entries.count() > 2));
        }
        same(&place, "whole", &out);
        assert!(!place.0.join(format!("{out}.partial")).exists());
        if kills >= 20 {
            break;
        }
    }
    assert!(kills == 20 && went_on >= 5, "{kills} kills, {went_on} of them with finished runs");
}

/// Killed at the very end, when its results are there and what was kept is being taken away.
#[test]
fn killed_when_its_results_are_there() {
    let place = place("kill-last");
    let short = ["--set", "monte_carlo.runs=1000", "--set", "duration=12 s"];
    let run = |out: &str| command(&place, &[&["run", "a.yaml", "--out", out][..], &short].concat());
    assert!(run("whole").status().expect("it starts").success());
    for round in 0..4 {
        let out = format!("killed-{round}");
        let mut child = run(&out).spawn().expect("it starts");
        while !place.0.join(&out).exists() && child.try_wait().expect("a child").is_none() {
            std::hint::spin_loop();
        }
        let _ = child.kill();
        let _ = child.wait();
        let again = run(&out).output().expect("it starts");
        assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
        same(&place, "whole", &out);
        assert!(!place.0.join(format!("{out}.partial")).exists());
    }
}

/// Parts of any size, merged in any order, are the study.
#[test]
fn merged_parts_are_one_process() {
    let place = place("merge");
    succeeds(&place, &["run", "a.yaml", "--out", "whole"]);
    for k in 1..=3 {
        succeeds(&place, &["run", "a.yaml", "--shard", &format!("{k}/3"), "--out", &format!("p{k}")]);
    }
    // A part that is there is not made again.
    let written =
        |part: &str| fs::metadata(place.0.join(part).join("runs.parquet")).and_then(|m| m.modified());
    let before = written("p2").expect("a time");
    succeeds(&place, &["run", "a.yaml", "--shard", "2/3", "--out", "p2"]);
    assert_eq!(before, written("p2").expect("a time"));
    for (k, order) in [["p1", "p2", "p3"], ["p3", "p1", "p2"], ["p2", "p3", "p1"]].iter().enumerate() {
        let out = format!("merged-{k}");
        succeeds(&place, &["merge", order[0], order[1], order[2], "--out", &out]);
        same(&place, "whole", &out);
    }
    for (k, runs) in ["0..1", "1..700", "700..1000"].iter().enumerate() {
        succeeds(&place, &["run", "a.yaml", "--runs", runs, "--out", &format!("r{k}")]);
    }
    succeeds(&place, &["merge", "r2", "r0", "r1", "--out", "of-ranges"]);
    same(&place, "whole", "of-ranges");
    // What ends early in one process does so in parts.
    let set = "monte_carlo.until={ quantity: dn_m, way: rms, at: 40 s, relative: 12 % }";
    succeeds(&place, &["run", "a.yaml", "--set", set, "--out", "early"]);
    for k in 1..=2 {
        let part = format!("{k}/2");
        succeeds(&place, &["run", "a.yaml", "--set", set, "--shard", &part, "--out", &format!("e{k}")]);
    }
    succeeds(&place, &["merge", "e2", "e1", "--out", "early-merged"]);
    same(&place, "early", "early-merged");
    assert!(text(&fs::read(place.0.join("early/summary.json")).expect("a summary")).contains("after 256 of"));
}

/// Parts that do not belong together are refused, and what was there before stays.
#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let place = place("refused");
    for (out, runs, seed) in
        [("a", "0..500", "1"), ("b", "500..1000", "1"), ("c", "400..1000", "1"), ("other", "500..1000", "2")]
    {
        succeeds(&place, &["run", "a.yaml", "--runs", runs, "--seed", seed, "--out", out]);
    }
    let set = "imu.rate=50 Hz";
    succeeds(&place, &["run", "a.yaml", "--runs", "500..1000", "--set", set, "--seed", "1", "--out", "slow"]);
    succeeds(&place, &["merge", "a", "b", "--out", "result"]);
    let before = files(&place.0.join("result"));
    let merge = |parts: &[&str], messages: &[&str]| {
        let arguments: Vec<&str> =
            ["merge"].iter().chain(parts).chain(&["--out", "result"]).copied().collect();
        refused(&place, &arguments, messages);
    };
    merge(&["a", "other"], &["another seed", "expected: 1", "found: 2"]);
    merge(&["a", "slow"], &["another scenario"]);
    merge(&["a", "c"], &["stand twice", "from run 500 on"]);
    merge(&["a", "a", "b"], &["stand twice"]);
    merge(&["a"], &["runs after this part are missing", "up to run 1000"]);
    merge(&["b"], &["runs before this part are missing"]);
    merge(&["a", "nowhere"], &["cannot read nowhere/manifest.json"]);
    // Nothing but a part takes the place of one.
    let part = files(&place.0.join("b"));
    for arguments in [
        &["merge", "a", "b", "--out", "b"][..],
        &["run", "a.yaml", "--run", "3", "--out", "b"],
        &["run", "a.yaml", "--out", "b"],
    ] {
        refused(&place, arguments, &["holds a part of a study", "`manifest.json`"]);
    }
    assert_eq!(files(&place.0.join("b")), part);
    // Another version.
    let manifest = fs::read_to_string(place.0.join("b/manifest.json")).expect("a manifest");
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(manifest.contains(&version));
    fs::write(place.0.join("b/manifest.json"), manifest.replace(&version, "\"version\": \"9.9.9\""))
        .expect("written");
    merge(&["a", "b"], &["another version", "9.9.9"]);
    // A scenario that is not the one of the runs.
    assert!(manifest.contains("duration: 40 s"), "{manifest}");
    fs::write(place.0.join("b/manifest.json"), manifest.replace("duration: 40 s", "duration: 50 s"))
        .expect("written");
    merge(&["a", "b"], &["the scenario in its manifest is not the one of its runs"]);
    fs::write(place.0.join("b/manifest.json"), &manifest).expect("written");
    // A truncated file, a damaged one, and one of other runs.
    let runs = fs::read(place.0.join("b/runs.parquet")).expect("runs");
    fs::write(place.0.join("b/runs.parquet"), &runs[..runs.len() / 2]).expect("written");
    merge(&["a", "b"], &["damaged or incomplete", "make the part again"]);
    let mut damaged = runs.clone();
    damaged[runs.len() / 3] ^= 1;
    fs::write(place.0.join("b/runs.parquet"), damaged).expect("written");
    merge(&["a", "b"], &["damaged or incomplete"]);
    fs::copy(place.0.join("a/runs.parquet"), place.0.join("b/runs.parquet")).expect("copied");
    merge(&["a", "b"], &["damaged or incomplete", "run 0 in place of 500"]);
    fs::write(place.0.join("b/runs.parquet"), &runs).expect("written");
    assert!(before == files(&place.0.join("result")));
    succeeds(&place, &["merge", "b", "a", "--out", "result"]);
    assert!(before == files(&place.0.join("result")));
    // Arguments.
    refused(&place, &["run", "a.yaml", "--shard", "0/3"], &["as in 3/8"]);
    refused(&place, &["run", "a.yaml", "--runs", "5..5"], &["as in 0..500"]);
    refused(&place, &["run", "a.yaml", "--runs", "500..1001"], &["no such runs", "runs within 0..1000"]);
    refused(&place, &["run", "a.yaml", "--run", "1000"], &["no such run", "0 to 999"]);
    refused(&place, &["plan", "--slurm", "1001", "a.yaml"], &["not so many parts"]);
}

/// A file system of two megabytes, in a mount namespace of its own. It holds earlier results, and a file that leaves little room:
/// too little for the first runs, then for all runs, then for the results of a few runs. Copies go to `seen`, which is outside.
const SMALL_DISK: &str = r#"
set -eu
mkdir disk seen
mount -t tmpfs -o size=2m none disk
schuler run a.yaml --quiet --out disk/out
cp -r disk/out seen/earlier
attempt() { # name, kilobytes, arguments
  name=$1 free=$2; shift 2
  room=$(df -k --output=avail disk | tail -n 1)
  head -c $(( (room - free) * 1024 )) /dev/zero > disk/filler
  code=0; schuler run a.yaml --quiet --out disk/out "$@" 2> "seen/$name.error" || code=$?
  echo $code > "seen/$name.code"
  cp -r disk/out "seen/$name"
  rm disk/filler
}
attempt first 16 $MANY --seed 2
attempt some 200 $MANY --seed 2
ls disk/out.partial > seen/kept
attempt resumed 1300 $MANY --seed 2
test ! -e disk/out.partial
attempt results 40 --seed 3 --set monte_carlo.runs=2
schuler run a.yaml --quiet --out disk/out --seed 3 --set monte_carlo.runs=2
cp -r disk/out seen/few
"#;

/// A disk that is full says so, leaves what was there, and once there is room the study goes on to the same bytes. Where nobody may
/// mount anything, that is said.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_loses_nothing() {
    let probe = |namespace: &[&str]| {
        let place = place("probe");
        fs::create_dir(place.0.join("disk")).expect("a folder");
        let mut command = Command::new(namespace[0]);
        command.current_dir(&place.0).args(&namespace[1..]);
        command.args(["mount", "-t", "tmpfs", "-o", "size=64k", "none", "disk"]);
        command.output().is_ok_and(|output| output.status.success())
    };
    let namespaces: [&[&str]; 2] =
        [&["unshare", "--user", "--map-root-user", "--mount"], &["unshare", "--mount"]];
    let Some(namespace) = namespaces.into_iter().find(|namespace| probe(namespace)) else {
        eprintln!("skipped: neither a user namespace nor the rights of root to mount a small file system");
        return;
    };
    let place = place("disk");
    // So many samples that 128 runs, 100 kB, take one thread longer than the tenth of a second after which runs are kept.
    let many = "--set imu.rate=2kHz --set monte_carlo.runs=512";
    let arguments: Vec<&str> =
        ["run", "a.yaml", "--seed", "2", "--out", "whole"].into_iter().chain(many.split(' ')).collect();
    succeeds(&place, &arguments);
    succeeds(&place, &["run", "a.yaml", "--seed", "3", "--set", "monte_carlo.runs=2", "--out", "whole few"]);
    fs::write(place.0.join("disk.sh"), SMALL_DISK).expect("a script");
    let output =
        bash(&place, &format!("RAYON_NUM_THREADS=1 MANY='{many}' {} bash disk.sh", namespace.join(" ")), &[]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let seen = |name: &str| fs::read_to_string(place.0.join("seen").join(name)).expect("a file");
    for (name, code) in [("first", "2"), ("some", "2"), ("resumed", "0"), ("results", "2")] {
        assert_eq!(seen(&format!("{name}.code")).trim(), code, "{name}: {}", seen(&format!("{name}.error")));
    }
    for (name, file) in [("first", "disk/out.partial/"), ("some", "disk/out.partial/"), ("results", "disk/")]
    {
        let error = seen(&format!("{name}.error"));
        let told = error.contains(file) && error.contains("No space left on device");
        assert!(told && error.contains("cannot write"), "{name}: {error}");
        assert!(name == "results" || error.contains("make room and start again"), "{name}: {error}");
    }
    assert!(seen("kept").contains("runs-0000000000-"), "{}", seen("kept"));
    same(&place, "seen/earlier", "seen/first");
    same(&place, "seen/earlier", "seen/some");
    same(&place, "whole", "seen/resumed");
    same(&place, "seen/resumed", "seen/results");
    same(&place, "whole few", "seen/few");
}

/// Unfinished runs of something else, and places that cannot be written.
#[test]
fn foreign_state_and_files_too_large_are_told() {
    let place = place("full");
    succeeds(&place, &["run", "a.yaml", "--out", "out"]);
    let before = files(&place.0.join("out"));
    // A limit on the size of files: the first file of finished runs does not fit.
    let program = assert_cmd::cargo::cargo_bin!("schuler");
    let limited =
        format!("trap '' XFSZ; ulimit -f 8; exec '{}' run a.yaml --seed 2 --out out", program.display());
    let output = Command::new("bash").current_dir(&place.0).args(["-c", &limited]).output().expect("bash");
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("cannot write out.partial/") && error.contains("File too large"), "{error}");
    assert!(error.contains("make room and start again"), "{error}");
    assert!(before == files(&place.0.join("out")));
    // With room again it goes on; with another seed it is told whose runs are in the way.
    refused(
        &place,
        &["run", "a.yaml", "--seed", "3", "--out", "out"],
        &["out.partial: unfinished runs of another seed", "expected: 3", "found: 2", "--out DIR"],
    );
    succeeds(&place, &["run", "a.yaml", "--seed", "2", "--out", "out"]);
    assert!(before != files(&place.0.join("out")) && !place.0.join("out.partial").exists());
    fs::create_dir(place.0.join("b.partial")).expect("a folder");
    fs::write(place.0.join("b.partial/notes.txt"), "mine").expect("a file");
    refused(&place, &["run", "a.yaml", "--out", "b"], &["no unfinished runs", "`notes.txt`"]);
    fs::write(place.0.join("c.partial"), "mine").expect("a file");
    refused(&place, &["run", "a.yaml", "--out", "c"], &["cannot write c.partial"]);
    #[cfg(target_os = "linux")]
    refused(
        &place,
        &["run", "a.yaml", "--shard", "1/2", "--out", "/proc/schuler/a"],
        &["cannot write the results here"],
    );
    // A chunk that was damaged after it was written is made again.
    let set = "monte_carlo.runs=200";
    let mut child =
        command(&place, &["run", "a.yaml", "--set", set, "--out", "d"]).spawn().expect("it starts");
    let _ = child.wait();
    succeeds(&place, &["run", "a.yaml", "--set", set, "--shard", "1/1", "--out", "e"]);
    succeeds(&place, &["merge", "e", "--out", "f"]);
    same(&place, "d", "f");
}

fn bash(place: &Place, script: &str, environment: &[(&str, String)]) -> Output {
    let program = Path::new(assert_cmd::cargo::cargo_bin!("schuler")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let mut command = Command::new("bash");
    command.current_dir(&place.0).env("PATH", path).args(["-c", script, "job"]);
    command.envs(environment.iter().map(|(k, v)| (k, v)));
    command.output().expect("bash")
}

/// The script for a Slurm array, its tasks in disorder as Slurm may start them.
#[test]
fn a_slurm_array_gives_the_same() {
    let place = place("slurm");
    succeeds(&place, &["run", "a.yaml", "--out", "whole"]);
    let plan = place.schuler(&["plan", "--slurm", "4", "a.yaml", "--out", "of array"]);
    let script = text(&plan.stdout);
    assert!(script.starts_with("#!/bin/bash\n#SBATCH") && script.contains("--array=1-4"), "{script}");
    for task in [3, 1, 4, 2] {
        let output = bash(&place, &script, &[("SLURM_ARRAY_TASK_ID", task.to_string())]);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    let output = bash(&place, &format!("set -- merge\n{script}"), &[]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    same(&place, "whole", "of array");
}

/// GNU parallel with the printed script. It is a package of its own: where it is not installed, that is said.
#[test]
fn gnu_parallel_gives_the_same() {
    let version = Command::new("parallel").arg("--version").output();
    if !version.is_ok_and(|v| text(&v.stdout).contains("GNU parallel")) {
        eprintln!("skipped: GNU parallel is not installed (apt-get install parallel)");
        return;
    }
    let place = place("parallel");
    succeeds(&place, &["run", "a.yaml", "--out", "whole"]);
    let plan = place.schuler(&["plan", "--gnu-parallel", "5", "a.yaml", "--out", "of parallel"]);
    let output = bash(&place, &text(&plan.stdout), &[]);
    assert!(output.status.success(), "{}\n{}", text(&plan.stdout), text(&output.stderr));
    same(&place, "whole", "of parallel");
}

/// Processes that Python starts and workers of Dask, as the page on Monte Carlo shows them.
#[test]
fn python_and_dask_give_the_same() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/studies/monte_carlo.md");
    let page = fs::read_to_string(page).expect("the page");
    let place = place("python");
    succeeds(&place, &["run", "a.yaml", "--out", "whole"]);
    for (number, module) in [(1, "multiprocessing"), (2, "dask.distributed")] {
        let import = Command::new("python3").args(["-c", &format!("import {module}")]).output();
        if !import.is_ok_and(|output| output.status.success()) {
            eprintln!("skipped: python3 with {module} is not installed");
            continue;
        }
        let code =
            page.split("```python\n").nth(number).and_then(|rest| rest.split("```").next()).expect("code");
        assert!(code.contains(&format!("from {module} import")));
        let out = format!("out/{number}");
        let code = code.replace("configs/monte_carlo_tactical.yaml", "a.yaml").replace("out/a", &out);
        fs::write(place.0.join("study.py"), code).expect("written");
        let output = bash(&place, "python3 study.py", &[]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        same(&place, "whole", &out);
    }
}
