#!/usr/bin/env bash
# The long tests: scripts/soak.sh [ACTIONS] [SEED]. First all tests with all their cases, of which
# scripts/test.sh tries a tenth; then random actions on a session, a million or ACTIONS, with progress and
# the count of each kind; on a failure the seed and a minimal sequence of actions.
set -euo pipefail
cd "$(dirname "$0")/.."

export IK_ARM_SOAK_ACTIONS=${1:-1000000} IK_ARM_SOAK_SEED=${2:-1} RUST_BACKTRACE=0

IK_ARM_ALL_CASES=1 cargo test --locked
cargo test --locked --test document -- --ignored --nocapture soak::
printf 'Everything passed in %d s.\n' "$SECONDS"
