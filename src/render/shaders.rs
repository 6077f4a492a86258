use super::{backdrop, crowd, crowd_solver, globe, label, line, shadow, shell, solid};

/// Names and WGSL sources of all complete shaders.
pub fn shaders() -> [(&'static str, &'static str); 10] {
    [
        ("backdrop", backdrop::SHADER),
        ("crowd_arms", crowd::ARMS),
        ("crowd_cull", crowd::CULL),
        ("crowd_solver", crowd_solver::SHADER),
        ("globe", globe::SHADER),
        ("label", label::SHADER),
        ("line", line::SHADER),
        ("shadow", shadow::SHADER),
        ("shell", shell::SHADER),
        ("solid", solid::SHADER),
    ]
}
