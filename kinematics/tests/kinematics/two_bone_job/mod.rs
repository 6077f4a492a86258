//! Every correction is judged by posing the skeleton anew in f64, from local transforms.

mod accuracy;
mod any_start;
mod batch;
mod cases;
mod edges;
mod properties;
mod skeleton;
