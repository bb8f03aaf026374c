#!/usr/bin/env bash
# Installs the Debian 12 packages that linefeed needs. Idempotent: what is there already is left alone, and when nothing is missing apt
# is not called at all. Asks nothing; works as root, or through sudo.
#
# usage: deploy/dependencies.sh [build] [test] [lint] [fuzz] [package]     (without arguments: build)
set -euo pipefail

build_packages=(cmake ninja-build g++ libboost1.81-dev libsqlite3-dev sqlite3 zlib1g-dev libssl-dev libpng-dev libcli11-dev nlohmann-json3-dev libyaml-cpp-dev libspdlog-dev libsystemd-dev prometheus-cpp-dev)
test_packages=(libgtest-dev libgmock-dev libbenchmark-dev python3 python3-jsonschema python3-yaml gcovr valgrind
               scdoc shellcheck systemd prometheus iproute2)
lint_packages=(clang-format-14 clang-tidy-14)
fuzz_packages=(clang-14 libclang-rt-14-dev)
package_packages=(dpkg-dev debhelper scdoc lintian debootstrap)

fail() {
    echo "dependencies.sh: $*" >&2
    exit 1
}

wanted=()
for group in "${@:-build}"; do
    case "$group" in
        build) wanted+=("${build_packages[@]}") ;;
        test) wanted+=("${test_packages[@]}") ;;
        lint) wanted+=("${lint_packages[@]}") ;;
        fuzz) wanted+=("${fuzz_packages[@]}") ;;
        package) wanted+=("${package_packages[@]}") ;;
        *) fail "there is no group \"$group\": build, test, lint, fuzz, package" ;;
    esac
done

command -v dpkg-query > /dev/null || fail "this is not Debian: install the equivalents of: ${wanted[*]}"

missing=()
for package in "${wanted[@]}"; do
    status=$(dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2> /dev/null | head -n 1) || true
    [[ $status == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
    exit 0
fi

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo > /dev/null || fail "root or sudo is needed to install: ${missing[*]}"
    as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o Dpkg::Use-Pty=0 -qq)

# Of prometheus only its promtool is wanted: no service is started, now or at the next boot.
policy=/usr/sbin/policy-rc.d
if [[ ! -e $policy ]]; then
    trap '"${as_root[@]}" rm -f "$policy"' EXIT
    printf '#!/bin/sh\nexit 101\n' | "${as_root[@]}" install -m 0755 /dev/stdin "$policy" || fail "cannot write $policy"
fi

echo "installing: ${missing[*]}"
"${apt[@]}" update < /dev/null || fail "apt-get update failed"
"${apt[@]}" install --yes --no-install-recommends "${missing[@]}" < /dev/null > /dev/null || fail "cannot install: ${missing[*]}"
if [[ " ${missing[*]} " == *" prometheus "* ]]; then
    "${as_root[@]}" systemctl --quiet disable prometheus || fail "cannot disable the service of prometheus"
fi
