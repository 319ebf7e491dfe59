#!/usr/bin/env bash
# Install this clone into .venv, from nothing but Python 3.11+ and a C++20 compiler.
# usage: scripts/setup.sh [EXTRA]...      extras of pyproject.toml: test, check
# Does nothing where nothing changed since the last call.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf 'setup: %s\n' "$*" >&2; }

# Install system packages where we may; else say what is missing, and stop.
install() {
    local reason=$1 apt=()
    shift
    if command -v apt-get >/dev/null; then
        if [ "$(id -u)" = 0 ]; then
            apt=(apt-get)
        elif sudo -n true 2>/dev/null; then
            apt=(sudo -n apt-get)
        fi
    fi
    if [ ${#apt[@]} = 0 ]; then
        say "$reason."
        say "It cannot be installed from here: that needs apt-get as root, or sudo without a password."
        say "Install it (on Debian and Ubuntu: sudo apt-get install $*) and run this again."
        exit 1
    fi
    say "$reason: installing $* ..."
    "${apt[@]}" update -qq
    "${apt[@]}" install -y -qq --no-install-recommends "$@" >/dev/null
}

find_python() {
    local candidate
    for candidate in python3 python3.14 python3.13 python3.12 python3.11; do
        if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            python=$candidate
            return
        fi
    done
    return 1
}

python_makes_environments() { "$python" -c 'import ensurepip, venv' 2>/dev/null; }

python_has_headers() {
    "$python" -c 'import pathlib, sys, sysconfig
sys.exit(not pathlib.Path(sysconfig.get_path("include"), "Python.h").exists())'
}

compiler_works() {
    echo '#include <concepts>' | "${CXX:-c++}" -std=c++20 -fopenmp -fsyntax-only -x c++ - 2>/dev/null
}

find_python || install "Python 3.11 or newer is missing" python3
find_python || { say "the system's Python is older than 3.11: install a newer one"; exit 1; }
debian=$(basename "$(readlink -f "$(command -v "$python")")") # python3.11: also its packages' stem
python_makes_environments || install "$python cannot make virtual environments" "$debian-venv"
python_has_headers || install "the headers of $python are missing" "$debian-dev"
compiler_works || install "a C++20 compiler with OpenMP is missing" g++

if [ ! -x .venv/bin/pip ]; then
    say "making the virtual environment .venv"
    "$python" -m venv --clear .venv
fi
export PIP_DISABLE_PIP_VERSION_CHECK=1

sources() { find CMakeLists.txt pyproject.toml cmake cpp python -type f ! -name '*.py[co]' ! -name '*.so'; }
state=$({ sources | LC_ALL=C sort | xargs -d '\n' sha256sum; env | grep '^SKBUILD_' || true; } | sha256sum)
if [ "$state" != "$(cat .venv/installed 2>/dev/null)" ]; then
    say "compiling and installing mpsdem into .venv (a few minutes the first time)"
    rm -f .venv/installed .venv/installed-*
    .venv/bin/pip install -qq .
    echo "$state" >.venv/installed
fi
for extra; do
    [ ! -e ".venv/installed-$extra" ] || continue
    say "installing the packages for: $extra"
    .venv/bin/pip install -qq "mpsdem[$extra]" # mpsdem itself is there: adds what the extra names
    touch ".venv/installed-$extra"
done
