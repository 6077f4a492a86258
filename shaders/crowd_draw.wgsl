// What the shaders that draw a level of detail of a crowd share.

override LOD: u32;

// The lists of `crowd_cull.wgsl`.
@group(1) @binding(3) var<storage, read> visible: array<u32>;
