//! A test bench: runs the panels as `src/app/window.rs` does, with simulated time and no window.

use crate::common::arm::{ArmSession, Step};
use std::f32::consts::TAU;
use std::time::Duration;

use egui::accesskit::Role;
use egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, Rect, TouchPhase,
    Vec2, ViewportId, vec2,
};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, Node, SnapshotOptions, SnapshotResults};
use glam::{Quat, Vec3};
use ik_arm::document::{Ray, Theme};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::session::{
    Action, Actions, Effect, Grip, GripRing, PanelTab, PlaybackAction, Preferences, SelectAction,
    Session, ShellAction, ViewAction,
};
use ik_arm::ui::{self, FrameTime, FrameTimes, Machine, style};

use crate::common::documents::open_example;

pub const LARGE: Vec2 = vec2(1280.0, 800.0);
pub const SMALL: Vec2 = vec2(960.0, 600.0);
pub const SECONDS_PER_FRAME: f64 = 1.0 / 60.0;

/// State of the window.
pub struct App {
    pub session: Session,
    pub machine: Machine,
    viewport: Rect,
    actions: Actions,
    effects: Vec<Effect>,
}

/// One frame of 12 milliseconds.
fn times() -> FrameTimes {
    let mut times = FrameTimes::default();
    times.push(FrameTime { panels: Duration::from_millis(12), ..FrameTime::default() });
    times
}

pub struct Bench {
    pub harness: Harness<'static, App>,
    now: f64,
    modifiers: Modifiers,
    pointer: Pos2,
}

impl Bench {
    pub fn new() -> Self {
        Self::of_size(LARGE)
    }

    /// With the timeline closed.
    pub fn of_size(size: Vec2) -> Self {
        Self::liking(size, Preferences { timeline_open: Some(false), ..Preferences::default() })
    }

    /// With the timeline open.
    pub fn with_timeline(size: Vec2) -> Self {
        Self::liking(size, Preferences { timeline_open: Some(true), ..Preferences::default() })
    }

    /// With the sections unfolded whose settings many tests use, and without the offer of the tour.
    pub fn liking(size: Vec2, preferences: Preferences) -> Self {
        let mut bench = Self::first(size, Preferences { offers_tour: false, ..preferences });
        bench.toggle(&["Limb", "Lengths", "Root", "Hierarchy"]);
        bench
    }

    /// As at the first start of the program.
    pub fn first(size: Vec2, preferences: Preferences) -> Self {
        let app = App {
            session: Session::new(preferences),
            machine: Machine {
                adapter: "Test adapter".to_owned(),
                times: times(),
                ..Machine::default()
            },
            viewport: Rect::ZERO,
            actions: Actions::new(),
            effects: Vec::new(),
        };
        let harness = Harness::builder()
            .with_size(size)
            .with_render_cursor(false)
            .with_context_setup(style::install)
            .build_ui_state(
                |ui, app: &mut App| {
                    let App { session, machine, viewport, actions, .. } = app;
                    *viewport = ui::show(ui, session, machine, actions);
                },
                app,
            );
        assert!(harness.state().actions.is_empty(), "nothing happens by itself");
        let mut bench =
            Self { harness, now: 10.0, modifiers: Modifiers::NONE, pointer: Pos2::ZERO };
        bench.settle();
        bench
    }

    /// With a session that some actions have changed.
    pub fn after(actions: impl IntoIterator<Item = impl Into<Step>>) -> Self {
        let mut bench = Self::new();
        bench.apply(actions);
        bench
    }

    /// With a built-in example.
    pub fn example(name: &str) -> Self {
        Self::after([open_example(name)])
    }

    /// Applies actions and waits until nothing moves. An example that plays when it is opened is
    /// stopped at its start.
    pub fn apply(&mut self, actions: impl IntoIterator<Item = impl Into<Step>>) {
        let session = &mut self.harness.state_mut().session;
        for action in actions {
            let step = action.into();
            let opens_example = step.opens_example();
            step.apply(session);
            if opens_example {
                session.apply(PlaybackAction::Play(false));
            }
        }
        self.settle();
    }

    /// Applies an action from outside, such as a finished save. Returns the effect.
    pub fn tell(&mut self, action: impl Into<Action>) -> Option<Effect> {
        self.harness.state_mut().session.apply(action)
    }

    /// Like [`Self::apply`], for actions that start movement: does not wait for its end.
    pub fn apply_moving(&mut self, actions: impl IntoIterator<Item = impl Into<Step>>) {
        for action in actions {
            action.into().apply(&mut self.harness.state_mut().session);
        }
        self.frame([]);
    }

    pub fn session(&self) -> &Session {
        &self.harness.state().session
    }

