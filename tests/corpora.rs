//! The files that the fuzzer begins with, and those it found something wrong with, hold what it
//! asks of any bytes: see `fuzz/README.md`.

#[path = "../fuzz/src/lib.rs"]
mod checks;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time after which a file counts as one that hangs: several times what the slowest one takes
/// without optimisation, a motion of 16,000 frames.
const LONGEST: Duration = Duration::from_secs(60);

/// Runs the check of a target on all its files.
fn replay(target: &str, check: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    let [seeds, regressions] = ["seeds", "regressions"].map(|kind| folder.join(kind).join(target));
    let seeds = files(&seeds);
    assert!(!seeds.is_empty(), "{target} has no seeds");
    for file in seeds.into_iter().chain(files(&regressions)) {
        // Shown if the check fails.
        println!("{}", file.display());
        let start = Instant::now();
        check(&fs::read(&file).expect("a file"));
        assert!(start.elapsed() < LONGEST, "{} takes {:?}", file.display(), start.elapsed());
    }
}

/// In order; none where there is no folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files
}

#[test]
fn documents_are_refused_or_saved_unchanged() {
    replay("document", checks::document);
}

#[test]
fn scenes_are_refused_or_have_valid_skeletons() {
    replay("js3d", checks::js3d);
}

#[test]
fn motions_are_refused_or_have_valid_skeletons() {
    replay("bvh", checks::bvh);
}

#[test]
fn robots_are_refused_or_have_valid_skeletons() {
    replay("urdf", checks::urdf);
}

#[test]
fn meshes_are_refused_or_valid() {
    replay("obj", checks::obj);
}

#[test]
fn gltf_is_refused_or_has_valid_skeletons() {
    replay("gltf", checks::gltf);
}

#[test]
fn lines_are_refused_or_have_poses_that_match_their_report() {
    replay("json_lines", checks::json_lines);
}

#[test]
fn arms_and_jobs_of_any_numbers_are_refused_or_have_finite_poses() {
    replay("two_bone", checks::two_bone);
}

#[test]
fn chains_of_any_numbers_are_refused_or_solved_within_limits() {
    replay("chain", checks::chain);
}
