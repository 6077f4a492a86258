#!/usr/bin/env bash
# The real window on a virtual display, and a mouse in it. To be sourced.
set -euo pipefail
# shellcheck source=scripts/display.sh
source scripts/display.sh

target=${CARGO_TARGET_DIR:-target}
program=${PROGRAM:-$target/release/ik-arm}
program_pid=
settings=

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

open_window() {
    local window
    start_virtual_display
    export DISPLAY=$virtual_display
    # Remembered settings could move the arm or the panels away from hand_path.
    settings=$(mktemp -d)
    XDG_CONFIG_HOME=$settings XDG_DATA_HOME=$settings XDG_STATE_HOME=$settings \
        "$program" &
    program_pid=$!
    window=$(wait_for_window)
    # No window manager gives it the keyboard.
    xdotool windowfocus "$window"
    # Without graphics hardware, the first frames take their time.
    sleep 3
}

wait_for_window() {
    local window deadline=$((SECONDS + 60))
    until window=$(xdotool search --onlyvisible --name '^ik-arm' 2>/dev/null); do
        if ! kill -0 "$program_pid" 2>/dev/null || ((SECONDS > deadline)); then
            printf 'The window of ik-arm does not appear.\n' >&2
            return 1
        fi
        sleep 0.5
    done
    head -n 1 <<<"$window"
}

drag() {
    local x1=$1 y1=$2 x2=$3 y2=$4 step steps=12
    xdotool mousemove "$x1" "$y1" sleep 0.3 mousedown 1 sleep 0.1
    for ((step = 1; step <= steps; step++)); do
        xdotool mousemove \
            $((x1 + (x2 - x1) * step / steps)) $((y1 + (y2 - y1) * step / steps)) sleep 0.05
    done
    xdotool mouseup 1 sleep 0.3
}

close_window() {
    local deadline=$((SECONDS + 15))
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
