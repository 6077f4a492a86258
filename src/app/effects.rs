use std::path::PathBuf;

use winit::event_loop::EventLoopProxy;

use super::background::{self, UserEvent, ViewportPicture};
use super::window::AppWindow;
use crate::io;
use crate::session::{Action, BakeAction, Effect, FileAction, Session};

/// Execution of the effects that a session requests.
impl AppWindow {
    /// Applies an action that does not come from the panels, and carries out its effect.
    pub fn act(
        &mut self,
        action: Action,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) {
        if let Some(effect) = session.apply(action)
            && self.carry_out(effect, session, proxy)
        {
            self.ends = true;
        }
    }

    fn viewport_picture(&self, session: &Session) -> ViewportPicture {
        let scale = self.egui.egui_ctx().pixels_per_point();
        ViewportPicture {
            posed: session.posed().clone(),
            overlays: session.overlays(),
            theme: session.preferences().theme,
            size: self.viewport_pixels(scale),
            scale,
        }
    }

    /// Waits until the export's thread, if there is one, has ended: a cancelled export removes its
    /// files first.
    pub fn await_export(&mut self) {
        if let Some(thread) = self.exporting.take()
            && thread.join().is_err()
        {
            log::error!("an export panicked");
        }
    }

    /// Carries out an effect and returns whether the program is to end.
    pub(super) fn carry_out(
        &mut self,
        effect: Effect,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> bool {
        match effect {
            Effect::CopyText(text) => self.egui.egui_ctx().copy_text(text),
            Effect::SavePicture(path) => {
                let picture = self.viewport_picture(session);
                background::save_picture(picture, PathBuf::from(path), proxy.clone());
            }
            Effect::Bake(settings) => {
                let job = background::bake(settings, session.document().clone(), proxy.clone());
                session.apply(BakeAction::Started(job));
            }
            Effect::Export(export) => {
                let document = session.document().clone();
                let picture = self.viewport_picture(session);
                let (job, thread) = background::export(export, document, &picture, proxy.clone());
                self.exporting = Some(thread);
                session.apply(FileAction::ExportStarted(job));
            }
            Effect::ChoosePath(dialog) => {
                let path = session.files().full_path(&dialog, dialog.path());
                background::choose_path(dialog, &path, proxy.clone());
            }
            Effect::Open { path, options } => background::open(path, options, proxy.clone()),
            Effect::LocateSkin(path) => {
                background::locate_skin(path, session.skeleton_rig(), proxy.clone());
            }
            Effect::Save(path) => {
                let saved = match io::save(session.document(), &path) {
                    Ok(()) => FileAction::Saved(path),
                    Err(error) => FileAction::NotSaved { path, why: error.to_string() },
                };
                let next = session.apply(saved);
                return next.is_some_and(|effect| self.carry_out(effect, session, proxy));
            }
            Effect::Quit => return true,
        }
        false
    }
}
