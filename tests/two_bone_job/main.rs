//! Every correction is judged by posing the skeleton anew in f64, from local transforms.

mod accuracy;
mod any_start;
mod cases;
mod edges;
mod properties;
#[path = "../common/rigs.rs"]
mod rigs;
mod skeleton;
