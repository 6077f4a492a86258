//! `ik-arm solve`, as a person or a script runs it.

mod reach;
mod twist;

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use glam::Vec3;
use ik_arm::kinematics::two_bone::{Reach, TwoBone};
use proptest::prelude::*;
use serde::Deserialize;
use serde_json::Value;

use crate::common::Random;
use crate::common::strategies::config;
use crate::{program, stderr};

const POSE: &str = r#"{"hand":[250,120,60]}"#;

// Running it

fn command() -> Command {
    let mut command = program();
    command.arg("solve").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn solve(input: impl AsRef<[u8]>) -> Output {
    feed(&mut command(), input.as_ref())
}

fn feed(command: &mut Command, input: &[u8]) -> Output {
    let mut child = command.spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it has a standard input");
    thread::scope(|scope| {
        // A program that has stopped reading is no failure of the test.
        scope.spawn(move || stdin.write_all(input));
        child.wait_with_output().expect("it ends")
    })
}

fn solve_file(path: &Path) -> Output {
    feed(command().arg(path), b"")
}

fn answers(output: &Output) -> Vec<String> {
    let text = str::from_utf8(&output.stdout).expect("the answers are UTF-8");
    assert!(text.is_empty() || text.ends_with('\n'), "the last line has an end: {text:?}");
    text.lines().map(str::to_owned).collect()
}

fn errors(output: &Output) -> Vec<(u64, String)> {
    answers(output).iter().filter_map(|line| error_of(line)).collect()
}

fn error_of(answer: &str) -> Option<(u64, String)> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct BadLine {
        line: u64,
        error: String,
    }
    serde_json::from_str(answer).ok().map(|BadLine { line, error }| (line, error))
}

