use std::time::Duration;

use egui::{FullOutput, RawInput, Rect, ViewportId};
use web_time::Instant;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};

use super::background;
use super::dynamic_resolution::{SceneChange, lap_timer};
use super::error::GraphicsError;
use super::event::UserEvent;
use super::graphics::{Graphics, guarded};
use super::platform;
use super::present::Presented;
use super::window::{AppWindow, Repaint};
use crate::session::{Actions, Effect, InspectAction, ReachAction, Session};
use crate::ui::{self, FrameTime, style};

/// Time between frames while only counts of earlier frames are missing.
const COUNTS_INTERVAL: Duration = Duration::from_millis(50);

/// A frame: the panels run, their actions are applied, and the window is drawn.
impl AppWindow {
    /// Runs one frame: takes the input, applies the actions of the panels, and draws.
    pub fn redraw(
        &mut self,
        event_loop: &ActiveEventLoop,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Repaint {
        if let Some(later) = self.restore(event_loop, session, proxy) {
            return later;
        }
        let started = Instant::now();
        let input = self.egui.take_egui_input(&self.window);
        style::apply(self.egui.egui_ctx(), session.preferences().theme);
        let interval = self.moving_since.take().map(|last| started - last);
        let mut frame = FrameTime { interval, ..FrameTime::default() };
        let (mut output, viewport, effects) = self.run(input, session, &mut frame);
        self.viewport = viewport;
        if self.ends || effects.into_iter().any(|effect| self.carry_out(effect, session, proxy)) {
            output.textures_delta.clear();
            return Repaint::Quit;
        }
        if let Some(job) = session.next_inspection() {
            session.apply(InspectAction::Started(job.clone()));
            background::inspect(job, proxy.clone());
        }
        if let Some(job) = session.next_reach_region() {
            session.apply(ReachAction::Started(job.clone()));
            background::find_reach(job, proxy.clone());
        }
        self.update_title(session);
        let system = std::mem::take(&mut output.platform_output);
        platform::copy(&system.commands);
        self.egui.handle_platform_output(&self.window, system);
        let delay = output.viewport_output.get(&ViewportId::ROOT).map(|root| root.repaint_delay);
        let delay = match self.draw(session, output, &mut frame) {
            Ok(Presented::Shown { has_changed }) => {
                self.machine.crowd = self.graphics.as_ref().and_then(Graphics::crowd_times);
                if has_changed {
                    self.machine.times.push(frame);
                }
                if !self.graphics.as_ref().is_some_and(|graphics| graphics.has_own_time) {
                    let budget = session.preferences().frame_budget.time();
                    self.dynamic_resolution.measure(&frame, frame.total(), budget);
                }
                self.moving_since = delay.filter(Duration::is_zero).map(|_| started);
                self.frames += 1;
                log::trace!("frame {}: {frame}", self.frames);
                self.retries.reset();
                let counts = self.awaits_counts.then_some(COUNTS_INTERVAL);
                delay
                    .into_iter()
                    .chain(self.dynamic_resolution.rests_in(started))
                    .chain(counts)
                    .min()
            }
            // Motion that is not visible needs few frames.
            Ok(Presented::Later(again)) => {
                let delay = delay.map(|delay| delay.max(Graphics::HIDDEN_FRAME_INTERVAL));
                delay.into_iter().chain(again).min()
            }
            Err(error) => return self.lose(error),
        };
        delay.and_then(|delay| started.checked_add(delay)).map_or(Repaint::OnInput, Repaint::At)
    }

    /// Runs the panels once for each key press or mouse button, so that each press sees the effects
    /// of the previous one.
    fn run(
        &mut self,
        mut input: RawInput,
        session: &mut Session,
        frame: &mut FrameTime,
    ) -> (FullOutput, Rect, Vec<Effect>) {
        let mut events = std::mem::take(&mut self.held_keys);
        if !session.shell().is_asking() {
            // These events were typed while the system's dialog had the focus.
            events.clear();
        }
        events.append(&mut input.events);
        let strokes = ui::strokes(events);
        let mut output = FullOutput::default();
        let mut viewport = Rect::ZERO;
        let mut effects = Vec::new();
        for events in strokes {
            let events = if session.shell().is_choosing() {
                ui::hold_typed(events, &mut self.held_keys)
            } else {
                events
            };
            let dropped_files = std::mem::take(&mut input.dropped_files);
            let stroke = RawInput { events, dropped_files, ..input.clone() };
            let (run, rect, new_effects) = self.run_stroke(stroke, session, frame);
            output.append(run);
            viewport = rect;
            effects.extend(new_effects);
        }
        (output, viewport, effects)
    }

    /// Runs the panels and applies their actions. If there were any actions, runs the panels again,
    /// so that no panel shows an outdated state.
    fn run_stroke(
        &mut self,
        input: RawInput,
        session: &mut Session,
        frame: &mut FrameTime,
    ) -> (FullOutput, Rect, Vec<Effect>) {
        let mut lap = lap_timer();
        let again = RawInput { events: Vec::new(), dropped_files: Vec::new(), ..input.clone() };
        let (machine, ctx) = (&self.machine, self.egui.egui_ctx());
        let mut viewport = Rect::ZERO;
        let mut actions = Actions::new();
        let mut output = ctx.run_ui(input, |ui| {
            viewport = ui::show(ui, session, machine, &mut actions);
        });
        frame.panels += lap();
        if actions.is_empty() {
            return (output, viewport, Vec::new());
        }
        let effects = actions.drain().filter_map(|action| session.apply(action)).collect();
        frame.solve += lap();
        style::apply(ctx, session.preferences().theme);
        output.append(ctx.run_ui(again, |ui| {
            viewport = ui::show(ui, session, machine, &mut actions);
        }));
        frame.panels += lap();
        (output, viewport, effects)
    }

    /// Draws the scene and the panels.
    fn draw(
        &mut self,
        session: &Session,
        output: FullOutput,
        frame: &mut FrameTime,
    ) -> Result<Presented, GraphicsError> {
        let FullOutput { shapes, textures_delta: mut textures, pixels_per_point: scale, .. } =
            output;
        // Taken out first: egui panics if texture changes are dropped with the output.
        let changed = std::mem::take(&mut textures.set);
        let freed = std::mem::take(&mut textures.free);
        let pixels = self.viewport_pixels(scale);
        let Some(graphics) = &mut self.graphics else {
            return Ok(Presented::Later(None));
        };
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return guarded(|| {
                graphics.panels.update_textures(&graphics.gpu, changed);
                graphics.panels.free_textures(freed);
                Ok(Presented::Later(None))
            });
        }
        let mut lap = lap_timer();
        let (posed, theme) = (session.posed(), session.preferences().theme);
        session.write_overlays(&mut self.overlays);
        self.overlays.has_handles = true;
        match &mut self.scene {
            Some(scene) => self.builder.refill(scene, posed, &self.overlays, theme),
            None => self.scene = Some(self.builder.build(posed, &self.overlays, theme)),
        }
        let budget = session.preferences().frame_budget.time();
        let held = self.egui.egui_ctx().input(|input| input.pointer.any_down());
        let is_driven = held || session.playback().is_playing();
        let change = SceneChange::new(graphics.drawn_scene(), self.scene.as_ref(), is_driven);
        frame.resolution_scale =
            self.dynamic_resolution.next(change, pixels, budget, Instant::now());
        frame.scene += lap();
        let panels = self.egui.egui_ctx().tessellate(shapes, scale);
        frame.panels += lap();
        let (machine, dynamic_resolution) = (&mut self.machine, &mut self.dynamic_resolution);
        guarded(|| {
            // The times are those of earlier frames.
            while let Some((earlier, time)) = graphics.read_clock() {
                if let Some(earlier) = machine.times.set_gpu(earlier, time)
                    && graphics.has_own_time
                {
                    dynamic_resolution.measure(earlier, earlier.work() + time, budget);
                }
            }
            graphics.panels.update_textures(&graphics.gpu, changed);
            if let Some(scene) = &mut self.scene {
                machine.counts =
                    Some(graphics.draw_scene(scene, pixels, scale, frame.resolution_scale));
                frame.draws_scene = graphics.picture.is_new;
                self.awaits_counts = graphics.awaits_counts();
            }
            frame.encode += lap();
            let drawn = machine.times.drawn();
            let (presented, waited) =
                graphics.present(&panels, self.viewport, scale, &self.window, drawn)?;
            frame.wait += waited;
            frame.encode += lap().saturating_sub(waited);
            graphics.panels.free_textures(freed);
            if self.retries.is_retrying() && matches!(presented, Presented::Shown { .. }) {
                graphics.finish()?;
            }
            Ok(presented)
        })
    }
}
