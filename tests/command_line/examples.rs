//! `ik-arm examples`, as a person runs it.

use std::fs;
use std::process::Output;

use ik_arm::io::{self, Example};

use crate::run;

fn examples(arguments: &[&str]) -> Output {
    run(&[&["examples"], arguments].concat())
}

fn stdout(output: &Output) -> &str {
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    str::from_utf8(&output.stdout).expect("UTF-8")
}

#[test]
fn without_a_name_all_examples_are_listed_with_descriptions() {
    let output = examples(&[]);
    let lines: Vec<_> = stdout(&output).lines().collect();
    assert_eq!(lines.len(), Example::ALL.len());
    for (line, example) in lines.iter().zip(Example::ALL) {
        assert!(line.starts_with(&format!("{} ", example.name)), "{line}");
        assert!(line.ends_with(&format!(" {}: {}", example.title, example.sentence)), "{line}");
    }
}

#[test]
fn with_a_name_the_example_is_printed() {
    for example in Example::ALL {
        let output = examples(&[example.name]);
        assert_eq!(stdout(&output), example.text);
        io::parse("printed", stdout(&output), &io::OpenOptions::default()).expect("it opens");
    }
}

#[test]
fn with_an_output_the_example_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("snake.json");
    let output = examples(&["snake", "-o", path.to_str().expect("a path in UTF-8")]);
    assert_eq!(stdout(&output), "");
    let opened = io::open(&path, &io::OpenOptions::default()).expect("it opens");
    assert_eq!(opened.document.skeleton().joints().len(), 24);
}

#[test]
fn a_file_that_cannot_be_written_is_an_error_that_names_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("missing/snake.json");
    let output = examples(&["snake", "-o", path.to_str().expect("a path in UTF-8")]);
    assert_eq!(output.status.code(), Some(1));
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(complaint.contains(&*path.to_string_lossy()), "{complaint}");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn an_unknown_name_is_a_usage_error_that_lists_the_known_ones() {
    for arguments in [["horse"].as_slice(), &["-o", "x.json"]] {
        let output = examples(arguments);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    }
    let complaint = examples(&["horse"]).stderr;
    let complaint = String::from_utf8_lossy(&complaint);
    assert!(Example::ALL.iter().all(|example| complaint.contains(example.name)), "{complaint}");
}
