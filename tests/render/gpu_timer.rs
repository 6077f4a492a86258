//! The time of frames on the device.
//!
//! These tests fail on an adapter without a clock; Mesa's llvmpipe has one, and `WGPU_ADAPTER_NAME`
//! chooses it.

use std::time::{Duration, Instant};

use ik_arm::document::{Document, Theme};
use ik_arm::render::{Canvas, Gpu, GpuTimer, Renderer, TimedPass};
use ik_arm::scene::Scene;
use ik_arm::session::Overlays;
use pollster::block_on;

const SIZE: (u32, u32) = (640, 400);

/// Draws a picture and waits for it. Returns the time that took, and what the timer reports.
fn timed(
    gpu: &Gpu,
    renderer: &mut Renderer,
    gpu_timer: &mut GpuTimer,
    frame: u64,
) -> (Duration, Option<(u64, Duration)>) {
    let scene = Scene::new(&Document::default().at(0.0), &Overlays::default(), Theme::Dark);
    let canvas = Canvas::new(gpu, SIZE.0, SIZE.1);
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("idle");
    let started = Instant::now();
    renderer.upload(gpu, &scene, &canvas, 1.0);
    gpu_timer.start();
    let drawn = renderer.encode(gpu, &canvas, Some(gpu_timer.pass(TimedPass::Scene)));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    gpu_timer.stop(&mut encoder, frame);
    gpu.queue.submit([drawn, encoder.finish()]);
    gpu_timer.fetch();
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("drawn");
    let took = started.elapsed();
    (took, gpu_timer.read(gpu))
}

fn gpu_and_timer() -> (Gpu, GpuTimer) {
    let gpu = block_on(Gpu::headless()).expect("a graphics adapter");
    let name = gpu.name();
    let has_clock = gpu.adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
    assert!(has_clock, "{name} has no clock: choose another adapter with WGPU_ADAPTER_NAME");
    let gpu_timer = GpuTimer::new(&gpu).expect("an adapter with a clock has a timer");
    (gpu, gpu_timer)
}

#[test]
fn gpu_time_is_at_most_the_wall_time_of_a_frame() {
    let (gpu, mut gpu_timer) = gpu_and_timer();
    let mut renderer = Renderer::new(&gpu);
    for frame in 0..12 {
        let (took, read) = timed(&gpu, &mut renderer, &mut gpu_timer, frame);
        let (of, time) = read.expect("it is there once all is done");
        assert_eq!(of, frame);
        assert!(time > Duration::ZERO && time < took, "{time:?} of {took:?}");
        assert_eq!(gpu_timer.read(&gpu), None, "it is told once");
    }
}

#[test]
fn unread_frames_are_dropped_without_waiting() {
    let (gpu, mut gpu_timer) = gpu_and_timer();
    let mut read = 0;
    for frame in 0..20 {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        gpu_timer.start();
        gpu_timer.stop(&mut encoder, frame);
        gpu.queue.submit([encoder.finish()]);
        gpu_timer.fetch();
    }
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("done");
    while let Some((frame, time)) = gpu_timer.read(&gpu) {
        assert!(frame < 20 && time == Duration::ZERO, "no pass was timed");
        read += 1;
    }
    assert!(read > 0);
}
