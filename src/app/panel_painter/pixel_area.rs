use egui::Rect;
use egui_wgpu::ScreenDescriptor;

/// A rectangle of whole pixels in the window: left, top, width and height, not empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::app) struct PixelArea {
    pub at: [u32; 2],
    pub size: [u32; 2],
}

impl PixelArea {
    /// All pixels that a rectangle in points touches; `None` without any in the window.
    pub fn touched(rect: Rect, screen: &ScreenDescriptor) -> Option<Self> {
        Self::of(rect, screen, [f32::floor, f32::ceil])
    }

    /// The pixels of a rectangle that is made of whole pixels, but for rounding.
    pub fn nearest(rect: Rect, screen: &ScreenDescriptor) -> Option<Self> {
        Self::of(rect, screen, [f32::round, f32::round])
    }

    fn of(rect: Rect, screen: &ScreenDescriptor, round: [fn(f32) -> f32; 2]) -> Option<Self> {
        let [from, to] = round;
        let [width, height] = screen.size_in_pixels;
        let pixel = |at: f32, most: u32| (at.max(0.0) as u32).min(most);
        let points = rect * screen.pixels_per_point;
        let at = [pixel(from(points.left()), width), pixel(from(points.top()), height)];
        let end = [pixel(to(points.right()), width), pixel(to(points.bottom()), height)];
        let size = [end[0].saturating_sub(at[0]), end[1].saturating_sub(at[1])];
        (size[0] > 0 && size[1] > 0).then_some(Self { at, size })
    }

    pub fn in_points(self, screen: &ScreenDescriptor) -> Rect {
        let point = |x: u32, y: u32| egui::pos2(x as f32, y as f32) / screen.pixels_per_point;
        let ([x, y], [width, height]) = (self.at, self.size);
        Rect::from_min_max(point(x, y), point(x + width, y + height))
    }

    pub fn intersection(self, other: Self) -> Option<Self> {
        let range = |axis: usize| {
            let from = self.at[axis].max(other.at[axis]);
            let to = (self.at[axis] + self.size[axis]).min(other.at[axis] + other.size[axis]);
            (from < to).then(|| (from, to - from))
        };
        let ((x, width), (y, height)) = (range(0)?, range(1)?);
        Some(Self { at: [x, y], size: [width, height] })
    }
}

#[cfg(test)]
mod tests {
    use egui::{pos2, vec2};

    use super::*;

    #[test]
    fn areas_are_in_the_window_and_cover_what_they_are_made_of() {
        let screen = ScreenDescriptor { size_in_pixels: [100, 50], pixels_per_point: 1.5 };
        let area = |x: f32, y: f32, width: f32, height: f32| {
            PixelArea::touched(Rect::from_min_size(pos2(x, y), vec2(width, height)), &screen)
        };
        assert_eq!(area(1.0, 1.0, 2.0, 2.0), Some(PixelArea { at: [1, 1], size: [4, 4] }));
        assert_eq!(area(-9.0, -9.0, 10.0, 10.0), Some(PixelArea { at: [0, 0], size: [2, 2] }));
        assert_eq!(area(70.0, 0.0, 9.0, 9.0), None);
        let all = PixelArea::touched(Rect::EVERYTHING, &screen);
        assert_eq!(all, Some(PixelArea { at: [0, 0], size: [100, 50] }));
        let viewport = Rect::from_min_max(pos2(2.0, 4.0), pos2(20.0, 30.0000002));
        let nearest = PixelArea::nearest(viewport, &screen);
        assert_eq!(nearest, Some(PixelArea { at: [3, 6], size: [27, 39] }));
    }
}
