/// Something that the view shows of a part of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InsideLayer {
    /// The columns of the Jacobian, as arrows at the tips.
    Columns,
    /// The ellipsoid of J·Jᵀ.
    Ellipsoid,
    /// The moves of the tips, and the turns of the angles.
    Step,
    /// CCD: the rays from the joint to tip and target, and the arc between them.
    Rays,
    /// FABRIK and relaxation: the chain of points of a pass.
    Passes,
    /// Two-bone: the triangle and the circle of all elbows.
    Triangle,
}

impl InsideLayer {
    /// All layers.
    pub const ALL: [Self; 6] =
        [Self::Columns, Self::Ellipsoid, Self::Step, Self::Rays, Self::Passes, Self::Triangle];
}

/// The layers that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsideLayers([bool; InsideLayer::ALL.len()]);

impl Default for InsideLayers {
    /// All layers.
    fn default() -> Self {
        Self([true; InsideLayer::ALL.len()])
    }
}

impl InsideLayers {
    /// Whether a layer is shown.
    pub fn shows(self, layer: InsideLayer) -> bool {
        self.0[layer as usize]
    }

    /// These layers with one of them shown or hidden.
    #[must_use]
    pub fn with(mut self, layer: InsideLayer, shown: bool) -> Self {
        self.0[layer as usize] = shown;
        self
    }
}
