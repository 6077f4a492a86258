use glam::{Vec2, Vec3};

use crate::document::Projection;
use crate::scene::{LabelSide, Scene};

/// Distance from the picture, in points, from which a point outside it has no label.
const OUTSIDE: f32 = 30.0;
/// Height of a line in points.
pub(super) const LINE_HEIGHT: f32 = 15.0;
/// Across and down, the nearest that a text comes to the middle of a ball, as fractions of the ball's
/// radius: beside an upright limb, the text is clear of the limb's whole width.
const CLEAR: Vec2 = Vec2::new(1.0, core::f32::consts::FRAC_1_SQRT_2);
/// Least space between two texts side by side, in points.
const BETWEEN: f32 = 5.0;
/// Ratio of the height of letters to that of a line.
const LETTERS: f32 = 0.75;
/// Maximum number of lines by which a label is moved away from its point to be clear of others.
const MOST_LINES: u8 = 3;
/// Columns and rows of the points of a text at which it may cover a limb.
const SAMPLES: [u16; 2] = [6, 3];
/// Least radius in pixels of what a text should not cover.
const LEAST_RADIUS: f32 = 3.0;
/// What it costs to cover one of these points, by a limb or by a thin line, and to go a line farther
/// away. To go to the next side costs 1.
const COST_OF_LIMB: u32 = 4;
const COST_OF_THIN: u32 = 3;
const COST_OF_LINE: u32 = 5;

/// Where labels are written, so that none covers another or leaves the picture, nor a limb where
/// there is room beside it: on its own side of its point, else on another side, else farther away.
/// Earlier labels of a scene choose first.
#[derive(Debug, Default)]
pub(super) struct LabelPlaces {
    pens: Vec<Option<Vec2>>,
    /// Corners of the placed texts.
    taken: Vec<[Vec2; 2]>,
    /// What the texts should not cover.
    limbs: Vec<SeenLimb>,
}

impl LabelPlaces {
    /// The start of each label's baseline in pixels; `None` for a point that is not in the picture or
    /// near it.
    pub fn pens(&self) -> &[Option<Vec2>] {
        &self.pens
    }

    /// Places the labels of a scene, of which each text has a width in pixels, on a picture of a size
    /// in pixels. `scale` is the number of pixels per point.
    pub fn place(
        &mut self,
        scene: &Scene,
        widths: impl Iterator<Item = f32>,
        size: Vec2,
        scale: f32,
    ) {
        self.pens.clear();
        self.taken.clear();
        self.limbs.clear();
        let projection = scene.camera.projection(size.x / size.y);
        if !scene.labels.is_empty() {
            self.limbs.extend(SeenLimb::all(scene, &projection, size));
        }
        for (label, width) in scene.labels.iter().zip(widths) {
            let near = Vec2::splat(OUTSIDE * scale);
            let is_seen = |at: &Vec2| at.cmpge(-near).all() && at.cmple(size + near).all();
            let Some(point) = pixel(&projection, label.at, size).filter(is_seen) else {
                self.pens.push(None);
                continue;
            };
            let ball = label.clearance / projection.half_height_at(label.at) * size.y / 2.0;
            let away = ball * CLEAR + label.gap * scale;
            let text = Text { point, away, width, line: LINE_HEIGHT * scale };
            let is_free = |pen: &Vec2| {
                let corners = text.corners(*pen);
                self.taken.iter().all(|other| !overlap(corners, *other))
            };
            let is_inside = |pen: &Vec2| {
                let [low, high] = text.corners(*pen);
                low.cmpge(Vec2::ZERO).all() && high.cmple(size).all()
            };
            let mut best = (text.pen(label.side, 0), (true, true, u32::MAX));
            for (far, pen) in text.places(label.side) {
                if best.1 <= (false, false, far) {
                    // Later places cost at least this much.
                    break;
                }
                let covered = text.covered(pen, &self.limbs);
                let cost = (!is_free(&pen), !is_inside(&pen), covered + far);
                if cost < best.1 {
                    best = (pen, cost);
                }
            }
            let (pen, _) = best;
            let [low, high] = text.corners(pen);
            let beside = Vec2::new(BETWEEN * scale, 0.0);
            self.taken.push([low - beside, high + beside]);
            self.pens.push(Some(pen));
        }
    }
}

