#!/bin/sh
# packaging/static.sh FOLDER: builds the program without shared libraries, for Linux with any C library or none, and puts it into FOLDER with
# what an image around it needs: certificates for stores behind HTTPS, and a folder for temporary files.
# Needs what a build needs, and the static C library (Debian: libc6-dev).
set -eu
folder=${1:?"usage: packaging/static.sh FOLDER"}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
cd "$(dirname "$0")/.."
host=$(rustc -vV | sed -n 's/^host: //p')
# With --target the flag is for the program alone and not for macros and build scripts, which cannot be static. It joins those of
# .cargo/config.toml, which RUSTFLAGS would replace.
cargo build --release --locked --package enfilade --target "$host" --config "target.'cfg(all())'.rustflags = ['-Ctarget-feature=+crt-static']"
mkdir -p "$folder/usr/bin" "$folder/etc/ssl/certs" "$folder/data"
install -d -m 1777 "$folder/tmp"
install -m 755 "${CARGO_TARGET_DIR:-target}/$host/release/enfilade" "$folder/usr/bin/enfilade"
cp /etc/ssl/certs/ca-certificates.crt "$folder/etc/ssl/certs/"
