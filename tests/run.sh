#!/usr/bin/env bash
# Tests everything: installs what is missing, builds the release preset, runs all tests, checks the form of the code and its coverage. From a clean clone, as root or with sudo, without questions.
#
# usage: tests/run.sh [--long]
#   --long   clang-tidy, the rates for 60 s each instead of 5 s, each fuzz target for 10 minutes (LINEFEED_FUZZ_SECONDS),
#            the storage and kill tests in full, 1 000 hours of simulated production, and the deliberate mistakes it has to catch
set -uo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." || exit 1

long=0
case "${1:-}" in
    "") ;;
    --long) long=1 ;;
    *) echo "usage: tests/run.sh [--long]" >&2; exit 2 ;;
esac

passed=0
failed=0
cores=$(nproc)

stage() { # NAME COMMAND…: counts as one test
    local name=$1 started=$SECONDS
    shift
    printf '\n=== %s\n' "$name"
    if "$@"; then
        passed=$((passed + 1))
        echo "=== $name: ok ($((SECONDS - started)) s)"
    else
        failed=$((failed + 1))
        echo "=== $name: FAILED ($((SECONDS - started)) s)"
        return 1
    fi
}

finish() {
    printf '\n%s s in all\n%s passed, %s failed\n' "$SECONDS" "$passed" "$failed"
    [[ $failed -eq 0 && $passed -gt 0 ]]
    exit
}

run_tests() { # NAME CTEST-ARGUMENTS…: every test of ctest counts
    local name=$1 log started=$SECONDS total bad
    shift
    printf '\n=== %s\n' "$name"
    log=$(mktemp)
    ctest --test-dir build/release --output-on-failure --no-tests=error "$@" 2>&1 | tee "$log" | grep -v '^ *Start \|\*\*\* *Skipped\|  Passed '
    local code=${PIPESTATUS[0]}
    read -r bad total < <(sed -n 's/^.*tests passed, \([0-9]*\) tests failed out of \([0-9]*\)$/\1 \2/p' "$log")
    rm -f "$log"
    if [[ -z ${total:-} ]]; then
        bad=1 total=1
    elif [[ $code -ne 0 && $bad -eq 0 ]]; then
        bad=1
    fi
    passed=$((passed + total - bad))
    failed=$((failed + bad))
    echo "=== $name: $((total - bad)) of $total ($((SECONDS - started)) s)"
}

build_release() {
    cmake --preset release -D LINEFEED_TESTS=ON > build/release-configure.log 2>&1 || { cat build/release-configure.log; return 1; }
    cmake --build --preset release --parallel "$cores"
}

fuzz() { # all targets at once, each with its own log; what it finds is in build/fuzz/found
    local targets target seconds=${LINEFEED_FUZZ_SECONDS:-600} bad=0
    cmake --preset fuzz > build/fuzz-configure.log 2>&1 || { cat build/fuzz-configure.log; return 1; }
    targets=$(sed -n 's/^linefeed_fuzz_target(\([a-z_]*\) .*/\1/p' tests/fuzz/CMakeLists.txt)
    # shellcheck disable=SC2086
    cmake --build --preset fuzz --parallel "$cores" --target ${targets//$'\n'/_fuzz }_fuzz || return 1
    declare -A running=()
    for target in $targets; do
        mkdir -p "build/fuzz/found/$target" "build/fuzz/grown/$target"
        echo "fuzzing $target for $seconds s"
        "build/fuzz/bin/${target}_fuzz" -max_total_time="$seconds" -print_final_stats=1 -artifact_prefix="build/fuzz/found/$target/" \
            "build/fuzz/grown/$target" "tests/fuzz/corpus/$target" > "build/fuzz/$target.log" 2>&1 &
        running[$target]=$!
    done
    for target in $targets; do
        if wait "${running[$target]}"; then
            echo "$target: $(grep number_of_executed_units "build/fuzz/$target.log")"
        else
            tail -n 60 "build/fuzz/$target.log"
            bad=1
        fi
    done
    return "$bad"
}

production() { # a simulation on each core, with seeds of its own
    local core bad=0 simulations=()
    for ((core = 1; core <= cores; ++core)); do
        build/release/bin/linefeed_simulation --from "${core}000000000" --hours $((1000 / cores + 1)) > "build/production_$core.log" 2>&1 &
        simulations+=($!)
    done
    for core in "${!simulations[@]}"; do
        wait "${simulations[$core]}" || bad=1
        tail -n 6 "build/production_$((core + 1)).log"
    done
    return "$bad"
}

mkdir -p build
groups=(build test lint)
[[ $long -eq 0 ]] || groups+=(fuzz package)
stage "packages" deploy/dependencies.sh "${groups[@]}" || finish
stage "build" build_release || finish
[[ $long -eq 0 ]] || export LINEFEED_LONG_TESTS=1
run_tests "unit and architecture" -L unit --parallel "$cores"
run_tests "fuzz corpora" -L fuzz --parallel "$cores"
run_tests "simulation" -L simulation -E mutations --parallel "$cores"
run_tests "integration" -L integration --parallel $((cores + 1)) # most of them wait for a line
stage "bench-slice" benchmarks/run.py --quick
stage "format" tests/lint.sh format
[[ $long -eq 0 ]] || stage "tidy" tests/lint.sh tidy
stage "coverage" tests/coverage.sh
[[ $long -eq 0 ]] || stage "fuzz" fuzz
[[ $long -eq 0 ]] || stage "1000 hours of production" production
[[ $long -eq 0 ]] || run_tests "deliberate mistakes" -L simulation -R mutations
finish
