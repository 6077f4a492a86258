#!/usr/bin/env bash
# Builds the page that runs the program in a browser: target/web. Copy that folder to any web server.
# scripts/web.sh [--serve | --tools]: --serve then serves it on this computer alone, at
# http://127.0.0.1:8080; --tools only looks whether the tools for it are there.
set -euo pipefail
cd "$(dirname "$0")/.."

triple=wasm32-unknown-unknown
target=${CARGO_TARGET_DIR:-target}
page=$target/web
# CARGO names another cargo with a standard library for the web, WASM its folder of builds.
cargo=${CARGO:-cargo}

main() {
    require_tools
    if [[ ${1-} == --tools ]]; then
        return
    fi
    "$cargo" build --locked --profile web --target "$triple" --bin ik-arm
    rm -rf "$page"
    mkdir -p "$page"
    wasm-bindgen "${WASM:-$target}/$triple/web/ik-arm.wasm" \
        --target web --no-typescript --remove-name-section --remove-producers-section \
        --out-dir "$page" --out-name ik-arm
    cp assets/web/index.html assets/icon-64.png docs/pictures/start.png "$page"
    make_kinematics_page
    printf 'The page is %s: %s, %s compressed.\n' "$page" "$(size <"$page/ik-arm_bg.wasm")" \
        "$(gzip -9 <"$page/ik-arm_bg.wasm" | size)"
    if [[ ${1-} == --serve ]]; then
        printf 'Open http://127.0.0.1:8080\n'
        exec python3 -m http.server --bind 127.0.0.1 --directory "$page" 8080
    fi
}

# The kinematics of docs, with a live figure at each thing to try.
make_kinematics_page() {
    if ! command -v cmark-gfm python3 >/dev/null; then
        printf 'Left out: kinematics.html, which needs cmark-gfm and python3 (Debian: cmark-gfm).\n'
        return
    fi
    cmark-gfm --unsafe -e table docs/kinematics.md | python3 scripts/live-page.py \
        >"$page/kinematics.html"
    mkdir -p "$page/pictures"
    cp docs/pictures/{circle,limits,globe}.png "$page/pictures"
}

# Says what is to be installed, and how.
require_tools() {
    local version missing=0
    version=$(sed -n '/^name = "wasm-bindgen"$/{n;s/version = "\(.*\)"/\1/p}' Cargo.lock)
    if [[ $cargo == cargo ]] && ! rustc --print target-libdir --target "$triple" | xargs test -d; then
        printf 'The standard library for the web is missing:  rustup target add %s\n' "$triple" >&2
        missing=1
    fi
    if [[ $(wasm-bindgen --version 2>/dev/null) != "wasm-bindgen $version" ]]; then
        printf 'wasm-bindgen %s is missing:  cargo install wasm-bindgen-cli --version %s --locked\n' \
            "$version" "$version" >&2
        missing=1
    fi
    ((missing == 0))
}

size() {
    wc -c | awk '{ printf "%.1f MB", $1 / 1e6 }'
}

main "$@"