/// A label's text beside its point, in pixels.
#[derive(Clone, Copy)]
struct Text {
    point: Vec2,
    /// Distance from the point along each axis.
    away: Vec2,
    width: f32,
    /// Height of a line.
    line: f32,
}

impl Text {
    /// Starts of the baseline, the best first, each with what it costs not to be the best.
    fn places(self, side: LabelSide) -> impl Iterator<Item = (u32, Vec2)> {
        let others = LabelSide::ALL.into_iter().filter(move |other| *other != side);
        let sides = [side, LabelSide::Under].into_iter().chain(others);
        (0..=MOST_LINES).flat_map(move |lines| {
            (0..).zip(sides.clone()).map(move |(nth, side)| {
                (COST_OF_LINE * u32::from(lines) + nth, self.pen(side, lines))
            })
        })
    }

    fn pen(self, side: LabelSide, lines: u8) -> Vec2 {
        let Self { point, away, width, line } = self;
        let across = match side {
            LabelSide::Over | LabelSide::Under => -0.5 * width,
            _ if side.is_left() => -away.x - width,
            _ => away.x,
        };
        let farther = f32::from(lines) * line;
        let drop = if side.is_above() { -away.y - farther } else { away.y + 0.6 * line + farther };
        point + Vec2::new(across, drop)
    }

    /// What it costs that the text covers limbs, at points that are spread evenly over it: [`SAMPLES`].
    fn covered(self, pen: Vec2, limbs: &[SeenLimb]) -> u32 {
        let [low, high] = self.corners(pen);
        let [columns, rows] = SAMPLES;
        let cost = |nth: u16| {
            let [column, row] = [nth % columns, nth / columns].map(f32::from);
            let part =
                Vec2::new(column, row) / Vec2::new(f32::from(columns - 1), f32::from(rows - 1));
            let at = low + (high - low) * part;
            let covered = limbs.iter().filter(|limb| limb.covers(at));
            covered.map(|it| if it.is_thin { COST_OF_THIN } else { COST_OF_LIMB }).max()
        };
        (0..columns * rows).filter_map(cost).sum()
    }

    fn corners(self, pen: Vec2) -> [Vec2; 2] {
        [pen - Vec2::new(0.0, LETTERS * self.line), pen + Vec2::new(self.width, 0.0)]
    }
}

/// A limb in the picture, in pixels.
#[derive(Clone, Copy, Debug)]
struct SeenLimb {
    from: Vec2,
    to: Vec2,
    radius: f32,
    /// True for a line.
    is_thin: bool,
}

impl SeenLimb {
    /// The cones, hands and lines of a scene, and the limbs that cast shadows: those of a skin. What
    /// is partly behind the eye is left out.
    fn all(scene: &Scene, projection: &Projection, size: Vec2) -> impl Iterator<Item = Self> {
        let cones = scene.solids.iter().chain(&scene.guide_solids).map(|solid| {
            let [from, to] = [0.0, solid.shape.length]
                .map(|along| solid.transform.transform_point3(Vec3::X * along));
            (from, to, solid.shape.base_radius.max(solid.shape.tip_radius))
        });
        let with_shadows = scene
            .shadows
            .iter()
            .map(|limb| (limb.base, limb.tip, limb.base_radius.max(limb.tip_radius)));
        let hands = scene.hands.iter().map(|hand| {
            let [(from, from_radius), (to, to_radius)] = hand.ends();
            (from, to, from_radius.max(to_radius))
        });
        let lines = scene.lines.iter().map(|line| (line.from, line.to, 0.0));
        cones.chain(with_shadows).chain(hands).chain(lines).filter_map(move |(from, to, radius)| {
            let pixels = 0.5 * size.y / projection.half_height_at(from.midpoint(to));
            Some(Self {
                from: pixel(projection, from, size)?,
                to: pixel(projection, to, size)?,
                radius: (radius * pixels).max(LEAST_RADIUS),
                is_thin: radius == 0.0,
            })
        })
    }

