//! A saved document is whole, whatever happens while it is saved.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use glam::Vec3;
use ik_arm::document::{Document, RigKind};
use ik_arm::io;
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::session::{EditAction, FileAction, Session};

use crate::common::{Random, cases};

/// Names the file that a child process saves to.
const TO: &str = "IK_ARM_TEST_SAVES_TO";

/// Large enough that saving takes a while.
fn document(joints: usize) -> Document {
    let joint = |index: usize| Joint {
        rotation: Vec3::splat(index as f32 / 7.0),
        ..Joint::new(&format!("joint_{index}"), index.checked_sub(1).map(JointId::new), Vec3::Y)
    };
    let skeleton = Skeleton::from_joints((0..joints).map(joint).collect()).expect("a skeleton");
    let mut document = Document { rig: RigKind::Skeleton, ..Document::default() };
    *document.skeleton_mut() = skeleton;
    document
}

fn old_and_new() -> [Document; 2] {
    [document(300), document(1500)]
}

/// Helper process: other tests start it with a path, and kill it.
#[test]
#[ignore = "no test of its own: it saves for ever, if another test names a file"]
fn saves_one_document_after_the_other_for_ever() {
    let Some(path) = std::env::var_os(TO) else { return };
    let texts = old_and_new().map(|document| io::to_json(&document).expect("written"));
    for text in texts.iter().cycle() {
        io::write(Path::new(&path), text.as_bytes()).expect("saved");
    }
}

struct Saver(Child);

impl Saver {
    fn start(path: &Path) -> Self {
        let mut child = Command::new(std::env::current_exe().expect("this test"));
        child.args(["--ignored", "--exact", "saving::saves_one_document_after_the_other_for_ever"]);
        child.env(TO, path).stdout(Stdio::null()).stderr(Stdio::null());
        Self(child.spawn().expect("it starts"))
    }
}

/// Kills with a signal that cannot be caught.
impl Drop for Saver {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_file_is_the_old_or_the_new_document_whenever_the_program_is_killed_while_it_saves() {
    let kills = cases(200);
    let documents = old_and_new();
    let texts = documents.each_ref().map(|document| io::to_json(document).expect("written"));
    let folder = tempfile::tempdir().expect("a folder");
    let mut random = Random(0x5a7e);
    let (mut found, mut interrupted) = ([0; 2], 0);
    for kill in 0..kills {
        let folder = folder.path().join(kill.to_string());
        fs::create_dir(&folder).expect("a folder");
        let path = folder.join("document.json");
        io::save(&documents[0], &path).expect("saved");
        let before = fs::metadata(&path).expect("there").modified().expect("dated");
        let saver = Saver::start(&path);
        // It has begun when the file is no longer the first one.
        let given_up = Instant::now() + Duration::from_secs(20);
        while fs::metadata(&path).expect("there").modified().expect("dated") == before {
            assert!(Instant::now() < given_up, "it does not save");
            sleep(Duration::from_micros(200));
        }
        sleep(Duration::from_micros(random.below(20_000) as u64));
        drop(saver);

        let text = fs::read_to_string(&path).expect("there");
        let which = texts.iter().position(|whole| *whole == text);
        let which = which.unwrap_or_else(|| panic!("{} bytes are neither", text.len()));
        let opened = io::open(&path, &io::OpenOptions::default()).expect("it opens");
        assert!(opened.document == documents[which] && opened.warnings.is_empty());
        found[which] += 1;
        interrupted += usize::from(fs::read_dir(&folder).expect("a folder").count() > 1);
        fs::remove_dir_all(&folder).expect("removed");
    }
    println!("{found:?} of {kills} were old and new; {interrupted} were killed in the middle");
    assert!(found.iter().all(|count| *count > 0), "{found:?}: the moments were not random");
    assert!(interrupted > kills / 10, "only {interrupted} were killed while they wrote");
}

/// A session with changes, and what it says when it is told to save to `path`.
fn not_saved(path: &Path) -> (Session, String) {
    let mut session = Session::default();
    session.apply(EditAction::SetHand(Vec3::new(1.0, 2.0, 3.0)));
    let document = session.document().clone();
    let error = io::save(session.document(), path).expect_err("it cannot be saved");
    let why = error.to_string();
    session.apply(FileAction::NotSaved { path: path.to_owned(), why });
    assert!(session.is_unsaved());
    assert_eq!(session.document(), &document);
    assert_eq!(session.file(), None);
    let message = session.message().expect("it is said").to_owned();
    (session, message)
}

#[test]
#[cfg(target_os = "linux")]
fn on_a_full_disk_the_document_stays_open_and_unsaved() {
    let (_, message) = not_saved(Path::new("/dev/full"));
    assert!(message.starts_with("Not saved: /dev/full could not be written: No space left"));
}

#[test]
fn a_disk_that_fills_while_a_file_is_written_leaves_the_old_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("old.json");
    io::save(&Document::default(), &path).expect("saved");
    // A limit on the size of files fails a write in the middle, as a full disk does.
    let mut child = Command::new("sh");
    child.arg("-c").arg("trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"");
    child.arg(std::env::current_exe().expect("this test"));
    child.args(["--ignored", "--exact", "saving::saves_one_document_after_the_other_for_ever"]);
    let ended = child.env(TO, &path).output().expect("it runs");
    let said = String::from_utf8_lossy(&ended.stdout);
    assert!(said.contains("File too large"), "{ended:?}");
    assert_eq!(
        io::open(&path, &io::OpenOptions::default()).expect("whole").document,
        Document::default()
    );
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing else is left");
}

#[test]
fn in_a_read_only_folder_the_document_stays_open_and_unsaved() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).expect("read-only");
    let path = folder.path().join("x.json");
    // Root may write there, too; but nobody may among the kernel's own files.
    let path = match fs::write(&path, "") {
        Ok(()) => Path::new("/proc/self/x.json").to_owned(),
        Err(_) => path,
    };
    let (session, message) = not_saved(&path);
    assert!(message.starts_with(&format!("Not saved: {}", path.display())), "{message}");
    // It can still be saved elsewhere.
    let elsewhere = tempfile::tempdir().expect("a folder");
    io::save(session.document(), &elsewhere.path().join("x.json")).expect("saved");
}

#[test]
fn messages_tell_the_reason_of_the_system_without_its_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("missing.json");
    let options = io::OpenOptions::default();
    let read = io::open(&missing, &options).expect_err("it is missing");
    let said = read.to_string();
    assert!(said.ends_with("missing.json cannot be read: No such file or directory"), "{said}");
    let read = io::open(folder.path(), &options).expect_err("a folder");
    assert!(!read.to_string().contains("os error"), "{read}");
}
