#!/usr/bin/env bash
# Soaks a session in random actions: scripts/soak.sh [ACTIONS] [SEED]. Prints how far it is and how
# often each action was done; of one that breaks something, the seed and the least that breaks it.
set -euo pipefail
cd "$(dirname "$0")/.."

export IK_ARM_SOAK_ACTIONS=${1:-1000000} IK_ARM_SOAK_SEED=${2:-1} RUST_BACKTRACE=0

exec cargo test --locked --release --no-default-features --features document --test soak -- \
    --ignored --nocapture
