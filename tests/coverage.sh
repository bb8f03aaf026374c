#!/usr/bin/env bash
# Line and branch coverage of src/protocol and src/feeder by their own unit tests. Fails under the thresholds below, which are what the
# tests reach less a little. Branches that the compiler adds for exceptions are not counted: nothing in these libraries throws.
#
# usage: tests/coverage.sh     (builds in build/coverage)
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
build=build/coverage
thresholds=("protocol 98 88" "feeder 98 91") # library, lines %, branches %

mkdir -p "$build"
log=$build/coverage.log
cmake --preset coverage > "$log" 2>&1 || { cat "$log" >&2; exit 1; }
cmake --build --preset coverage --target protocol_tests feeder_tests >> "$log" 2>&1 || { cat "$log" >&2; exit 1; }
find "$build" -name '*.gcda' -delete
for library in protocol feeder; do
    "$build/bin/${library}_tests" --gtest_brief=1 >> "$log" 2>&1 || { cat "$log" >&2; exit 1; }
done

gcovr --root . --filter 'src/protocol/' --filter 'src/feeder/' --exclude-throw-branches --exclude-unreachable-branches \
    --gcov-ignore-parse-errors --json "$build/coverage.json" "$build/src/protocol" "$build/src/feeder" \
    "$build/tests/unit/protocol" "$build/tests/unit/feeder" >> "$log" 2>&1 || { cat "$log" >&2; exit 1; }

failed=0
for entry in "${thresholds[@]}"; do
    read -r library lines branches <<< "$entry"
    report=(gcovr --root . --add-tracefile "$build/coverage.json" --filter "src/$library/")
    echo "== src/$library: lines"
    "${report[@]}" --txt --fail-under-line "$lines" || { echo "coverage: src/$library: fewer lines than $lines %" >&2; failed=1; }
    echo "== src/$library: branches"
    "${report[@]}" --txt --branches --fail-under-branch "$branches" ||
        { echo "coverage: src/$library: fewer branches than $branches %" >&2; failed=1; }
done
exit "$failed"
