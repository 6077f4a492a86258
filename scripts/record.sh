#!/usr/bin/env bash
# Films the hand being dragged in the real window, for README.md: assets/demo.gif.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/window.sh
source scripts/window.sh

# Closed curve of the hand on screen: centre and radii, in pixels.
middle=(733 376)
across=90
up=75
steps=72

frames=$target/record
film=assets/demo.gif

main() {
    set_up virtual-display
    require_tools ffmpeg:ffmpeg
    cargo build --release --locked
    trap clean_up EXIT
    open_window
    press_just_play_and_elbow_circle
    rm -rf "$frames"
    mkdir -p "$frames"
    drag_around
    close_window
    join_frames
    printf 'The film is %s\n' "$film"
}

press_just_play_and_elbow_circle() {
    local place
    for place in '439 697' '16 336'; do
        # shellcheck disable=SC2086 # two numbers
        xdotool mousemove $place click 1
        wait_for_rest
    done
}

# One picture per step, taken when the window is at rest, so that the film is smooth on a slow machine.
drag_around() {
    local step place
    xdotool mousemove "${middle[@]}"
    wait_for_rest
    xdotool mousedown 1
    for ((step = 0; step <= steps; step++)); do
        place=$(awk -v t="$step" -v n="$steps" -v x="${middle[0]}" -v y="${middle[1]}" \
            -v a="$across" -v b="$up" 'BEGIN {
                turn = 6.2831853 * t / n
                printf "%d %d", x + a * sin(turn), y - b * (1 - cos(turn)) + 0.4 * b * sin(2 * turn)
            }')
        # shellcheck disable=SC2086 # two numbers
        xdotool mousemove $place
        wait_for_rest
        import -window root "$frames/$(printf %03d "$step").png"
    done
    xdotool mouseup 1
}

join_frames() {
    local scale="fps=24,scale=960:-1:flags=lanczos"
    ffmpeg -loglevel error -y -framerate 24 -i "$frames/%03d.png" -filter_complex \
        "$scale,split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse=dither=bayer:bayer_scale=4" \
        -loop 0 "$film"
}

main "$@"
