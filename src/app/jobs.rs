//! What runs beside the window, on threads of its own, and reports when it is done.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use winit::event_loop::EventLoopProxy;

use super::UserEvent;
use crate::document::{Document, Theme};
use crate::export::{self, ExportError, Format, Options};
use crate::io::{self, OpenError, Opened, Progress};
use crate::render::{self, Gpu, Picture};
use crate::scene::Scene;
use crate::session::{Action, Actions, Dialog, Export, FileAction, Job, Overlays, ShellAction};

/// What a picture shows and how large it is, in pixels and pixels a point.
pub(super) struct Shot {
    pub document: Document,
    pub overlays: Overlays,
    pub theme: Theme,
    pub size: (u32, u32),
    pub scale: f32,
}

/// Draws with a device of its own, so that the window goes on.
pub(super) fn save_picture(shot: Shot, path: PathBuf, proxy: EventLoopProxy<UserEvent>) {
    thread::spawn(move || {
        let how = match draw(&shot, &path) {
            Ok(()) => Ok(format!("Saved {}", path.display())),
            Err(error) => Err(format!("Not saved: {error}")),
        };
        report(&proxy, UserEvent::Report(how));
    });
}

fn draw(shot: &Shot, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::headless()?;
    let scene = Scene::new(&shot.document, &shot.overlays, shot.theme);
    let (width, height) = shot.size;
    let image = Picture::new(&gpu, width, height, shot.scale).draw(&scene)?;
    Ok(render::save(&image, path)?)
}

/// Exports beside the window, which shows how far it is.
pub(super) fn export(
    export: Export,
    document: Document,
    shot: &Shot,
    proxy: EventLoopProxy<UserEvent>,
) -> (Job, JoinHandle<()>) {
    let progress = Arc::new(Progress::default());
    let job = Job { path: export.path.clone(), progress: Arc::clone(&progress) };
    let options = Options {
        fps: Some(export.frame_rate),
        size: export.size,
        theme: shot.theme,
        time: Some(shot.overlays.time),
        ..Options::default()
    };
    let thread = thread::spawn(move || {
        let write = || export::export(&document, &export.path, &options, &progress);
        // The window is told, whatever happens: it waits for that before it exports again.
        let how = match std::panic::catch_unwind(std::panic::AssertUnwindSafe(write)) {
            Ok(exported) => say_exported(&export.path, exported),
            Err(_) => Err("Not exported: the export failed by a fault of the program".to_owned()),
        };
        report(&proxy, UserEvent::Exported(how));
    });
    (job, thread)
}

fn say_exported(path: &Path, exported: Result<Vec<String>, ExportError>) -> Result<String, String> {
    match exported {
        Ok(notes) => Ok(match &notes[..] {
            [] => format!("Exported {}", path.display()),
            [note] => format!("Exported {}; {note}", path.display()),
            [first, rest @ ..] => {
                format!("Exported {}; {first}, and {} more notes", path.display(), rest.len())
            }
        }),
        Err(ExportError::Cancelled(_)) => Ok("Export cancelled; no file was left".to_owned()),
        Err(error) => Err(format!("Not exported: {error}")),
    }
}

/// Reads a file: a large one takes a while.
pub(super) fn open(path: PathBuf, skeleton: Option<String>, proxy: EventLoopProxy<UserEvent>) {
    thread::spawn(move || {
        let read = Box::new(io::open(&path, skeleton.as_deref()));
        report(&proxy, UserEvent::Opened { path, chosen: skeleton.is_some(), read });
    });
}

