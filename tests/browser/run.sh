#!/usr/bin/env bash
# The page of `kickdrift explore` and figures in a real browser. Installs what is missing, builds the program unless KICKDRIFT names one,
# runs the tests, and leaves screenshots of the main states in the folder $SCREENSHOTS, if that is given.
set -euo pipefail
cd "$(dirname "$0")"

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

missing=()
command -v chromium >/dev/null || missing+=(chromium)
command -v node >/dev/null || missing+=(nodejs)
command -v npm >/dev/null || missing+=(npm)
command -v rsvg-convert >/dev/null || missing+=(librsvg2-bin)
if [ ${#missing[@]} -gt 0 ]; then
    as_root apt-get update -qq
    as_root apt-get install -qq -y --no-install-recommends "${missing[@]}"
fi

if [ -z "${KICKDRIFT:-}" ]; then
    cargo build --quiet --release --manifest-path ../../Cargo.toml
    target=$(cargo metadata --format-version 1 --no-deps --manifest-path ../../Cargo.toml |
        sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
    export KICKDRIFT=$target/release/kickdrift
fi

KICKDRIFT_SYSTEM=$(cd ../../data/scenes && pwd)/two-bars.json
export KICKDRIFT_SYSTEM

# The packages lie beside the copy of the tests in a scratch folder: nothing is written into the repository.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp ./*.mjs package.json package-lock.json "$scratch"
# The page in one file, from the program.
export KICKDRIFT_ATLAS=$scratch/atlas.html
python3 ../../docs/atlas.py "$(realpath "$KICKDRIFT")" "$KICKDRIFT_ATLAS"
cd "$scratch"
npm ci --silent --no-audit --no-fund
# A browser that a failed test leaves open must not hold the rest.
timeout 1200 node --test --test-concurrency=1
