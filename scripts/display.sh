#!/usr/bin/env bash
# Virtual display for the window. To be sourced.
set -euo pipefail

virtual_display_pid=

has_display() {
    [[ $(uname -s) != Linux || -n ${DISPLAY-} || -n ${WAYLAND_DISPLAY-} ]]
}

# Sets virtual_display to the new DISPLAY. The caller stops it, on failure too.
start_virtual_display() {
    local log=${CARGO_TARGET_DIR:-target}/xvfb.log number
    exec 3< <(exec Xvfb -displayfd 3 -screen 0 1280x800x24 -dpi 96 -nolisten tcp -noreset \
        3>&1 >"$log" 2>&1)
    virtual_display_pid=$!
    if ! read -r -t 30 number <&3; then
        printf 'Xvfb does not start:\n%s\n' "$(<"$log")" >&2
        return 1
    fi
    exec 3<&-
    # For the scripts that source this one.
    # shellcheck disable=SC2034
    virtual_display=:$number
}

stop_virtual_display() {
    if [[ -n $virtual_display_pid ]]; then
        kill "$virtual_display_pid" 2>/dev/null || true
        wait "$virtual_display_pid" 2>/dev/null || true
        virtual_display_pid=
    fi
}
