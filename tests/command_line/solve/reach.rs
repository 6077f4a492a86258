//! Soft limits, stretching limbs and the smallest elbow angle.

use std::ops::Range;

use glam::{DVec3, Vec3};

use super::{Answer, pose, poses, refusal};
use crate::common::Random;

/// A line with softness, stretch and smallest elbow angle.
#[derive(Debug)]
struct Query {
    hand: Vec3,
    root: Vec3,
    upper: f32,
    lower: f32,
    softness: f32,
    max_stretch: f32,
    min_elbow_angle_deg: f32,
}

/// The expected result by the formulas, in f64.
#[derive(Debug)]
struct Twin {
    distance: f64,
    stretch: f64,
    /// L, before any stretching.
    longest: f64,
}

impl Query {
    fn line(&self) -> String {
        let Self { hand, root, upper, lower, softness, max_stretch, min_elbow_angle_deg } = self;
        let (hand, root) = (hand.to_array(), root.to_array());
        format!(
            concat!(
                r#"{{"hand":{:?},"root":{:?},"upper":{},"lower":{},"#,
                r#""softness":{},"max_stretch":{},"min_elbow_angle_deg":{}}}"#
            ),
            hand, root, upper, lower, softness, max_stretch, min_elbow_angle_deg
        )
    }

    fn twin(&self) -> Twin {
        let [d1, d2, s, longest_stretch, degrees] =
            [self.upper, self.lower, self.softness, self.max_stretch, self.min_elbow_angle_deg]
                .map(f64::from);
        let d = self.hand.as_dvec3().length();
        let longest = d1 + d2;
        let open = (d1 * d1 + d2 * d2 - 2.0 * d1 * d2 * degrees.to_radians().cos()).max(0.0).sqrt();
        let least = open.max((d1 - d2).abs());
        let w = s * (longest - least) / 2.0;
        let (outer, inner) = (longest - w, least + w);
        let softened = if s == 0.0 {
            d.clamp(least, longest)
        } else if d > outer {
            outer + w * (1.0 - (-(d - outer) / w).exp())
        } else if d < inner {
            least + w * ((d - inner) / w).exp()
        } else {
            d
        };
        let stretch = if d > outer { (d / softened).clamp(1.0, longest_stretch) } else { 1.0 };
        Twin { distance: softened * stretch, stretch, longest }
    }

    fn check(&self, answer: &Answer) {
        let Twin { distance, stretch, longest } = self.twin();
        let (l, root, asked) = (longest * stretch, self.root.as_dvec3(), self.hand.as_dvec3());
        let near = |what: &str, found: f64, expected: f64, bound: f64| {
            let off = (found - expected).abs();
            assert!(off <= bound, "{what}: {found}, not {expected}, of {self:?}: {answer:?}");
        };
        near("distance", f64::from(answer.distance), distance, 5e-7 * l);

        // Elbow and hand are in world space, where f32 are coarse far from the origin.
        let coarse = 4.0 * f64::from(f32::EPSILON) * (root.abs().max_element() + l);
        let [elbow, hand] = [answer.elbow, answer.hand].map(|joint| joint.as_dvec3() - root);
        near("hand", hand.length(), distance, 5e-7 * l + coarse);
        near("upper", elbow.length(), stretch * f64::from(self.upper), 5e-7 * l + coarse);
        near("lower", elbow.distance(hand), stretch * f64::from(self.lower), 5e-7 * l + coarse);
        if asked != DVec3::ZERO {
            let aside = hand.reject_from(asked).length();
            near("beside the way to the cursor", aside, 0.0, 5e-7 * l + coarse);
        }

        // Within rounding of ε = 1e-6·L either answer is right.
        let off = (asked.length() - distance) / longest;
        let rounding = 1e-7 + 2.0 * f64::from(f32::EPSILON) * asked.length() / longest;
        let reach = match off {
            off if off.abs() < 1e-6 - rounding => Some("reached"),
            off if off > 1e-6 + rounding => Some("too_far"),
            off if off < -1e-6 - rounding => Some("too_close"),
            _ => None,
        };
        assert!(reach.is_none_or(|reach| reach == answer.reach), "{reach:?} {self:?}: {answer:?}");

        // The angle by the law of cosines; its cosine, because the angle itself is coarse at 0 and
        // 180°.
        let [d1, d2] = [self.upper, self.lower].map(|length| stretch * f64::from(length));
        let cos = (d1 * d1 + d2 * d2 - distance * distance) / (2.0 * d1 * d2);
        let ratio = l * l / (d1 * d2);
        let printed = f64::from(answer.elbow_angle_deg);
        assert!((0.0..=180.0).contains(&printed), "{answer:?}");
        near("cos φ", printed.to_radians().cos(), cos, 2e-6 * ratio);
    }
}

