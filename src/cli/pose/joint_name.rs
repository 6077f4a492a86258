use thiserror::Error;

use crate::kinematics::skeleton::{JointId, Skeleton};

/// Names below this similarity (Jaro–Winkler, from 0 to 1) are not suggested.
const NEAR: f64 = 0.7;
const MOST_NAMES: usize = 5;

/// A text that names no joint.
#[derive(Debug, PartialEq, Eq, Error)]
pub enum JointNameError {
    #[error("there is no joint {text:?}; near names are {}", quoted(near))]
    Near { text: String, near: Vec<String> },
    #[error("there is no joint {text:?}; the joints are 0 to {last}, called {}", quoted(first))]
    Unlike { text: String, last: usize, first: Vec<String> },
}

/// Finds the joint with this name, else the one with this index in the file. `order` has the joints
/// in the file's order.
///
/// # Errors
///
/// [`JointNameError`] if there is no such joint.
pub fn find(text: &str, skeleton: &Skeleton, order: &[JointId]) -> Result<JointId, JointNameError> {
    let by_index = || order.get(text.parse::<usize>().ok()?).copied();
    skeleton.find(text).or_else(by_index).ok_or_else(|| missing(text, skeleton, order))
}

fn missing(text: &str, skeleton: &Skeleton, order: &[JointId]) -> JointNameError {
    let names = || order.iter().map(|joint| &skeleton[*joint].name);
    let near = near(text, names());
    let text = text.to_owned();
    if near.is_empty() {
        let first = names().take(MOST_NAMES).cloned().collect();
        return JointNameError::Unlike { text, last: order.len().saturating_sub(1), first };
    }
    JointNameError::Near { text, near }
}

/// The names most similar to a text, the nearest first.
fn near<'a>(text: &str, names: impl Iterator<Item = &'a String>) -> Vec<String> {
    let text = text.to_lowercase();
    let similarity = |name: &String| strsim::jaro_winkler(&text, &name.to_lowercase());
    let mut near: Vec<(f64, &String)> = names.map(|name| (similarity(name), name)).collect();
    near.retain(|(similarity, _)| *similarity >= NEAR);
    near.sort_by(|one, other| other.0.total_cmp(&one.0));
    near.into_iter().take(MOST_NAMES).map(|(_, name)| name.clone()).collect()
}

fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ")
}
