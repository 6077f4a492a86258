#!/usr/bin/env bash
# Soak test of the real window: scripts/soak-window.sh [SECONDS, at least 60, default 600]
# Resizes, hides, shows, drags, orbits, plays and undoes. Fails if the program ends, logs an error,
# leaks memory, or draws while idle. Builds a release first, unless PROGRAM names a binary.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh
# shellcheck source=scripts/window.sh
source scripts/window.sh

# Positions in the newly opened window, in pixels.
open_timeline=("1225 755")
# Positions while the timeline is open.
hand_path=("720 318" "815 204" "688 157" "624 268" "720 318")
spin_slider=("85 221" "170 221")
beside_the_arm=("400 540" "520 500")
middle_of_the_ruler=("730 640")
to_the_start=("20 755")
nowhere=("640 12")

# From the second quarter of the time to the last, memory may grow by 2 % or by this many KiB (one
# screen of glyphs).
growth_of_noise=4096

log=$target/soak-window.log
samples=$target/soak-window.csv
window=

main() {
    local seconds=${1:-600}
    if [[ ! $seconds =~ ^[0-9]+$ ]] || ((seconds < 60)); then
        printf 'usage: scripts/soak-window.sh [SECONDS, at least 60]\n' >&2
        exit 2
    fi
    set_up virtual-display
    if [[ -z ${PROGRAM-} ]]; then
        cargo build --release --locked
    fi
    trap clean_up EXIT
    # Each frame is a line of the log.
    export RUST_LOG=warn,ik_arm=trace
    open_window 2>"$log"
    window=$(xdotool search --onlyvisible --name '^ik-arm' | head -n 1)
    xdotool windowmove "$window" 0 0
    printf 'time,frames,kib\n' >"$samples"

    SECONDS=0
    printf '%-28s %8s %8s %10s\n' "" "time s" "frames" "memory MiB"
    report "start"
    key_a_motion
    storm_of_sizes $((seconds / 10))
    report "after the storm of sizes"
    hide_and_show $((seconds / 20))
    report "after hiding and showing"
    while ((SECONDS < seconds)); do
        wear_once
    done
    report "after all"
    check_rest
    check_log
    check_memory "$seconds"
    printf 'The window is as it should be.\n'
}

fail() {
    printf 'FAILED: %s\n' "$1" >&2
    tail -n 5 "$log" | grep -v 'drawn$' >&2 || true
    exit 1
}

# --- measurements ---

memory() {
    awk '$1 == "VmRSS:" { print $2 }' "/proc/$program_pid/status"
}

frames() {
    grep -c 'drawn$' "$log" || true
}

# In hundredths of a second.
cpu_time() {
    awk '{ sub(/.*\) /, ""); print $12 + $13 }' "/proc/$program_pid/stat"
}

sample() {
    kill -0 "$program_pid" 2>/dev/null || fail "the program has ended after $SECONDS s"
    printf '%d,%d,%d\n' "$SECONDS" "$(frames)" "$(memory)" >>"$samples"
}

report() {
    sample
    printf '%-28s %8d %8d %10.1f\n' "$1" "$SECONDS" "$(frames)" \
        "$(awk -v kib="$(memory)" 'BEGIN { print kib / 1024 }')"
}

# --- actions ---

place() {
    # shellcheck disable=SC2086 # two numbers
    xdotool mousemove $1 sleep 0.1
}

# wipe POINT...: drags from each point to the next.
wipe() {
    local from=$1 to
    shift
    for to in "$@"; do
        # shellcheck disable=SC2086 # two numbers each
        drag $from $to
        from=$to
    done
}

press() {
    xdotool key --delay 30 "$@" sleep 0.2
}

click() {
    place "$1"
    xdotool click 1 sleep 0.3
}

# Keys the hand and a raised hand half a timeline later.
key_a_motion() {
    click "${open_timeline[0]}"
    place "${beside_the_arm[0]}"
    xdotool click 1
    press shift+k
    click "${middle_of_the_ruler[0]}"
    wipe "${hand_path[0]}" "${hand_path[1]}"
    press shift+k
    click "${to_the_start[0]}"
}

size() {
    xdotool windowsize "$window" "$1" "$2" sleep 0.1
}

# Includes sizes that no window manager would set.
storm_of_sizes() {
    local end=$((SECONDS + $1)) count=0
    local corners=("640 400" "320 200" "2560 1600" "1 1" "64 1200" "2000 40" "960 600")
    while ((SECONDS < end)); do
        # shellcheck disable=SC2086 # two numbers
        size ${corners[count % ${#corners[@]}]}
        size $((200 + RANDOM % 1800)) $((150 + RANDOM % 1100))
        count=$((count + 1))
        ((count % 10)) || sample
    done
    size 1280 800
    sleep 2
    printf '%d sizes\n' $((2 * count))
}

# Plays while hidden: a hidden window must not draw without a frame limit.
hide_and_show() {
    local end=$((SECONDS + $1))
    while ((SECONDS < end)); do
        hide_once
        sample
    done
    printf 'Hidden and playing for 1 s: %d ms of CPU time\n' $((10 * hidden_cpu))
}

# Sets hidden_cpu.
hide_once() {
    local before
    press space
    xdotool windowunmap "$window" sleep 1
    before=$(cpu_time)
    xdotool sleep 1
    hidden_cpu=$(($(cpu_time) - before))
    xdotool windowmap "$window" sleep 0.5 windowfocus "$window" sleep 0.3
    press space
    click "${to_the_start[0]}"
}

wear_once() {
    local size
    wipe "${hand_path[@]}"
    sample
    press ctrl+z ctrl+z ctrl+z ctrl+z
    wipe "${spin_slider[@]}"
    press ctrl+z
    wipe "${beside_the_arm[@]}" "${beside_the_arm[0]}"
    sample
    press space
    xdotool sleep 3
    press space
    click "${to_the_start[0]}"
    sample
    for size in "640 400" "1920 1080" "700 900" "1400 500" "1280 800"; do
        # shellcheck disable=SC2086 # two numbers
        size $size
    done
    hide_once
    sample
}

# --- checks ---

check_rest() {
    local frames_before cpu_before drawn used
    place "${nowhere[0]}"
    sleep 4
    frames_before=$(frames) cpu_before=$(cpu_time)
    sleep 5
    drawn=$(($(frames) - frames_before)) used=$(($(cpu_time) - cpu_before))
    printf 'At rest for 5 s: %d frames, %d ms of CPU time\n' "$drawn" $((10 * used))
    ((drawn == 0)) || fail "the window draws while nothing happens"
    ((used <= 5)) || fail "the program works while nothing happens"
}

check_log() {
    if grep -E 'ERROR|WARN +ik_arm|panicked' "$log" >&2; then
        fail "the program reports errors"
    fi
}

check_memory() {
    local second last
    second=$(median_memory $(($1 / 4)) $(($1 / 2)))
    last=$(median_memory $(($1 * 3 / 4)) "$1")
    printf 'Memory, medians: %d KiB in the second quarter, %d in the last\n' "$second" "$last"
    ((last - second <= growth_of_noise || (last - second) * 50 <= second)) ||
        fail "memory grows"
}

# median_memory FROM TO: in seconds.
median_memory() {
    awk -F , -v from="$1" -v to="$2" 'NR > 1 && $1 >= from && $1 <= to { print $3 }' "$samples" |
        sort -n | awk '{ value[NR] = $1 } END { print value[int((NR + 1) / 2)] }'
}

main "$@"