/// One of two values, often at the edge of a range.
fn edge_or(random: &mut Random, edge: f32, range: Range<f32>) -> f32 {
    if random.below(3) == 0 { edge } else { random.within(range) }
}

fn reaching(random: &mut Random) -> Query {
    let [upper, lower] = [(); 2].map(|()| random.within(20.0..400.0));
    Query {
        hand: random.direction() * (upper + lower) * edge_or(random, 0.0, 0.0..2.5),
        root: random.vector(0.8) * [0.0, 1000.0][random.below(2)],
        upper,
        lower,
        softness: edge_or(random, 0.0, 0.0..0.999),
        max_stretch: edge_or(random, 1.0, 1.0..2.0),
        min_elbow_angle_deg: edge_or(random, 0.0, 0.0..179.0),
    }
}

#[test]
fn the_hand_meets_its_limits_as_the_formulas_say() {
    let mut random = Random(2);
    let asked: Vec<Query> = (0..4000).map(|_| reaching(&mut random)).collect();
    let lines: Vec<String> = asked.iter().map(Query::line).collect();
    for (asked, answer) in asked.iter().zip(poses(&lines)) {
        asked.check(&answer);
    }
}

/// The seed's arm with its hand along +x: limits 100 and 500, so that softness 0.5 is 100 wide.
fn along_x(distance: f32, fields: &str) -> Answer {
    pose(&format!(r#"{{"hand":[{distance},0,0]{fields}}}"#))
}

#[test]
fn a_soft_hand_lags_before_both_limits_and_is_exact_between() {
    let soft = |distance| along_x(distance, r#","softness":0.5"#);
    let left = |zones: f64| 100.0 * (-zones).exp();
    for (asked, expected, reach) in [
        (0.0, 100.0 + left(2.0), "too_close"),
        (100.0, 100.0 + left(1.0), "too_close"),
        (150.0, 100.0 + left(0.5), "too_close"),
        (200.0, 200.0, "reached"),
        (300.0, 300.0, "reached"),
        (400.0, 400.0, "reached"),
        (450.0, 500.0 - left(0.5), "too_far"),
        (500.0, 500.0 - left(1.0), "too_far"),
        (1000.0, 500.0 - left(6.0), "too_far"),
        (1e6, 500.0, "too_far"),
    ] {
        let answer = soft(asked);
        let off = (f64::from(answer.distance) - expected).abs();
        assert!(off < 1e-4, "{asked}: {}, not {expected}", answer.distance);
        assert_eq!(answer.reach, reach, "{asked}");
        assert_eq!(answer.hand.x.to_bits(), answer.distance.to_bits(), "{asked}");
        let is_exact = answer.distance.to_bits() == asked.to_bits();
        assert_eq!(is_exact, reach == "reached", "{asked}");
    }
}

#[test]
fn without_softness_the_hand_stops_at_its_limits() {
    for (asked, expected) in
        [(0.0, 100.0), (99.0, 100.0), (101.0, 101.0), (499.0, 499.0), (501.0, 500.0)]
    {
        assert_eq!(along_x(asked, r#","softness":0"#).distance, expected);
    }
}

#[test]
fn limbs_stretch_to_the_cursor_up_to_their_maximum() {
    let stretched = |distance| along_x(distance, r#","max_stretch":1.5"#);
    for (asked, distance, sigma, reach) in [
        (50.0, 100.0, 1.0, "too_close"),
        (400.0, 400.0, 1.0, "reached"),
        (600.0, 600.0, 1.2, "reached"),
        (750.0, 750.0, 1.5, "reached"),
        (800.0, 750.0, 1.5, "too_far"),
        (1e6, 750.0, 1.5, "too_far"),
    ] {
        let answer = stretched(asked);
        assert_eq!((answer.distance, answer.reach.as_str()), (distance, reach), "{asked}");
        let lower = (answer.hand - answer.elbow).length();
        assert!((answer.elbow.length() - 200.0 * sigma).abs() < 1e-3, "{answer:?}");
        assert!((lower - 300.0 * sigma).abs() < 1e-3, "{answer:?}");
    }
}

#[test]
fn a_soft_arm_that_stretches_stays_bent_and_still_reaches() {
    // d' = 500 − 100/e at 500, and the limbs are as much longer as it is short.
    let answer = along_x(500.0, r#","softness":0.5,"max_stretch":1.5"#);
    let sigma = 500.0 / (500.0 - 100.0 * (-1.0_f64).exp());
    assert_eq!((answer.hand.x, answer.reach.as_str()), (500.0, "reached"));
    assert!((f64::from(answer.elbow.length()) - 200.0 * sigma).abs() < 1e-3, "{answer:?}");
    assert!(answer.elbow_angle_deg < 160.0, "{answer:?}");
}

#[test]
fn the_elbow_angle_is_never_below_its_minimum() {
    for degrees in [0.0, 1.0, 30.0, 90.0, 150.0, 179.0_f32] {
        let open = |distance| along_x(distance, &format!(r#","min_elbow_angle_deg":{degrees}"#));
        let cos = f64::from(degrees).to_radians().cos();
        let least = (200.0_f64.powi(2) + 300.0_f64.powi(2) - 2.0 * 200.0 * 300.0 * cos).sqrt();
        for asked in [0.0, 0.5 * least, 0.999 * least] {
            let answer = open(asked as f32);
            assert_eq!(answer.reach, "too_close", "{degrees} {asked}");
            assert!((f64::from(answer.distance) - least).abs() < 1e-4, "{degrees}: {answer:?}");
            assert!((answer.elbow_angle_deg - degrees).abs() < 0.05, "{degrees}: {answer:?}");
        }
        let farther = open((0.5 * (least + 500.0)) as f32);
        assert_eq!(farther.reach, "reached");
        assert!(farther.elbow_angle_deg > degrees, "{degrees}: {farther:?}");
    }
}

#[test]
fn the_elbow_angle_is_180_straight_0_folded_and_90_in_a_right_triangle() {
    assert_eq!(along_x(500.0, "").elbow_angle_deg, 180.0);
    assert_eq!(along_x(900.0, "").elbow_angle_deg, 180.0);
    for fields in ["", r#","upper":300,"lower":200"#, r#","upper":70,"lower":70"#] {
        assert_eq!(along_x(0.0, fields).elbow_angle_deg, 0.0, "{fields}");
    }
    let right = along_x(50.0, r#","upper":30,"lower":40"#).elbow_angle_deg;
    assert!((right - 90.0).abs() < 1e-4, "{right}");
}

// Invalid lines

#[test]
fn a_number_out_of_its_range_is_refused_with_the_range() {
    for (field, range, values) in [
        ("softness", "from 0 to less than 1", ["1", "1.5", "-0.5", "-0.001"]),
        ("max_stretch", "finite and at least 1", ["0", "0.5", "-2", "0.999"]),
        ("min_elbow_angle_deg", "from 0 to less than 180°", ["180", "200", "-1", "-0.25"]),
    ] {
        for value in values {
            assert_eq!(
                refusal(format!(r#"{{"hand":[1,2,3],"{field}":{value}}}"#)),
                format!("{field}: must be {range}, got {value}")
            );
        }
        assert_eq!(
            refusal(format!(r#"{{"hand":[1,2,3],"{field}":"1"}}"#)),
            format!(r#"{field}: invalid type: string "1", expected a number"#)
        );
        assert_eq!(
            refusal(format!(r#"{{"hand":[1,2,3],"{field}":null}}"#)),
            format!("{field}: invalid type: null, expected a number")
        );
        assert_eq!(
            refusal(format!(r#"{{"hand":[1,2,3],"{field}":1e39}}"#)),
            format!("{field}: must be between -3.4028235e38 and 3.4028235e38, got 1e39")
        );
        assert_eq!(
            refusal(format!(r#"{{"hand":[1,2,3],"{field}":1,"{field}":1}}"#)),
            format!("duplicate field `{field}`")
        );
    }
}

#[test]
fn extreme_values_of_each_field_give_finite_poses() {
    for fields in [
        r#""softness":0.99999994"#,
        r#""max_stretch":3.4028235e38"#,
        r#""min_elbow_angle_deg":179.99998"#,
        r#""softness":1e-45,"max_stretch":1,"min_elbow_angle_deg":1e-45"#,
    ] {
        for hand in ["[0,0,0]", "[1e-45,0,0]", "[250,120,60]", "[3.4028235e38,0,0]"] {
            let answer = pose(&format!(r#"{{"hand":{hand},{fields}}}"#));
            assert!(answer.elbow.is_finite() && answer.hand.is_finite(), "{hand} {fields}");
        }
    }
}
