#!/usr/bin/env bash
# Builds ik-arm and opens its demo: scripts/demo.sh [-- ARGUMENTS FOR THE PROGRAM]
# Without a display it drags the hand in a virtual one and saves a picture.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/window.sh
source scripts/window.sh

# Points between which the mouse drags the hand, in screen pixels.
hand_path=("733 376" "853 240" "700 183" "623 317" "795 288")

picture=$target/demo.png
program=$target/demo/ik-arm

main() {
    if [[ ${1-} == -- ]]; then
        shift
    elif [[ $# -gt 0 ]]; then
        printf 'usage: scripts/demo.sh [-- ARGUMENTS FOR THE PROGRAM]\n' >&2
        exit 2
    fi
    if has_display; then
        set_up
        build
        exec "$program" "$@"
    fi
    set_up virtual-display
    build
    trap clean_up EXIT
    open_window
    pose_hand
    take_picture
    close_window
    printf 'The picture is in %s\n' "$picture"
}

build() {
    cargo build --profile demo --locked
}

pose_hand() {
    local point x y from_x from_y
    read -r from_x from_y <<<"${hand_path[0]}"
    for point in "${hand_path[@]:1}"; do
        read -r x y <<<"$point"
        drag "$from_x" "$from_y" "$x" "$y"
        from_x=$x from_y=$y
    done
}

take_picture() {
    wait_for_rest
    import -window root "$picture"
}

main "$@"
