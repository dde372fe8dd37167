#!/bin/sh
# packaging/notes.sh VERSION: prints what CHANGELOG.md says of a version, without its heading: the notes of the release.
set -eu
version=${1:?"usage: packaging/notes.sh VERSION"}
awk -v heading="## [$version]" '
    /^## / { here = index($0, heading) == 1; next }
    here && (/[^ ]/ || written) { print; written = 1 }
    END {
        if (!written) {
            print "CHANGELOG.md: found nothing under " heading ", expected the notes of the release" > "/dev/stderr"
            exit 1
        }
    }' "$(dirname "$0")/../CHANGELOG.md"
