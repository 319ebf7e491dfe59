#!/usr/bin/env bash
# Set up what is missing, run the horizontal pipe at quick fidelity, say where the figures are.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
.venv/bin/mpsdem run cases/horizontal_pipe.toml --fidelity quick -o out/horizontal_pipe --overwrite
echo "Figures:" "$PWD"/out/horizontal_pipe/figures/*
