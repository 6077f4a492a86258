use bytemuck::{Pod, Zeroable};

pub(super) const ARMS: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/crowd.wgsl"),
    include_str!("../../shaders/crowd_draw.wgsl"),
    include_str!("../../shaders/crowd_arms.wgsl"),
);

pub(super) const FAR: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/crowd.wgsl"),
    include_str!("../../shaders/crowd_draw.wgsl"),
    include_str!("../../shaders/crowd_far.wgsl"),
);

/// A level of detail of the arms of a crowd: how each arm, or each limb, is drawn.
#[derive(Clone, Copy)]
pub(super) struct CrowdLod {
    pub shader: &'static str,
    pub topology: wgpu::PrimitiveTopology,
    /// Number of sides of a limb; 0 for a line or a point.
    sides: u32,
    /// Number of vertices of an entry in the level's list: an arm, or a limb with its colour.
    vertices: u32,
    /// Number of u32s of an arm in the list.
    words: u32,
}

/// `Lod` in `crowd.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct CrowdLodData {
    sides: u32,
    vertices: u32,
    first: u32,
    padding: u32,
}

const _: () = assert!(size_of::<CrowdLodData>() == 16);

/// Arguments of an indirect draw: vertex count, instance count, first vertex and first instance.
pub(super) type DrawArguments = [u32; 4];

impl CrowdLod {
    pub const COUNT: usize = 5;

    /// Levels from the nearest arms to the farthest: round limbs with joints, five-sided limbs,
    /// flat limbs, lines, points.
    pub const ALL: [Self; Self::COUNT] = [
        Self::with_sides(12, 3 * 10 * 5 * 6),
        Self::with_sides(5, 0),
        Self::with_sides(1, 0),
        Self::of_limbs(wgpu::PrimitiveTopology::LineList, 2),
        Self::of_limbs(wgpu::PrimitiveTopology::PointList, 1),
    ];

    /// Arguments that draw nothing until the culling shader has counted the vertices. One instance
    /// holds all arms, because many instances of few vertices are slow on a software adapter.
    pub const NO_DRAWS: [DrawArguments; Self::COUNT] = [[0, 1, 0, 0]; Self::COUNT];

    const fn with_sides(sides: u32, joint_vertices: u32) -> Self {
        let vertices = 2 * 6 * sides + joint_vertices;
        let topology = wgpu::PrimitiveTopology::TriangleList;
        Self { shader: ARMS, topology, sides, vertices, words: 1 }
    }

    const fn of_limbs(topology: wgpu::PrimitiveTopology, vertices: u32) -> Self {
        Self { shader: FAR, topology, sides: 0, vertices, words: 4 }
    }

    /// True if its limbs are lines or points.
    pub fn is_far(&self) -> bool {
        self.sides == 0
    }

    /// Uniforms of all levels, whose lists have room for `stride` arms.
    pub fn data(stride: u32) -> [CrowdLodData; Self::COUNT] {
        let mut first = 0;
        Self::ALL.map(|lod| {
            let Self { sides, vertices, words, .. } = lod;
            let data = CrowdLodData { sides, vertices, first, padding: 0 };
            first += words * stride;
            data
        })
    }

    /// Number of u32s of an arm in the lists of all levels together.
    pub fn words() -> u32 {
        Self::ALL.iter().map(|lod| lod.words).sum()
    }

    /// Number of triangles that draws with these arguments draw. Lines and points count none.
    pub fn triangles(arguments: &[u8]) -> u32 {
        let draws = arguments.chunks_exact(size_of::<DrawArguments>());
        let of_draw = |(lod, draw): (&Self, &[u8])| {
            let is_triangles = lod.topology == wgpu::PrimitiveTopology::TriangleList;
            let vertices = draw.first_chunk().filter(|_| is_triangles);
            vertices.map_or(0, |bytes| u32::from_le_bytes(*bytes) / 3)
        };
        Self::ALL.iter().zip(draws).map(of_draw).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_levels_do_not_overlap() {
        let lists = CrowdLod::data(1000).map(|lod| lod.first);
        assert_eq!(lists, [0, 1000, 2000, 3000, 7000]);
        assert_eq!(CrowdLod::words(), 11);
    }

    #[test]
    fn triangles_of_arms_are_counted_without_lines_and_points() {
        let vertices = [2 * 1044, 3 * 60, 12, 1000, 1000];
        let draws = vertices.map(|vertices| [vertices, 1, 0, 0]);
        assert_eq!(CrowdLod::triangles(bytemuck::cast_slice(&draws)), 2 * 348 + 3 * 20 + 4);
    }
}
