#!/usr/bin/env bash
# fuzz.sh [SECONDS] [TARGET...]: runs every target, or the named ones, for 600 s or SECONDS each, and
# fails on a finding. See fuzz/README.md.
set -euo pipefail
cd "$(dirname "$0")/.."

targets=(document js3d bvh urdf obj gltf json_lines two_bone chain)
target_folder=$(realpath -m "${CARGO_TARGET_DIR:-fuzz/target}")
logs=$target_folder/logs
found=()

main() {
    local seconds=${1:-600} target
    if [[ ! $seconds =~ ^[0-9]+$ ]]; then
        fail "$seconds is not a number of seconds"
    fi
    [[ $# -le 1 ]] || targets=("${@:2}")
    for target in "${targets[@]}"; do
        [[ -f fuzz/fuzz_targets/$target.rs ]] || fail "$target is not a target"
    done
    check_tools
    mkdir -p "$logs"
    for target in "${targets[@]}"; do
        fuzz "$target" "$seconds"
    done
    print_table
    if [[ ${#found[@]} -gt 0 ]]; then
        fail "found something with ${found[*]}: see fuzz/artifacts and fuzz/README.md"
    fi
}

check_tools() {
    cargo +nightly --version >/dev/null 2>&1 ||
        fail "nightly Rust is missing: rustup toolchain install nightly --profile minimal"
    cargo fuzz --version >/dev/null 2>&1 ||
        fail "cargo-fuzz is missing: cargo install cargo-fuzz --locked"
}

# fuzz TARGET SECONDS
fuzz() {
    local target=$1 folder options
    local folders=("fuzz/corpus/$target")
    for folder in fuzz/{seeds,regressions}/"$target"; do
        [[ ! -d $folder ]] || folders+=("$folder")
    done
    mkdir -p "${folders[0]}"
    # The timeout counts wall-clock time, so it must allow for a busy machine.
    options=(-max_total_time="$2" -timeout=30 -rss_limit_mb=2048 -max_len="$(longest "$target")"
        -print_final_stats=1)
    if [[ -f fuzz/dictionaries/$target.dict ]]; then
        options+=(-dict="fuzz/dictionaries/$target.dict")
    fi
    printf '\n==> %s\n' "$target"
    # The crate has no unsafe code, and without a sanitizer the fuzzer runs twice as fast.
    local run=(cargo +nightly fuzz run --sanitizer none --codegen-units 16
        --target-dir "$target_folder" "$target" "${folders[@]}")
    if ! nice -n 19 "${run[@]}" -- "${options[@]}" >"$logs/$target.log" 2>&1; then
        grep -m 1 -A 2 'panicked at' "$logs/$target.log" | cut -c 1-1000 >&2 ||
            tail -n 5 "$logs/$target.log" | cut -c 1-1000 >&2
        found+=("$target")
    fi
}

# In bytes.
longest() {
    case $1 in
        two_bone) printf 256 ;;
        chain) printf 768 ;;
        *) printf 16384 ;;
    esac
}

print_table() {
    local target
    printf '\n%-12s %12s %10s %10s %10s\n' target executions per_second coverage features
    for target in "${targets[@]}"; do
        awk -v target="$target" '
            /^stat::number_of_executed_units/ { executions = $2 }
            /^stat::average_exec_per_sec/ { rate = $2 }
            match($0, / cov: [0-9]+/) { coverage = substr($0, RSTART + 6, RLENGTH - 6) }
            match($0, / ft: [0-9]+/) { features = substr($0, RSTART + 5, RLENGTH - 5) }
            END { printf "%-12s %12d %10d %10d %10d\n", target, executions, rate, coverage, features }
        ' "$logs/$target.log"
    done
}

fail() {
    printf 'fuzz.sh: %s\n' "$1" >&2
    exit 1
}

main "$@"
