#!/usr/bin/env bash
# bench.sh [--tables]: runs the benchmarks and rewrites the tables between the marks of
# docs/performance.md. With --tables it rewrites the tables from the last run. Takes about half an hour
# on two cores of an otherwise idle machine.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh

tools=(git:git python3:python3)
page=docs/performance.md
results=${CARGO_TARGET_DIR:-target}/criterion

main() {
    set_up
    require_tools "${tools[@]}"
    if [[ ${1:-} != --tables ]]; then
        cargo bench --locked --no-default-features \
            --bench two_bone --bench batch --bench curves --bench chain_ik --bench keying
        cargo build --locked --release
    fi
    local figures
    figures=$(mktemp)
    # Into a file first, so that a failure does not leave half a page.
    {
        machine
        batch_table
        other_table
        crowd_table
        size_table
    } >"$figures"
    put_between_marks "$figures"
    rm "$figures"
    echo "Wrote $page."
}

machine() {
    local processor memory
    processor=$(lscpu | sed -n 's/^Model name: *//p' | head -1)
    memory=$(awk '$1 == "MemTotal:" { printf "%d", $2 / 1048576 }' /proc/meminfo)
    printf 'Measured on %s: %s, %s threads, %s GiB, %s; commit %s.\n\n' "$(date +%F)" \
        "$processor" "$(nproc)" "$memory" "$(rustc --version | cut -d' ' -f1-2)" \
        "$(git rev-parse --short HEAD)"
}

# estimate BENCH: median of a run in ns, by the bench's folder.
estimate() {
    local file="$results/$1/new/estimates.json"
    python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["median"]["point_estimate"])' \
        "$file"
}

batch_table() {
    printf '| arms | elbow and hand | copy | ratio | with rotations | own bones | angles | all cores |\n'
    printf '| --- | --- | --- | --- | --- | --- | --- | --- |\n'
    local size count
    for size in "4 Ki:4096" "1 Mi:1048576" "4 Mi:4194304"; do
        count=${size#*:}
        size=${size%:*}
        python3 - "$size" "$count" "$(batch "$size" "elbow and hand")" "$(batch "$size" copy)" \
            "$(batch "$size" "with rotations")" "$(batch "$size" "own bones")" \
            "$(batch "$size" angles)" "$(batch "$size" "all cores")" <<'PYTHON'
import sys
size, arms, *times = sys.argv[1:]
each = [float(time) / int(arms) for time in times]
solve, copy, *others = each
cells = [f"{solve:.2f} ns", f"{copy:.2f} ns", f"**{solve / copy:.2f}**"]
cells += [f"{other:.2f} ns" for other in others]
print(f"| {size} | " + " | ".join(cells) + " |")
PYTHON
    done
    printf '\n'
}

batch() {
    estimate "batch/$2/$1"
}

other_table() {
    printf '| benchmark | median |\n| --- | --- |\n'
    python3 - "$results" <<'PYTHON'
import json, pathlib, sys
root = pathlib.Path(sys.argv[1])
def rows(group):
    found = []
    for file in sorted(root.glob(f"{group}/**/new/estimates.json")):
        name = "/".join(file.relative_to(root).parts[:-2])
        throughput = json.loads((file.parent / "benchmark.json").read_text())["throughput"]
        elements = (throughput or {}).get("Elements", 1)
        time = json.loads(file.read_text())["median"]["point_estimate"] / elements
        found.append((name, time))
    return found
for group in ("two_bone", "twist", "spline", "chain_ik", "iteration"):
    for name, time in rows(group):
        shown = f"{time:.1f} ns" if time < 1e3 else f"{time / 1e3:.1f} µs" if time < 1e6 else f"{time / 1e6:.2f} ms"
        print(f"| {name} | {shown} |")
PYTHON
    printf '\n'
}

crowd_table() {
    printf '| arms | solved by | solve | ns per arm | frame | adapter |\n'
    printf '| --- | --- | --- | --- | --- | --- |\n'
    local arms solver
    for arms in 1000 100000 1000000; do
        for solver in cpu gpu; do
            "${CARGO_TARGET_DIR:-target}"/release/ik-arm render --crowd $arms --frames 20 --timings \
                --solve $solver | python3 -c '
import json, sys
line = json.load(sys.stdin)
solve = line["solve_ms_median"]
print("| {:,} | {} | {:.2f} ms | {:.1f} | {:.0f} ms | {} |".format(
    line["arms"], sys.argv[1], solve, solve * 1e6 / line["arms"], line["frame_ms_median"],
    line["adapter"]))' $solver
        done
    done
    printf '\n'
}

size_table() {
    printf 'The release binary: %s MB.\n' \
        "$(stat -Lc %s "${CARGO_TARGET_DIR:-target}/release/ik-arm" | awk '{ printf "%.1f", $1 / 1e6 }')"
}

put_between_marks() {
    awk -v figures="$1" '
        /<!-- figures end -->/ { skip = 0 }
        !skip { print }
        /<!-- figures begin -->/ { skip = 1; while ((getline line < figures) > 0) print line }
    ' "$page" >"$page.new"
    mv "$page.new" "$page"
}

main "$@"