    pub fn joint(&self, name: &str) -> JointId {
        self.session().skeleton().find(name).expect("a joint of that name")
    }

    pub fn tip(&self, name: &str) -> Vec3 {
        self.session().skeleton_pose().tip(self.joint(name))
    }

    pub fn hand(&self) -> Vec3 {
        self.session().arm().cursor_in_root()
    }

    /// One frame of the window: its input, one key press or mouse button after the other.
    pub fn frame(&mut self, events: impl IntoIterator<Item = Event>) {
        self.now += SECONDS_PER_FRAME;
        for stroke in ui::strokes(events.into_iter().collect()) {
            self.stroke(stroke);
        }
    }

    /// A pass of the panels, and if they ask for anything, another one.
    fn stroke(&mut self, events: Vec<Event>) {
        self.pass(events);
        let app = self.harness.state_mut();
        if app.actions.is_empty() {
            return;
        }
        for action in std::mem::take(&mut app.actions) {
            match app.session.apply(action) {
                // The system has no file dialog.
                Some(Effect::ChoosePath(dialog)) if app.session.shell().dialog().is_none() => {
                    app.session.apply(ShellAction::OpenDialog(dialog.into()));
                }
                effect => app.effects.extend(effect),
            }
        }
        self.pass(Vec::new());
        self.harness.state_mut().actions = Actions::new();
    }

    fn pass(&mut self, events: Vec<Event>) {
        style::apply(&self.harness.ctx, self.session().preferences().theme);
        let input = self.harness.input_mut();
        input.time = Some(self.now);
        input.predicted_dt = SECONDS_PER_FRAME as f32;
        input.events = events;
        self.harness.step();
    }

    /// Lets time pass, a frame at a time.
    pub fn wait(&mut self, seconds: f64) {
        let end = self.now + seconds;
        while self.now < end - 1e-9 {
            self.frame([]);
        }
    }

    /// Lets time pass in one frame.
    pub fn skip(&mut self, seconds: f64) {
        self.now += seconds - SECONDS_PER_FRAME;
        self.frame([]);
    }

    /// Runs until the window would sleep.
    pub fn settle(&mut self) {
        let moves = (0..60).all(|_| {
            self.frame([]);
            self.asks_for_a_frame()
        });
        assert!(!moves, "still moving: {:?}", self.harness.ctx.repaint_causes());
    }

    pub fn asks_for_a_frame(&self) -> bool {
        self.harness.output().viewport_output[&ViewportId::ROOT].repaint_delay.is_zero()
    }

    /// Effects since the last call.
    pub fn effects(&mut self) -> Vec<Effect> {
        std::mem::take(&mut self.harness.state_mut().effects)
    }
}

/// Looking.
impl Bench {
    pub fn node<'a>(&'a self, role: Role, name: &'a str) -> Node<'a> {
        self.harness.get_by_role_and_label(role, name)
    }

    pub fn shows(&self, role: Role, name: &str) -> bool {
        self.harness.query_all_by_role_and_label(role, name).next().is_some()
    }

    pub fn says(&self, text: &str) -> bool {
        self.harness.query_all_by_label_contains(text).next().is_some()
    }

    /// Number of widgets whose name contains a text.
    pub fn count(&self, text: &str) -> usize {
        self.harness.query_all_by_label_contains(text).count()
    }

    pub fn rect(&self, role: Role, name: &str) -> Rect {
        self.node(role, name).rect()
    }

    /// Role and name of the focused widget.
    pub fn focused(&self) -> Option<(Role, String)> {
        let focused = self.harness.root().children_recursive().find(Node::is_focused)?;
        let node = focused.accesskit_node();
        Some((node.role(), node.label().or(node.value()).unwrap_or_default()))
    }

    pub fn viewport(&self) -> Rect {
        self.harness.state().viewport
    }

    /// Screen position of a point in world space.
    pub fn on_screen(&self, point: Vec3) -> Pos2 {
        let rect = self.viewport();
        let projection = self.session().camera().projection(rect.aspect_ratio());
        let at = projection.project(point).expect("before the eye");
        rect.center() + vec2(at.x, -at.y) * rect.size() / 2.0
    }

    /// The ray through a screen position, in world space.
    pub fn ray(&self, at: Pos2) -> Ray {
        let rect = self.viewport();
        let from_centre = (at - rect.center()) / (rect.size() / 2.0);
        let projection = self.session().camera().projection(rect.aspect_ratio());
        projection.ray(glam::Vec2::new(from_centre.x, -from_centre.y))
    }

