//! Twist references, and the state kept from line to line.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::{Answer, answers, errors, pose, poses, refusal, solve};
use crate::common::Random;

/// The seed's arm.
const LONGEST: f64 = 500.0;

/// A JSON line with a hand and a twist reference.
fn line(hand: Vec3, twist_reference: &str) -> String {
    let Vec3 { x, y, z } = hand;
    format!(r#"{{"hand":[{x},{y},{z}],"reference":{twist_reference}}}"#)
}

fn transported(hand: Vec3) -> String {
    line(hand, r#""transport""#)
}

fn pole(pole: Vec3) -> String {
    format!(r#"{{"pole":[{},{},{}]}}"#, pole.x, pole.y, pole.z)
}

/// Direction from the shoulder-hand line to the elbow, for an arm at the origin.
fn outward(answer: &Answer) -> DVec3 {
    answer.elbow.as_dvec3().reject_from(answer.hand.as_dvec3()).normalize()
}

/// Signed angle from `from` to `to` about `w`.
fn turn(from: DVec3, to: DVec3, w: DVec3) -> f64 {
    w.dot(from.cross(to)).atan2(from.dot(to))
}

/// Parallel transport by Rodrigues' formula: the least turn from one direction to another.
fn transported_in_f64(e: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let axis = from.cross(to);
    let (sin, cos) = (axis.length(), from.dot(to));
    let axis = axis.normalize_or_zero();
    e * cos + axis.cross(e) * sin + axis * axis.dot(e) * (1.0 - cos)
}

/// The stereographic direction with R = −x, V = +y.
fn on_map(w: DVec3) -> DVec3 {
    (w - DVec3::NEG_X).cross(DVec3::Y).cross(w).normalize()
}

/// A hand in reach of the default arm, and nowhere near straight or folded.
fn hand(random: &mut Random) -> Vec3 {
    loop {
        let hand = random.vector(480.0);
        if (150.0..450.0).contains(&hand.length()) {
            return hand;
        }
    }
}

/// A twist reference as JSON, with the formulas of its direction e₀ and its gain.
struct Formula {
    twist_reference: String,
    outward: fn(w: DVec3, pole: DVec3) -> DVec3,
    gain: fn(w: DVec3, pole: DVec3) -> f64,
}

fn formulas(at: Vec3) -> [Formula; 3] {
    [
        Formula {
            twist_reference: r#""up""#.to_owned(),
            outward: |w, _| DVec3::Y.reject_from(w).normalize(),
            gain: |w, _| w.y.asin().tan().abs(),
        },
        Formula {
            twist_reference: pole(at),
            outward: |w, pole| pole.reject_from(w).normalize(),
            gain: |w, pole| w.angle_between(pole).tan().recip().abs(),
        },
        Formula {
            twist_reference: r#""stereographic""#.to_owned(),
            outward: |w, _| on_map(w),
            gain: |w, _| (0.5 * w.angle_between(DVec3::X)).tan(),
        },
    ]
}

#[test]
fn twist_and_gain_are_those_of_the_chosen_reference() {
    let mut random = Random(41);
    let mut requests = Vec::new();
    let mut lines = Vec::new();
    for _ in 0..1000 {
        let (hand, at) = (hand(&mut random), random.vector(0.8) * 300.0);
        let twist = random.within(-360.0..360.0);
        for formula in formulas(at) {
            let Vec3 { x, y, z } = hand;
            let twist_reference = &formula.twist_reference;
            lines.push(format!(
                r#"{{"hand":[{x},{y},{z}],"twist_deg":{twist},"reference":{twist_reference}}}"#
            ));
            requests.push((hand.as_dvec3(), at.as_dvec3(), f64::from(twist), formula));
        }
    }

    let mut checked = 0;
    for ((hand, at, twist, formula), answer) in requests.iter().zip(poses(&lines)) {
        let (w, twist_reference) = (hand.normalize(), &formula.twist_reference);
        let gain = (formula.gain)(w, *at);
        if gain > 20.0 {
            continue;
        }
        checked += 1;
        let printed = f64::from(answer.reference_gain.expect("a small gain is a number"));
        let off = (printed - gain).abs();
        assert!(off < 5e-7 * (1.0 + gain * gain), "{twist_reference}: {printed}, not {gain}");

        let e = (formula.outward)(w, *at);
        let (sin, cos) = twist.to_radians().sin_cos();
        let out =
            w * f64::from(answer.along) + (e * cos + w.cross(e) * sin) * f64::from(answer.out);
        let off = answer.elbow.as_dvec3().distance(out);
        assert!(
            off < 2e-6 * LONGEST * (1.0 + 0.1 * gain),
            "{twist_reference}: off by {off}, gain {gain}"
        );
    }
    assert!(checked > 2500, "only {checked} were checked");
}

#[test]
fn a_pole_is_relative_to_the_root() {
    let towards_z = r#""hand":[300,0,0],"reference":{"pole":[0,0,50]}"#;
    let at_origin = pose(&format!("{{{towards_z}}}"));
    // In the world such a pole would be on the other side.
    let moved = pose(&format!(r#"{{{towards_z},"root":[64,-128,1024]}}"#));
    assert!(outward(&at_origin).distance(DVec3::Z) < 1e-6, "{at_origin:?}");
    let back = moved.elbow.as_dvec3() - DVec3::new(64.0, -128.0, 1024.0);
    assert!(back.distance(at_origin.elbow.as_dvec3()) < 2e-4, "{moved:?}");
    assert_eq!(moved.reference_gain, at_origin.reference_gain);
}

#[test]
fn at_a_singular_direction_the_gain_is_null_and_the_elbow_is_that_of_limb() {
    let hand = Vec3::new(250.0, 120.0, 60.0);
    for (hand, twist_reference) in [
        (Vec3::new(0.0, 400.0, 0.0), r#""up""#.to_owned()),
        (Vec3::new(0.0, -400.0, 0.0), r#""up""#.to_owned()),
        (hand, pole(Vec3::ZERO)),
        (hand, pole(hand)),
        (hand, pole(hand * -7.0)),
        (hand, pole(hand * 1e30)),
        (Vec3::new(-400.0, 0.0, 0.0), r#""stereographic""#.to_owned()),
    ] {
        // State of earlier lines has no effect on it.
        let elsewhere = transported(Vec3::new(10.0, -20.0, 300.0));
        let lines = [elsewhere, line(hand, &twist_reference), line(hand, r#""up""#)];
        let [_, singular, limb] = poses(&lines).try_into().expect("three poses");
        assert_eq!(singular.reference_gain, None, "{twist_reference} at {hand}");
        let off = singular.elbow.distance(limb.elbow);
        assert!(f64::from(off) < 1e-6 * LONGEST, "{twist_reference} at {hand}: off by {off}");
    }
}

#[test]
fn beside_a_singular_direction_the_gain_is_a_number() {
    for (twist_reference, hand) in [
        (r#""up""#.to_owned(), Vec3::new(0.1, 400.0, 0.0)),
        (r#""stereographic""#.to_owned(), Vec3::new(-400.0, 0.2, 0.0)),
        (pole(Vec3::new(0.0, 0.0, -9.0)), Vec3::new(0.1, 0.0, -400.0)),
    ] {
        let gain = pose(&line(hand, &twist_reference)).reference_gain.expect("a number");
        assert!((gain - 4000.0).abs() < 1.0, "{twist_reference}: {gain}");
    }
}

// Transport

/// Hands once around a circle that a cone about `axis` makes, back to the first, at changing
/// distances.
fn around(axis: DVec3, half_angle: f64, steps: usize) -> Vec<Vec3> {
    let (u, v) = axis.any_orthonormal_pair();
    let hand = |step: usize| {
        let turned = 2.0 * PI * (step % steps) as f64 / steps as f64;
        let aside = u * turned.cos() + v * turned.sin();
        let w = axis * half_angle.cos() + aside * half_angle.sin();
        (w * (300.0 + 90.0 * (3.0 * turned).sin())).as_vec3()
    };
    (0..=steps).map(hand).collect()
}

#[test]
fn transport_starts_stereographic_and_continues_from_line_to_line() {
    const STEPS: usize = 90;
    let mut random = Random(5);
    for half_angle in [0.3, 0.8, 1.2, 1.5] {
        let axis = hand(&mut random).as_dvec3().normalize();
        let hands = around(axis, half_angle, STEPS);
        let lines: Vec<String> = hands.iter().map(|hand| transported(*hand)).collect();

        let poses = poses(&lines);

        let w: Vec<DVec3> = hands.iter().map(|hand| hand.as_dvec3().normalize()).collect();
        let mut e = on_map(w[0]);
        for (step, answer) in poses.iter().enumerate() {
            if step > 0 {
                e = transported_in_f64(e, w[step - 1], w[step]);
            }
            let off = turn(e, outward(answer), w[step]).abs();
            assert!(off < 1e-5, "off by {off} after {step} lines around {axis}");
            assert_eq!(answer.reference_gain, Some(0.0));
        }
        // The holonomy: the area of the cap, less what a circle of 90 corners cuts off.
        let turned = turn(outward(&poses[0]), outward(&poses[STEPS]), w[0]);
        let cap = 2.0 * PI * (1.0 - half_angle.cos());
        let off = (turned - cap + PI).rem_euclid(2.0 * PI) - PI;
        assert!(off.abs() < 0.02, "turned by {turned}, not {cap}");
        assert_eq!(poses[0].hand, poses[STEPS].hand);
    }
}

#[test]
fn the_twist_is_not_part_of_the_transported_direction() {
    let hands = around(DVec3::new(0.0, 0.6, 0.8), 0.9, 12);
    let lines: Vec<String> = hands.iter().map(|hand| transported(*hand)).collect();
    let twist = |(step, line): (usize, &String)| {
        let twist = 25.0 * step as f64;
        line.replace('}', &format!(r#","twist_deg":{twist}}}"#))
    };
    let twisted: Vec<String> = lines.iter().enumerate().map(twist).collect();
    for (step, (plain, twisted)) in poses(&lines).iter().zip(poses(&twisted)).enumerate() {
        let w = plain.hand.as_dvec3().normalize();
        let turned = turn(outward(plain), outward(&twisted), w);
        let off = (turned - (25.0 * step as f64).to_radians() + PI).rem_euclid(2.0 * PI) - PI;
        assert!(off.abs() < 1e-5, "{turned} at {step}");
    }
}

/// Hands for which the last elbow depends on the ones before.
fn way() -> [String; 3] {
    [Vec3::new(-100.0, 50.0, 300.0), Vec3::new(20.0, -310.0, 5.0), Vec3::new(-200.0, 30.0, -240.0)]
        .map(transported)
}

#[test]
fn the_transported_direction_survives_bad_and_blank_lines() {
    let [first, second, third] = way();
    let whole = answers(&solve(format!("{first}\n{second}\n{third}")));
    let alone = answers(&solve(&third));
    assert_ne!(whole[2], alone[0], "else nothing is transported");
    let long = " ".repeat(70_000);
    for bad in [
        "x",
        "{}",
        r#"{"hand":[1,2]}"#,
        r#"{"hand":[0,0,300],"reference":"up","upper":0}"#,
        r#"{"hand":[0,0,300],"reference":"limp"}"#,
        r#"{"hand":[0,0,300],"reference":"transport","softness":1}"#,
        r#"{"hand":[0,0,300],"reference":"transport"} x"#,
        // It has a pose, but none in the world.
        r#"{"hand":[0,0,-3e38],"root":[0,0,-3e38],"lower":3e38,"reference":"transport"}"#,
        r#"{"hand":[0,0,-3e38],"root":[0,0,-3e38],"lower":3e38}"#,
        &long,
    ] {
        let output = solve(format!("{first}\n\n{bad}\n \t\n{second}\n{bad}\n{bad}\n{third}\n"));
        let mut good = answers(&output);
        good.retain(|answer| !answer.starts_with(r#"{"line""#));
        assert_eq!(errors(&output).len(), 3, "{bad}");
        assert_eq!(good, whole, "{bad}");
    }
}

#[test]
fn transport_restarts_after_a_line_with_another_reference() {
    let [first, second, third] = way();
    let alone = answers(&solve(&third));
    for other in [
        "",
        r#","reference":"up""#,
        r#","reference":{"pole":[1,2,3]}"#,
        r#","reference":"stereographic""#,
    ] {
        let other = format!(r#"{{"hand":[100,200,300]{other}}}"#);
        let interrupted = answers(&solve(format!("{first}\n{second}\n{other}\n{third}")));
        assert_eq!(interrupted[3..], alone, "{other}");
        assert_eq!(
            interrupted[2..3],
            answers(&solve(&other)),
            "it ignores the transported direction too"
        );
    }
}

#[test]
fn transport_continues_across_arms_roots_and_softness() {
    let [first, second, third] = way();
    let changed = second
        .replace('}', r#","upper":900,"lower":30,"root":[5,6,7],"softness":0.5,"twist_deg":77}"#);
    let whole = answers(&solve(format!("{first}\n{second}\n{third}")));
    let answers = answers(&solve(format!("{first}\n{changed}\n{third}")));
    assert_ne!(answers[1], whole[1]);
    assert_eq!(answers[2], whole[2]);
}

#[test]
fn a_transported_hand_that_comes_to_the_shoulder_keeps_its_direction() {
    let before = Vec3::new(0.0, 0.0, -400.0);
    let lines = [before, Vec3::ZERO, before].map(transported);
    let [out, at_shoulder, back] = poses(&lines).try_into().expect("three poses");
    assert_eq!(at_shoulder.hand, Vec3::new(0.0, 0.0, -100.0));
    assert!(out.elbow.distance(back.elbow) < 1e-3, "{out:?} {back:?}");
    assert_eq!(pose(&lines[1]).hand, Vec3::new(100.0, 0.0, 0.0), "alone it has none");
}

#[test]
fn without_transport_lines_are_independent() {
    let mut random = Random(77);
    let lines: Vec<String> = (0..200)
        .flat_map(|_| {
            let hand = match random.below(4) {
                0 => Vec3::ZERO,
                1 => Vec3::new(0.0, -250.0, 0.0),
                _ => hand(&mut random),
            };
            let at = random.vector(0.8);
            formulas(at).map(|formula| line(hand, &formula.twist_reference))
        })
        .collect();
    let forwards = answers(&solve(lines.join("\n")));
    let mut backwards: Vec<&str> = lines.iter().map(String::as_str).rev().collect();
    let transport = transported(Vec3::new(-50.0, -300.0, 100.0));
    for place in (0..=lines.len()).rev().step_by(7) {
        backwards.insert(place, &transport);
    }
    let mut found = answers(&solve(backwards.join("\n")));
    let mut requests = backwards.into_iter();
    found.retain(|_| requests.next() != Some(&transport));
    found.reverse();
    assert_eq!(found, forwards);
}

#[test]
fn the_reference_up_is_read_by_its_former_name_too() {
    let lines = [r#""limb""#, r#""up""#].map(|name| line(Vec3::new(120.0, 200.0, 40.0), name));
    let poses = poses(&lines);
    assert_eq!(poses[0].elbow, poses[1].elbow);
}

// Invalid lines

#[test]
fn an_unknown_reference_is_refused_with_the_list_of_references() {
    let all = r#"expected "up", {"pole":[x,y,z]}, "stereographic" or "transport""#;
    for (twist_reference, found) in [
        (r#""limp""#, r#"invalid value: string "limp""#),
        (r#""Up""#, r#"invalid value: string "Up""#),
        (r#""""#, r#"invalid value: string """#),
        (r#""pole""#, r#"invalid value: string "pole""#),
        ("null", "invalid type: null"),
        ("true", "invalid type: boolean `true`"),
        ("5", "invalid type: integer `5`"),
        ("[0,1,0]", "invalid type: sequence"),
        (r#"["up"]"#, "invalid type: sequence"),
    ] {
        let error = refusal(line(Vec3::ONE, twist_reference));
        assert_eq!(error, format!("reference: {found}, {all}"));
    }
}

#[test]
fn an_invalid_pole_is_named_with_the_expected_type() {
    let range = "must be between -3.4028235e38 and 3.4028235e38";
    for (twist_reference, error) in [
        ("{}", "reference: missing field `pole`".to_owned()),
        (r#"{"pol":[0,1,0]}"#, "reference.pol: unknown field `pol`, expected `pole`".to_owned()),
        (r#"{"up":null}"#, "reference.up: unknown field `up`, expected `pole`".to_owned()),
        (
            r#"{"pole":[0,1,0],"up":1}"#,
            "reference.up: unknown field `up`, expected `pole`".to_owned(),
        ),
        (r#"{"pole":[0,1,0],"pole":[0,1,0]}"#, "reference: duplicate field `pole`".to_owned()),
        (r#"{"pole":[]}"#, "reference.pole: found 0 numbers, expected three: [x, y, z]".to_owned()),
        (
            r#"{"pole":[0,1]}"#,
            "reference.pole: found 2 numbers, expected three: [x, y, z]".to_owned(),
        ),
        (
            r#"{"pole":[0,1,0,0]}"#,
            "reference.pole: found 4 numbers, expected three: [x, y, z]".to_owned(),
        ),
        (
            r#"{"pole":null}"#,
            "reference.pole: invalid type: null, expected three numbers: [x, y, z]".to_owned(),
        ),
        (
            r#"{"pole":[0,"1",0]}"#,
            r#"reference.pole[1]: invalid type: string "1", expected a number"#.to_owned(),
        ),
        (r#"{"pole":[0,1e39,0]}"#, format!("reference.pole[1]: {range}, got 1e39")),
        (r#"{"pole":[0,0,-1e999]}"#, format!("reference.pole[2]: {range}, got -1e999")),
        (
            r#"{"pole":[NaN,0,0]}"#,
            "reference.pole[0]: not JSON: expected value, found `NaN` (byte 38)".to_owned(),
        ),
    ] {
        assert_eq!(refusal(line(Vec3::ONE, twist_reference)), error, "{twist_reference}");
    }
    assert_eq!(
        refusal(r#"{"hand":[1,2,3],"reference":"up","reference":"up"}"#),
        "duplicate field `reference`"
    );
}
