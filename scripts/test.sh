#!/usr/bin/env bash
# Set up what is missing, run the tests. usage: scripts/test.sh [PYTEST ARGUMENT]...
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh test check
.venv/bin/pytest "$@"