    /// Screen positions around a ring with a constant `radius` on screen, in points.
    pub fn around(&self, ring: GripRing, radius: f32) -> Vec<Pos2> {
        const STEPS: u16 = 96;
        let rect = self.viewport();
        let projection = self.session().camera().projection(rect.aspect_ratio());
        let [right, up] = [projection.right, projection.up].map(Vec3::normalize);
        let (u, v) = ring.axis.any_orthonormal_pair();
        let centre = self.on_screen(ring.centre);
        let place = |step: u16| {
            let (sin, cos) = (f32::from(step) / f32::from(STEPS) * TAU).sin_cos();
            let aside = radius * (u * cos + v * sin);
            centre + vec2(aside.dot(right), -aside.dot(up))
        };
        (0..STEPS).map(|step| place(step * 7 % STEPS)).collect()
    }

    /// Presses at a place of a ring of the selection where that takes `grip`, and returns the place
    /// at which the mouse has turned the ring by an angle in radians. The button stays down.
    pub fn take_ring(&mut self, grip: Grip, ring: GripRing, radius: f32, by: f32) -> Pos2 {
        let selection = [SelectAction::Joints(self.session().selection().joints().to_vec())];
        for at in self.around(ring, radius) {
            let facing = self.ray(at).direction.normalize().dot(ring.axis).abs();
            self.move_to(at);
            self.press(PointerButton::Primary);
            let is_taken = self.session().history().drag().is_some_and(|drag| drag.grip() == grip);
            if let Some(met) = self.ray(at).meets_plane(ring.centre, ring.axis)
                && is_taken
                && facing > 0.15
            {
                let turn = Quat::from_axis_angle(ring.axis, by);
                return self.on_screen(ring.centre + turn * (met - ring.centre));
            }
            self.key(Key::Escape);
            self.release(PointerButton::Primary);
            self.apply(selection.clone());
            // So that the next press is no double click.
            self.skip(1.0);
        }
        panic!("{grip:?} is nowhere");
    }

    pub fn cursor_on_screen(&self) -> Pos2 {
        self.on_screen(self.session().arm().cursor_in_world())
    }

    /// A point of the viewport without handles.
    pub fn empty_point(&self) -> Pos2 {
        self.viewport().left_top() + vec2(40.0, 80.0)
    }
}

/// Acting. Each is one frame, as input comes from a hand.
impl Bench {
    pub fn move_to(&mut self, at: Pos2) {
        self.pointer = at;
        self.frame([Event::PointerMoved(at)]);
    }

    pub fn press(&mut self, button: PointerButton) {
        self.frame([self.button(button, true)]);
    }

    pub fn release(&mut self, button: PointerButton) {
        self.frame([self.button(button, false)]);
    }

    pub fn button(&self, button: PointerButton, pressed: bool) -> Event {
        Event::PointerButton { pos: self.pointer, button, pressed, modifiers: self.modifiers }
    }

    pub fn hold(&mut self, modifiers: Modifiers) {
        self.modifiers = modifiers;
        self.frame([Event::ModifiersChanged(modifiers)]);
    }

    pub fn key(&mut self, key: Key) {
        self.frame([self.key_event(key, true)]);
        self.frame([self.key_event(key, false)]);
    }

    pub fn key_with(&mut self, modifiers: Modifiers, key: Key) {
        let before = self.modifiers;
        self.hold(modifiers);
        self.key(key);
        self.hold(before);
    }

