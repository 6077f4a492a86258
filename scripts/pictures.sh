#!/usr/bin/env bash
# Takes pictures from the program itself: those of docs/guide.md and docs/kinematics.md in
# docs/pictures, those of the examples in assets/pictures, and README's figure. With names of examples,
# only theirs.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/window.sh
source scripts/window.sh

pictures=docs/pictures
example_pictures=assets/pictures

main() {
    set_up virtual-display
    require_tools python3:python3
    cargo build --release --locked
    trap clean_up EXIT
    mkdir -p "$pictures" "$example_pictures"/{dark,light}
    mapfile -t examples < <("$program" examples | awk '{ print $1 }')
    for example in "${@:-${examples[@]}}"; do
        picture_of_example "$example"
    done
    if (($#)); then
        return
    fi
    picture_of_window start
    picture_of_window tour gui --tour 4
    picture_of_window twist gui --tour 8
    picture_of_window race gui --tour 11
    picture_of_window figure gui --tour 12
    "$program" examples keyframes -o "$settings/keyframes.json"
    picture_of_window timeline "$settings/keyframes.json"
    picture_of_scene circle elbow-circle
    picture_of_scene limits limits
    picture_of_scene globe globe
    figure_of_readme
    printf 'The pictures are in %s\n' "$pictures"
}

# picture_of_window NAME [ARGUMENTS OF THE PROGRAM]
picture_of_window() {
    local name=$1
    shift
    open_window "$@"
    case $name in
        race) press 1065 75 ;; # Race all solvers
        tour) press 480 660 ;; # an answer
    esac
    import -window root "$pictures/$name.full.png"
    close_window
    stop_virtual_display
    shrink "$name"
}

