//! The menu bar.

use egui::{Align, Button, Label, Layout, MenuBar, RichText, Ui};

use super::{commands, labels, panels};
use crate::document::{Channel, Overlay, RigKind, Theme};
use crate::io::{Example, ExampleGroup, OpenOptions};
use crate::session::{
    Action, Actions, Dialog, DisplayEdit, FileAction, FrameBudget, JointEdit, KeysEdit, Navigation,
    Session, ShellAction, TourAction, TransactionAction, ViewAction,
};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file(ui, session, actions));
        ui.menu_button("Edit", |ui| edit(ui, session, actions));
        ui.menu_button("View", |ui| view(ui, session, actions));
        ui.menu_button("Examples", |ui| examples(ui, actions));
        ui.menu_button("Help", |ui| help(ui, actions));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let rig = match session.rig() {
                RigKind::Arm => match session.arm().influence {
                    1.0 => "Arm · IK (hand → joint angles)".to_owned(),
                    0.0 => "Arm · FK (joint angles → hand)".to_owned(),
                    influence => format!("Arm · {:.0} % IK, rest FK", influence * 100.0),
                },
                RigKind::Skeleton => {
                    format!("Skeleton · {}", session.skeleton_rig().solver.method.title())
                }
            };
            ui.add(Label::new(RichText::new(rig).weak()).selectable(false));
            ui.separator();
            document_name(ui, session);
        });
    });
}

/// Shows the name of the document, with an asterisk while it has unsaved changes.
fn document_name(ui: &mut Ui, session: &Session) {
    const NO_FILE: &str = "This document has no file yet (Ctrl+S)";
    let name = session.files().name().unwrap_or_else(|| "untitled".to_owned());
    let (name, tooltip) = match (session.files().file(), session.files().contents()) {
        _ if session.tour().is_some() => {
            ("Tour".to_owned(), "Your own document is kept".to_owned())
        }
        (Some(path), _) => (name, path.display().to_string()),
        (None, Some(from)) => (name, format!("{NO_FILE}; it comes from {}", from.path.display())),
        (None, None) => (name, NO_FILE.to_owned()),
    };
    let is_unsaved = session.tour().is_none() && session.history().is_unsaved();
    let (mark, told) = if is_unsaved { ("*", "\nIt has unsaved changes") } else { ("", "") };
    let name = Label::new(format!("{name}{mark}")).truncate().selectable(false);
    ui.add(name).on_hover_text(format!("{tooltip}{told}"));
}

fn item(ui: &mut Ui, name: &str, keys: &str) -> bool {
    let button = Button::new(name);
    ui.add(if keys.is_empty() { button } else { button.shortcut_text(keys) }).clicked()
}

fn file(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    if item(ui, "New", "Ctrl+N") {
        actions.push(FileAction::New);
    }
    if item(ui, "New skeleton", "Ctrl+Shift+N") {
        actions.push(FileAction::NewSkeleton);
    }
    if item(ui, "Open…", "Ctrl+O") {
        actions.push(commands::open());
    }
    ui.add_enabled_ui(!session.files().recent().is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| recent(ui, session, actions));
    });
    contents(ui, session, actions);
    ui.separator();
    if item(ui, "Save", "Ctrl+S") {
        actions.push(FileAction::Save);
    }
    if item(ui, "Save as…", "Ctrl+Shift+S") {
        actions.push(commands::save_as(session));
    }
    ui.separator();
    if item(ui, "Export…", "Ctrl+E") {
        actions.push(ShellAction::OpenDialog(session.export_dialog().into()));
    }
    if item(ui, "Save picture…", "Ctrl+P") {
        actions.push(commands::save_picture(session));
    }
    ui.separator();
    if item(ui, "Quit", "Ctrl+Q") {
        actions.push(FileAction::Quit);
    }
}

/// Shows the item that opens another skeleton or animation of the file.
fn contents(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let several = session.files().contents().filter(|contents| contents.has_choice());
    let button = Button::new("Skeletons and animations…");
    let item = ui.add_enabled(several.is_some(), button);
    let item = item.on_disabled_hover_text("The file has no other skeleton or animation");
    if let Some(contents) = several.filter(|_| item.clicked()) {
        actions.push(ShellAction::OpenDialog(Dialog::ChooseContents(Box::new(contents.clone()))));
    }
}

fn recent(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    for path in session.files().recent() {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let button = ui.button(name).on_hover_text(path.display().to_string());
        if button.clicked() {
            actions.push(FileAction::Open { path: path.clone(), options: OpenOptions::default() });
        }
    }
}

