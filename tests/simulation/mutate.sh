#!/bin/sh
# Shows that the judge can fail: compiles each file of the core that has a deliberate mistake (mutations/*.patch), links the simulation with it
# and runs seeds until one catches it. Prints a table. Fails if a patch does not apply or a mistake is not caught within the seeds allowed.
#   mutate.sh SOURCE_DIR BUILD_DIR [SEEDS] [PATTERN]
# Mistakes with "secured" or "chained" in their name are looked for with the profile of that name.
# BUILD_DIR is a configured build (Ninja); only the mistaken file is compiled anew, into BUILD_DIR/mutations. Patches are of .cpp files.
set -eu
source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
seeds=${3:-1000}
pattern=${4:-}
here=$source/tests/simulation
work=$build/mutations
rm -rf "$work"
mkdir -p "$work"
cd "$build"
ninja linefeed_simulation >"$work/build.log" 2>&1 || { tail -20 "$work/build.log"; exit 1; }
ninja -t commands linefeed_simulation >"$work/commands"
link=$(grep -F -- '-o bin/linefeed_simulation ' "$work/commands" | tail -1)

# run PROGRAM PROFILE: the first violation
run() {
    "$1" --profile "$2" --from 1 --count "$seeds" --stop-at-first >"$work/run.log" 2>&1 || true
    grep -m 1 '^VIOLATION' "$work/run.log" || true
}

for profile in mixed secured chained; do
    caught=$(run bin/linefeed_simulation $profile)
    [ -z "$caught" ] || { echo "the simulation finds something without any mistake: $caught"; exit 1; }
done
missed=0
total=0
printf '%-34s %-8s %s\n' mistake "at seed" "caught by"
for patch in "$here"/mutations/*${pattern}*.patch; do
    name=$(basename "$patch" .patch)
    total=$((total + 1))
    file=$(sed -n '1s,^--- a/,,p' "$patch")
    patch --output="$work/mistaken.cpp" --reject-file=- --fuzz=1 "$source/$file" "$patch" >"$work/patch.log" 2>&1 ||
        { echo "$name does not apply:"; cat "$work/patch.log"; exit 1; }
    compile=$(grep -F -- "-c $source/$file" "$work/commands" | tail -1 |
        sed "s, -MD -MT [^ ]* -MF [^ ]*,,; s, -o [^ ]* -c [^ ]*, -o $work/mistaken.o -c $work/mistaken.cpp,")
    # An object is linked before the libraries, so it takes the place of the library's own.
    with_mistake=$(echo "$link" | sed "s, -o bin/linefeed_simulation , $work/mistaken.o -o $work/mistaken ,")
    { sh -c "$compile" && sh -c "$with_mistake"; } >"$work/build.log" 2>&1 || { echo "$name does not compile:"; tail -20 "$work/build.log"; exit 1; }
    case $name in
        *secured*) profile=secured ;;
        *chained*) profile=chained ;;
        *) profile=mixed ;;
    esac
    caught=$(run "$work/mistaken" $profile)
    if [ -n "$caught" ]; then
        printf '%-34s %-8s %s\n' "$name" "$(echo "$caught" | sed 's/VIOLATION seed \([0-9]*\):.*/\1/')" "${caught#*: }"
    else
        printf '%-34s %-8s %s\n' "$name" - "NOT CAUGHT within $seeds seeds"
        missed=$((missed + 1))
    fi
done
echo "$((total - missed)) of $total mistakes caught"
[ "$missed" -eq 0 ] && [ "$total" -ge 12 ]
