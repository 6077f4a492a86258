//! Files that the user gives to the page: by the browser's file dialog, or dropped on the page.

use std::path::{Path, PathBuf};

use js_sys::Uint8Array;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{DragEvent, Event, FileList, HtmlInputElement};
use winit::event_loop::EventLoopProxy;

use super::page::{document, on_each};
use crate::app::background;
use crate::app::event::{PathChoice, UserEvent, send};
use crate::io::{self, FileFormat, OpenOptions};
use crate::session::PathDialog;

/// Opens the browser's file dialog in place of `dialog`; for a file that is written, takes the name
/// that it has already, because the browser asks for the place itself.
pub fn choose_path(dialog: PathDialog, path: &Path, proxy: EventLoopProxy<UserEvent>) {
    if !dialog.reads_file() {
        let name = match &dialog {
            PathDialog::SaveAs { .. } => "untitled.json",
            _ => "arm.png",
        };
        let path = path.file_name().map_or_else(|| PathBuf::from(name), |_| path.to_owned());
        send(&proxy, UserEvent::Chosen(dialog, PathChoice::Path(path)));
        return;
    }
    let (_, extensions) = background::filter(&dialog);
    let accept: Vec<String> = extensions.iter().map(|extension| format!(".{extension}")).collect();
    if let Err(refused) = pick(&accept.join(","), move |files| {
        let (dialog, proxy) = (dialog.clone(), proxy.clone());
        spawn_local(async move {
            let choice = match keep_all(files).await {
                Some(first) => PathChoice::Path(first),
                None => PathChoice::Cancelled,
            };
            send(&proxy, UserEvent::Chosen(dialog, choice));
        });
    }) {
        log::error!("the browser opens no file dialog: {refused:?}");
    }
}

/// Opens the browser's file dialog, and calls `chosen` with the files.
fn pick(accept: &str, chosen: impl Fn(Option<FileList>) + Clone + 'static) -> Result<(), JsValue> {
    let document = document().ok_or("there is no page")?;
    let input: HtmlInputElement = document.create_element("input")?.unchecked_into();
    input.set_type("file");
    input.set_multiple(true);
    input.set_accept(accept);
    input.set_hidden(true);
    document.body().ok_or("the page is empty")?.append_child(&input)?;
    for event in ["change", "cancel"] {
        let (of_input, chosen) = (input.clone(), chosen.clone());
        on_each(Some(&input), event, move |_: Event| {
            chosen(of_input.files());
            of_input.remove();
        });
    }
    input.click();
    Ok(())
}

/// Reads files and keeps them for the page. Returns the name of the first that can be opened, or
/// else of the first.
async fn keep_all(files: Option<FileList>) -> Option<PathBuf> {
    let files = files?;
    let mut names = Vec::new();
    for index in 0..files.length() {
        let Some(file) = files.get(index) else { continue };
        let name = PathBuf::from(file.name());
        match JsFuture::from(file.array_buffer()).await {
            Ok(bytes) => io::keep(&name, Uint8Array::new(&bytes).to_vec()),
            Err(refused) => log::error!("{} cannot be read: {refused:?}", name.display()),
        }
        names.push(name);
    }
    let can_open = |name: &&PathBuf| {
        let extension = name.extension().map(|it| it.to_string_lossy().to_lowercase());
        extension.is_some_and(|it| FileFormat::readable().contains(&it.as_str()))
    };
    names.iter().find(can_open).or(names.first()).cloned()
}

/// Opens files that are dropped on the page.
pub fn take_dropped(proxy: &EventLoopProxy<UserEvent>) {
    let proxy = proxy.clone();
    on_each(document(), "drop", move |event: DragEvent| {
        event.prevent_default();
        let files = event.data_transfer().and_then(|data| data.files());
        let proxy = proxy.clone();
        spawn_local(async move {
            if let Some(path) = keep_all(files).await {
                background::open(path, OpenOptions::default(), proxy);
            }
        });
    });
    on_each(document(), "dragover", |event: DragEvent| event.prevent_default());
}
