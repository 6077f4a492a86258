use std::path::{Path, PathBuf};

use winit::event_loop::EventLoopProxy;

use super::UserEvent;
use super::jobs::{self, Shot};
use super::window::{AppWindow, pixels};
use crate::io;
use crate::session::{Action, Effect, FileAction, Session};

/// What the session asks of the world outside.
impl AppWindow {
    /// Does what the session is told from elsewhere than the panels.
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

    /// What the viewport shows.
    fn shot(&self, session: &Session) -> Shot {
        let scale = self.egui.egui_ctx().pixels_per_point();
        Shot {
            document: session.shown().clone(),
            overlays: session.overlays(),
            theme: session.preferences().theme,
            size: pixels(self.viewport, scale),
            scale,
        }
    }

    /// Until an export that was cancelled has left no file.
    pub fn await_export(&mut self) {
        if let Some(thread) = self.exporting.take()
            && thread.join().is_err()
        {
            log::error!("an export ended by a fault");
        }
    }

    /// Whether the program is to end.
    pub(super) fn carry_out(
        &mut self,
        effect: Effect,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> bool {
        match effect {
            Effect::CopyText(text) => self.egui.egui_ctx().copy_text(text),
            Effect::SavePicture(path) => {
                let shot = self.shot(session);
                jobs::save_picture(shot, PathBuf::from(path), proxy.clone());
            }
            Effect::Export(export) => {
                let document = session.document().clone();
                let shot = self.shot(session);
                let (job, thread) = jobs::export(export, document, &shot, proxy.clone());
                self.exporting = Some(thread);
                session.apply(FileAction::ExportStarted(job));
            }
            Effect::ChoosePath(dialog) => {
                let path = session.full_path(&dialog, dialog.path().unwrap_or(Path::new("")));
                jobs::choose_path(dialog, &path, proxy.clone());
            }
            Effect::Open { path, skeleton } => jobs::open(path, skeleton, proxy.clone()),
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
