#!/bin/sh
# packaging/archive.sh TARGET PROGRAM FOLDER: packs a built program into FOLDER/enfilade-vVERSION-TARGET.tar.gz, or .zip for Windows. What is
# within lies in a folder of the archive's name: [package.metadata.binstall] in crates/cli/Cargo.toml has both.
set -eu
target=${1:?"usage: packaging/archive.sh TARGET PROGRAM FOLDER"}
program=${2:?"usage: packaging/archive.sh TARGET PROGRAM FOLDER"}
folder=${3:?"usage: packaging/archive.sh TARGET PROGRAM FOLDER"}
root=$(cd "$(dirname "$0")/.." && pwd)
name=enfilade-v$("$root/packaging/version.sh")-$target

rm -rf "${folder:?}/$name"
mkdir -p "$folder/$name"
cp "$program" "$root/README.md" "$root/CHANGELOG.md" "$root/LICENSE-APACHE" "$root/LICENSE-MIT" "$folder/$name/"
# Of what is within the program under other licences.
cp "$root/crates/suggest/data/LICENSE" "$folder/$name/LICENSE-suggest-data"
cp "$root/crates/denoise/data/LICENSE" "$folder/$name/LICENSE-denoise-data"
cp "$root/crates/serve/web/vendor/three.LICENSE" "$folder/$name/LICENSE-three.js"
cd "$folder"
case $target in
    *-windows-*) 7z a -bso0 "$name.zip" "$name" ;;
    *) tar -czf "$name.tar.gz" "$name" ;;
esac
rm -r "$name"
