//! Jobs on threads of their own, and the events by which they report to the window when they end.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use winit::event_loop::EventLoopProxy;

use crate::document::{Bake, Baked, Document, Posed, SkeletonRig, Skin, Theme};
use crate::export::{self, ExportError, ExportFormat, ExportOptions};
use crate::io::{self, FileFormat, OpenError, OpenOptions, Opened, Progress};
use crate::render::{self, Gpu, PictureRenderer};
use crate::rig::{MeshSkin, SkinFile, SkinFileError, SkinSource};
use crate::scene::Scene;
use crate::session::{
    Action, BakeJob, Export, ExportJob, FileAction, InspectAction, InspectionJob, Overlays,
    PathDialog, ShellAction,
};

/// Saves a picture of the viewport, drawn on a graphics device of its own.
pub(super) fn save_picture(
    picture: ViewportPicture,
    path: PathBuf,
    proxy: EventLoopProxy<UserEvent>,
) {
    thread::spawn(move || {
        let picture = ViewportPicture { posed: picture.posed.into_known(), ..picture };
        let result = match draw(&picture, &path) {
            Ok(()) => Ok(format!("Saved {}", path.display())),
            Err(error) => Err(format!("Not saved: {error}")),
        };
        send(&proxy, UserEvent::Report(result));
    });
}

fn draw(picture: &ViewportPicture, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::headless()?;
    let scene = Scene::new(&picture.posed, &picture.overlays, picture.theme);
    let (width, height) = picture.size;
    let image = PictureRenderer::new(&gpu, width, height, picture.scale).draw(&scene)?;
    Ok(render::save(&image, path)?)
}

/// Starts a bake; its dialog shows the progress.
pub(super) fn bake(
    settings: Bake,
    document: Document,
    proxy: EventLoopProxy<UserEvent>,
) -> BakeJob {
    let job = BakeJob { progress: Arc::new(Progress::default()) };
    let started = job.clone();
    thread::spawn(move || {
        let go_on = |done, total| job.progress.step(done, total).is_ok();
        let bake = || settings.run(&document, go_on);
        // Sent even after a panic, because the dialog waits for this event.
        let result = match std::panic::catch_unwind(std::panic::AssertUnwindSafe(bake)) {
            Ok(baked) => baked.map(Box::new).map_err(|error| error.to_string()),
            Err(_) => Err("the program failed (this is a bug)".to_owned()),
        };
        send(&proxy, UserEvent::Baked(job, result));
    });
    started
}

/// Starts an inspection of the motion.
pub(super) fn inspect(job: InspectionJob, proxy: EventLoopProxy<UserEvent>) {
    thread::spawn(move || {
        // After a panic, what is known of the motion stays unknown.
        match std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| job.run())) {
            Ok(ended) => send(&proxy, UserEvent::Inspected(Box::new(ended))),
            Err(_) => log::error!("the inspection of a motion panicked"),
        }
    });
}

/// Starts an export; the window shows its progress.
pub(super) fn export(
    export: Export,
    document: Document,
    picture: &ViewportPicture,
    proxy: EventLoopProxy<UserEvent>,
) -> (ExportJob, JoinHandle<()>) {
    let progress = Arc::new(Progress::default());
    let job = ExportJob { path: export.path.clone(), progress: Arc::clone(&progress) };
    let options = ExportOptions {
        fps: Some(export.frame_rate),
        size: export.size,
        theme: picture.theme,
        time: Some(picture.posed.time()),
        ..ExportOptions::default()
    };
    let thread = thread::spawn(move || {
        let write = || export::export(&document, &export.path, &options, &progress);
        // Sent even after a panic, because the window allows no other export before this event.
        let result = match std::panic::catch_unwind(std::panic::AssertUnwindSafe(write)) {
            Ok(exported) => export_message(&export.path, exported),
            Err(_) => Err("Not exported: the program failed (this is a bug)".to_owned()),
        };
        send(&proxy, UserEvent::Exported(result));
    });
    (job, thread)
}