# Pictures of an example in both themes: frames in six columns, evenly spaced in time; one frame if it
# stands still.
picture_of_example() {
    local name=$1 frames quality=(-quality 76 -strip) file all time nth theme contrast
    frames=$(mktemp -d)
    file=$frames/example.json
    "$program" examples "$name" | without_names >"$frames/given.json"
    # With the camera that frames the rig, if the example has none.
    "$program" convert "$frames/given.json" -o "$file"
    "$program" export "$file" --size 16x10 --fps 30 -o "$frames/####.png"
    all=("$frames"/*.png)
    rm "$frames"/*.png
    for theme in dark light; do
        contrast=()
        if [[ $theme == light ]]; then
            # So small, figures on a light ground look pale.
            contrast=(-sigmoidal-contrast "3,80%")
        fi
        if ((${#all[@]} == 1)); then
            come_closer "$name" "$file" 1 >"$frames/closer.json"
            "$program" render "$frames/closer.json" --theme "$theme" --size 576x360 -o "$frames/0.png"
            convert "$frames/0.png" -resize 288x180 "${contrast[@]}" "${quality[@]}" \
                "$example_pictures/$theme/$name.jpg"
            continue
        fi
        for nth in {10..33}; do
            time=$(awk "BEGIN { print (${#all[@]} - 1) / 30 * (($nth - 10 + $(first "$name")) % 24) / 24 }")
            come_closer "$name" "$file" "$time" >"$frames/closer.json"
            "$program" render "$frames/closer.json" --theme "$theme" --time "$time" --size 576x360 \
                -o "$frames/$nth.png"
        done
        montage "$frames"/[1-3]*.png -tile 6x4 -geometry 288x180+0+0 "$frames/all.png"
        convert "$frames/all.png" "${contrast[@]}" "${quality[@]}" \
            "$example_pictures/$theme/$name.jpg"
    done
    rm -r "$frames"
}

# Reads a document and writes it without names, axes and edges, which would be specks and stray lines.
without_names() {
    python3 -c '
import json, sys
document = json.load(sys.stdin)
shown = ["cursor", "skin", "trail", "paths", "grid_xz", "ground", "shadow"]
document["overlays"] = [it for it in document.get("overlays") or shown if it not in ("labels", "axes", "wireframe")]
json.dump(document, sys.stdout)'
}

# first NAME: the frame of 24 that is shown first, and while the picture does not play.
first() {
    case $1 in
        looking-at-the-hand | reaching-down) echo 7 ;; # the figure just stands before
        candy-wrapper) echo 18 ;; # twisted
        *) echo 0 ;;
    esac
}

# come_closer NAME FILE TIME: prints the document with a nearer camera if its own makes the figure tiny
# in so small a picture, and looks at the figure; the camera of the walk goes along.
come_closer() {
    local part=1 to=(0 0 0)
    case $1 in
        arm) part=0.62 to=(60 -20 10) ;;
        two-targets) part=0.65 ;;
        table) part=0.72 to=(0.05 0.14 0) ;;
        ten-joints) part=0.7 to=(-0.1 -0.02 0) ;;
        jumping-chain) part=0.7 ;;
        keyframes) part=0.9 ;;
        pulled-apart | out-of-reach) part=0.62 ;;
        inside-* | too-few-iterations) part=0.75 ;;
        locked) part=0.9 ;;
        degenerate) part=0.62 to=(0 -0.1 0) ;;
        snake) part=0.6 to=(0.55 0 0.75) ;;
        walk) part=0.68 to=(0 0 "$(awk "BEGIN { print 1.41 * ($3 - 1) }")") ;; # metres in a second
        human) part=0.88 ;;
        wheel) part=0.62 to=(0 0.26 0.1) ;;
        tadpoles) part=0.8 to=(-0.04 0 0.05) ;;
        reaching-down) part=0.8 ;;
        looking-at-the-hand) part=0.65 to=(0 0.1 0) ;;
    esac
    python3 - "$2" "$part" "${to[@]}" <<'END'
import json, sys
document = json.load(open(sys.argv[1]))
part, *to = map(float, sys.argv[2:])
if camera := document.get("camera"):
    camera["distance"] *= part
    camera["target"] = [at + by for at, by in zip(camera["target"], to)]
json.dump(document, sys.stdout)
END
}

press() {
    xdotool mousemove "$1" "$2" click 1
    wait_for_rest
    xdotool mousemove 700 400
    wait_for_rest
}

# picture_of_scene NAME SCENE
picture_of_scene() {
    "$program" render "assets/tour/$2.json" --size 1280x800 -o "$pictures/$1.full.png"
    shrink "$1"
}

# The walk in its skin and with its bones, and the skins of a twisted forearm, side by side.
figure_of_readme() {
    local frames around=grid_xz,ground,shadow
    frames=$(mktemp -d)
    nearer walk 0.62 "skin,$around" >"$frames/skin.json"
    nearer walk 0.62 "skin,bones,$around" >"$frames/bones.json"
    nearer candy-wrapper 1 "skin,compare_skinning,wireframe,labels,$around" >"$frames/twisted.json"
    "$program" render "$frames/skin.json" --time 1 --size 360x480 -o "$frames/0.png"
    "$program" render "$frames/bones.json" --time 1 --size 360x480 -o "$frames/1.png"
    "$program" render "$frames/twisted.json" --time 2 --size 540x480 -o "$frames/2.png"
    convert "$frames"/[0-2].png +append +repage -strip assets/figure.png
    rm -r "$frames"
}

# nearer NAME PART OVERLAYS: prints the example with these overlays, and its camera at a part of its
# distance.
nearer() {
    "$program" examples "$1" | python3 -c '
import json, sys
document = json.load(sys.stdin)
document["camera"]["distance"] *= float(sys.argv[1])
document["overlays"] = sys.argv[2].split(",")
json.dump(document, sys.stdout)' "$2" "$3"
}

# Colours of a palette make the files a third as large.
shrink() {
    convert "$pictures/$1.full.png" -resize 960x -colors 128 -strip "$pictures/$1.png"
    rm "$pictures/$1.full.png"
}

main "$@"
