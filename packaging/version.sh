#!/bin/sh
# packaging/version.sh [TAG]: prints the version of the workspace. With a tag, as v0.1.0, it fails unless everything in the repository agrees
# that this is the version to release.
set -eu
cd "$(dirname "$0")/.."
fail() {
    echo "$1" >&2
    exit 1
}

# The first `version` below [workspace.package].
version=$(awk -F'"' '/^\[/ { here = $0 == "[workspace.package]" } here && /^version *=/ { print $2; exit }' Cargo.toml)
[ -n "$version" ] || fail 'Cargo.toml: found no version in [workspace.package], expected one such as "0.1.0"'
locked=$(awk -F'"' '/^name = "enfilade"$/ { here = 1 } here && /^version/ { print $2; exit }' Cargo.lock)
[ "$locked" = "$version" ] || fail "Cargo.lock: found enfilade $locked, expected $version as in Cargo.toml; run: cargo update --workspace --offline"

if [ $# -gt 0 ]; then
    [ "$1" = "v$version" ] || fail "found the tag $1, expected v$version, the version in Cargo.toml; set the version, or tag another commit"
    grep -qE "^## \[$version\] - [0-9]{4}-[0-9]{2}-[0-9]{2}\$" CHANGELOG.md ||
        fail "CHANGELOG.md: found no heading '## [$version] - YYYY-MM-DD'; date the section of this release"
    awk '/^## / { here = $0 == "## [Unreleased]" } here && /^- / { found = 1 } END { exit found }' CHANGELOG.md ||
        fail "CHANGELOG.md: found lines under [Unreleased], which would be in no release; move them below [$version]"
    if ! grep -qE '^repository *= *"https://' Cargo.toml || ! grep -q '^repository\.workspace = true$' crates/cli/Cargo.toml; then
        fail 'found no repository in Cargo.toml ([workspace.package]) or crates/cli/Cargo.toml, by which cargo binstall finds archives; add it'
    fi
fi
echo "$version"
