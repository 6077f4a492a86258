//! The menu bar.

use egui::{Align, Button, Label, Layout, MenuBar, RichText, Ui};

use super::{commands, labels, panels, widgets};
use crate::document::{Channel, Overlay, Theme};
use crate::io::{Example, ExampleGroup, OpenOptions};
use crate::session::{
    Action, Actions, Dialog, FileAction, FrameBudget, JointEdit, KeysEdit, Navigation, Session,
    ShellAction, TargetEdit, TourAction, TransactionAction, ViewAction,
};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file(ui, session, actions));
        ui.menu_button("Edit", |ui| edit(ui, session, actions));
        ui.menu_button("View", |ui| view(ui, session, actions));
        ui.menu_button("Examples", |ui| examples(ui, actions));
        ui.menu_button("Help", |ui| help(ui, actions));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let rig = match session.rig().sole_limb().map(|target| target.influence) {
                Some(1.0) => "Limb · IK (hand → joint angles)".to_owned(),
                Some(0.0) => "Limb · FK (joint angles → hand)".to_owned(),
                Some(influence) => format!("Limb · {:.0} % IK, rest FK", influence * 100.0),
                None => "Figure".to_owned(),
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
    let file = session.files().name().unwrap_or_else(|| "untitled".to_owned());
    let (name, tooltip) = match (session.files().file(), session.files().contents()) {
        _ if session.tour().is_some() => {
            ("Tour".to_owned(), "Your own document is kept".to_owned())
        }
        (Some(path), _) => (file, path.display().to_string()),
        (None, Some(from)) => (file, format!("{NO_FILE}; it comes from {}", from.path.display())),
        (None, None) => (file, NO_FILE.to_owned()),
    };
    let is_unsaved = session.tour().is_none() && session.history().is_unsaved();
    let (mark, told) = if is_unsaved { ("*", "\nIt has unsaved changes") } else { ("", "") };
    let label = Label::new(format!("{name}{mark}")).truncate().selectable(false);
    ui.add(label).on_hover_text(format!("{tooltip}{told}"));
}

/// Shows an item with its shortcut, which may be empty, and pushes the action when it is pressed.
fn item<A: Into<Action>>(
    ui: &mut Ui,
    name: &str,
    keys: &str,
    action: impl FnOnce() -> A,
    actions: &mut Actions,
) {
    if widgets::menu_item(ui, name, keys, "", None) {
        actions.push(action());
    }
}

fn file(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    ui.menu_button("New", |ui| {
        item(ui, "Arm", "Ctrl+N", || FileAction::New, actions);
        item(ui, "Figure", "Ctrl+Alt+N", || FileAction::NewFigure, actions);
        item(ui, "Empty", "Ctrl+Shift+N", || FileAction::NewEmpty, actions);
        item(ui, "Example…", "", commands::show_examples, actions);
    });
    item(ui, "Open…", "Ctrl+O", commands::open, actions);
    ui.add_enabled_ui(!session.files().recent().is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| recent(ui, session, actions));
    });
    contents(ui, session, actions);
    ui.separator();
    item(ui, "Save", "Ctrl+S", || FileAction::Save, actions);
    item(ui, "Save as…", "Ctrl+Shift+S", || commands::save_as(session), actions);
    ui.separator();
    item(
        ui,
        "Export…",
        "Ctrl+E",
        || ShellAction::OpenDialog(session.files().export_dialog(session.document()).into()),
        actions,
    );
    item(ui, "Save picture…", "Ctrl+P", || commands::save_picture(session), actions);
    ui.separator();
    item(ui, "Quit", "Ctrl+Q", || FileAction::Quit, actions);
}

