#!/usr/bin/env bash
# Films the hand being dragged in the real window, for README.md: assets/demo.gif.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/window.sh
source scripts/window.sh

# The scene of the tour's first step.
scene=assets/tour/over-the-shoulder.json
# Places on screen, in pixels: the hand's red arrow, how far it is dragged, and the ellipse that the
# circle of elbows is there, by its centre and half axes.
arrow=(822 285)
way=(-300 -46)
centre=(667 420)
long_axis=(88 66)
short_axis=(-33 44)
steps=30

frames=$target/record
film=assets/demo.gif
frame=0

main() {
    set_up virtual-display
    require_tools ffmpeg:ffmpeg
    cargo build --release --locked
    trap clean_up EXIT
    open_window "$scene"
    press 534 697 # "Just play"
    rm -rf "$frames"
    mkdir -p "$frames"
    drag_hand_over_shoulder_and_back
    drag_elbow_around
    close_window
    join_frames
    printf 'The film is %s\n' "$film"
}

press() {
    xdotool mousemove "$1" "$2" click 1
    wait_for_rest
}

# The elbow jumps on the way, and jumps back.
drag_hand_over_shoulder_and_back() {
    drag "${arrow[@]}" $((2 * steps)) '
        part = (1 - cos(turn)) / 2
        printf "%d %d", x + part * wx, y + part * wy'
}

# Once around its circle.
drag_elbow_around() {
    local start
    start=$(along_ellipse 0)
    # shellcheck disable=SC2086 # two numbers
    drag $start $((2 * steps)) '
        printf "%d %d", cx - cos(turn) * lx - sin(turn) * sx, cy - cos(turn) * ly - sin(turn) * sy'
}

along_ellipse() {
    awk -v turn="$1" -v cx="${centre[0]}" -v cy="${centre[1]}" -v lx="${long_axis[0]}" -v ly="${long_axis[1]}" \
        'BEGIN { printf "%d %d", cx - cos(turn) * lx, cy - cos(turn) * ly }'
}

# drag X Y STEPS PATH: presses at the place and follows the path, an awk program that prints the place
# for `turn` from 0 to a full turn. One picture per step, taken when the window is at rest, so that the
# film is smooth on a slow machine.
drag() {
    local step place
    xdotool mousemove "$1" "$2"
    wait_for_rest
    xdotool mousedown 1
    for ((step = 0; step <= $3; step++)); do
        place=$(awk -v t="$step" -v n="$3" -v x="$1" -v y="$2" -v wx="${way[0]}" -v wy="${way[1]}" \
            -v cx="${centre[0]}" -v cy="${centre[1]}" -v lx="${long_axis[0]}" -v ly="${long_axis[1]}" \
            -v sx="${short_axis[0]}" -v sy="${short_axis[1]}" \
            "BEGIN { turn = 6.2831853 * t / n; $4 }")
        # shellcheck disable=SC2086 # two numbers
        xdotool mousemove $place
        wait_for_rest
        import -window root "$frames/$(printf %03d "$frame").png"
        frame=$((frame + 1))
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
