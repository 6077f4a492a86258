#!/usr/bin/env bash
# The real window in a virtual display, driven by a mouse. To be sourced.
set -euo pipefail
# shellcheck source=scripts/display.sh
source scripts/display.sh

target=${CARGO_TARGET_DIR:-target}
program=${PROGRAM:-$target/release/ik-arm}
program_pid=
settings=
# Settings of the program, in RON; none: the defaults.
initial_settings=

clean_up() {
    if [[ -n $program_pid ]]; then
        kill "$program_pid" 2>/dev/null || true
        wait "$program_pid" 2>/dev/null || true
    fi
    stop_virtual_display
    if [[ -n $settings ]]; then
        rm -rf "$settings"
    fi
}

# open_window [ARGUMENTS OF THE PROGRAM]
open_window() {
    local window empty
    start_virtual_display
    export DISPLAY=$virtual_display
    empty=$(screen)
    # Saved settings could move the arm or the panels.
    settings=$(mktemp -d)
    mkdir "$settings/ik-arm"
    if [[ -n $initial_settings ]]; then
        printf '%s\n' "$initial_settings" >"$settings/ik-arm/settings.ron"
    fi
    XDG_CONFIG_HOME=$settings XDG_DATA_HOME=$settings XDG_STATE_HOME=$settings \
        "$program" "$@" &
    program_pid=$!
    window=$(wait_for_window)
    # There is no window manager to give it the keyboard focus.
    xdotool windowfocus "$window"
    wait_for_screen_other_than "$empty"
    wait_for_rest
}

# Checksum of the screen.
screen() {
    import -window root -depth 8 rgb:- | cksum
}

# wait_for_screen_other_than CHECKSUM
wait_for_screen_other_than() {
    local deadline=$((SECONDS + 60))
    while [[ $(screen) == "$1" ]]; do
        if ((SECONDS > deadline)); then
            printf 'The screen does not change.\n' >&2
            return 1
        fi
        sleep 0.1
    done
}

# Waits until the screen has not changed for half a second.
wait_for_rest() {
    local last now deadline=$((SECONDS + 60))
    now=$(screen)
    until [[ $now == "${last-}" ]]; do
        if ((SECONDS > deadline)); then
            printf 'The screen does not come to rest.\n' >&2
            return 1
        fi
        sleep 0.5
        last=$now
        now=$(screen)
    done
}

wait_for_window() {
    local window deadline=$((SECONDS + 60))
    until window=$(xdotool search --onlyvisible --pid "$program_pid" 2>/dev/null); do
        if ! kill -0 "$program_pid" 2>/dev/null || ((SECONDS > deadline)); then
            printf 'The window of ik-arm does not appear.\n' >&2
            return 1
        fi
        sleep 0.5
    done
    head -n 1 <<<"$window"
}

# drag X1 Y1 X2 Y2: at the speed of a human hand. The first steps are short, because a frame may
# receive them together with the press.
drag() {
    local x1=$1 y1=$2 x2=$3 y2=$4 step steps=12
    local square=$((steps * steps))
    xdotool mousemove "$x1" "$y1" sleep 0.3 mousedown 1 sleep 0.1
    for ((step = 1; step <= steps; step++)); do
        xdotool mousemove $((x1 + (x2 - x1) * step * step / square)) \
            $((y1 + (y2 - y1) * step * step / square)) sleep 0.05
    done
    xdotool mouseup 1 sleep 0.3
}

close_window() {
    local deadline=$((SECONDS + 60))
    # Without changes it does not ask whether to save them.
    xdotool key --repeat 40 --delay 20 ctrl+z
    xdotool key ctrl+q
    while kill -0 "$program_pid" 2>/dev/null; do
        if ((SECONDS > deadline)); then
            printf 'ik-arm does not close on Ctrl+Q.\n' >&2
            return 1
        fi
        sleep 0.2
    done
    wait "$program_pid"
    program_pid=
}
