//! A saved document is whole, whatever happens while it is saved.

use crate::common::arm::{ArmEdit, ArmSession};
use std::fs;
use std::io::Write as _;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use glam::Vec3;
use ik_arm::document::{Document, SkeletonRig};
use ik_arm::io;
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::session::{FileAction, Session};

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
    let mut document = Document::new(SkeletonRig::default());
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
    session.edit_arm(ArmEdit::SetHand(Vec3::new(1.0, 2.0, 3.0)));
    let document = session.document().clone();
    let error = io::save(session.document(), path).expect_err("it cannot be saved");
    let why = error.to_string();
    session.apply(FileAction::NotSaved { path: path.to_owned(), why });
    assert!(session.history().is_unsaved());
    assert_eq!(session.document(), &document);
    assert_eq!(session.files().file(), None);
    let message = session.shell().message().expect("it is said").to_owned();
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

#[test]
fn a_write_protected_file_is_not_replaced_and_the_message_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("kept.json");
    fs::write(&path, "kept").expect("written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).expect("write-protected");
    // Holds for root, too.
    let (_, message) = not_saved(&path);
    assert!(message.ends_with("kept.json could not be written: the file is write-protected"));
    let batch = io::FileBatch::beside(&path).expect("a folder");
    batch.add(std::ffi::OsStr::new("kept.json"), b"new").expect("added");
    let message = batch.finish().expect_err("it is write-protected").to_string();
    assert!(message.ends_with("the file is write-protected"), "{message}");
    assert_eq!(fs::read_to_string(&path).expect("there"), "kept");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing else is left");
}

/// Only root may give files away; another user cannot make the case.
#[test]
fn a_replaced_file_keeps_owner_and_mode() {
    use std::os::unix::fs::{MetadataExt as _, chown};
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("theirs.json");
    fs::write(&path, "old").expect("written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("mode");
    let is_theirs = chown(&path, Some(12_345), Some(12_346)).is_ok();
    let before = fs::metadata(&path).expect("there");
    let owner = |file: &fs::Metadata| (file.uid(), file.gid(), file.mode());
    io::write(&path, b"new").expect("written");
    let after = fs::metadata(&path).expect("there");
    assert_eq!(owner(&after), owner(&before), "given away: {is_theirs}");
    assert_eq!(fs::read(&path).expect("there"), b"new");

    let batch = io::FileBatch::beside(&path).expect("a folder");
    batch.add(std::ffi::OsStr::new("theirs.json"), b"newer").expect("added");
    batch.finish().expect("written");
    assert_eq!(owner(&fs::metadata(&path).expect("there")), owner(&before));
    assert_eq!(fs::read(&path).expect("there"), b"newer");
}

#[test]
fn a_link_to_a_file_that_is_not_there_yet_stays_a_link() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("inner")).expect("a folder");
    let (first, second) = (folder.path().join("first.json"), folder.path().join("second.json"));
    std::os::unix::fs::symlink("second.json", &first).expect("a link");
    std::os::unix::fs::symlink("inner/real.json", &second).expect("a link");
    io::write(&first, b"content").expect("written");
    for link in [&first, &second] {
        assert!(fs::symlink_metadata(link).expect("there").is_symlink(), "{}", link.display());
    }
    assert_eq!(fs::read(folder.path().join("inner/real.json")).expect("there"), b"content");

    let lost = folder.path().join("lost.json");
    std::os::unix::fs::symlink("no-folder/real.json", &lost).expect("a link");
    let message = io::write(&lost, b"content").expect_err("no folder").to_string();
    assert!(message.contains("there is no folder") && message.contains("no-folder"), "{message}");
}

#[test]
fn temporary_files_of_killed_programs_are_removed_by_the_next_write_and_those_of_others_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("document.json");
    let others = folder.path().join("others.json");
    let hidden = || {
        let names = fs::read_dir(folder.path()).expect("a folder").flatten();
        let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.filter(|name| name.starts_with(".ik-arm-")).collect::<Vec<_>>()
    };
    // Kills it until it has left something behind.
    let given_up = Instant::now() + Duration::from_secs(60);
    while hidden().is_empty() {
        assert!(Instant::now() < given_up, "it is never killed while it writes");
        let saver = Saver::start(&path);
        sleep(Duration::from_millis(60));
        drop(saver);
    }
    // A folder as a killed export of pictures leaves it, with a file that it was about to replace.
    let pictures = folder.path().join(".ik-arm-pictures");
    fs::create_dir_all(pictures.join("before")).expect("a folder");
    fs::write(pictures.join(".lock"), "").expect("written");
    fs::write(pictures.join("a.png"), "new").expect("written");
    fs::write(pictures.join("before/a.png"), "the only copy").expect("written");

    let batch = io::FileBatch::beside(&path).expect("a folder");
    let of_batch = hidden();
    assert_eq!(of_batch.len(), 1, "only the folder of the running batch is left: {of_batch:?}");
    assert_eq!(fs::read(folder.path().join("a.png")).expect("put back"), b"the only copy");
    let mut file = io::NewFile::at(&others).expect("a folder");
    io::write(&path, b"another").expect("written");
    assert_eq!(hidden().len(), 2, "files that are being written stay: {:?}", hidden());
    file.write_all(b"other").expect("written");
    file.finish().expect("written");
    batch.add(std::ffi::OsStr::new("b.png"), b"picture").expect("added");
    batch.finish().expect("written");
    assert_eq!(hidden(), [""; 0]);
    assert_eq!(fs::read(&others).expect("there"), b"other");
    assert_eq!(fs::read(folder.path().join("b.png")).expect("there"), b"picture");
}
