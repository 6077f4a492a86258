#!/usr/bin/env bash
# Packages ik-arm for Linux: target/package/ik-arm_VERSION-1_ARCHITECTURE.deb, and a .tar.gz of the same files.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh

target=${CARGO_TARGET_DIR:-target}
packages=$target/package
program=$target/release/ik-arm
maintainer='The ik-arm developers <ik-arm@users.noreply.github.com>'
tree=

main() {
    set_up
    require_tools dpkg-deb:dpkg readelf:binutils
    cargo build --release --locked
    trap clean_up EXIT
    tree=$(mktemp -d)
    chmod 755 "$tree"
    lay_out
    pack_tar
    pack_deb
}

clean_up() {
    if [[ -n $tree ]]; then
        rm -rf "$tree"
    fi
}

version() {
    sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1
}

architecture() {
    dpkg --print-architecture
}

# Lays out all files below $tree/usr.
lay_out() {
    install_file 755 "$program" bin/ik-arm
    install_file 644 assets/linux/ik-arm.desktop share/applications/ik-arm.desktop
    install_file 644 assets/linux/io.github.ik_arm.IkArm.metainfo.xml \
        share/metainfo/io.github.ik_arm.IkArm.metainfo.xml
    install_file 644 assets/linux/ik-arm.mime.xml share/mime/packages/ik-arm.xml
    install_file 644 assets/linux/ik-arm.png share/icons/hicolor/256x256/apps/ik-arm.png
    install_file 644 assets/linux/ik-arm.svg share/icons/hicolor/scalable/apps/ik-arm.svg
    install_file 644 assets/linux/ik-arm.svg \
        share/icons/hicolor/scalable/mimetypes/application-x-ik-arm.svg
    install_completions
    install_manual
    install_documents
}

# install_file MODE FROM TO
install_file() {
    install -D -m "$1" "$2" "$tree/usr/$3"
}

install_completions() {
    complete bash share/bash-completion/completions/ik-arm
    complete zsh share/zsh/vendor-completions/_ik-arm
    complete fish share/fish/vendor_completions.d/ik-arm.fish
}

# complete SHELL TO
complete() {
    "$program" completions "$1" | install -D -m 644 /dev/stdin "$tree/usr/$2"
}

install_manual() {
    "$program" manual "$tree/usr/share/man/man1"
    compress "$tree"/usr/share/man/man1/*.1
}

install_documents() {
    local folder=share/doc/ik-arm
    install_file 644 assets/linux/copyright "$folder/copyright"
    install_file 644 CHANGELOG.md "$folder/changelog"
    dependencies | install -D -m 644 /dev/stdin "$tree/usr/$folder/dependencies"
    debian_changelog | install -D -m 644 /dev/stdin "$tree/usr/$folder/changelog.Debian"
    compress "$tree/usr/$folder"/{changelog,changelog.Debian,dependencies}
}

debian_changelog() {
    cat <<END
ik-arm ($(version)-1) unstable; urgency=medium

  * See changelog.gz.

 -- $maintainer  $(date -R -u -r CHANGELOG.md)
END
}

# compress FILE...: without names and times, so that the same files give the same package.
compress() {
    chmod 644 "$@"
    gzip -9n "$@"
}

# The crates that are linked, each with its licence, and the text of each licence.
dependencies() {
    local crates
    crates=$(cargo tree --locked --package ik-arm --edges normal --prefix none --format '{p}|{l}|{r}' |
        sed 's/ (\*)$//; s/ (proc-macro)//' | grep -v '^ik-arm' | sort -u)
    printf 'ik-arm links these crates:\n\n'
    awk -F '|' '{ printf "%s: %s, %s\n", $1, $2, $3 }' <<<"$crates"
    licence_texts "$crates"
}

# licence_texts CRATES: each text once, below the crates that have it.
licence_texts() {
    local crate name number file sum
    declare -A crates_of=() file_of=()
    while IFS='|' read -r crate _; do
        name=${crate% v*} number=${crate##* v}
        for file in "${CARGO_HOME:-$HOME/.cargo}"/registry/src/*/"$name-$number"/{LICEN[CS]E,COPYING,NOTICE}*; do
            [[ -f $file ]] || continue
            sum=$(sha256sum <"$file")
            file_of[$sum]=$file
            crates_of[$sum]+=" $name"
        done
    done <<<"$1"
    for sum in "${!file_of[@]}"; do
        printf '\n%s\n\n' "$(printf '=%.0s' {1..80})"
        # shellcheck disable=SC2086 # several names
        printf '%s\n' ${crates_of[$sum]} | sort -u | paste -sd ' ' | fold -s -w 80
        printf '\n'
        cat "${file_of[$sum]}"
    done
}

pack_tar() {
    local name
    name=ik-arm-$(version)-$(uname -m)-linux
    mkdir -p "$packages"
    tar --create --gzip --file "$packages/$name.tar.gz" --owner 0 --group 0 --sort name \
        --transform "s,^usr,$name," --directory "$tree" usr
    printf '%s\n' "$packages/$name.tar.gz"
}

pack_deb() {
    local package
    package=$packages/ik-arm_$(version)-1_$(architecture).deb
    install -d "$tree/DEBIAN"
    control >"$tree/DEBIAN/control"
    (cd "$tree" && find usr -type f -exec md5sum {} +) >"$tree/DEBIAN/md5sums"
    dpkg-deb --root-owner-group --build "$tree" "$package" >/dev/null
    printf '%s\n' "$package"
}

control() {
    cat <<END
Package: ik-arm
Version: $(version)-1
Architecture: $(architecture)
Maintainer: $maintainer
Installed-Size: $(du -sk "$tree/usr" | cut -f 1)
Depends: libc6 (>= $(least_libc)), libgcc-s1, ${window_libraries[0]#*:}$(printf ', %s' "${window_libraries[@]:1}" | sed 's/[^ ]*://g')
Recommends: mesa-vulkan-drivers
Section: graphics
Priority: optional
Description: pose a 3D inverse-kinematics arm and understand it
 Drag a hand, and the program computes the angles of shoulder and elbow. It
 shows why the elbow is where it is, where it jumps and why, and how solvers
 of longer chains find a pose, iteration by iteration.
 .
 It poses arms and whole figures, says why a target is not reached and what
 would help, and reads and writes glTF and BVH.
END
}

# The newest version of the C library that the program needs.
least_libc() {
    readelf --wide --dyn-syms "$program" | grep -o 'GLIBC_[0-9.]*' | sed 's/GLIBC_//' | sort -uV | tail -n 1
}

main "$@"
