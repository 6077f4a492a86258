use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use winit::event_loop::EventLoopProxy;

use crate::app::background::filter;
use crate::app::event::{PathChoice, UserEvent, send};
use crate::session::PathDialog;

/// Opens the system's file dialog in place of `dialog`, starting at `path`.
pub(in crate::app) fn choose_path(
    dialog: PathDialog,
    path: &Path,
    proxy: EventLoopProxy<UserEvent>,
) {
    /// An answer before this time comes from a system without file dialogs, which answers like a
    /// user who cancels.
    const FASTEST_USER: Duration = Duration::from_millis(400);
    let (name, extensions) = filter(&dialog);
    let mut system = rfd::AsyncFileDialog::new().add_filter(name, &extensions);
    if let Some(name) = path.file_name() {
        system = system.set_file_name(name.to_string_lossy());
    }
    if let Some(folder) = path.parent().filter(|folder| folder.is_dir()) {
        system = system.set_directory(folder);
    }
    let start = Instant::now();
    let (open, save) = if dialog.reads_file() {
        (Some(system.pick_file()), None)
    } else {
        (None, Some(system.save_file()))
    };
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