    fn covers(&self, at: Vec2) -> bool {
        let along = self.to - self.from;
        let part = (at - self.from).dot(along) / along.length_squared();
        let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
        at.distance_squared(self.from + along * part) < self.radius * self.radius
    }
}

/// Position of a point in the picture, in pixels; `None` behind the eye.
fn pixel(projection: &Projection, point: Vec3, size: Vec2) -> Option<Vec2> {
    Some((projection.project(point)? * Vec2::new(0.5, -0.5) + 0.5) * size)
}

fn overlap([low, high]: [Vec2; 2], [other_low, other_high]: [Vec2; 2]) -> bool {
    low.cmplt(other_high).all() && other_low.cmplt(high).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Document, Overlay, Theme, Track, TwistReferenceKind};
    use crate::scene::Label;
    use crate::session::Overlays;

    const SIZE: Vec2 = Vec2::new(720.0, 700.0);
    /// Width of a letter and height of a line, in pixels.
    const LETTER: f32 = 7.0;

    /// The corners of the texts of a scene.
    fn placed(scene: &Scene) -> Vec<[Vec2; 2]> {
        let mut places = LabelPlaces::default();
        let width = |label: &Label| LETTER * scene.text(label).chars().count() as f32;
        places.place(scene, scene.labels.iter().map(width), SIZE, 1.0);
        assert_eq!(places.pens().len(), scene.labels.len());
        places.taken
    }

    #[test]
    fn no_label_of_the_arm_covers_another() {
        let kinds = [TwistReferenceKind::Up, TwistReferenceKind::Pole];
        for (overlay, count) in [(Overlay::Frames, 9), (Overlay::TwistReferences, 3)] {
            for kind in kinds {
                for cursor in [[250.0, 120.0, 60.0], [440.0, 320.0, 60.0], [10.0, 220.0, -200.0]] {
                    let mut document = Document::default();
                    let target = &mut document.rig.targets[0];
                    target.home = Vec3::from(cursor);
                    target.limb_mut().expect("a limb").reference = kind;
                    document.display = document.display.with(overlay, true);
                    let posed = document.at(0.0);
                    let overlays = Overlays::new(&Track::new(&document), &posed);
                    let scene = Scene::new(&posed, &overlays, Theme::Dark);
                    let texts = placed(&scene);
                    assert!(texts.len() >= count, "{overlay:?}: {}", texts.len());
                    for (index, text) in texts.iter().enumerate() {
                        let others = texts[..index].iter();
                        let hidden = others.filter(|other| overlap(*text, **other)).count();
                        let label = scene.text(&scene.labels[index]);
                        assert_eq!(hidden, 0, "{overlay:?}, {kind:?}, {cursor:?}: {label}");
                    }
                }
            }
        }
    }

    /// Number of points of texts that cover a limb, at their places and at those that their own
    /// sides have.
    fn covered(scene: &Scene) -> [u32; 2] {
        let mut places = LabelPlaces::default();
        let width = |label: &Label| LETTER * scene.text(label).chars().count() as f32;
        places.place(scene, scene.labels.iter().map(width), SIZE, 1.0);
        let projection = scene.camera.projection(SIZE.x / SIZE.y);
        let points = |label: &Label, pen: Vec2| {
            let point = pixel(&projection, label.at, SIZE).expect("before the eye");
            let ball = label.clearance / projection.half_height_at(label.at) * SIZE.y / 2.0;
            let away = ball * CLEAR + label.gap;
            let text = Text { point, away, width: width(label), line: LINE_HEIGHT };
            [pen, text.pen(label.side, 0)].map(|pen| text.covered(pen, &places.limbs))
        };
        let each = scene
            .labels
            .iter()
            .zip(places.pens())
            .filter_map(|(label, pen)| Some(points(label, (*pen)?)));
        each.fold([0, 0], |sum, each| [sum[0] + each[0], sum[1] + each[1]])
    }

    #[test]
    fn a_point_far_outside_the_picture_has_no_label() {
        let mut scene = Scene::new(&Document::default().at(0.0), &Overlays::default(), Theme::Dark);
        let projection = scene.camera.projection(SIZE.x / SIZE.y);
        let label = scene.labels[0];
        let mut places = LabelPlaces::default();
        for step in -60_i16..=60 {
            let along = f32::from(step) * 0.05;
            scene.labels[0].at = label.at + along * 300.0 * projection.right;
            let seen = pixel(&projection, scene.labels[0].at, SIZE).expect("before the eye");
            let outside = (seen - seen.clamp(Vec2::ZERO, SIZE)).abs().max_element();
            places.place(&scene, std::iter::repeat(40.0), SIZE, 1.0);
            assert_eq!(places.pens()[0].is_some(), outside <= OUTSIDE, "at {seen}");
        }
    }

    #[test]
    fn names_of_an_arm_stand_beside_its_limbs() {
        let mut sum = [0, 0];
        for angle in (0_u8..36).map(|nth| f32::from(nth) * 0.17) {
            let mut document = Document::default();
            let home = Vec3::new(320.0 * angle.cos(), 180.0, 320.0 * angle.sin());
            document.rig.targets[0].home = home;
            let scene = Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark);
            let [chosen, own] = covered(&scene);
            let unseen = placed(&scene).len().abs_diff(scene.labels.len());
            assert!(unseen <= 1, "at {angle}: the Pointer alone may end outside the picture");
            assert!(chosen <= own, "at {angle}: {chosen} points over limbs instead of {own}");
            sum = [sum[0] + chosen, sum[1] + own];
        }
        assert!(sum[1] > 36 && 2 * sum[0] < sum[1], "{sum:?} points over limbs");
    }

    #[test]
    fn the_length_of_a_gap_stands_clear_of_the_handles_of_the_cursor() {
        // In points, as the handles are drawn.
        const SQUARE: f32 = 42.0;
        const ARROW: f32 = 80.0;
        for cursor in [[440.0, 320.0, 60.0], [-300.0, 400.0, 200.0], [300.0, -200.0, 400.0]] {
            let mut document = Document::default();
            document.rig.targets[0].home = Vec3::from(cursor);
            document.camera = document.camera.framing(Vec3::ZERO, 900.0, SIZE.x / SIZE.y);
            let overlays = Overlays { has_handles: true, ..Overlays::default() };
            let scene = Scene::new(&document.at(0.0), &overlays, Theme::Dark);
            let gap = scene.labels.iter().position(|it| scene.text(it).starts_with("gap "));
            let [low, high] = placed(&scene)[gap.expect("the length of the gap")];
            let projection = scene.camera.projection(SIZE.x / SIZE.y);
            let seen = |point: Vec3| {
                let at = projection.project(point).expect("before the eye");
                (at * Vec2::new(0.5, -0.5) + 0.5) * SIZE
            };
            let centre = seen(cursor.into());
            let is_in = |at: Vec2| at.cmpge(low).all() && at.cmple(high).all();
            for nth in 0..=u16::try_from(ARROW as u32).unwrap() {
                for axis in Vec3::AXES {
                    let to = (seen(Vec3::from(cursor) + axis) - centre).normalize_or_zero();
                    assert!(!is_in(centre + to * f32::from(nth)), "{cursor:?}: under an arrow");
                }
            }
            let nearest = centre.clamp(low, high);
            assert!((nearest - centre).abs().max_element() >= SQUARE, "{cursor:?}: under a square");
        }
    }
}