/// The message that a line alone gets.
fn refusal(line: impl AsRef<[u8]>) -> String {
    let output = solve(line);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert_eq!(stderr(&output), "", "stderr is for failures of the run");
    match errors(&output).as_slice() {
        [(1, error)] => error.clone(),
        other => panic!("expected one bad line, got {other:?}"),
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    reach: String,
    elbow: Vec3,
    hand: Vec3,
    distance: f32,
    theta_z_deg: f32,
    theta_y_deg: f32,
    theta_e_deg: f32,
    along: f32,
    out: f32,
    // Null, not missing.
    #[serde(deserialize_with = "Option::deserialize")]
    reference_gain: Option<f32>,
    elbow_angle_deg: f32,
}

/// The pose that a line alone gets.
fn pose(line: &str) -> Answer {
    let mut poses = poses(&[line]);
    poses.pop().expect("one line has one pose")
}

/// The poses that lines get, all of them good.
fn poses(lines: &[impl AsRef<str>]) -> Vec<Answer> {
    let lines: Vec<&str> = lines.iter().map(AsRef::as_ref).collect();
    let output = solve(lines.join("\n"));
    let answers = answers(&output);
    assert_eq!(errors(&output), []);
    assert_eq!((output.status.code(), answers.len()), (Some(0), lines.len()), "{output:?}");
    assert_eq!(stderr(&output), "");
    let pose = |answer: &String| serde_json::from_str(answer).expect("the answer is a pose");
    answers.iter().map(pose).collect()
}

// Poses

#[test]
fn an_answer_has_exactly_these_keys_in_this_order() {
    let output = solve(r#"{"hand":[500,0,0],"root":[10,20,30]}"#);
    assert_eq!(
        answers(&output),
        [concat!(
            r#"{"reach":"reached","elbow":[210.0,20.0,30.0],"hand":[510.0,20.0,30.0],"#,
            r#""distance":500.0,"theta_z_deg":0.0,"theta_y_deg":0.0,"theta_e_deg":0.0,"#,
            r#""along":200.0,"out":0.0,"reference_gain":0.0,"elbow_angle_deg":180.0}"#
        )]
    );
}

#[test]
fn omitted_fields_default_to_the_original_arm_at_the_origin() {
    let full = concat!(
        r#"{"min_elbow_angle_deg":0,"max_stretch":1,"softness":0,"reference":"up","#,
        r#""twist_deg":0,"root":[0,0,0],"lower":300,"upper":200,"hand":[250,120,60]}"#
    );
    assert_eq!(answers(&solve(POSE)), answers(&solve(full)));
}

#[test]
fn an_unreachable_hand_is_a_result_and_not_an_error() {
    assert_eq!(pose(r#"{"hand":[0,600,0]}"#).reach, "too_far");
    assert_eq!(pose(r#"{"hand":[0,60,0]}"#).reach, "too_close");
    assert_eq!(pose(r#"{"hand":[0,0,0]}"#).hand, Vec3::new(100.0, 0.0, 0.0));
}

#[test]
fn each_line_is_solved_on_its_own() {
    let at_the_shoulder = r#"{"hand":[0,0,0]}"#;
    let alone = answers(&solve(at_the_shoulder));
    let after_another = answers(&solve(format!("{{\"hand\":[0,0,-400]}}\n{at_the_shoulder}")));
    assert_eq!(after_another[1..], alone);
}

#[test]
fn a_huge_twist_is_reduced_exactly_before_it_becomes_radians() {
    let twisted = |twist: f32| pose(&format!(r#"{{"hand":[250,120,60],"twist_deg":{twist:e}}}"#));
    assert_eq!(twisted(360.0 * 4096.0 + 90.0).elbow, twisted(90.0).elbow);
    assert_eq!(twisted(1e30).elbow, twisted(1e30 % 360.0).elbow);
    assert_eq!(twisted(-f32::MAX).elbow, twisted(-f32::MAX % 360.0).elbow);
}

#[test]
fn a_decimal_is_rounded_once() {
    // Just below the middle of two f32; as f64 it is the middle, which rounds up.
    let decimal = "1.00000017881393432617187499";
    let hand = pose(&format!(r#"{{"hand":[{decimal},0,0],"upper":1,"lower":0.5}}"#)).hand;
    assert_eq!(Ok(hand.x), decimal.parse());
    assert_ne!(hand.x, decimal.parse::<f64>().unwrap() as f32);
}

#[test]
fn escaped_keys_and_whitespace_anywhere_are_accepted() {
    let line = "\t { \"h\\u0061nd\" :\t[ 2.5e2 , 120.0,6E+1 ] } ";
    assert_eq!(answers(&solve(line)), answers(&solve(POSE)));
}

#[test]
fn numbers_read_back_to_the_same_f32_as_the_library_gives() {
    let mut random = Random(7);
    let query: Vec<Query> = (0..2000).map(|_| Query::random(&mut random)).collect();
    let lines: Vec<String> = query.iter().map(|query| query.line(&mut random)).collect();

    let output = solve(lines.join("\n"));

    let answers = answers(&output);
    assert_eq!(answers.len(), query.len());
    for ((query, line), answer) in query.iter().zip(&lines).zip(&answers) {
        query.check(&serde_json::from_str(answer).unwrap_or_else(|_| panic!("{line}: {answer}")));
        check_shortest(answer);
    }
}

/// A random input, compared with the library's result.
#[derive(Debug)]
struct Query {
    hand: Vec3,
    upper: f32,
    lower: f32,
    root: Vec3,
    twist_deg: f32,
}

impl Query {
    fn random(random: &mut Random) -> Self {
        let [upper, lower] = [(); 2].map(|()| random.power_of_ten(-2.0..4.0) as f32);
        if random.below(8) == 0 {
            let [hand, root] = [(); 2].map(|()| random.finite_vector());
            return Self { hand, upper, lower, root, twist_deg: random.finite() };
        }
        Self {
            hand: random.vector(0.8) * (upper + lower),
            upper,
            lower,
            root: random.vector(0.8) * 1000.0,
            twist_deg: random.within(-1000.0..1000.0),
        }
    }

    fn line(&self, random: &mut Random) -> String {
        let mut number = |value: f32| match random.below(3) {
            0 => format!("{value}"),
            1 => format!("{value:e}"),
            _ => format!("{value:?}"),
        };
        let mut point = |v: Vec3| v.to_array().map(&mut number).join(",");
        let (hand, root) = (point(self.hand), point(self.root));
        let [upper, lower, twist] = [self.upper, self.lower, self.twist_deg].map(number);
        // Omitted fields, written out.
        let as_before = [
            "",
            r#","reference":"up""#,
            r#","softness":0,"max_stretch":1"#,
            r#","min_elbow_angle_deg":0,"reference":"up","softness":-0.0,"max_stretch":1.0"#,
        ][random.below(4)];
        format!(
            r#"{{"hand":[{hand}],"upper":{upper},"lower":{lower},"root":[{root}],"twist_deg":{twist}{as_before}}}"#
        )
    }

    fn check(&self, answer: &Answer) {
        let arm = TwoBone::new(self.upper, self.lower).expect("random lengths are above 0");
        let pose = arm.solve(self.hand, (self.twist_deg % 360.0).to_radians());
        let reach = match pose.reach {
            Some(Reach::Reached) | None => "reached",
            Some(Reach::TooFar) => "too_far",
            Some(Reach::TooClose) => "too_close",
        };
        assert_eq!(answer.reach, reach, "{self:?}");
        assert_eq!(bits(answer.elbow), bits(self.root + pose.elbow), "{self:?}");
        assert_eq!(bits(answer.hand), bits(self.root + pose.hand), "{self:?}");
        let numbers = [
            ("distance", answer.distance, pose.distance),
            ("theta_z_deg", answer.theta_z_deg, pose.yaw().to_degrees()),
            ("theta_y_deg", answer.theta_y_deg, pose.pitch().to_degrees()),
            ("theta_e_deg", answer.theta_e_deg, pose.shoulder_angle().to_degrees()),
            ("along", answer.along, pose.along),
            ("out", answer.out, pose.out),
            ("elbow_angle_deg", answer.elbow_angle_deg, pose.elbow_angle().to_degrees()),
        ];
        for (name, printed, own) in numbers {
            assert_eq!(printed.to_bits(), own.to_bits(), "{name} of {self:?}");
        }
    }
}

fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(f32::to_bits)
}

/// No number has more digits than it takes to read the same f32 back.
fn check_shortest(answer: &str) {
    let is_number = |token: &&str| token.starts_with(|c: char| c == '-' || c.is_ascii_digit());
    let tokens: Vec<&str> =
        answer.split([':', ',', '[', ']', '{', '}']).filter(is_number).collect();
    let numbers = if answer.contains(r#""reference_gain":null"#) { 13 } else { 14 };
    assert_eq!(tokens.len(), numbers, "{answer}");
    for token in tokens {
        let value: f32 = token.parse().expect("it is a number");
        assert_eq!(digits(token), digits(&format!("{value:e}")), "{token} in {answer}");
    }
}

/// Number of significant digits. Two shortest forms may be equally near and differ in the last
/// digit.
fn digits(number: &str) -> usize {
    let mantissa = number.split('e').next().unwrap_or_default();
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    digits.trim_matches('0').len()
}

// Bad lines

#[test]
fn a_line_that_is_not_json_is_an_error_with_its_position() {
    for (line, error) in [
        ("hello", "not JSON: expected value, found `hello` (byte 1)"),
        ("{hand:[1,2,3]}", "not JSON: key must be a string, found `hand` (byte 2)"),
        (r#"{"hand":[1,2,3]"#, "not JSON: EOF while parsing an object (byte 15)"),
        (r#"{"hand":[1,2,"#, "hand: not JSON: EOF while parsing a value (byte 13)"),
        (r#"{"hand":[1,2,3],}"#, "not JSON: trailing comma (byte 17)"),
        (r#"{"hand":[1,2,3]} x"#, "not JSON: trailing characters, found `x` (byte 18)"),
        (r#"{"hand":[1,2,3]}{}"#, "not JSON: trailing characters (byte 17)"),
        (r#"{"hand":[1,NaN,3]}"#, "hand[1]: not JSON: expected value, found `NaN` (byte 12)"),
        (r#"{"hand":[1,2,3],"upper":01}"#, "upper: not JSON: invalid number, found `01` (byte 26)"),
        (
            r#"{"hand":[1,2,3],"root":[1,2,-Infinity]}"#,
            "root[2]: not JSON: invalid number, found `-Infinity` (byte 30)",
        ),
    ] {
        assert_eq!(refusal(line), error, "{line}");
    }
}

#[test]
fn a_line_that_is_json_but_no_object_is_refused() {
    for (line, found) in [
        ("[]", "sequence"),
        ("[[250,120,60],200,300,[0,0,0],0]", "sequence"),
        ("5", "integer `5`"),
        ("\"hand\"", "string \"hand\""),
        ("null", "null"),
        ("true", "boolean `true`"),
    ] {
        let expected =
            format!(r#"invalid type: {found}, expected an object like {{"hand":[250,120,60]}}"#);
        assert_eq!(refusal(line), expected);
    }
}

#[test]
fn a_missing_unknown_or_duplicate_field_is_named() {
    let fields = concat!(
        "`hand`, `upper`, `lower`, `root`, `twist_deg`, ",
        "`reference`, `softness`, `max_stretch`, `min_elbow_angle_deg`"
    );
    for (line, error) in [
        ("{}", "missing field `hand`".to_owned()),
        (r#"{"upper":1}"#, "missing field `hand`".to_owned()),
        (r#"{"hand":[1,2,3],"hand":[1,2,3]}"#, "duplicate field `hand`".to_owned()),
        (r#"{"upper":1,"hand":[1,2,3],"upper":1}"#, "duplicate field `upper`".to_owned()),
        (r#"{"hnad":[1,2,3]}"#, format!("unknown field `hnad`, expected one of {fields}")),
        (r#"{"Hand":[1,2,3]}"#, format!("unknown field `Hand`, expected one of {fields}")),
        (r#"{"hand":[1,2,3],"":0}"#, format!("unknown field ``, expected one of {fields}")),
        (
            r#"{"hand":[1,2,3],"elbow_spin_deg":0}"#,
            "unknown field `elbow_spin_deg`; it is called `twist_deg`".to_owned(),
        ),
        (
            r#"{"swivel":"up","hand":[1,2,3]}"#,
            "unknown field `swivel`; it is called `reference`".to_owned(),
        ),
        (
            r#"{"hand":[1,2,3],"min_elbow_deg":5}"#,
            "unknown field `min_elbow_deg`; it is called `min_elbow_angle_deg`".to_owned(),
        ),
    ] {
        assert_eq!(refusal(line), error, "{line}");
    }
}

#[test]
fn a_field_of_the_wrong_type_is_named_with_both_types() {
    for (field, value, error) in [
        ("upper", "\"2\"", "upper: invalid type: string \"2\", expected a number"),
        ("upper", "null", "upper: invalid type: null, expected a number"),
        ("lower", "[300]", "lower: invalid type: sequence, expected a number"),
        ("lower", "{}", "lower: invalid type: map, expected a number"),
        ("twist_deg", "true", "twist_deg: invalid type: boolean `true`, expected a number"),
        ("root", "null", "root: invalid type: null, expected three numbers: [x, y, z]"),
        ("root", "5", "root: invalid type: integer `5`, expected three numbers: [x, y, z]"),
        ("root", "{\"x\":1}", "root: invalid type: map, expected three numbers: [x, y, z]"),
        ("root", "[1,\"2\",3]", "root[1]: invalid type: string \"2\", expected a number"),
        ("root", "[1,2,null]", "root[2]: invalid type: null, expected a number"),
    ] {
        assert_eq!(refusal(format!(r#"{{"hand":[1,2,3],"{field}":{value}}}"#)), error);
    }
    assert_eq!(
        refusal(r#"{"hand":null}"#),
        "hand: invalid type: null, expected three numbers: [x, y, z]"
    );
}

#[test]
fn a_vector_of_the_wrong_length_is_an_error_with_its_length() {
    for (hand, found) in [
        ("[]", "0 numbers"),
        ("[1]", "1 number"),
        ("[1,2]", "2 numbers"),
        ("[1,2,3,4]", "4 numbers"),
    ] {
        let expected = format!("hand: found {found}, expected three: [x, y, z]");
        assert_eq!(refusal(format!(r#"{{"hand":{hand}}}"#)), expected);
    }
}

#[test]
fn a_number_that_is_not_finite_in_f32_is_refused() {
    let range = "must be between -3.4028235e38 and 3.4028235e38";
    let whole = format!("1{}", "0".repeat(39));
    for number in ["1e39", "-1e39", "3.4028236e38", "1e999", "-1e9999999999999", &whole] {
        for (field, before, after) in [
            ("hand[1]", r#"{"hand":[1,"#, ",3]}"),
            ("root[2]", r#"{"hand":[1,2,3],"root":[1,2,"#, "]}"),
            ("upper", r#"{"hand":[1,2,3],"upper": "#, " }"),
            ("twist_deg", r#"{"twist_deg":"#, r#","hand":[1,2,3]}"#),
        ] {
            assert_eq!(
                refusal(format!("{before}{number}{after}")),
                format!("{field}: {range}, got {number}")
            );
        }
    }
    assert_eq!(pose(r#"{"hand":[3.4028235e38,0,0]}"#).reach, "too_far");
}

#[test]
fn a_length_that_is_not_above_0_is_refused() {
    for (field, value, shown) in [
        ("upper", "-3", "-3"),
        ("upper", "0", "0"),
        ("lower", "-0.0", "-0"),
        ("lower", "-2.5e0", "-2.5"),
        ("lower", "1e-60", "0"),
    ] {
        assert_eq!(
            refusal(format!(r#"{{"hand":[1,2,3],"{field}":{value}}}"#)),
            format!("{field}: must be finite and above 0, got {shown}")
        );
    }
}

#[test]
fn a_pose_that_overflows_in_world_space_is_refused() {
    assert_eq!(
        refusal(r#"{"hand":[3e38,0,0],"root":[3e38,0,0],"upper":2e38,"lower":2e38}"#),
        "root: must keep the elbow within ±3.4028235e38, got [3e38, 0.0, 0.0]"
    );
    assert_eq!(
        refusal(r#"{"hand":[0,-3e38,0],"root":[0,-3e38,0],"upper":1,"lower":3e38}"#),
        "root: must keep the hand within ±3.4028235e38, got [0.0, -3e38, 0.0]"
    );
}

#[test]
fn bytes_that_are_not_utf_8_are_refused() {
    let rule = "the line must be UTF-8, got";
    assert_eq!(refusal(b"{\"hand\xff\":[1,2,3]}"), format!("{rule} 0xff as byte 7"));
    assert_eq!(refusal(b"{\"hand\":[1,2,3]}\xc3"), format!("{rule} 0xc3 as byte 17"));
    assert_eq!(refusal(b"\xff\xfe{\0}\0"), format!("{rule} 0xff as byte 1"));
}

#[test]
fn deep_nesting_is_an_error_and_no_stack_overflow() {
    for opening in ["[", "{\"hand\":", "{\"a\":"] {
        refusal(opening.repeat(60_000 / opening.len()));
    }
    refusal(format!("{{\"hand\":{}", "[".repeat(60_000)));
    refusal(format!("{}{}", "[".repeat(30_000), "]".repeat(30_000)));
}

#[test]
fn a_long_value_does_not_make_a_long_message() {
    for line in [
        format!(r#"{{"{}":1}}"#, "é".repeat(30_000)),
        format!(r#"{{"hand":"{}"}}"#, "x".repeat(60_000)),
        format!(r#"{{"hand":[{},0,0]}}"#, "9".repeat(60_000)),
        "x".repeat(60_000),
    ] {
        let error = refusal(line);
        assert!(error.chars().count() < 600, "{error}");
        assert!(error.contains('…'), "{error}");
    }
}

#[test]
fn a_line_longer_than_64_kib_is_refused_and_the_next_is_solved() {
    const LONGEST: usize = 64 * 1024;
    let spaced = |length: usize| POSE.to_owned() + &" ".repeat(length - POSE.len());
    for end in ["\n", "\r\n"] {
        for (length, bad) in [
            (LONGEST - 1, false),
            (LONGEST, false),
            (LONGEST + 1, true),
            (LONGEST + 2, true),
            (LONGEST + 3, true),
            (3_000_000, true),
        ] {
            let output = solve(format!("{}{end}{POSE}{end}", spaced(length)));
            let long = (1, "the line must be at most 64 KiB long".to_owned());
            assert_eq!(errors(&output), Vec::from_iter(bad.then_some(long)), "{length} {end:?}");
            assert_eq!(answers(&output).len(), 2);
        }
    }
    let unended = solve(spaced(LONGEST + 1));
    assert_eq!(errors(&unended).len(), 1);
}

#[test]
fn messages_have_no_second_line_number() {
    let field = refusal(r#"{"hand":[1,2,3],"x at line 7 column 3":1}"#);
    assert!(field.starts_with("unknown field `x at line 7 column 3`, expected"), "{field}");
    for line in ["x", "{", "{}", "[]", r#"{"hand":1e99}"#, r#"{"hand":[1e99]}"#] {
        let error = refusal(line);
        assert!(!error.contains(" line ") && !error.contains("column"), "{error}");
    }
}

// Lines

#[test]
fn answers_and_errors_come_in_the_order_of_the_lines() {
    let input = format!("{POSE}\nx\n\n{POSE}\r\n \t \r\n\r\n{{}}\n{POSE}\n\n\n[]");

    let output = solve(input);

    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr(&output), "");
    let places: Vec<Option<u64>> =
        answers(&output).iter().map(|answer| error_of(answer).map(|(line, _)| line)).collect();
    assert_eq!(places, [None, Some(2), None, Some(7), None, Some(11)]);
}

#[test]
fn blank_lines_alone_print_nothing_and_are_not_an_error() {
    for input in ["", "\n", "\r\n\r\n", " \t\n  ", "\u{feff}", "\u{feff}\n"] {
        let output = solve(input);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(0), 0), "{input:?}");
    }
}

#[test]
fn windows_line_ends_a_byte_order_mark_and_a_missing_last_end_change_nothing() {
    let plain = answers(&solve(format!("{POSE}\n{POSE}\n")));
    assert_eq!(answers(&solve(format!("\u{feff}{POSE}\r\n{POSE}\r\n"))), plain);
    assert_eq!(answers(&solve(format!("{POSE}\n{POSE}"))), plain);
    assert_eq!(answers(&solve(format!("{POSE}\r\n{POSE}\r"))), plain);
}

#[test]
fn a_byte_order_mark_further_down_is_a_bad_line() {
    let output = solve(format!("{POSE}\n\u{feff}{POSE}\n"));
    assert_eq!(errors(&output).len(), 1);
}

#[test]
fn a_hundred_thousand_lines_are_all_answered() {
    let mut input = String::new();
    for i in 0..100_000 {
        let _ = match i % 1000 {
            999 => writeln!(input, r#"{{"hand":[{i}]}}"#),
            _ => writeln!(input, r#"{{"hand":[{i},120,-60.5]}}"#),
        };
    }
    let output = solve(input);
    assert_eq!(answers(&output).len(), 100_000);
    let bad: Vec<u64> = errors(&output).iter().map(|(line, _)| *line).collect();
    assert_eq!(bad, Vec::from_iter((1000..=100_000).step_by(1000)));
}

// Input and output

#[test]
fn a_file_and_a_dash_are_read_like_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("poses.jsonl");
    std::fs::write(&path, format!("{POSE}\n")).unwrap();

    let from_file = solve_file(&path);
    let from_dash = feed(command().arg("-"), POSE.as_bytes());

    assert_eq!(from_file.status.code(), Some(0));
    assert_eq!(answers(&from_file), answers(&solve(POSE)));
    assert_eq!(answers(&from_dash), answers(&solve(POSE)));
}

#[test]
fn a_file_that_cannot_be_read_is_named_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.jsonl");
    for path in [missing.as_path(), folder.path()] {
        let output = solve_file(path);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert_eq!(output.stdout.len(), 0);
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(message.starts_with("ik-arm: cannot "), "{message}");
        assert!(message.contains(&format!("{}: ", path.display())), "{message}");
    }
    let missing = stderr(&solve_file(&missing));
    assert!(cfg!(windows) || missing.contains("No such file or directory"), "{missing}");
}

#[test]
fn a_usage_error_exits_with_2_and_prints_no_result() {
    for args in [["--nonsense"].as_slice(), &["one", "two"], &[""]] {
        let output = feed(command().args(args), b"");
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert_eq!(output.stdout.len(), 0);
        assert!(stderr(&output).starts_with("error: "), "{output:?}");
    }
}

#[test]
fn an_answer_comes_before_more_input_is_needed() {
    let mut child = command().spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it has a standard input");
    let stdout = BufReader::new(child.stdout.take().expect("it has a standard output"));
    let (sender, answers) = mpsc::channel();
    thread::spawn(move || stdout.lines().map_while(Result::ok).try_for_each(|l| sender.send(l)));

    for (said, heard) in [
        (format!("{POSE}\n"), ["reach"].as_slice()),
        (format!("{POSE}\n{{\"hand\":"), &["reach"]),
        (format!("[1,2]}}\r\n\n{POSE}\n  \n"), &["error", "reach"]),
        (format!(" \n{POSE}\nx"), &["reach"]),
        ("\n".to_owned(), &["error"]),
        ("x".repeat(200_000), &[]),
        (format!("\n{POSE}\n"), &["error", "reach"]),
    ] {
        stdin.write_all(said.as_bytes()).expect("it listens");
        for key in heard {
            let answer = answers.recv_timeout(Duration::from_secs(60)).expect("it answers at once");
            assert!(answer.contains(&format!("\"{key}\":")), "{answer} to {said:?}");
        }
    }
    drop(stdin);
    assert_eq!(child.wait().expect("it ends").code(), Some(1));
}

#[test]
fn a_broken_pipe_ends_quietly() {
    let mut child = command().spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it has a standard input");
    let feeder = thread::spawn(move || {
        let megabyte = format!("{POSE}\n").repeat(50_000);
        (0..20).try_for_each(|_| stdin.write_all(megabyte.as_bytes()))
    });
    let mut first = String::new();
    let mut stdout = BufReader::new(child.stdout.take().expect("it has a standard output"));
    stdout.read_line(&mut first).expect("it answers");
    drop(stdout);

    let status = child.wait().expect("it ends");

    let mut message = String::new();
    child.stderr.take().map(|mut stderr| stderr.read_to_string(&mut message));
    assert_eq!((status.code(), message.as_str()), (Some(0), ""));
    assert!(first.contains("\"reach\""), "{first}");
    assert!(feeder.join().expect("no panic").is_err(), "it stopped before the input did");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_failure_with_a_message() {
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("Linux has it");
    let output = feed(command().stdout(full()), POSE.as_bytes());
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("ik-arm: cannot write to standard output: "));

    let nowhere_to_complain = feed(command().stdout(full()).stderr(full()), POSE.as_bytes());
    assert_eq!(nowhere_to_complain.status.code(), Some(1), "and not 101, a panic");
}

// Random input

proptest! {
    #![proptest_config(config(150, 2026))]

    #[test]
    fn any_bytes_get_one_answer_per_line_that_is_not_blank(input in any_input()) {
        let output = solve(&input);

        let query = numbers_of_lines_that_are_not_blank(&input);
        let answers = answers(&output);
        prop_assert_eq!(answers.len(), query.len());
        let mut bad = 0;
        for (answer, number) in answers.iter().zip(query) {
            let parsed: Value = serde_json::from_str(answer).expect("every answer is JSON");
            if parsed.get("error").is_some() {
                prop_assert_eq!(error_of(answer).map(|(line, _)| line), Some(number));
                bad += 1;
            } else {
                let pose: Answer = serde_json::from_str(answer).expect("and else a pose");
                prop_assert!(pose.elbow.is_finite() && pose.hand.is_finite());
                prop_assert!((0.0..=180.0).contains(&pose.elbow_angle_deg), "{answer}");
            }
        }
        prop_assert_eq!(output.status.code(), Some(i32::from(bad > 0)));
        prop_assert_eq!(stderr(&output), "");
    }
}

fn numbers_of_lines_that_are_not_blank(input: &[u8]) -> Vec<u64> {
    let input = input.strip_prefix(b"\xef\xbb\xbf").unwrap_or(input);
    let lines = (1..).zip(input.split(|&byte| byte == b'\n'));
    lines.filter(|(_, line)| !line.trim_ascii().is_empty()).map(|(number, _)| number).collect()
}

fn any_input() -> impl Strategy<Value = Vec<u8>> {
    let end = prop_oneof![4 => Just("\n"), 1 => Just("\r\n"), 1 => Just("\n \n")];
    let mark = prop_oneof![3 => Just(""), 1 => Just("\u{feff}")];
    (mark, prop::collection::vec((any_line(), end), 0..60)).prop_map(|(mark, lines)| {
        let lines = lines.into_iter().flat_map(|(line, end)| [line, end.into()]).flatten();
        mark.bytes().chain(lines).collect()
    })
}

fn any_line() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        1 => prop::collection::vec(any::<u8>(), 0..60),
        2 => prop::collection::vec(any_piece(), 0..12).prop_map(|pieces| pieces.concat().into()),
        2 => any_valid_line().prop_map(String::into_bytes),
        4 => (any_valid_line(), prop::collection::vec(any_change(), 1..4)).prop_map(changed),
    ]
}

fn any_piece() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "\"",
        "\"hand\":",
        "\"upper\":",
        "\"root\":",
        "\"reference\":",
        "\"transport\"",
        "{\"pole\":[0,1,0]}",
        "\"softness\":",
        "[1,2,3]",
        "[1e39,0,0]",
        "-",
        "1e400",
        "1e-400",
        "0",
        "-0.0",
        "null",
        "true",
        "\\u",
        "\\",
        " ",
        "é",
        "\u{feff}",
        "\r",
        "{\"hand\":[1,2,3]}",
        "NaN",
        "\0",
    ])
}

fn any_valid_line() -> impl Strategy<Value = String> {
    let number = || any::<f32>().prop_filter("finite", |n| n.is_finite());
    let length = number().prop_map(|n| n.abs().max(f32::from_bits(1)));
    let twist_reference = prop_oneof![
        prop::sample::select(vec!["up", "stereographic", "transport"])
            .prop_map(|name| format!("\"{name}\"")),
        prop::array::uniform3(number())
            .prop_map(|[x, y, z]| format!("{{\"pole\":[{x:e},{y:e},{z:e}]}}")),
    ];
    let stretch = number().prop_map(|n| n.abs().max(1.0));
    let fields = (
        optional("upper", length.prop_map(|n| format!("{n:e}"))),
        optional("twist_deg", number().prop_map(|n| n.to_string())),
        optional("reference", twist_reference),
        optional("softness", (0.0..1.0_f32).prop_map(|n| n.to_string())),
        optional("max_stretch", stretch.prop_map(|n| format!("{n:e}"))),
        optional("min_elbow_angle_deg", (0.0..180.0_f32).prop_map(|n| n.to_string())),
    );
    (prop::array::uniform3(number()), fields).prop_map(|([x, y, z], (a, b, c, d, e, f))| {
        format!("{{\"hand\":[{x:e},{y:e},{z}]{a}{b}{c}{d}{e}{f}}}")
    })
}

fn optional(
    name: &'static str,
    value: impl Strategy<Value = String>,
) -> impl Strategy<Value = String> {
    let field = value.prop_map(move |value| format!(",\"{name}\":{value}"));
    prop_oneof![Just(String::new()), field]
}

#[derive(Clone, Debug)]
enum Change {
    Replace(u8),
    Insert(u8),
    Remove,
    CutOff,
}

fn any_change() -> impl Strategy<Value = (prop::sample::Index, Change)> {
    let byte = || {
        prop_oneof![prop::sample::select(b"0123456789-+.eE,:[]{}\"\\ \t\n".to_vec()), any::<u8>()]
    };
    let change = prop_oneof![
        4 => byte().prop_map(Change::Replace),
        4 => byte().prop_map(Change::Insert),
        3 => Just(Change::Remove),
        1 => Just(Change::CutOff),
    ];
    (any::<prop::sample::Index>(), change)
}

fn changed((line, changes): (String, Vec<(prop::sample::Index, Change)>)) -> Vec<u8> {
    let mut line = line.into_bytes();
    for (index, change) in changes {
        if line.is_empty() {
            break;
        }
        let at = index.index(line.len());
        match change {
            Change::Replace(byte) => line[at] = byte,
            Change::Insert(byte) => line.insert(at, byte),
            Change::Remove => drop(line.remove(at)),
            Change::CutOff => line.truncate(at),
        }
    }
    line
}
