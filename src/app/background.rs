//! Jobs in the background, and the events by which they report to the window when they end.

use std::future::poll_fn;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::pin::pin;
use std::sync::Arc;
use std::task::Poll;

use winit::event_loop::EventLoopProxy;

use super::event::{PathChoice, UserEvent, send};
use super::platform::{self, Task};
use crate::document::{Bake, Document, Posed, SkeletonRig, Skin, Theme};
use crate::export::{self, ExportError, ExportFormat, ExportOptions};
use crate::io::{self, FileFormat, OpenError, OpenOptions, Opened, Progress};
use crate::render::{self, Gpu, PictureRenderer};
use crate::rig::SkinSource;
use crate::scene::Scene;
use crate::session::{
    Action, BakeJob, Export, ExportJob, FileAction, InspectionJob, Overlays, PathDialog, ReachJob,
    ShellAction,
};

/// The result of a job; `None` if it panicked.
async fn caught<T>(job: impl Future<Output = T>) -> Option<T> {
    let mut job = pin!(job);
    poll_fn(|context| {
        let polled = catch_unwind(AssertUnwindSafe(|| job.as_mut().poll(context)));
        polled.map_or(Poll::Ready(None), |polled| polled.map(Some))
    })
    .await
}

/// Saves a picture of the viewport, drawn on a graphics device of its own.
pub(super) fn save_picture(
    picture: ViewportPicture,
    path: PathBuf,
    proxy: EventLoopProxy<UserEvent>,
) {
    platform::spawn(async move || {
        let picture = ViewportPicture { posed: picture.posed.into_known(), ..picture };
        let result = match draw(&picture, &path).await {
            Ok(()) => Ok(format!("Saved {}", path.display())),
            Err(error) => Err(format!("Not saved: {error}")),
        };
        send(&proxy, UserEvent::Report(result));
    });
}

async fn draw(picture: &ViewportPicture, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::headless().await?;
    let scene = Scene::new(&picture.posed, &picture.overlays, picture.theme);
    let (width, height) = picture.size;
    let mut renderer = PictureRenderer::new(&gpu, width, height, picture.scale);
    let image = renderer.draw(&scene).await?;
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
    platform::spawn(async move || {
        let go_on = async |done, total| job.progress.step(done, total).await.is_ok();
        // Sent even after a panic, because the dialog waits for this event.
        let result = match caught(settings.run(&document, go_on)).await {
            Some(baked) => baked.map(Box::new).map_err(|error| error.to_string()),
            None => Err("the program failed (this is a bug)".to_owned()),
        };
        send(&proxy, UserEvent::Baked(job, result));
    });
    started
}

/// Starts an inspection of the motion.
pub(super) fn inspect(job: InspectionJob, proxy: EventLoopProxy<UserEvent>) {
    platform::spawn(async move || {
        // After a panic, what is known of the motion stays unknown.
        match caught(job.run()).await {
            Some(ended) => send(&proxy, UserEvent::Inspected(Box::new(ended))),
            None => log::error!("the inspection of a motion panicked"),
        }
    });
}

/// Starts a search for a reach region.
pub(super) fn find_reach(job: ReachJob, proxy: EventLoopProxy<UserEvent>) {
    platform::spawn(async move || match caught(job.run()).await {
        Some(ended) => send(&proxy, UserEvent::FoundReach(Box::new(ended))),
        None => log::error!("the search for a reach region panicked"),
    });
}

/// Starts an export; the window shows its progress.
pub(super) fn export(
    export: Export,
    document: Document,
    picture: &ViewportPicture,
    proxy: EventLoopProxy<UserEvent>,
) -> (ExportJob, Task) {
    let progress = Arc::new(Progress::default());
    let job = ExportJob { path: export.path.clone(), progress: Arc::clone(&progress) };
    let options = ExportOptions {
        fps: Some(export.frame_rate),
        size: export.size,
        theme: picture.theme,
        time: Some(picture.posed.time()),
        ..ExportOptions::default()
    };
    let thread = platform::spawn(async move || {
        let written = export::export(&document, &export.path, &options, &progress);
        // Sent even after a panic, because the window allows no other export before this event.
        let result = match caught(written).await {
            Some(exported) => export_message(&export.path, exported),
            None => Err("Not exported: the program failed (this is a bug)".to_owned()),
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

/// Reads a file in the background, because the file may be large.
pub(super) fn open(path: PathBuf, options: OpenOptions, proxy: EventLoopProxy<UserEvent>) {
    platform::spawn(async move || {
        let read = io::open(&path, &options).map(|mut opened| {
            opened.warnings.extend(io::undrawn_textures(&opened.document));
            opened
        });
        let read = Box::new(read);
        send(&proxy, UserEvent::Opened { path, options, read });
    });
}

/// Reads the mesh of the skin of `rig` from a file in the background, because the file may be large.
pub(super) fn locate_skin(path: PathBuf, rig: &SkeletonRig, proxy: EventLoopProxy<UserEvent>) {
    let Some(Skin { source: SkinSource::Mesh(skin), .. }) = &rig.skin else { return };
    let (skin, skeleton) = (skin.clone(), rig.skeleton.clone());
    platform::spawn(async move || {
        let before = skin.file().cloned();
        let read = Box::new(io::relocated_skin(&path, &skin, &skeleton));
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

/// Name and extensions of the files that a dialog is about.
pub(super) fn filter(dialog: &PathDialog) -> (&'static str, Vec<&'static str>) {
    match dialog {
        PathDialog::SavePicture { .. } => ("PNG", vec!["png"]),
        PathDialog::Open { .. } => ("Scene", FileFormat::readable()),
        PathDialog::SaveAs { .. } => ("Scene", FileFormat::DOCUMENT.extensions.to_vec()),
        PathDialog::LocateSkin { .. } => ("Skin", FileFormat::with_skins()),
        PathDialog::Export(_) => ("Export", ExportFormat::extensions()),
    }
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
