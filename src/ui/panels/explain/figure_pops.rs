//! What is wrong with the motion of a figure: its pops, lost targets and slides.

use egui::Ui;

use crate::document::{FramePop, Inspection, LostSpan, SkeletonRig, Slide, Target};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::TwistReferenceKind;
use crate::rig::{LimbSettings, RigPop, RigPopCause, TargetKind};
use crate::session::{Actions, PlaybackAction, SelectAction, Session, SolverEdit, TargetEdit};
use crate::ui::widgets;
use crate::words::{self, significant};

/// Maximum number of lines of one kind.
const LISTED: usize = 12;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    if !session.document().is_posed_over_time() {
        ui.label(
            "No target moves the figure. Give a target a path or keys: this page then shows where \
             joints jump, where targets are lost and where feet slide, and why.",
        );
        return;
    }
    let Some(found) = session.inspection() else {
        // Without a spinner, which would draw all the time.
        ui.weak("Looking through the motion…");
        return;
    };
    pops(ui, session, found, actions);
    lost(ui, session, found, actions);
    slides(ui, session, found, actions);
}

fn pops(ui: &mut Ui, session: &Session, found: &Inspection, actions: &mut Actions) {
    let peaks = &found.peaks;
    if peaks.is_empty() {
        ui.label("No pops: joints move as smoothly as their targets.");
    }
    let rig = session.rig();
    let line = |FramePop { time, pop }: &FramePop| (*time, pop.joint, words::pop(rig, pop));
    lines(ui, peaks.iter().map(line), actions);
    let mut offered: Vec<Target> = Vec::new();
    for FramePop { pop, .. } in peaks {
        let Some((label, tooltip, target)) = remedy(rig, pop) else { continue };
        if !offered.contains(&target) {
            offered.push(target);
            if widgets::button(ui, &label, tooltip, None) {
                actions.push(TargetEdit::SetTarget(target));
            }
        }
    }
    if !session.rig().is_tracked && !peaks.is_empty() {
        let tooltip = "Switch off Each frame by itself in the Solver page";
        if widgets::button(ui, "Continue from frame to frame", tooltip, None) {
            actions.push(SolverEdit::SetTracked(true));
        }
    }
}

/// A change of a target that helps against a pop, with its label and its tooltip; `None` if no
/// setting of the target helps.
fn remedy(rig: &SkeletonRig, pop: &RigPop) -> Option<(String, &'static str, Target)> {
    const SOFTER: f32 = 0.2;
    const SOFTEST: f32 = 0.8;
    let target = rig.targets[rig.target(pop.target)?];
    let name = &rig.skeleton.joint(rig.end_of(&target))?.name;
    match (pop.cause, target.kind) {
        (RigPopCause::Straight, TargetKind::WholeBody) if target.softness < SOFTEST => {
            let softer = Target { softness: target.softness + SOFTER, ..target };
            Some((
                format!("Soften the target of {name}"),
                "Slow the tip before the chain is straight",
                softer,
            ))
        }
        (RigPopCause::Straight, TargetKind::Limb(limb)) if limb.soft_reach.softness() < SOFTEST => {
            let soft = limb.soft_reach;
            let softness = soft.softness() + SOFTER;
            let soft_reach = SoftReach::new(softness, soft.max_stretch(), soft.min_elbow_angle());
            let limb = LimbSettings { soft_reach: soft_reach.ok()?, ..limb };
            let softer = Target { kind: TargetKind::Limb(limb), ..target };
            Some((
                format!("Soften the limb of {name}"),
                "Slow the tip before the limb is straight",
                softer,
            ))
        }
        (RigPopCause::Singular, TargetKind::Limb(limb)) => {
            let limb = LimbSettings { reference: TwistReferenceKind::Transport, ..limb };
            let carried = Target { kind: TargetKind::Limb(limb), ..target };
            let tooltip = "Carry the direction along the motion: it flips nowhere";
            Some((format!("Use Transport for {name}"), tooltip, carried))
        }
        _ => None,
    }
}

fn lost(ui: &mut Ui, session: &Session, found: &Inspection, actions: &mut Actions) {
    if found.lost.is_empty() {
        return;
    }
    widgets::section(ui, "Lost targets", |ui| {
        let rig = session.rig();
        let line = |LostSpan { target, from, to, miss }: &LostSpan| {
            let until = if to > from { format!(", until {to:.2} s") } else { String::new() };
            (*from, *target, format!("{}{until}", words::lost(rig, *target, *miss)))
        };
        lines(ui, found.lost.iter().map(line), actions);
        if let Some(posture) = &found.better_posture {
            let tooltip = "Begin the motion in another pose, from which it loses no target";
            if widgets::button(ui, "Begin in another pose", tooltip, None) {
                actions.push(SolverEdit::SetPosture(posture.clone()));
            }
        }
    });
}

fn slides(ui: &mut Ui, session: &Session, found: &Inspection, actions: &mut Actions) {
    if found.slides.is_empty() {
        return;
    }
    widgets::section(ui, "Slides", |ui| {
        let rig = session.rig();
        let line = |Slide { target, from, to, by }: &Slide| {
            let end = rig.end_of_target(*target).unwrap_or(*target);
            let name = rig.skeleton.joint(end).map_or("", |joint| joint.name.as_str());
            let by = significant(*by);
            (
                *from,
                *target,
                format!("{name} slides by {by} until {to:.2} s, while its target rests"),
            )
        };
        lines(ui, found.slides.iter().map(line), actions);
    });
}

/// Shows lines of a time, a joint and a sentence. A click on the time moves the playhead there and
/// selects the joint.
fn lines(
    ui: &mut Ui,
    all: impl ExactSizeIterator<Item = (f64, JointId, String)>,
    actions: &mut Actions,
) {
    let more = all.len().saturating_sub(LISTED);
    for (time, joint, sentence) in all.take(LISTED) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let link = ui.link(format!("{time:.2} s"));
            if link.on_hover_text("Go to this time, and select the joint").clicked() {
                actions.push(PlaybackAction::SetTime(time));
                actions.push(SelectAction::Joints(vec![joint]));
            }
            ui.label(sentence);
        });
    }
    if more > 0 {
        ui.weak(format!("… and {more} more"));
    }
}