fn export_message(
    path: &Path,
    exported: Result<Vec<String>, ExportError>,
) -> Result<String, String> {
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

/// Reads a file on a thread of its own, because the file may be large.
pub(super) fn open(path: PathBuf, options: OpenOptions, proxy: EventLoopProxy<UserEvent>) {
    thread::spawn(move || {
        let read = io::open(&path, &options).map(|mut opened| {
            opened.warnings.extend(io::undrawn_textures(&opened.document));
            opened
        });
        let read = Box::new(read);
        send(&proxy, UserEvent::Opened { path, options, read });
    });
}

/// Reads the mesh of the skin of `rig` from a file on a thread of its own, because the file may be
/// large.
pub(super) fn locate_skin(path: PathBuf, rig: &SkeletonRig, proxy: EventLoopProxy<UserEvent>) {
    let Some(Skin { source: SkinSource::Mesh(skin), .. }) = &rig.skin else { return };
    let (skin, skeleton) = (skin.clone(), rig.skeleton.clone());
    thread::spawn(move || {
        let before = skin.file().cloned();
        let name = before.as_ref().map_or("", |file| &file.skeleton);
        let read = Box::new(io::relocated_skin(&path, name, skin.joints(), &skeleton));
        send(&proxy, UserEvent::SkinLocated { path, before, read });
    });
}

/// The action for a file that was read, which shows the file's document or the error, and what to
/// say once the document is open.
pub(super) fn opened(
    path: PathBuf,
    options: OpenOptions,
    read: Result<Opened, OpenError>,
) -> (Option<String>, FileAction) {
    let opened = match read {
        Ok(opened) => opened,
        Err(error) => return (None, FileAction::NotOpened { path, why: error.to_string() }),
    };
    let remark = match &opened.warnings[..] {
        [] => format!("Opened {}", path.display()),
        [one] => format!("Opened {}; {one}", path.display()),
        [first, rest @ ..] => {
            format!("Opened {}; {first}, and {} more warnings", path.display(), rest.len())
        }
    };
    (Some(remark), FileAction::opened(path, options, opened))
}

/// Opens the system's file dialog in place of `dialog`, starting at `path`.
pub(super) fn choose_path(dialog: PathDialog, path: &Path, proxy: EventLoopProxy<UserEvent>) {
    /// An answer before this time comes from a system without file dialogs, which answers like a
    /// user who cancels.
    const FASTEST_USER: Duration = Duration::from_millis(400);
    let (name, extensions) = match &dialog {
        PathDialog::SavePicture { .. } => ("PNG", vec!["png"]),
        PathDialog::Open { .. } => ("Scene", FileFormat::readable()),
        PathDialog::SaveAs { .. } => ("Scene", FileFormat::DOCUMENT.extensions.to_vec()),
        PathDialog::LocateSkin { .. } => ("Skin", FileFormat::with_skins()),
        PathDialog::Export(_) => ("Export", ExportFormat::extensions()),
    };
    let mut system = rfd::AsyncFileDialog::new().add_filter(name, &extensions);
    if let Some(name) = path.file_name() {
        system = system.set_file_name(name.to_string_lossy());
    }
    if let Some(folder) = path.parent().filter(|folder| folder.is_dir()) {
        system = system.set_directory(folder);
    }
    let start = Instant::now();
    let is_open = matches!(dialog, PathDialog::Open { .. } | PathDialog::LocateSkin { .. });
    let (open, save) =
        if is_open { (Some(system.pick_file()), None) } else { (None, Some(system.save_file())) };
    thread::spawn(move || {
        let file = match (open, save) {
            (Some(open), _) => pollster::block_on(open),
            (None, Some(save)) => pollster::block_on(save),
            (None, None) => None,
        };
        let choice = match file {
            Some(file) => PathChoice::Path(file.path().to_owned()),
            None if start.elapsed() < FASTEST_USER => PathChoice::NoDialog,
            None => PathChoice::Cancelled,
        };
        send(&proxy, UserEvent::Chosen(dialog, choice));
    });
}

/// Action for the answer of the system's file dialog. If the system has no file dialog, the action
/// opens the program's own dialog.
pub(super) fn path_action(dialog: PathDialog, choice: PathChoice) -> Action {
    match (choice, dialog) {
        (PathChoice::Path(path), PathDialog::Open { .. }) => {
            FileAction::Open { path, options: OpenOptions::default() }.into()
        }
        (PathChoice::Path(path), PathDialog::SaveAs { .. }) => FileAction::SaveAs(path).into(),
        (PathChoice::Path(path), PathDialog::LocateSkin { .. }) => {
            FileAction::LocateSkin(path).into()
        }
        (PathChoice::Path(path), PathDialog::SavePicture { .. }) => {
            FileAction::SavePicture(path.display().to_string()).into()
        }
        (PathChoice::Path(path), PathDialog::Export(export)) => {
            let dialog = PathDialog::Export(Export { path, ..export });
            ShellAction::OpenDialog(dialog.into()).into()
        }
        (PathChoice::Cancelled, _) => FileAction::ChoseNothing.into(),
        (PathChoice::NoDialog, dialog) => FileAction::NoSystemDialog(dialog).into(),
    }
}

/// Events that do not come from the window.
#[derive(Debug)]
pub enum UserEvent {
    /// Request of a screen reader.
    Accesskit(egui_winit::accesskit_winit::Event),
    /// Message or error of a finished background job.
    Report(Result<String, String>),
    /// Result or error of a finished bake.
    Baked(BakeJob, Result<Box<Baked>, String>),
    /// End of an inspection of the motion.
    Inspected(Box<InspectAction>),
    /// Message or error of a finished export.
    Exported(Result<String, String>),
    /// The backup of unsaved changes was written.
    BackedUp,
    /// The graphics device failed.
    GraphicsFailed,
    /// Answer of the system's file dialog.
    Chosen(PathDialog, PathChoice),
    /// A file was read.
    Opened { path: PathBuf, options: OpenOptions, read: Box<Result<Opened, OpenError>> },
    /// The file of a skin was read.
    SkinLocated {
        path: PathBuf,
        before: Option<SkinFile>,
        read: Box<Result<MeshSkin, SkinFileError>>,
    },
}

/// Answer to a request for a path.
#[derive(Debug)]
pub enum PathChoice {
    Path(PathBuf),
    Cancelled,
    /// The system has no file dialog.
    NoDialog,
}

impl From<egui_winit::accesskit_winit::Event> for UserEvent {
    fn from(event: egui_winit::accesskit_winit::Event) -> Self {
        Self::Accesskit(event)
    }
}

/// Sends an event to the window, which may have been closed.
pub fn send(proxy: &EventLoopProxy<UserEvent>, event: UserEvent) {
    if proxy.send_event(event).is_err() {
        log::info!("the window was closed before a background job ended");
    }
}

/// Everything that a picture of the viewport shows.
pub struct ViewportPicture {
    pub posed: Posed,
    pub overlays: Overlays,
    pub theme: Theme,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Pixels per point.
    pub scale: f32,
}
