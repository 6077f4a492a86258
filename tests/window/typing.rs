//! Fast typing with the real keyboard: several keys arrive in one frame.

use ik_arm::io::Example;
use std::path::Path;

use ik_arm::document::{AxisView, Camera, Document};
use ik_arm::io;

use crate::open;
use crate::screen::{Program, wait_for};

/// Saves the document by the keyboard alone, without a pause, and reads the file.
fn saved_to(program: &Program, path: &Path) -> Document {
    program.quickly(&["key", "ctrl+s", "type", "--delay", "0", &path.display().to_string()]);
    program.at_rest();
    program.key("Return");
    wait_for("the saved file", || path.exists().then_some(()));
    program.at_rest();
    io::open(path, &io::OpenOptions::default()).expect("a document").document
}

fn saved_again(program: &Program, path: &Path) -> Document {
    std::fs::remove_file(path).expect("it was there");
    program.key("ctrl+s");
    wait_for("the saved file", || path.exists().then_some(()));
    program.at_rest();
    io::open(path, &io::OpenOptions::default()).expect("a document").document
}

#[test]
#[ignore = "needs a display of its own"]
fn a_file_name_typed_after_a_click_in_the_viewport_reaches_the_dialog() {
    let (folder, places, program) = open();
    program.click(places.empty);
    // Each letter is also a shortcut of the view or the skeleton.
    let path = folder.path().join("start-157-fraks.json");
    let document = saved_to(&program, &path);
    assert_eq!(document.camera, Camera::default(), "no letter looks elsewhere");
    assert_eq!(document, Document::default());
}

#[test]
#[ignore = "needs a display of its own"]
fn a_clicked_joint_is_renamed_by_the_keyboard() {
    let (folder, places, program) = open();
    program.key("ctrl+alt+n");
    program.at_rest();
    program.click(places.head);
    program.at_rest();
    program.quickly(&["key", "F2", "type", "--delay", "0", "Start 5"]);
    program.at_rest();
    program.key("Return");
    let joints = |document: &Document| -> Vec<String> {
        let joints = document.skeleton().joints();
        joints.iter().map(|joint| joint.name.clone()).collect()
    };
    let document = saved_to(&program, &folder.path().join("named.json"));
    let human = Example::find("human").expect("an example").open().expect("it opens").document;
    let mut expected = joints(&human);
    let head = expected.iter().position(|name| name == "head").expect("the Human has a head");
    "Start 5".clone_into(&mut expected[head]);
    assert_eq!(joints(&document), expected, "no letter adds a joint");
    let rotations = |document: &Document| -> Vec<_> {
        document.skeleton().joints().iter().map(|joint| joint.rotation).collect()
    };
    assert_eq!(rotations(&document), rotations(&human), "or runs the solver");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_quick_ctrl_1_looks_from_the_back_each_time() {
    let (folder, places, program) = open();
    program.click(places.empty);
    let path = folder.path().join("view.json");
    saved_to(&program, &path);
    for time in 0..7 {
        program.quickly(&["key", "--delay", "0", "1"]);
        program.at_rest();
        program.quickly(&["key", "--delay", "0", "ctrl+1"]);
        program.at_rest();
        let camera = saved_again(&program, &path).camera;
        assert_eq!(camera.yaw, camera.along(AxisView::Back).yaw, "time {time}");
    }
}

#[test]
#[ignore = "needs a display of its own"]
fn nothing_behind_the_save_dialog_reacts() {
    let (folder, places, program) = open();
    let first = program.at_rest();
    program.drag(places.thumb, places.rail_end);
    program.click(places.empty);
    program.wait_for_change(&first);
    let path = folder.path().join("kept.json");
    let before = saved_to(&program, &path);
    assert_ne!(before.rig, Document::default().rig);

    program.drag(places.rail_end, places.thumb);
    program.click(places.empty);
    let dragged = program.at_rest();
    program.key("ctrl+q");
    program.wait_for_change(&dragged);
    program.quickly(&["type", "--delay", "0", "1573fk"]);
    program.quickly(&["key", "ctrl+z", "key", "ctrl+1", "key", "ctrl+o", "key", "F1"]);
    program.at_rest();
    program.key("Escape");
    program.at_rest();
    let after = saved_again(&program, &path);
    assert_eq!(after.camera, Camera::default());
    assert_ne!(after.rig, before.rig, "nothing was undone");
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "all is saved");
}

#[test]
#[ignore = "needs a display of its own"]
fn an_export_does_not_overwrite_a_file_by_enter_alone() {
    let (folder, places, program) = open();
    program.click(places.empty);
    let path = folder.path().join("precious.csv");
    std::fs::write(&path, "precious").expect("written");
    program.quickly(&["key", "ctrl+e", "type", "--delay", "0", &path.display().to_string()]);
    program.at_rest();
    for _ in 0..2 {
        program.key("Return");
        program.at_rest();
    }
    assert_eq!(std::fs::read_to_string(&path).expect("still there"), "precious");
    // Enter asks again; Tab moves to the button that replaces the file.
    program.key("Return");
    program.at_rest();
    program.key("Tab");
    program.key("Return");
    wait_for("the exported table", || {
        let text = std::fs::read_to_string(&path).ok()?;
        (text != "precious").then_some(())
    });
}
