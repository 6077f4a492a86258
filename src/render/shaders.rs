use super::{
    backdrop, crowd, crowd_lod, crowd_solver, globe, label, line, shadow, shell, skin,
    skin_deformer, solid, texture_painter, triangle_painter,
};

/// Names and WGSL sources of all complete shaders.
pub fn shaders() -> [(&'static str, &'static str); 15] {
    [
        ("backdrop", backdrop::SHADER),
        ("crowd_arms", crowd_lod::ARMS),
        ("crowd_cull", crowd::CULL),
        ("crowd_far", crowd_lod::FAR),
        ("crowd_solver", crowd_solver::SHADER),
        ("globe", globe::SHADER),
        ("label", label::SHADER),
        ("line", line::SHADER),
        ("shadow", shadow::SHADER),
        ("shell", shell::SHADER),
        ("skin", skin::SHADER),
        ("skin_deform", skin_deformer::SHADER),
        ("solid", solid::SHADER),
        ("texture", texture_painter::SHADER),
        ("triangle", triangle_painter::SHADER),
    ]
}