fn edit(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    step(
        ui,
        "Undo",
        session.history().undo_label(),
        "Ctrl+Z",
        TransactionAction::Undo.into(),
        actions,
    );
    step(
        ui,
        "Redo",
        session.history().redo_label(),
        "Ctrl+Shift+Z",
        TransactionAction::Redo.into(),
        actions,
    );
    ui.separator();
    ui.menu_button("Key", |ui| key(ui, session, actions));
    bake(ui, session, actions);
    let is_skeleton = session.rig() == RigKind::Skeleton;
    let turn = ui.add_enabled(is_skeleton, Button::new("Turn to y up"));
    let tooltip = "Turn a skeleton that stands along z by −90° about x";
    let turn = turn.on_hover_text(tooltip);
    if turn.on_disabled_hover_text("Show a skeleton: the arm is not turned").clicked() {
        actions.push(JointEdit::TurnYUp);
    }
    ui.separator();
    let copy = Button::new("Copy pose as JSON line").shortcut_text("Ctrl+C");
    let copy = ui.add_enabled(!is_skeleton, copy);
    if copy.on_disabled_hover_text("Only the pose of the arm can be copied").clicked() {
        actions.push(ShellAction::CopyPose);
    }
    ui.separator();
    ui.menu_button("Navigation", |ui| {
        for navigation in Navigation::ALL {
            let chosen = session.preferences().navigation == navigation;
            let [orbit, pan, zoom] = navigation.help();
            let tooltip = format!("Orbit: {orbit}\nPan: {pan}\nZoom: {zoom}");
            if ui.radio(chosen, navigation.name()).on_hover_text(tooltip).clicked() {
                actions.push(ShellAction::SetNavigation(navigation));
            }
        }
    });
}

/// Shows the item that opens the bake dialog; disabled if there is nothing to bake.
fn bake(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let document = session.document();
    let why_not = match session.rig() {
        RigKind::Arm => Some("Show a skeleton: the arm is not baked"),
        RigKind::Skeleton
            if document.skeleton_rig.targets.is_empty() && !document.follows_path() =>
        {
            Some("Add a target or a path: nothing else poses the skeleton")
        }
        RigKind::Skeleton => None,
    };
    let tooltip = "Replace targets and path by keys";
    let item = ui.add_enabled(why_not.is_none(), Button::new("Bake to keys…"));
    let item = item.on_hover_text(tooltip).on_disabled_hover_text(why_not.unwrap_or_default());
    if item.clicked() {
        actions.push(ShellAction::OpenDialog(session.bake_dialog()));
    }
}

/// Shows the menu of channels to key; the channels of overlays are in a submenu.
fn key(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    if item(ui, "Selected", "K") {
        actions.push(KeysEdit::Key(session.channels_to_key()));
    }
    if item(ui, "All", "Shift+K") {
        actions.push(KeysEdit::Key(session.all_channels()));
    }
    ui.separator();
    let one = |ui: &mut Ui, channel: Channel, actions: &mut Actions| {
        if ui.button(labels::channel(session, channel)).clicked() {
            actions.push(KeysEdit::Key(vec![channel]));
        }
    };
    match session.rig() {
        RigKind::Arm => Channel::ARM.into_iter().for_each(|channel| one(ui, channel, actions)),
        RigKind::Skeleton => {
            one(ui, Channel::Translation, actions);
            for joint in session.selection().joints() {
                let there =
                    Channel::of_joint(*joint).filter(|it| it.value(session.shown()).is_some());
                there.for_each(|channel| one(ui, channel, actions));
            }
        }
    }
    ui.menu_button("Guides and display", |ui| {
        Overlay::all().map(Channel::Overlay).for_each(|channel| one(ui, channel, actions));
    });
}

/// Shows the item to undo or redo a step. `name` is the label of the step; `None` disables the
/// item.
fn step(
    ui: &mut Ui,
    verb: &str,
    name: Option<&str>,
    keys: &str,
    action: Action,
    actions: &mut Actions,
) {
    let title = name.map_or(verb.to_owned(), |name| format!("{verb} {name}"));
    let button = ui.add_enabled(name.is_some(), Button::new(title).shortcut_text(keys));
    if button.clicked() {
        actions.push(action);
    }
}

