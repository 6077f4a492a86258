#!/usr/bin/env bash
# Times of frames while the mouse drags in the real window: scripts/drag-times.sh
# Drags the hand of an arm with all guides and orbits, then the same with a figure in its skin, once
# with every frame in full and once within 33 ms a frame. Prints histograms. Builds a release first,
# unless PROGRAM names a binary.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/window.sh
source scripts/window.sh

# Positions in the newly opened window, in pixels.
arm_hand="720 318"
beside_the_arm="420 560"
figure_hand="489 225"
beside_the_figure="420 300"
moves=250

log=$target/drag-times.log
arm=$target/drag-times-arm.json
figure=$target/drag-times-figure.json

main() {
    set_up virtual-display
    require_tools python3:python3
    if [[ -z ${PROGRAM-} ]]; then
        cargo build --release --locked
    fi
    trap clean_up EXIT
    write_arm
    "$program" examples human >"$figure"
    for budget in unlimited thirtieth; do
        measure "$budget" arm "$arm" "$arm_hand" "$beside_the_arm"
        measure "$budget" figure "$figure" "$figure_hand" "$beside_the_figure"
    done
}

# The arm with all guides.
write_arm() {
    "$program" examples arm | python3 -c '
import json, sys
document = json.load(sys.stdin)
document["overlays"] = sys.argv[1:]
json.dump(document, sys.stdout)' \
        cursor pointer inner_limit outer_limit elbow_circle cylinders hand skin \
        grid_xy grid_xz grid_yz ground axes labels shadow >"$arm"
}

# measure BUDGET NAME FILE "X Y" "X Y": with the positions of the hand and of the background.
measure() {
    local budget=$1 rig=$2 file=$3 hand=$4 beside=$5
    initial_settings="(preferences:(frame_budget:$budget,offers_tour:false,has_dragged_hand:true))"
    export RUST_LOG=warn,ik_arm=trace
    open_window "$file" 2>"$log"
    printf '\n%s, budget: %s\n' "$rig" "$budget"
    # shellcheck disable=SC2086 # two coordinates
    histogram "dragging the hand" $hand
    # shellcheck disable=SC2086
    histogram "orbiting" $beside
    close_window
    stop_virtual_display
}

# histogram WHAT X Y: drags in a circle from a point, 5 ms between moves.
histogram() {
    local what=$1 x=$2 y=$3 step first steps=()
    xdotool mousemove "$x" "$y" sleep 0.5
    first=$(wc -l <"$log")
    for ((step = 0; step < moves; step++)); do
        steps+=(mousemove_relative -- $((step % 50 < 25 ? 4 : -4)) $((step % 30 < 15 ? 3 : -3)))
        steps+=(sleep 0.005)
    done
    xdotool mousedown 1 sleep 0.1 "${steps[@]}"
    # The last frames of the drag, and the picture in full, are drawn before the button is released.
    sleep 1
    xdotool mouseup 1 sleep 1
    tail -n +$((first + 1)) "$log" | times | summary "$what"
}

# Reads a log and prints the milliseconds of each frame and the percentage of the size.
times() {
    sed -n 's/.*frame [0-9]*: \([0-9.]*\) ms at \([0-9]*\) %.*/\1 \2/p'
}

summary() {
    sort -n | awk -v what="$1" '
        { time[NR] = $1; share[$2]++; bin[int($1 / 10)]++ }
        END {
            printf "%s: %d frames, median %d ms, 95 %% within %d ms, slowest %d ms\n", what, NR,
                time[int((NR + 1) / 2)], time[int(NR * 0.95)], time[NR]
            for (i = 0; i <= int(time[NR] / 10); i++) {
                printf "  %3d–%3d ms %5d ", 10 * i, 10 * i + 9, bin[i]
                for (dots = 0; dots < 60 * bin[i] / NR; dots++) printf "#"
                print ""
            }
            for (of in share) printf "  at %d %% of the size: %d frames\n", of, share[of]
        }'
}

main "$@"
