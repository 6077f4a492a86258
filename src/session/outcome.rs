use core::fmt::Display;
use std::path::PathBuf;

use super::drag::grip::{Drag, DragLimit};
use super::files::action::{Export, FileAction, FileContents, PathDialog};
use super::parts::{Key, SelectedKeys};
use super::preferences::{PanelTab, Preferences};
use crate::document::{Bake, Camera, Channel, Document, Keys, Ray, SkeletonRig};
use crate::io::OpenOptions;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Joint, JointId, JointRemap, RotationAxis, SkeletonError};
use crate::rig::{LimbFrames, Posture};
use crate::session::dialog::{Dialog, Message};

/// A request from the session to the program around it.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Copies a text to the clipboard.
    CopyText(String),
    /// Copies a link with these parts to the clipboard.
    CopyLink(String),
    /// Draws the viewport and saves the picture to a path.
    SavePicture(String),
    /// Starts a bake of the document.
    Bake(Bake),
    /// Starts an export.
    Export(Export),
    /// Opens the system's file dialog in place of one of the program's.
    ChoosePath(PathDialog),
    /// Reads a file.
    Open {
        /// The file.
        path: PathBuf,
        /// Choice of one of several skeletons and animations.
        options: OpenOptions,
    },
    /// Reads the mesh of the document's skin from a file.
    LocateSkin(PathBuf),
    /// Saves the document to a file.
    Save(PathBuf),
    /// Ends the program.
    Quit,
}

/// One consequence of an action for the session as a whole.
#[derive(Debug)]
pub(super) enum Consequence {
    /// Shows a message in the status bar; `None` removes it.
    Message(Option<Message>),
    /// Says that the limb of a joint's target has moved, if it has moved away from this pose.
    SayIfLimbMoved(JointId, Box<LimbFrames>),
    /// Replaces the shown document and updates all that depends on it.
    Write(Box<Document>),
    /// Evaluates the document again.
    Refresh,
    /// Discards all unkeyed edits.
    DiscardUnkeyed,
    /// Discards the unkeyed edits of channels.
    ForgetUnkeyed(Vec<Channel>),
    /// Discards the unkeyed edit of an angle if its keys have the same one.
    ForgetLikeKeys(Channel),
    /// Sets the keys from which the next move of keys in the open transaction starts.
    RestartKeysFrom(Box<Keys>),
    /// Opens a transaction, unless one is open.
    Begin(Option<Box<Drag>>),
    /// Closes the open transaction with an undo step.
    Commit,
    /// Restores the state before the open transaction.
    Cancel,
    /// Undoes a step; if a transaction is open, cancels it instead.
    Undo,
    /// Redoes a step.
    Redo,
    /// Ends other moves of the camera, because something is dragged.
    Press,
    /// Lets heads follow the mouse in a transaction of their own, or ends that.
    FollowMouse(bool),
    /// Moves the mouse that heads follow.
    Lead(Ray),
    /// Selects joints.
    Select(Vec<JointId>),
    /// Sets the joint under the mouse.
    Hover(Option<JointId>),
    /// Selects keys, also such as will be set.
    SelectKeys(Vec<Key>),
    /// Renumbers the joints of the keys that were selected.
    RemapKeys(Box<JointRemap>, SelectedKeys),
    /// Lets an angle swing in the view, or stops it.
    Wiggle(Option<(JointId, RotationAxis)>),
    /// Moves the playhead.
    SetTime(f64),
    /// Plays or pauses where the playhead is.
    SetPlaying(bool),
    /// Plays from the playhead on, or from the start if it is at the end.
    Play,
    /// Lets time pass, to a time in seconds on the window's clock.
    Advance(f64),
    /// Forgets the previous frame unless the timeline plays, so that a crowd continues from where
    /// it paused.
    ForgetPause,
    /// Sets the camera at once.
    SetCamera(Camera),
    /// Lets the motion begin with the FK pose, instead of a posture, after the next change.
    ResetPosture,
    /// Lets the motion begin with a posture, or with the FK pose, after the next change.
    ChoosePosture(Option<Shared<Posture>>),
    /// Notes how the targets of the body limit the open drag.
    LimitDrag(Box<DragLimit>),
    /// Moves the camera smoothly.
    GlideTo(Camera),
    /// Frames all smoothly.
    FrameAll,
    /// Frames all if the tip of the active joint is not in the middle of the picture.
    KeepInView,
    /// Moves the camera to the end of its glide.
    EndGlide,
    /// Glides the camera so that what it follows is in the middle of the picture.
    CentreFollowed,
    /// Hides the crowd and resets it.
    ResetCrowd,
    /// Starts the measurement of holonomy anew.
    ResetTransport,
    /// Brings a page of the panel on the right to the front, if it is there.
    ShowTab(PanelTab),
    /// Replaces the preferences.
    Prefer(Preferences),
    /// Opens a dialog.
    OpenDialog(Box<Dialog>),
    /// Shows a dialog in place of the open one; what waits for that is kept.
    ShowDialog(Box<Dialog>),
    /// Removes the dialog; what waits for it is kept.
    TakeDialog,
    /// Closes the dialog, and drops what waits for it.
    CloseDialog,
    /// Sets whether the system's file dialog is open.
    SetChoosing(bool),
    /// Replaces the open document by that of a file, of which also the contents are given.
    Open(Box<Opening>),
    /// Counts the document as saved, or as not saved.
    MarkSaved(bool),
    /// Applies an action on files, after a question if it would lose unsaved changes.
    File(Box<FileAction>),
    /// Applies an action on files that was confirmed.
    ConfirmedFile(Box<FileAction>),
    /// Frames a sphere around a point with a radius.
    Frame(glam::Vec3, f32),
    /// Makes one iteration with the solver, and shows its first part.
    LookInside,
    /// Ends the solver run.
    EndSolvers,
    /// Takes z as up when other animations of the file are opened.
    TakeZAsUp,
    /// Asks something of the program.
    Program(Effect),
}