/// Shows the item that opens another skeleton or animation of the file.
fn contents(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let several = session.files().contents().filter(|contents| contents.has_choice());
    let none = "The file has no other skeleton or animation";
    let why_not = several.is_none().then_some(none);
    let is_pressed = widgets::menu_item(ui, "Skeletons and animations…", "", "", why_not);
    if let Some(contents) = several.filter(|_| is_pressed) {
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
    let (undo, redo) = (session.history().undo_label(), session.history().redo_label());
    step(ui, "Undo", undo, "Ctrl+Z", TransactionAction::Undo, actions);
    step(ui, "Redo", redo, "Ctrl+Shift+Z", TransactionAction::Redo, actions);
    ui.separator();
    ui.menu_button("Key", |ui| key(ui, session, actions));
    bake(ui, session, actions);
    let too_few = "The figure has too few joints for two arms and two legs";
    let why_not = (!panels::may_be_person(session)).then_some(too_few);
    if widgets::menu_item(ui, "Add targets", "", panels::ADD_TARGETS, why_not) {
        actions.push(TargetEdit::AddHumanoidTargets);
    }
    let tooltip = "Turn a figure that stands along z by −90° about x";
    if widgets::menu_item(ui, "Turn to y up", "", tooltip, None) {
        actions.push(JointEdit::TurnYUp);
    }
    ui.separator();
    let why_no_copy = session.limb().is_none().then_some("There is no limb to copy");
    if widgets::menu_item(ui, "Copy pose as JSON line", "Ctrl+C", "", why_no_copy) {
        actions.push(ShellAction::CopyPose);
    }
    let tooltip =
        "Copy a link that carries this document: the page in a browser and ik-arm open it";
    if widgets::menu_item(ui, "Copy link", "", tooltip, None) {
        actions.push(FileAction::CopyLink);
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
    let is_posed = !document.rig.targets.is_empty() || document.follows_path();
    let why_not = (!is_posed).then_some("Add a target or a path: nothing else poses the joints");
    let tooltip = "Replace targets and path by keys";
    if widgets::menu_item(ui, "Bake to keys…", "", tooltip, why_not) {
        actions.push(ShellAction::OpenDialog(Dialog::bake(session.document())));
    }
}

/// Shows the menu of channels to key; the channels of overlays are in a submenu.
fn key(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    item(ui, "Selected", "K", || KeysEdit::Key(KeysEdit::channels_to_key(session)), actions);
    item(ui, "All", "Shift+K", || KeysEdit::Key(KeysEdit::all_channels(session.shown())), actions);
    ui.separator();
    let one = |ui: &mut Ui, channel: Channel, actions: &mut Actions| {
        if ui.button(labels::channel(session, channel)).clicked() {
            actions.push(KeysEdit::Key(vec![channel]));
        }
    };
    one(ui, Channel::Translation, actions);
    let joints: Vec<_> = match session.rig().sole_limb() {
        Some(_) => session.skeleton().ids().collect(),
        None => session.selection().joints().to_vec(),
    };
    for joint in joints {
        let there = Channel::of_joint(joint).filter(|it| it.value(session.shown()).is_some());
        there.for_each(|channel| one(ui, channel, actions));
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
    action: TransactionAction,
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
        let glide = || ViewAction::GlideTo(session.settled_camera().along(axis_view));
        item(ui, name, keys, glide, actions);
    }
    ui.separator();
    item(ui, "Toggle orthographic", "5", || commands::toggle_projection(session), actions);
    item(ui, "Frame selection", "F", || commands::frame_selection(session), actions);
    item(ui, "Frame all", "Home", || commands::frame_all(session), actions);
    let follows = session.view().follows_selection();
    let tooltip =
        "Move the camera with the selection, or with the whole rig, while the time changes";
    let followed = widgets::check_box(ui, "Follow selection", tooltip, follows, None);
    actions.extend(followed.map(ViewAction::FollowSelection));
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
    if session.limb().is_some() {
        overlays.push((Overlay::SingularityGlobe, "Singularity globe"));
        overlays.push((Overlay::TwistReferences, "Twist references"));
    }
    for (overlay, name) in overlays {
        widgets::overlay_check_box(ui, session, overlay, name, "", None, actions);
    }
    let tooltip = "Show up to a million arms, each with its own target";
    let why_no_crowd = session.crowd_bones().err();
    let crowd = widgets::check_box(ui, "Crowd", tooltip, session.crowd().is_some(), why_no_crowd);
    actions.extend(crowd.map(ViewAction::ShowCrowd));
    let why_not = (!panels::has_room(ui)).then_some("Make the window wider: it has no room");
    let explains = session.preferences().explain;
    let explain = widgets::check_box(ui, "Explain panel", "", explains, why_not);
    actions.extend(explain.map(ViewAction::ShowExplain));
    let timeline = widgets::check_box(
        ui,
        "Timeline",
        "",
        session.preferences().shows_timeline(session.document()),
        None,
    );
    actions.extend(timeline.map(ViewAction::ShowTimeline));
    let tooltip = "Show keys as curves instead of a dope sheet";
    let curves = session.preferences().curves;
    let graph_editor = widgets::check_box(ui, "Graph editor", tooltip, curves, None);
    actions.extend(graph_editor.map(ViewAction::ShowGraphEditor));
}

fn examples(ui: &mut Ui, actions: &mut Actions) {
    item(ui, "Pictures of all…", "", commands::show_examples, actions);
    ui.separator();
    examples_of(ExampleGroup::Basics, ui, actions);
    ui.separator();
    for group in &ExampleGroup::ALL[1..] {
        ui.menu_button(group.title(), |ui| examples_of(*group, ui, actions));
    }
}

fn examples_of(group: ExampleGroup, ui: &mut Ui, actions: &mut Actions) {
    for example in Example::of(group) {
        if ui.button(example.title).on_hover_text(example.sentence).clicked() {
            actions.push(FileAction::OpenExample(example));
        }
    }
}

fn help(ui: &mut Ui, actions: &mut Actions) {
    item(ui, "Tour", "", || TourAction::Enter(0), actions);
    item(ui, "Glossary", "", || ShellAction::OpenDialog(Dialog::Glossary), actions);
    item(ui, "Shortcuts", "F1", || ShellAction::OpenDialog(Dialog::Shortcuts), actions);
    item(ui, "Statistics", "", || ShellAction::OpenDialog(Dialog::Statistics), actions);
    item(ui, "About", "", || ShellAction::OpenDialog(Dialog::About), actions);
}
