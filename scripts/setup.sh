#!/usr/bin/env bash
# Install this clone into .venv, from nothing but Python 3.11+ and a C++20 compiler.
# usage: scripts/setup.sh [EXTRA]...      extras of pyproject.toml: test, check
# Does nothing where nothing changed since the last call.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf 'setup: %s\n' "$*" >&2; }

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

# Say what the machine lacks, one "Debian package: what it is for" a line.
missing() {
    local package
    if find_python; then
        package=$(basename "$("$python" -c 'import os, sys; print(os.path.realpath(sys.executable))')")
        "$python" -c 'import ensurepip, venv' 2>/dev/null || echo "$package-venv: virtual environments"
        "$python" -c 'import os, sys, sysconfig
sys.exit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' ||
            echo "$package-dev: the headers of $python"
    else
        printf '%s\n' "python3: Python 3.11 or newer" "python3-venv: virtual environments" "python3-dev: its headers"
    fi
    echo '#include <concepts>' | "${CXX:-c++}" -std=c++20 -fopenmp -fsyntax-only -x c++ - 2>/dev/null ||
        echo "g++: a C++20 compiler with OpenMP"
}

# Install the system packages of `missing` where we may.
install_missing() {
    local packages apt=()
    mapfile -t packages < <(missing | sed 's/:.*//')
    if [ ${#packages[@]} = 0 ]; then return; fi
    say "this machine lacks:"
    missing | sed 's/^/setup:   /' >&2
    if ! command -v apt-get >/dev/null; then
        say "install that with the package manager of your system (the names are Debian's), then run this again."
        exit 1
    elif [ "$(id -u)" = 0 ]; then
        apt=(env DEBIAN_FRONTEND=noninteractive apt-get -qq)
    elif sudo -n true 2>/dev/null; then
        apt=(sudo -n DEBIAN_FRONTEND=noninteractive apt-get -qq)
    else
        say "installing needs root, or sudo without a password. Run this, then try again:"
        say "  sudo apt-get install ${packages[*]}"
        exit 1
    fi
    say "installing ${packages[*]}"
    "${apt[@]}" update
    "${apt[@]}" install -y --no-install-recommends "${packages[@]}" >/dev/null
    if [ -n "$(missing)" ]; then
        say "still missing after installing:"
        missing | sed 's/^/setup:   /' >&2
        exit 1
    fi
}

install_missing
find_python
if [ ! -x .venv/bin/pip ]; then
    say "making the virtual environment .venv with $("$python" --version)"
    "$python" -m venv --clear .venv
fi
export PIP_DISABLE_PIP_VERSION_CHECK=1

sources() { find CMakeLists.txt pyproject.toml cmake cpp python -type f ! -name '*.py[co]' ! -name '*.so'; }
state=$({ sources | LC_ALL=C sort | xargs -d '\n' sha256sum; env | grep '^SKBUILD_' || true; } | sha256sum)
if [ "$state" != "$(cat .venv/installed 2>/dev/null)" ]; then
    say "compiling mpsdem and installing it into .venv: a few minutes"
    rm -f .venv/installed .venv/installed-*
    .venv/bin/pip install -qq .
    echo "$state" >.venv/installed
fi
for extra; do
    if [ ! -e ".venv/installed-$extra" ]; then
        say "installing the packages for: $extra"
        .venv/bin/pip install -qq "mpsdem[$extra]" # mpsdem itself is there: adds what the extra names
        touch ".venv/installed-$extra"
    fi
done
