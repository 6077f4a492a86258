#!/usr/bin/env bash
# Runs all checks of CI and stops at the first failure.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/display.sh
source scripts/display.sh

current_step=
window_log=${CARGO_TARGET_DIR:-target}/window-tests.log
window_tests=

main() {
    trap finish EXIT
    step "Set-up" set_up virtual-display
    step "Format" cargo fmt --all --check
    step "Tests" run_tests
    # Tests of the window wait more than they compute; they wait while the compiler works.
    test_window >"$window_log" 2>&1 &
    window_tests=$!
    step "glTF validator" scripts/validate-gltf.sh
    step "Lints" lint
    step "Documentation" env RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps --all-features
    step "Tests without threads" test_without_threads
    step "Window" end_of_window_tests
    step "Browser" test_web
    printf '\nEverything passed in %d s.\n' "$SECONDS"
}

finish() {
    local status=$?
    if [[ -n $window_tests ]]; then
        # With the display that it has started.
        kill "$window_tests" 2>/dev/null || true
        wait "$window_tests" 2>/dev/null || true
    fi
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

# Tests of both packages. cargo-nextest, where it is installed, names slow and hanging tests; it runs
# each test in a process of its own, and none of those in documentation.
run_tests() {
    if cargo nextest --version >/dev/null 2>&1; then
        cargo nextest run --locked --no-fail-fast
        cargo test --locked --doc
    else
        cargo test --locked
    fi
}

# Only code under the feature `parallel` differs without it. Unoptimised, because it is compiled for this
# alone.
test_without_threads() {
    cargo test --locked --package ik-arm-kinematics --lib --test batches \
        --config profile.dev.package.ik-arm-kinematics.opt-level=0
}

# Lints everything with the default features, and each package's library in its smaller sets of features.
lint() {
    local arguments
    for arguments in --all-targets "--package ik-arm --lib --no-default-features" \
        "--package ik-arm-kinematics --lib"; do
        printf '%s\n' "$arguments"
        # shellcheck disable=SC2086 # several arguments
        cargo clippy --locked $arguments -- -D warnings
    done
}

test_window() {
    trap end_test_window EXIT
    # One after the other: they share the screen.
    local test=(cargo test --locked --test window -- --ignored --nocapture --test-threads=1)
    if is_linux; then
        start_virtual_display
        # A Wayland desktop would get the window instead.
        env -u WAYLAND_DISPLAY DISPLAY="$virtual_display" "${test[@]}" &
    else
        "${test[@]}" &
    fi
    # In the background, so that a signal ends it at once.
    wait $!
}

end_test_window() {
    # shellcheck disable=SC2046 # none or one
    kill $(jobs -p) 2>/dev/null || true
    stop_virtual_display
}

# The page in headless Chromium, where the tools that build and drive it are there.
test_web() {
    if ! scripts/web.sh --tools || ! command -v chromedriver python3 >/dev/null; then
        printf 'SKIPPED: the page was not built and not tested. Besides the tools named above, the tests need chromedriver (Debian: chromium-driver) and python3.\n'
        return
    fi
    scripts/web.sh
    IK_ARM_PAGE=${CARGO_TARGET_DIR:-target}/web \
        cargo test --locked --test web -- --ignored --test-threads=1
}

end_of_window_tests() {
    local tests=$window_tests status=0
    window_tests=
    wait "$tests" || status=$?
    cat "$window_log"
    return "$status"
}

main "$@"
