use crate::scene::{Ball, Globe, Label, LabelSide, Palette, Scene};

/// Ratio of the radius of a singular direction's mark to the radius of the globe.
const MARK_RADIUS: f32 = 0.026;

impl Scene {
    /// Shows a globe and marks each singular direction with a ball and a label. Does nothing if the
    /// globe cannot be drawn, see [`Globe::has_size`].
    pub fn add_globe(&mut self, globe: Globe) {
        if !globe.has_size() {
            return;
        }
        self.globe = Some(globe);
        let (ball, text) =
            (self.palette.gain(Palette::MAX_GAIN).with_opacity(1.0), self.palette.text);
        for direction in globe.singular() {
            let (centre, radius) =
                (globe.centre + direction * globe.radius, MARK_RADIUS * globe.radius);
            self.balls.push(Ball { centre, radius, colour: ball });
            let label = Label::new(centre, radius, LabelSide::Above, text);
            self.add_label(label, format_args!("singular"));
        }
    }
}