fn view(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    for (axis_view, name, keys) in commands::AXIS_VIEWS {
        if item(ui, name, keys) {
            actions.push(ViewAction::GlideTo(session.settled_camera().along(axis_view)));
        }
    }
    ui.separator();
    if item(ui, "Toggle orthographic", "5") {
        actions
            .push(ViewAction::SetCamera(commands::with_other_projection(session.settled_camera())));
    }
    if item(ui, "Frame selection", "F") {
        actions.push(commands::frame_selection(session));
    }
    if item(ui, "Frame all", "Home") {
        actions.push(commands::frame_all(session));
    }
    let mut follows = session.view().follows_selection();
    let tooltip =
        "Move the camera with the selection, or with the whole rig, while the time changes";
    if ui.checkbox(&mut follows, "Follow selection").on_hover_text(tooltip).changed() {
        actions.push(ViewAction::FollowSelection(follows));
    }
    ui.separator();
    for (theme, name) in [(Theme::Light, "Light theme"), (Theme::Dark, "Dark theme")] {
        if ui.radio(session.preferences().theme == theme, name).clicked() {
            actions.push(ShellAction::SetTheme(theme));
        }
    }
    ui.menu_button("While moving", |ui| {
        for budget in FrameBudget::ALL {
            let chosen = session.preferences().frame_budget == budget;
            if ui.radio(chosen, budget.name()).on_hover_text(budget.help()).clicked() {
                actions.push(ShellAction::SetFrameBudget(budget));
            }
        }
    });
    ui.separator();
    let mut overlays = vec![(Overlay::Trail, "Motion trail"), (Overlay::OnionSkins, "Onion skins")];
    if session.rig() == RigKind::Arm {
        overlays.push((Overlay::SingularityGlobe, "Singularity globe"));
        overlays.push((Overlay::TwistReferences, "Twist references"));
    }
    for (overlay, name) in overlays {
        let mut shown = session.shown().display.shows(overlay);
        if ui.checkbox(&mut shown, name).changed() {
            actions.push(DisplayEdit::ShowOverlay(overlay, shown));
        }
    }
    let mut crowd = session.crowd().is_some();
    let tooltip = "Show up to a million arms, each with its own target";
    if ui.checkbox(&mut crowd, "Crowd").on_hover_text(tooltip).changed() {
        actions.push(ViewAction::ShowCrowd(crowd));
    }
    let mut explain = session.preferences().explain;
    let panel = egui::Checkbox::new(&mut explain, "Explain panel");
    let panel = ui.add_enabled(panels::has_room(ui), panel);
    if panel.on_disabled_hover_text("Make the window wider: it has no room").changed() {
        actions.push(ViewAction::ShowExplain(explain));
    }
    let mut timeline = session.shows_timeline();
    if ui.checkbox(&mut timeline, "Timeline").changed() {
        actions.push(ViewAction::ShowTimeline(timeline));
    }
    let mut curves = session.preferences().curves;
    if ui
        .checkbox(&mut curves, "Graph editor")
        .on_hover_text("Show keys as curves instead of a dope sheet")
        .changed()
    {
        actions.push(ViewAction::ShowGraphEditor(curves));
    }
}

fn examples(ui: &mut Ui, actions: &mut Actions) {
    examples_of(ExampleGroup::Basics, ui, actions);
    ui.separator();
    ui.menu_button("Why not?", |ui| examples_of(ExampleGroup::WhyNot, ui, actions));
    ui.menu_button("Inside a solver", |ui| examples_of(ExampleGroup::InsideSolver, ui, actions));
    ui.menu_button("Hard cases", |ui| examples_of(ExampleGroup::HardCases, ui, actions));
}

fn examples_of(group: ExampleGroup, ui: &mut Ui, actions: &mut Actions) {
    for example in Example::of(group) {
        if ui.button(example.title).on_hover_text(example.sentence).clicked() {
            actions.push(FileAction::OpenExample(example));
        }
    }
}

fn help(ui: &mut Ui, actions: &mut Actions) {
    if item(ui, "Tour", "") {
        actions.push(TourAction::Enter(0));
    }
    if item(ui, "Glossary", "") {
        actions.push(ShellAction::OpenDialog(Dialog::Glossary));
    }
    if item(ui, "Shortcuts", "F1") {
        actions.push(ShellAction::OpenDialog(Dialog::Shortcuts));
    }
    if item(ui, "Statistics", "") {
        actions.push(ShellAction::OpenDialog(Dialog::Statistics));
    }
    if item(ui, "About", "") {
        actions.push(ShellAction::OpenDialog(Dialog::About));
    }
}
