#!/usr/bin/env bash
# The form of the code: clang-format over everything, clang-tidy (allow-list in .clang-tidy) over the sources.
#
# usage: tests/lint.sh [format] [tidy]     (both unless said otherwise)
# clang-tidy reads the compile commands of build/release (LINEFEED_BUILD_DIR for another); what it found good it does not read again
# until the file, a header of the project or the configuration changes.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
build=${LINEFEED_BUILD_DIR:-build/release}

tool() { # the versioned name, or the plain one
    command -v "$1-14" || command -v "$1" || { echo "lint.sh: $1 is missing: run deploy/dependencies.sh lint" >&2; exit 1; }
}

check_format() {
    local format
    format=$(tool clang-format)
    if find src tests \( -name '*.cpp' -o -name '*.hpp' \) -print0 | sort -z | xargs -0 -r "$format" --dry-run -Werror; then
        echo "format: ok"
    else
        echo "format: run $format -i on the files above" >&2
        return 1
    fi
}

tidy_one() { # FILE SUM: remembered as good under the sum of everything that it depends on
    local good
    good=$cache/$(printf '%s %s\n' "$2" "$(sha256sum "$1")" | sha256sum | cut -c 1-40)
    [[ -e $good ]] && return 0
    if "$tidy" --quiet -p "$build" "$1" 2> >(grep -v 'warnings generated\|warning generated' >&2); then
        touch "$good"
    else
        return 1
    fi
}

check_tidy() {
    [[ -f $build/compile_commands.json ]] || { echo "lint.sh: no $build/compile_commands.json: build first" >&2; return 1; }
    tidy=$(tool clang-tidy)
    cache=$build/tidy
    export tidy build cache
    export -f tidy_one
    mkdir -p "$cache"
    local sum
    sum=$(find src -name '*.hpp' -print0 | sort -z | xargs -0 cat .clang-tidy CMakeLists.txt | sha256sum | cut -c 1-40)
    if find src -name '*.cpp' -print0 | sort -z | xargs -0 -r -P "$(nproc)" -I{} bash -c 'tidy_one "$@"' tidy_one {} "$sum"; then
        echo "tidy: ok"
    else
        echo "tidy: see above" >&2
        return 1
    fi
}

for check in "${@:-all}"; do
    case "$check" in
        all) check_format; check_tidy ;;
        format) check_format ;;
        tidy) check_tidy ;;
        *) echo "lint.sh: there is no check \"$check\": format, tidy" >&2; exit 2 ;;
    esac
done
