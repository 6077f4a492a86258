//! What runs beside the window, on threads of its own, and reports when it is done.

use std::path::{Path, PathBuf};
use std::thread;

use winit::event_loop::EventLoopProxy;

use super::UserEvent;
use crate::document::{Document, Theme};
use crate::render::{self, Gpu, Picture};
use crate::scene::Scene;
use crate::session::{Action, Dialog};

/// What a picture shows and how large it is, in pixels and pixels a point.
pub(super) struct Shot {
    pub document: Document,
    pub theme: Theme,
    pub size: (u32, u32),
    pub scale: f32,
}

/// Draws with a device of its own, so that the window goes on.
pub(super) fn save_picture(shot: Shot, path: PathBuf, proxy: EventLoopProxy<UserEvent>) {
    thread::spawn(move || {
        let message = match draw(&shot, &path) {
            Ok(()) => format!("Saved {}", path.display()),
            Err(error) => format!("Not saved: {error}"),
        };
        report(&proxy, UserEvent::Report(message));
    });
}

fn draw(shot: &Shot, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::headless()?;
    let scene = Scene::new(&shot.document, &shot.document.arm.pose(), shot.theme);
    let (width, height) = shot.size;
    let image = Picture::new(&gpu, width, height, shot.scale).draw(&scene)?;
    Ok(render::save(&image, path)?)
}

/// Opens the system's own dialog.
pub(super) fn choose_picture_path(path: &Path, proxy: EventLoopProxy<UserEvent>) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut dialog = rfd::AsyncFileDialog::new().add_filter("PNG", &["png"]).set_file_name(name);
    if let Some(folder) = path.parent().filter(|folder| folder.is_dir()) {
        dialog = dialog.set_directory(folder);
    }
    let chosen = dialog.save_file();
    thread::spawn(move || {
        let path = pollster::block_on(chosen).map(|file| file.path().to_owned());
        report(&proxy, UserEvent::PicturePath(path));
    });
}

/// A dialog that was cancelled and a system that has none answer alike.
pub(super) fn chosen(path: Option<PathBuf>) -> Action {
    match path {
        Some(path) => Action::OpenDialog(Dialog::SavePicture { path: path.display().to_string() }),
        None => Action::Report("No file was chosen; a path can be typed instead".to_owned()),
    }
}

fn report(proxy: &EventLoopProxy<UserEvent>, event: UserEvent) {
    if proxy.send_event(event).is_err() {
        log::info!("the window closed before a job was done");
    }
}
