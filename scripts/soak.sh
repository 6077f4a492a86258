#!/usr/bin/env bash
# Soak test of a session: scripts/soak.sh [ACTIONS] [SEED]. Applies random actions and prints progress
# and the count of each kind; on a failure the seed and a minimal sequence of actions.
set -euo pipefail
cd "$(dirname "$0")/.."

export IK_ARM_SOAK_ACTIONS=${1:-1000000} IK_ARM_SOAK_SEED=${2:-1} RUST_BACKTRACE=0

exec cargo test --locked --release --no-default-features --test document -- \
    --ignored --nocapture soak::
