#!/usr/bin/env bash
# Coverage of the libraries by their own unit tests, in groups. A group with thresholds fails below its percentages, which are what the
# tests reach less a little. A strict group fails on every line or branch that is not executed and not listed with a reason in
# tests/coverage_exceptions.txt. Branches that the compiler adds for exceptions are not counted.
#
# usage: tests/coverage.sh     (builds in build/coverage, or in $LINEFEED_COVERAGE_BUILD)
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
build=${LINEFEED_COVERAGE_BUILD:-build/coverage}
libraries=(protocol feeder session spool store) # whose unit tests run

# name, lines %, branches %, files
thresholds=(
    "protocol 98 88 src/protocol/.*"
)
# name, files as regular expressions
strict=(
    "feeder src/feeder/.*"
    "session src/session/.*"
    "ledger src/spool/(.*_)?ledger(_.*)?[.][ch]pp src/spool/spool_verify[.]cpp src/store/ledger_keeper[.]cpp src/store/store_work[.]cpp"
)

mkdir -p "$build"
log=$build/coverage.log
quietly() {
    "$@" >> "$log" 2>&1 || { cat "$log" >&2; exit 1; }
}
: > "$log"
quietly cmake --preset coverage -B "$build"
quietly cmake --build "$build" --parallel "$(nproc)" --target "${libraries[@]/%/_tests}"
find "$build" -name '*.gcda' -delete
# Several at once: their counts of the same file are added up under a lock.
quietly xargs -P "$(nproc)" -I '{}' env "$build/bin/{}_tests" --gtest_brief=1 <<< "$(printf '%s\n' "${libraries[@]}")"
objects=()
for library in "${libraries[@]}"; do
    objects+=("$build/src/$library" "$build/tests/unit/$library")
done
quietly gcovr -j "$(nproc)" --root . --filter 'src/' --exclude-throw-branches --exclude-unreachable-branches --gcov-ignore-parse-errors \
    --json "$build/coverage.json" "${objects[@]}"

failed=0
for group in "${thresholds[@]}"; do
    read -r name lines branches files <<< "$group"
    report=(gcovr --root . --add-tracefile "$build/coverage.json" --filter "$files")
    echo "== $name: lines"
    "${report[@]}" --txt --fail-under-line "$lines" || { echo "coverage: $name: fewer lines than $lines %" >&2; failed=1; }
    echo "== $name: branches"
    "${report[@]}" --txt --branches --fail-under-branch "$branches" ||
        { echo "coverage: $name: fewer branches than $branches %" >&2; failed=1; }
done
echo "== everything executed or listed"
groups=()
for group in "${strict[@]}"; do
    read -ra words <<< "$group"
    groups+=(--group "${words[@]}")
done
python3 tests/coverage_check.py --report "$build/coverage.json" --exceptions tests/coverage_exceptions.txt --root . "${groups[@]}" ||
    { echo "coverage: cover these lines, or list them with a reason in tests/coverage_exceptions.txt" >&2; failed=1; }
exit "$failed"
