#!/usr/bin/env bash
# Makes the Debian packages (linefeed and linefeed-dbgsym) from the work tree, uncommitted changes included: a clean copy
# of what git knows, with deploy/debian as its debian/.
#
# usage: deploy/build-deb.sh [VERSION]      (default: what deploy/debian/changelog says; the result is in build/deb/)
# Needs: deploy/dependencies.sh build package
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
result=$root/build/deb
tree=$result/linefeed

fail() {
    echo "build-deb.sh: $*" >&2
    exit 1
}

command -v dh > /dev/null || fail "debhelper is missing: run deploy/dependencies.sh build package"
rm -rf "$result"
mkdir -p "$tree"
git -C "$root" ls-files -z --cached --others --exclude-standard |
    tar --create --directory "$root" --null --files-from - | tar --extract --directory "$tree" || fail "the tree cannot be copied"
cp -R "$tree/deploy/debian" "$tree/debian"
cd "$tree"
if [[ $# -gt 0 ]]; then
    {
        printf 'linefeed (%s) bookworm; urgency=medium\n\n  * Built from the work tree.\n\n' "$1"
        printf ' -- %s  %s\n\n' "$(sed -n 's/^Maintainer: //p' debian/control)" "$(date -R)"
        cat deploy/debian/changelog
    } > debian/changelog
fi
# debhelper moves HOME, and would leave the compiler's cache behind.
if command -v ccache > /dev/null; then
    CCACHE_DIR=$(ccache --get-config cache_dir)
    export CCACHE_DIR
fi
dpkg-buildpackage --build=binary --no-sign --jobs="$(nproc)" > "$result/build.log" 2>&1 || {
    tail -n 12 "$result/build.log" >&2
    fail "the package cannot be built, see $result/build.log"
}
rm -rf "$tree"
ls "$result"/*.deb