/// A document that replaces the open one.
#[derive(Debug, Default)]
pub(super) struct Opening {
    pub document: Document,
    /// The file that Save overwrites; `None` if Save must ask for a path.
    pub file: Option<PathBuf>,
    /// Further contents of a file of another program.
    pub contents: Option<Box<FileContents>>,
    /// True if z seems to point up in the file.
    pub seems_z_up: bool,
}

/// Consequences of an action, in their order. Parts and edits return them; only the session acts on
/// them.
#[derive(Debug, Default)]
#[must_use]
pub(super) struct Outcome(Vec<Consequence>);

impl Outcome {
    /// Shows a message.
    pub fn say(text: impl Into<String>) -> Self {
        Consequence::Message(Some(Message::new(text))).into()
    }

    /// Shows an error, with its first letter capitalized.
    pub fn fail(why: impl AsRef<str>) -> Self {
        Consequence::Message(Some(Message::error(why.as_ref()))).into()
    }

    /// Removes the message and replaces the shown document.
    pub fn write(after: Document) -> Self {
        Self(vec![Consequence::Message(None), Consequence::Write(Box::new(after))])
    }

    /// Changes a copy of the shown document and writes it; after an error, reports that. An edit
    /// after which a target could not be evaluated is an error.
    pub fn edit<E: Display>(
        shown: &Document,
        change: impl FnOnce(&mut Document) -> Result<(), E>,
    ) -> Self {
        Self::edit_with(shown, change).map_or_else(|refused| refused, |(written, ())| written)
    }

    /// As [`Outcome::edit`], with the value of the change.
    ///
    /// # Errors
    ///
    /// The report of the error.
    pub fn edit_with<T, E: Display>(
        shown: &Document,
        change: impl FnOnce(&mut Document) -> Result<T, E>,
    ) -> Result<(Self, T), Self> {
        let mut after = shown.clone();
        let value = change(&mut after).map_err(|error| Self::fail(error.to_string()))?;
        let checked = after.rig.check_target_spaces();
        checked.map_err(|error| Self::fail(error.to_string()))?;
        Ok((Self::write(after), value))
    }

    /// Changes a copy of the shown skeleton and writes it; after an error, reports that.
    pub fn edit_rig(
        shown: &Document,
        change: impl FnOnce(&mut SkeletonRig) -> Result<(), SkeletonError>,
    ) -> Self {
        Self::edit(shown, |document| change(&mut document.rig))
    }

    /// Changes a copy of a joint and writes it; after an error, reports that.
    pub fn edit_joint(shown: &Document, joint: JointId, change: impl FnOnce(&mut Joint)) -> Self {
        Self::edit_rig(shown, |rig| rig.skeleton_mut().change(joint, change))
    }

    /// Changes a copy of the shown document and writes it.
    pub fn change(shown: &Document, change: impl FnOnce(&mut Document)) -> Self {
        Self::edit(shown, |document| {
            change(document);
            Ok::<_, core::convert::Infallible>(())
        })
    }

    /// These consequences, then others.
    pub fn and(mut self, then: impl Into<Self>) -> Self {
        self.0.append(&mut then.into().0);
        self
    }
}

impl IntoIterator for Outcome {
    type Item = Consequence;
    type IntoIter = std::vec::IntoIter<Consequence>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl From<Consequence> for Outcome {
    fn from(one: Consequence) -> Self {
        Self(vec![one])
    }
}

impl From<Effect> for Outcome {
    fn from(effect: Effect) -> Self {
        Consequence::Program(effect).into()
    }
}

impl<C: Into<Self>> From<Option<C>> for Outcome {
    fn from(maybe: Option<C>) -> Self {
        maybe.map(Into::into).unwrap_or_default()
    }
}
