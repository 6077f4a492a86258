//! `ik-arm completions` and `ik-arm manual`, as a packager runs them.

use std::fs;

use crate::run;

fn help() -> String {
    String::from_utf8(run(&["--help"]).stdout).expect("UTF-8")
}

/// The names of all commands, from the help.
fn commands() -> Vec<String> {
    let help = help();
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = lines.take_while(|line| !line.is_empty());
    let names = names.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

#[test]
fn every_shell_gets_completions_of_every_command() {
    assert!(commands().len() >= 10, "{:?}", commands());
    for shell in ["bash", "zsh", "fish"] {
        let output = run(&["completions", shell]);
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        let script = String::from_utf8(output.stdout).expect("UTF-8");
        for command in commands() {
            assert!(script.contains(&command), "{command} for {shell}");
        }
        assert!(script.contains("animation"), "options of commands for {shell}");
    }
}

#[test]
fn every_command_has_a_page_with_its_options() {
    let folder = tempfile::tempdir().expect("a folder");
    let pages = folder.path().join("man1");
    let output = run(&["manual", pages.to_str().expect("UTF-8")]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let whole = fs::read_to_string(pages.join("ik-arm.1")).expect("the page of the program");
    for command in commands() {
        assert!(whole.contains(&command.replace('-', "\\-")), "{command}");
        let page = fs::read_to_string(pages.join(format!("ik-arm-{command}.1"))).expect(&command);
        assert!(page.contains(".SH SYNOPSIS"), "{command}");
    }
    assert!(fs::read_to_string(pages.join("ik-arm-pose.1")).expect("a page").contains("animation"));
}

#[test]
fn pages_that_cannot_be_written_are_told_with_their_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a file");
    fs::write(&file, "").expect("a file");
    let output = run(&["manual", file.to_str().expect("UTF-8")]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(said.contains("a file") && said.contains("cannot write"), "{said}");
}

#[test]
fn a_shell_without_completions_is_refused_with_those_that_have_some() {
    let output = run(&["completions", "cmd"]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(said.contains("bash") && said.contains("zsh") && said.contains("fish"), "{said}");
}
