#!/usr/bin/env bash
# Exports every example, with and without keys, and runs the Khronos glTF validator on the files.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/setup.sh
source scripts/setup.sh

# A package without dependencies, so node alone runs it.
validator=gltf-validator-2.0.0-dev.3.10
url=https://registry.npmjs.org/gltf-validator/-/$validator.tgz
sha512=a1d278934b519065e20c69fbf320c183e7c16c022f0675f187747002d6b47a64b11adc9a80513c078c442c1d6861edd2e510fc0a2dee640b1969ab1c1f62c011
tools=(node:nodejs curl:curl)
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
files=$target/gltf

main() {
    set_up
    require_tools "${tools[@]}"
    install_validator
    export_files
    validate_files
}

install_validator() {
    local folder=$target/$validator archive
    if [[ ! -d $folder ]]; then
        say "downloading $validator"
        archive=$(mktemp)
        curl --proto '=https' --tlsv1.2 -sSf -o "$archive" "$url"
        sha512sum --quiet --check <<<"$sha512  $archive"
        mkdir -p "$folder/node_modules/gltf-validator"
        tar --extract --gzip --file "$archive" --strip-components 1 \
            --directory "$folder/node_modules/gltf-validator"
        rm "$archive"
    fi
    export NODE_PATH=$folder/node_modules
}

export_files() {
    rm -rf "$files"
    mkdir -p "$files"
    IK_ARM_GLB_DIR=$files cargo test --locked --test files -- --ignored --exact \
        gltf::export::every_file_is_written_for_the_validator
}

# Fails at any error, warning, information or hint.
validate_files() {
    node - "$files"/*.glb <<'SCRIPT'
const { readFileSync } = require("fs");
const { basename } = require("path");
const { validateBytes } = require("gltf-validator");

async function main(paths) {
    let issues = 0;
    for (const path of paths) {
        const report = await validateBytes(new Uint8Array(readFileSync(path)));
        for (const { severity, code, message, pointer } of report.issues.messages) {
            const kind = ["error", "warning", "information", "hint"][severity];
            console.log(`${basename(path)}: ${kind} ${code} at ${pointer}: ${message}`);
            issues += 1;
        }
    }
    console.log(`${paths.length} files, ${issues} issues`);
    process.exitCode = paths.length > 0 && issues === 0 ? 0 : 1;
}

main(process.argv.slice(2)).catch((error) => {
    console.error(error);
    process.exitCode = 1;
});
SCRIPT
}

main "$@"
