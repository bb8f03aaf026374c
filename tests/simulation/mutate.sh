#!/bin/sh
# Shows that the judge can fail: applies each deliberate mistake of mutations/ to a copy of the tree, builds the simulation with it and runs
# seeds until one is caught. Prints a table; fails if a patch does not apply or a mistake is not caught within the seeds allowed.
#   mutate.sh SOURCE_DIR WORK_DIR [SEEDS] [PATTERN]
set -eu
source=$(cd "$1" && pwd)
work=$2
seeds=${3:-1000}
pattern=${4:-}
mkdir -p "$work"
work=$(cd "$work" && pwd)
tree=$work/tree
rm -rf "$tree"
mkdir -p "$tree/tests"
cp -r "$source/CMakeLists.txt" "$source/src" "$source/schema" "$tree/"
cp -r "$source/tests/simulation" "$tree/tests/"
printf 'add_subdirectory(simulation)\n' >"$tree/tests/CMakeLists.txt"
cmake -S "$tree" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release >"$work/configure.log" 2>&1 ||
    { tail -20 "$work/configure.log"; exit 1; }
build() {
    cmake --build "$work/build" --target linefeed_simulation >"$work/build.log" 2>&1 || { tail -20 "$work/build.log"; exit 1; }
}
build
"$work/build/bin/linefeed_simulation" --from 1 --count 20 >"$work/run.log" 2>&1 ||
    { echo "the tree without a mistake is not clean:"; grep VIOLATION "$work/run.log"; }
missed=0
total=0
printf '%-34s %-8s %s\n' mistake "at seed" "caught by"
for patch in "$source"/tests/simulation/mutations/*"$pattern"*.patch; do
    name=$(basename "$patch" .patch)
    total=$((total + 1))
    patch -d "$tree" -p1 --forward --no-backup-if-mismatch --reject-file=- <"$patch" >"$work/patch.log" 2>&1 ||
        { echo "$name does not apply:"; cat "$work/patch.log"; exit 1; }
    build
    "$work/build/bin/linefeed_simulation" --from 1 --count "$seeds" --stop-at-first >"$work/run.log" 2>&1 || true
    caught=$(grep -m 1 '^VIOLATION' "$work/run.log" || true)
    if [ -n "$caught" ]; then
        printf '%-34s %-8s %s\n' "$name" "$(echo "$caught" | sed 's/VIOLATION seed \([0-9]*\):.*/\1/')" "${caught#*: }"
    else
        printf '%-34s %-8s %s\n' "$name" - "NOT CAUGHT within $seeds seeds"
        missed=$((missed + 1))
    fi
    patch -d "$tree" -p1 --reverse --no-backup-if-mismatch --reject-file=- <"$patch" >"$work/patch.log" 2>&1
done
echo "$((total - missed)) of $total mistakes caught"
[ "$missed" -eq 0 ] && [ "$total" -ge 12 ]
