#!/usr/bin/env bash
# Runs all checks of CI and stops at the first failure.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/display.sh
source scripts/display.sh

current_step=

main() {
    trap finish EXIT
    step "Set-up" set_up virtual-display
    step "Format" cargo fmt --all --check
    step "Lints" lint
    step "Tests" cargo test --locked
    step "Tests without threads" cargo test --locked --package ik-arm-kinematics \
        --lib --test kinematics -- batch crowd_solve skin_from_bones
    step "glTF validator" scripts/validate-gltf.sh
    step "Documentation" env RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps --all-features
    step "Window" test_window
    printf '\nEverything passed in %d s.\n' "$SECONDS"
}

finish() {
    local status=$?
    stop_virtual_display
    if [[ $status -ne 0 ]]; then
        printf '\n==> FAILED: %s\n' "$current_step" >&2
    fi
}

# step HEADING COMMAND...
step() {
    local started=$SECONDS
    current_step=$1
    shift
    printf '\n==> %s\n' "$current_step"
    "$@"
    printf '==> %s: %d s\n' "$current_step" $((SECONDS - started))
}

# Lints everything with the default features, and each package's library in its smaller sets of features.
lint() {
    local arguments
    for arguments in --all-targets "--package ik-arm-kinematics --lib" \
        "--package ik-arm --lib --no-default-features" \
        "--package ik-arm --lib --no-default-features --features render"; do
        printf '%s\n' "$arguments"
        # shellcheck disable=SC2086 # several arguments
        cargo clippy --locked $arguments -- -D warnings
    done
}

test_window() {
    # One after the other: they share the screen.
    local test=(cargo test --locked --test window -- --ignored --nocapture --test-threads=1)
    if is_linux; then
        start_virtual_display
        # A Wayland desktop would get the window instead.
        env -u WAYLAND_DISPLAY DISPLAY="$virtual_display" "${test[@]}"
        stop_virtual_display
    else
        "${test[@]}"
    fi
}

main "$@"
