use glam::Vec2;

use super::inside_layer::InsideLayer;
use super::panel_tab::PanelTab;
use super::view_drag::CameraMotion;
use crate::document::Camera;
use crate::rig::Processor;

/// Changes the camera, the crowd or the open panels. The camera is saved, but not undone.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewAction {
    /// Sets the camera at once.
    SetCamera(Camera),
    /// Moves the camera smoothly.
    GlideTo(Camera),
    /// Begins to drag the camera from a position of the mouse in the picture, −1 to 1.
    Grab(CameraMotion, Vec2),
    /// Drags the camera by the mouse.
    Drag {
        /// Position of the mouse in the picture, −1 to 1.
        to: Vec2,
        /// Ratio of the picture's width to its height.
        aspect: f32,
    },
    /// Ends the drag of the camera.
    Drop,
    /// Ends the drag and restores the camera from before it.
    Cancel,
    /// Keeps the camera at its distance and direction from the selected joints, or from the middle of all
    /// joints, while the time changes; or lets it stand again.
    FollowSelection(bool),
    /// Shows or hides something of the part of an iteration that is looked at.
    ShowInside(InsideLayer, bool),
    /// Shows a crowd of arms instead of the rig, or the rig again.
    ShowCrowd(bool),
    /// Sets the number of arms, from 1 to [`Crowd::MOST`](crate::rig::Crowd::MOST).
    SetCrowdSize(u32),
    /// Solves the crowd on the CPU or on the GPU.
    SetCrowdSolver(Processor),
    /// Animates or pauses the crowd's targets.
    AnimateCrowd(bool),
    /// Restarts the measurement of holonomy at the present direction of the Pointer.
    ResetTransport,
    /// Opens or closes the panel on the right.
    ShowExplain(bool),
    /// Shows a page of the panel on the right, if the shown rig has it.
    ShowTab(PanelTab),
    /// Opens or closes the timeline above the transport bar.
    ShowTimeline(bool),
    /// Shows keys in the graph editor (true) or in the dope sheet (false).
    ShowGraphEditor(bool),
}
