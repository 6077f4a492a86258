use super::drawn_skeleton::{DrawnSkeleton, GHOST};
use crate::kinematics::skeleton::Skeleton;
use crate::scene::{Ball, Label, LabelSide, Line, Scene};
use crate::session::{WiggleTarget, WiggleView};

/// Adds an angle that swings: the bones that it moves, the path of the tip and the line that the
/// Jacobian predicts, and the residual.
pub(super) fn add(
    scene: &mut Scene,
    drawn: &DrawnSkeleton<'_>,
    skeleton: &Skeleton,
    wiggle: &WiggleView,
) {
    let (accent, guide) = (scene.palette.accent, scene.palette.guide);
    let swinging = drawn.posed(&wiggle.pose);
    for joint in skeleton.ids().filter(|it| skeleton.is_in_subtree(*it, wiggle.swing.joint)) {
        let (base, tip) = (wiggle.pose.base(joint), wiggle.pose.tip(joint));
        let radius = swinging.radius(joint) * GHOST;
        if base != tip {
            scene.add_guide_solid(base, tip, radius, radius, accent);
        }
    }
    let segments = wiggle.path.windows(2);
    scene.lines.extend(segments.map(|ends| Line {
        from: ends[0],
        to: ends[1],
        colour: accent,
        dashed: false,
    }));
    let [from, to] = wiggle.predicted;
    scene.lines.push(Line { from, to, colour: guide, dashed: true });
    let tip = wiggle.pose.tip(wiggle.swing.tip);
    let radius = 0.014 * drawn.reach;
    scene.guide_balls.push(Ball { centre: tip, radius, colour: accent });
    let label = Label::new(tip, radius, LabelSide::Above, accent);
    if let Some(WiggleTarget { before, now, .. }) = wiggle.target {
        scene.add_label(label, format_args!("{:+.4}", now - before));
    }
}