    fn key_event(&self, key: Key, pressed: bool) -> Event {
        let modifiers = self.modifiers;
        Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }
    }

    /// Types as a keyboard does: each key is pressed and gives its letter.
    pub fn type_text(&mut self, text: &str) {
        for letter in text.chars() {
            let letter = letter.to_string();
            let pressed = Key::from_name(&letter).map(|key| self.key_event(key, true));
            self.frame(pressed.into_iter().chain([Event::Text(letter)]));
        }
    }

    pub fn wheel(&mut self, lines: f32) {
        self.scroll(vec2(0.0, lines));
    }

    pub fn scroll(&mut self, delta: Vec2) {
        self.frame([Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta,
            phase: TouchPhase::Move,
            source: MouseWheelSource::Unknown,
            modifiers: self.modifiers,
        }]);
    }

    /// Scrolls the panel of a widget until the widget is in sight, in the left panel above the note
    /// on the selected target.
    pub fn reveal(&mut self, role: Role, name: &str) {
        const NOTE: f32 = 150.0;
        for _ in 0..40 {
            let (rect, view) = (self.rect(role, name), self.viewport());
            let has_note = rect.right() < view.left() && self.has_note();
            let is_hidden = rect.right() < view.left() && rect.top() < self.bottom_of_outliner();
            let room = view.bottom() - 8.0 - if has_note { NOTE } else { 0.0 };
            if rect.bottom() < room && !is_hidden {
                return;
            }
            self.move_to(egui::pos2(rect.center().x, self.viewport().center().y + 40.0));
            self.wheel(if is_hidden { 0.5 } else { -3.0 });
            self.settle();
        }
        panic!("{name} cannot be scrolled to");
    }

    /// The lower end of the tree of joints, below which the panel scrolls.
    pub fn bottom_of_outliner(&self) -> f32 {
        let is_open = self.shows(Role::List, "Joints as a tree");
        let open = (Role::List, "Joints as a tree");
        let last = if is_open { open } else { (Role::Button, "Joints") };
        self.rect(last.0, last.1).bottom()
    }

    fn has_note(&self) -> bool {
        let session = self.session();
        let rig = session.rig();
        let selected = session.selection().active();
        rig.sole_limb().is_none()
            && selected.is_some_and(|joint| {
                rig.target_of_end(joint).or_else(|| rig.limb_target_of(joint)).is_some()
            })
    }

    pub fn click_at(&mut self, at: Pos2) {
        self.move_to(at);
        self.press(PointerButton::Primary);
        self.release(PointerButton::Primary);
    }

    pub fn double_click_at(&mut self, at: Pos2) {
        self.click_at(at);
        self.click_at(at);
        self.settle();
    }

    /// Presses at one point, moves to the other in steps, and holds.
    pub fn drag(&mut self, button: PointerButton, from: Pos2, to: Pos2) {
        self.move_to(from);
        self.press(button);
        for step in 1..=8 {
            self.move_to(from + (to - from) * (step as f32 / 8.0));
        }
    }

    pub fn drag_and_drop(&mut self, button: PointerButton, from: Pos2, to: Pos2) {
        self.drag(button, from, to);
        self.release(button);
    }

    pub fn click(&mut self, role: Role, name: &str) {
        self.click_at(self.rect(role, name).center());
        self.settle();
    }

    /// Folds or unfolds sections of a panel.
    pub fn toggle(&mut self, sections: &[&str]) {
        for section in sections {
            self.node(Role::DisclosureTriangle, section).click_accesskit();
            self.settle();
        }
    }

    /// Unfolds the sections with the formulas of a limb's triangle.
    pub fn unfold_formulas(&mut self) {
        self.toggle(&["Pointer", "Elbow triangle", "Law of cosines", "Positions"]);
    }

    /// Shows a page of the panel on the right.
    pub fn show_tab(&mut self, tab: PanelTab) {
        self.apply([ViewAction::ShowTab(tab)]);
    }

    /// Opens menus and chooses the last. Waits until all rests, unless that plays.
    pub fn choose(&mut self, path: &[&str]) {
        for name in path {
            let item = self.harness.query_all_by_label_contains(name).find(|node| {
                // The label of an item ends with its keys.
                let node = node.accesskit_node();
                let label = node.label().unwrap_or_default();
                let rest = label.strip_prefix(name).unwrap_or("none of it");
                matches!(node.role(), Role::Button | Role::CheckBox | Role::RadioButton)
                    && (rest.is_empty() || rest.starts_with(' '))
            });
            let item = item.expect("in the menu").rect();
            self.click_at(item.center());
            if !self.session().playback().is_playing() {
                self.settle();
            }
        }
    }

    pub fn focus(&mut self, role: Role, name: &str) {
        self.node(role, name).focus();
        self.settle();
    }

    /// Clicks the number beside a rail, types another and enters it.
    pub fn enter(&mut self, slider: &str, text: &str) {
        self.type_into(&format!("{slider} value"), text);
    }

    /// Types into the field of a number.
    pub fn type_into(&mut self, field: &str, text: &str) {
        self.click(Role::SpinButton, field);
        self.key_with(Modifiers::COMMAND, Key::A);
        self.frame([Event::Text(text.to_owned())]);
        self.key(Key::Enter);
        self.settle();
    }
}

/// A point that is to be the same bit for bit.
pub fn bits(point: Vec3) -> [u32; 3] {
    point.to_array().map(f32::to_bits)
}

// Snapshots of the panels.

/// Options of a snapshot that may differ in at most so many pixels.
pub fn snapshot_options(most_pixels: usize) -> SnapshotOptions {
    SnapshotOptions::new()
        .threshold(2.0)
        .max_failed_pixels(most_pixels)
        .output_path("tests/ui/snapshots")
}

/// Name of a snapshot in a theme, such as "panels_dark".
pub fn themed(name: &str, theme: Theme) -> String {
    format!("{name}_{}", format!("{theme:?}").to_lowercase())
}

impl Bench {
    /// Compares the window with its snapshot.
    pub fn snapshot(&mut self, name: &str, theme: Theme, results: &mut SnapshotResults) {
        self.harness.snapshot_options(themed(name, theme), &snapshot_options(600));
        results.extend_harness(&mut self.harness);
    }
}
