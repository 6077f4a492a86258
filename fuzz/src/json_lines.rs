use ik_arm::io::{PreviousLine, solve_line};
use serde_json::Value;

use super::opened::is_readable;

/// The lines of `ik-arm solve`: each is refused with a short message and has no effect, or has a
/// pose of finite numbers with allowed limb lengths and a hand that matches the reported reach.
pub fn json_lines(data: &[u8]) {
    let mut past = None;
    for line in data.split(|byte| *byte == b'\n') {
        solve(line, &mut past);
    }
}

fn solve(line: &[u8], past: &mut Option<PreviousLine>) {
    let before = *past;
    match solve_line(line, past) {
        Err(error) => {
            is_readable(&error.message());
            assert_eq!(*past, before, "a bad line changes nothing");
        }
        Ok(answer) => {
            assert_eq!(solve_line(line, &mut before.clone()).expect("as before"), answer);
            let answer = serde_json::to_value(answer).expect("written");
            Asked::new(line).check(&answer);
        }
    }
}

/// A valid line, parsed by independent code.
struct Asked {
    hand: [f64; 3],
    root: [f64; 3],
    lengths: [f64; 2],
    max_stretch: f64,
    is_hard: bool,
}

impl Asked {
    fn new(line: &[u8]) -> Self {
        let line: Value = serde_json::from_slice(line).expect("a good line is JSON");
        let number = |key: &str, usual: f64| line.get(key).map_or(usual, as_f32);
        let max_stretch = number("max_stretch", 1.0);
        let softened = ["softness", "min_elbow_angle_deg"].map(|key| number(key, 0.0));
        Self {
            hand: point(&line["hand"]),
            root: line.get("root").map_or([0.0; 3], point),
            lengths: [number("upper", 200.0), number("lower", 300.0)],
            max_stretch,
            is_hard: max_stretch == 1.0 && softened == [0.0; 2],
        }
    }

    fn check(&self, answer: &Value) {
        /// Allowed error relative to the arm length, with and without soft reach or stretch.
        const SOFT: f64 = 2e-6;
        const HARD: f64 = 3e-7;
        let [elbow, hand] = ["elbow", "hand"].map(|key| point(&answer[key]));
        for key in ["distance", "theta_z_deg", "theta_y_deg", "theta_e_deg", "along", "out"] {
            assert!(answer[key].is_f64(), "{key} in {answer}");
        }
        let [upper, lower] = self.lengths;
        let length = (upper + lower) * self.max_stretch;
        if length > f64::from(f32::MAX) {
            return;
        }
        let bound =
            if self.is_hard { HARD } else { SOFT } * length + rounding([elbow, hand, self.root]);
        let limbs = [(distance(self.root, elbow), upper), (distance(elbow, hand), lower)];
        for (limb, rest) in limbs {
            let is_right = rest - bound <= limb && limb <= rest * self.max_stretch + bound;
            assert!(is_right, "{limb} for {rest}, ±{bound}, in {answer}");
        }
        if answer["reach"] == "reached" {
            let asked = [0, 1, 2].map(|axis| self.root[axis] + self.hand[axis]);
            assert!(distance(hand, asked) <= bound, "{asked:?} is not reached by {answer}");
        }
    }
}

/// Rounded to the nearest f32, as the program does.
fn as_f32(value: &Value) -> f64 {
    f64::from(value.as_f64().expect("a number") as f32)
}

fn point(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|axis| as_f32(&value[axis]))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    [0, 1, 2].map(|axis| a[axis] - b[axis]).into_iter().fold(0.0, f64::hypot)
}

/// 2 ulp of the largest coordinate.
fn rounding(points: [[f64; 3]; 3]) -> f64 {
    let largest = points.into_iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    2.0 * f64::from(f32::EPSILON) * largest + 4.0 * f64::from(f32::from_bits(1))
}
