#!/usr/bin/env bash
# Installs what ik-arm needs and this system lacks. Run it, or source it and call set_up.
set -euo pipefail

# command:Debian package
build_tools=(cc:gcc pkg-config:pkg-config)
screen_tools=(Xvfb:xvfb xdotool:xdotool import:imagemagick)
# library:Debian package. They are loaded at run time, so the build does not notice missing ones.
window_libraries=(
    libvulkan.so.1:libvulkan1
    libxkbcommon-x11.so.0:libxkbcommon-x11-0
    libXcursor.so.1:libxcursor1
    libXrandr.so.2:libxrandr2
    libXi.so.6:libxi6
    libX11-xcb.so.1:libx11-xcb1
)

# set_up [virtual-display]: with the argument, also installs a virtual display.
set_up() {
    local tools=("${build_tools[@]}")
    if [[ ${1-} == virtual-display ]] && is_linux; then
        tools+=("${screen_tools[@]}")
    fi
    require_tools "${tools[@]}"
    find_cargo || install_rust
    check_rust_version
}

# require_tools COMMAND:PACKAGE...: installs the commands that are missing, or names them and fails.
require_tools() {
    if has_command apt-get; then
        install_packages "$@"
    else
        name_what_is_missing "$@"
    fi
}

is_linux() {
    [[ $(uname -s) == Linux ]]
}

has_command() {
    command -v "$1" >/dev/null
}

install_packages() {
    local entry package missing=()
    for entry in "$@"; do
        has_command "${entry%%:*}" || missing+=("${entry#*:}")
    done
    for package in libc6-dev mesa-vulkan-drivers "${window_libraries[@]#*:}"; do
        has_package "$package" || missing+=("$package")
    done
    if ! find_cargo; then
        for package in curl ca-certificates; do
            has_package "$package" || missing+=("$package")
        done
    fi
    if [[ ${#missing[@]} -eq 0 ]]; then
        return
    fi

    if [[ $(id -u) -ne 0 ]] && ! has_command sudo; then
        fail "these packages are missing, and only root can install them: ${missing[*]}"
    fi
    say "installing ${missing[*]}"
    as_root apt-get update
    # A newly booted machine may still run its own updates.
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 \
        install -y --no-install-recommends "${missing[@]}"
}

has_package() {
    grep -qx installed <<<"$(dpkg-query -W -f '${db:Status-Status}\n' "$1" 2>/dev/null)"
}

# Also looks in rustup's folder, which is not on the PATH of shells opened before the installation.
find_cargo() {
    local bin=${CARGO_HOME:-$HOME/.cargo}/bin
    if ! has_command cargo && [[ -x $bin/cargo ]]; then
        PATH=$bin:$PATH
    fi
    has_command cargo
}

fail() {
    say "$1"
    exit 1
}

say() {
    printf 'set-up: %s\n' "$1" >&2
}

as_root() {
    if [[ $(id -u) -eq 0 ]]; then
        "$@"
    else
        sudo "$@"
    fi
}

install_rust() {
    say "installing Rust with rustup"
    curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs |
        sh -s -- -y --no-modify-path --profile minimal --component rustfmt --component clippy
    find_cargo || fail "rustup ended without installing cargo"
}

name_what_is_missing() {
    local entry missing=()
    for entry in "$@"; do
        has_command "${entry%%:*}" || missing+=("${entry%%:*}")
    done
    find_cargo || missing+=("cargo (Rust $(wanted_rust) or newer, from https://rustup.rs)")
    if is_linux; then
        name_missing_libraries
    fi
    if [[ ${#missing[@]} -gt 0 ]]; then
        say "there is no apt-get to install what is missing; please install:"
        printf '  %s\n' "${missing[@]}" >&2
        exit 1
    fi
}

wanted_rust() {
    sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml
}

# A warning only: libraries may be where ldconfig does not look.
name_missing_libraries() {
    local entry known missing=()
    known=$(PATH=$PATH:/usr/sbin:/sbin ldconfig -p 2>/dev/null || true)
    for entry in "${window_libraries[@]}"; do
        [[ $known == *"${entry%%:*}"* ]] || missing+=("${entry%%:*}")
    done
    if ! compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null &&
        ! compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null; then
        missing+=("a Vulkan driver (Mesa's lavapipe is enough)")
    fi
    if [[ ${#missing[@]} -gt 0 ]]; then
        say "not found; if the window does not open, please install:"
        printf '  %s\n' "${missing[@]}" >&2
    fi
}

check_rust_version() {
    local wanted found
    wanted=$(wanted_rust)
    found=$(cargo --version) || fail "$(command -v cargo) does not run"
    if ! is_at_least "$wanted" "$found"; then
        fail "ik-arm needs Rust $wanted or newer, but $(command -v cargo) is $found; \
update it with 'rustup update stable', or see https://rustup.rs"
    fi
}

# is_at_least 1.95 'cargo 1.96.0 (...)'
is_at_least() {
    local wanted found
    wanted=${1#*.}
    [[ $2 =~ ^cargo\ ([0-9]+)\.([0-9]+) ]] || return 1
    found=${BASH_REMATCH[2]}
    ((BASH_REMATCH[1] > ${1%%.*})) ||
        ((BASH_REMATCH[1] == ${1%%.*} && found >= ${wanted%%.*}))
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
    cd "$(dirname "$0")/.."
    set_up virtual-display
fi