/// What becomes of a file that was read: one that is no document leaves the open one as it is; one
/// with several skeletons asks which.
pub(super) fn opened(path: PathBuf, chosen: bool, read: Result<Opened, OpenError>) -> Actions {
    let mut actions = Actions::new();
    let Opened { document, warnings, skeletons, .. } = match read {
        Ok(opened) => opened,
        Err(error) => {
            actions.push(FileAction::NotOpened { path, why: error.to_string() });
            return actions;
        }
    };
    let said = match &warnings[..] {
        [] => format!("Opened {}", path.display()),
        [one] => format!("Opened {}; {one}", path.display()),
        [first, rest @ ..] => {
            format!("Opened {}; {first}, and {} more remarks", path.display(), rest.len())
        }
    };
    // A scene of another program is opened, not saved over.
    let file = skeletons.is_empty().then(|| path.clone());
    actions.push(FileAction::Opened { document: Box::new(document), file });
    actions.push(ShellAction::Report(said));
    if skeletons.len() > 1 && !chosen {
        actions.push(ShellAction::OpenDialog(Dialog::ChooseSkeleton { path, names: skeletons }));
    }
    actions
}

/// What became of a question for a path.
#[derive(Debug)]
pub(super) enum Choice {
    Path(PathBuf),
    Cancelled,
    /// The system has no dialog of its own.
    NoDialog,
}

/// Opens the system's own dialog for the path that one of ours asks for, at a path to begin with.
pub(super) fn choose_path(dialog: Dialog, path: &Path, proxy: EventLoopProxy<UserEvent>) {
    /// Nobody cancels as fast as a system answers that has no dialog; both answer alike.
    const FASTEST_HAND: Duration = Duration::from_millis(400);
    let exported = Format::ENDINGS.map(|(ending, _)| ending);
    let (name, extensions): (_, &[&str]) = match &dialog {
        Dialog::SavePicture { .. } => ("PNG", &["png"]),
        Dialog::Open { .. } => ("Scene", &["json", "js3d", "bvh", "glb", "gltf"]),
        Dialog::SaveAs { .. } => ("Scene", &["json"]),
        Dialog::Export(_) => ("Export", &exported),
        _ => return,
    };
    let mut system = rfd::AsyncFileDialog::new().add_filter(name, extensions);
    if let Some(name) = path.file_name() {
        system = system.set_file_name(name.to_string_lossy());
    }
    if let Some(folder) = path.parent().filter(|folder| folder.is_dir()) {
        system = system.set_directory(folder);
    }
    let asked = Instant::now();
    let is_open = matches!(dialog, Dialog::Open { .. });
    let (open, save) = match is_open {
        true => (Some(system.pick_file()), None),
        false => (None, Some(system.save_file())),
    };
    thread::spawn(move || {
        let file = match (open, save) {
            (Some(open), _) => pollster::block_on(open),
            (None, Some(save)) => pollster::block_on(save),
            (None, None) => None,
        };
        let choice = match file {
            Some(file) => Choice::Path(file.path().to_owned()),
            None if asked.elapsed() < FASTEST_HAND => Choice::NoDialog,
            None => Choice::Cancelled,
        };
        report(&proxy, UserEvent::Chosen(dialog, choice));
    });
}

/// A path is taken at once; where the system has no dialog, ours asks for it.
pub(super) fn chosen(dialog: Dialog, choice: Choice) -> Option<Action> {
    match (choice, dialog) {
        (Choice::Path(path), Dialog::Open { .. }) => {
            Some(FileAction::Open { path, skeleton: None }.into())
        }
        (Choice::Path(path), Dialog::SaveAs { .. }) => Some(FileAction::SaveAs(path).into()),
        (Choice::Path(path), Dialog::SavePicture { .. }) => {
            Some(FileAction::SavePicture(path.display().to_string()).into())
        }
        (Choice::Path(path), Dialog::Export(export)) => {
            Some(ShellAction::OpenDialog(Dialog::Export(Export { path, ..export })).into())
        }
        (Choice::Path(_), _) => None,
        (Choice::Cancelled, _) => Some(FileAction::ChoseNothing.into()),
        (Choice::NoDialog, dialog) => Some(FileAction::NoSystemDialog(dialog).into()),
    }
}

fn report(proxy: &EventLoopProxy<UserEvent>, event: UserEvent) {
    if proxy.send_event(event).is_err() {
        log::info!("the window closed before a job was done");
    }
}
