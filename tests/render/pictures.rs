//! Pictures drawn without a window, and the expected ones in `tests/golden`.
#![allow(dead_code, reason = "each test takes what it needs")]

use std::path::PathBuf;
use std::sync::{LazyLock, Mutex};

use ik_arm::render::{Gpu, PictureRenderer};
use ik_arm::scene::Scene;
use image::RgbaImage;
use pollster::block_on;

pub const SIZE: (u32, u32) = (480, 300);

/// Largest fraction of pixels that may differ by more than `NOTICED`, and largest mean difference.
const NOTICED: u8 = 16;
const MOST_NOTICED: f64 = 0.002;
const MOST_MEAN: f64 = 1.0;

pub static GPU: LazyLock<Mutex<Gpu>> =
    LazyLock::new(|| Mutex::new(block_on(Gpu::headless()).expect("a graphics adapter")));

pub fn draw(scene: &Scene) -> RgbaImage {
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    block_on(PictureRenderer::new(&gpu, SIZE.0, SIZE.1, 1.0).draw(scene)).expect("drawn")
}

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

pub fn kept(name: &str) -> RgbaImage {
    let path = path(&format!("{name}.png"));
    image::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).into_rgba8()
}

/// Fails with a description if two pictures differ too much.
pub fn compare(a: &RgbaImage, b: &RgbaImage) -> Result<(), String> {
    if a.dimensions() != b.dimensions() {
        return Err(format!("{:?} is not {:?}", a.dimensions(), b.dimensions()));
    }
    let apart = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| {
        let [r, g, b, _] = [0, 1, 2, 3].map(|channel| a.0[channel].abs_diff(b.0[channel]));
        [r, g, b]
    };
    let (mut noticed, mut sum) = (0_u32, 0_u64);
    for (a, b) in a.pixels().zip(b.pixels()) {
        let apart = apart(a, b);
        noticed += u32::from(apart.iter().any(|channel| *channel > NOTICED));
        sum += apart.iter().map(|channel| u64::from(*channel)).sum::<u64>();
    }
    let pixels = f64::from(a.width() * a.height());
    let (noticed, mean) = (f64::from(noticed) / pixels, sum as f64 / (3.0 * pixels));
    if noticed > MOST_NOTICED || mean > MOST_MEAN {
        return Err(format!(
            "{:.3} % of the pixels differ, the mean by {mean:.3}",
            noticed * 100.0
        ));
    }
    Ok(())
}

/// Fails unless the scene looks like the expected picture; with `UPDATE_GOLDEN` replaces it first.
pub fn check(name: &str, scene: &Scene) {
    let drawn = draw(scene);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        drawn.save(path(&format!("{name}.png"))).expect("saved");
    }
    if let Err(difference) = compare(&drawn, &kept(name)) {
        let new = path(&format!("{name}.new.png"));
        drawn.save(&new).expect("saved");
        panic!("{name}: {difference}; see {}", new.display());
    }
}
