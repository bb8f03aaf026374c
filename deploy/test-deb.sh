#!/usr/bin/env bash
# The Debian package as a plant meets it, on a clean Debian 12 root of its own (debootstrap): lintian, install, what is
# there then, printing, an upgrade in mid-job, removal, purge, and what is left. Takes minutes and needs root and a mirror.
#
# usage: deploy/test-deb.sh [--if-long] [DIRECTORY]
#   --if-long    end with exit code 77 unless LINEFEED_LONG_TESTS=1
#   DIRECTORY    packages that are built already, instead of building them: that of build-deb.sh
# LINEFEED_DEBIAN_MIRROR: where Debian comes from; http://deb.debian.org/debian
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
mirror=${LINEFEED_DEBIAN_MIRROR:-http://deb.debian.org/debian}
records=4000
work=
jobs=()

fail() {
    echo "test-deb.sh: FAILED: $*" >&2
    exit 1
}
step() { printf '\n== %s (%s s)\n' "$*" "$SECONDS"; }

if [[ ${1:-} == --if-long ]]; then
    shift
    if [[ ${LINEFEED_LONG_TESTS:-0} == 0 || -z ${LINEFEED_LONG_TESTS:-} ]]; then
        echo "skipped: LINEFEED_LONG_TESTS=1 runs it"
        exit 77
    fi
fi
[[ $EUID -eq 0 ]] || fail "root is needed, to make a Debian root"
if [[ -z ${LINEFEED_OWN_MOUNTS:-} ]]; then # mounts go with the process that made them
    LINEFEED_OWN_MOUNTS=1 exec unshare --mount --propagation private "$0" "$@"
fi

clean_up() {
    local job
    for job in "${jobs[@]}"; do
        kill -KILL "$job" 2> /dev/null || true
    done
    [[ -z $work ]] || { umount "$work/root/proc" "$work/root/sys" 2> /dev/null || true; rm -rf --one-file-system "$work"; }
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

surroundings=(/usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive)
service_user=(setpriv --reuid linefeed --regid linefeed --init-groups --)
in_root() { chroot "$work/root" "${surroundings[@]}" "$@"; }
as_service() { in_root "${service_user[@]}" "$@"; }
become_service() { exec chroot "$work/root" "${surroundings[@]}" "${service_user[@]}" "$@"; } # in the background: signals reach it
install_file() { # PACKAGE: as an operator does, from a file
    cp "$1" "$work/root/tmp/linefeed.deb"
    in_root apt-get -q -o Dpkg::Use-Pty=0 install --yes --no-install-recommends /tmp/linefeed.deb < /dev/null > "$work/apt.log" 2>&1 ||
        { cat "$work/apt.log" >&2; fail "$1 cannot be installed"; }
}
get() { # PACKAGE: from the mirror
    in_root apt-get -q -o Dpkg::Use-Pty=0 install --yes --no-install-recommends "$1" < /dev/null > "$work/apt.log" 2>&1 ||
        { cat "$work/apt.log" >&2; fail "$1 cannot be installed"; }
}
give_up() { # remove|purge
    in_root apt-get -q -o Dpkg::Use-Pty=0 "$1" --yes linefeed > "$work/apt.log" 2>&1 || { cat "$work/apt.log" >&2; fail "apt-get $1"; }
}
told_systemd() { # what was to be done with a unit since the last question
    local log=$work/root/tmp/systemctl.log
    [[ ! -e $log ]] || sed -nE "/(start|stop|kill).* $1/{s/^(--?[a-z]+ )*//;p}" "$log" | xargs
    rm -f "$log"
}
left() { # every file of the package or of the service that is there
    (cd "$work/root" && find . -xdev -iname '*linefeed*' -not -path './proc/*' -not -path './tmp/*' | sort)
}
expect_left() { # "WHAT IS TO BE LEFT": lines, as find shows them
    local there
    there=$(left)
    [[ $there == "$1" ]] || fail "left behind:
$there
instead of:
$1"
}

step "packages"
packages=${1:-}
if [[ -z $packages ]]; then
    "$root/deploy/build-deb.sh"
    packages=$root/build/deb
fi
package=$(find "$packages" -name 'linefeed_*.deb')
symbols=$(find "$packages" -name 'linefeed-dbgsym_*.deb')
[[ -f $package && -f $symbols ]] || fail "there should be linefeed and linefeed-dbgsym in $packages"
work=$(mktemp -d /var/tmp/linefeed-deb-XXXXXX)
chmod 0755 "$work"

step "lintian"
lintian --allow-root --fail-on error "$package" "$symbols" || fail "lintian has found errors"

step "the same as an upgrade"
dpkg-deb --raw-extract "$package" "$work/upgrade"
sed -i 's/^Version: .*/&+upgrade1/' "$work/upgrade/DEBIAN/control"
dpkg-deb --root-owner-group --build "$work/upgrade" "$work/upgrade.deb" > /dev/null

step "a clean Debian 12"
debootstrap --variant=minbase bookworm "$work/root" "$mirror" > "$work/debootstrap.log" 2>&1 ||
    { tail "$work/debootstrap.log" >&2; fail "debootstrap has failed"; }
mount -t proc proc "$work/root/proc"
printf '#!/bin/sh\ncase "$1" in linefeed*) exit 0 ;; *) exit 101 ;; esac\n' > "$work/root/usr/sbin/policy-rc.d"
chmod 0755 "$work/root/usr/sbin/policy-rc.d"
in_root apt-get -q update > "$work/apt.log" 2>&1 || { cat "$work/apt.log" >&2; fail "apt-get update"; }
get systemd
# As on a machine that runs systemd, which only takes down what it is told to do. Files are enabled as ever.
mkdir -p "$work/root/run/systemd/system"
mv "$work/root/usr/bin/systemctl" "$work/root/usr/bin/systemctl.real"
cat > "$work/root/usr/bin/systemctl" <<'SH'
#!/bin/sh
case " $* " in
    *" --root"*) exec systemctl.real "$@" ;;
    *" is-enabled "*) echo enabled ;;
    *" is-active "*) test -e /tmp/active ;;
    *) echo "$*" >> /tmp/systemctl.log ;;
esac
SH
chmod 0755 "$work/root/usr/bin/systemctl"

step "install"
install_file "$package"
told=$(told_systemd linefeedd)
[[ $told == "start linefeedd.service" ]] || fail "an installation tells systemd: $told"
[[ $(in_root dpkg --verify linefeed) == "" ]] || fail "dpkg --verify"
in_root id -nG linefeed | grep -qw dialout || fail "the user linefeed is not there, or not in the group dialout"
[[ $(in_root getent passwd linefeed | cut -d : -f 7) == */nologin ]] || fail "the user linefeed may log in"
[[ $(in_root stat -c '%A %U %G' /srv/linefeed) == "drwxrws--- linefeed linefeed" ]] || fail "/srv/linefeed: $(in_root stat -c '%A %U %G' /srv/linefeed)"
for unit in multi-user.target.wants/linefeedd.service timers.target.wants/linefeed-backup.timer; do
    [[ -L $work/root/etc/systemd/system/$unit ]] || fail "$unit is not enabled"
done
[[ $(in_root dpkg-query --show --showformat='${Conffiles}' linefeed | awk '{ print $1 }' | sort | xargs) == \
    "/etc/linefeed/errors.yaml /etc/linefeed/linefeed.yaml /etc/needrestart/conf.d/linefeed.conf" ]] || fail "conffiles"
for program in linefeed linefeed-sim linefeed-backup linefeed-restore; do
    in_root "$program" --help > /dev/null || fail "$program --help"
done
as_service linefeed check-config /etc/linefeed/linefeed.yaml > /dev/null || fail "the configuration as installed"

get udev
mount -t sysfs -o ro sysfs "$work/root/sys"
rules=$(in_root udevadm test --action=add /sys/class/tty/tty0 2>&1)
umount "$work/root/sys"
[[ $rules == *"Reading rules file: "*/70-linefeed.rules* && $rules != *70-linefeed.rules:[0-9]* ]] || fail "udev: $(grep linefeed <<< "$rules")"

# The line: a printer, a job of some time, and the service or, where it is not there, the command line.
start_printer() {
    become_service linefeed-sim --listen 127.0.0.1:0 --rate 200 --tape /srv/linefeed/tape.csv > "$work/simulator.out" 2>&1 &
    jobs+=($!)
    port=
    for _ in {1..100}; do
        port=$(sed -n 's/^linefeed-sim: listening on .*:\([0-9]\{1,5\}\)$/\1/p' "$work/simulator.out")
        [[ -z $port ]] || return 0
        sleep 0.1
    done
    fail "the simulator does not start"
}
tape_lines() { wc -l 2> /dev/null < "$work/root/srv/linefeed/tape.csv" || echo 0; }
wait_for_prints() { # N
    local _
    for _ in {1..600}; do
        [[ $(tape_lines) -lt $(($1 + 1)) ]] || return 0
        kill -0 "$line" 2> /dev/null || break
        sleep 0.1
    done
    [[ $(tape_lines) -ge $(($1 + 1)) ]] || { cat "$work/line.out" >&2; fail "only $(($(tape_lines) - 1)) of $1 prints"; }
}

step "print"
start_printer
seq -f 'serial %06g' 1 "$records" > "$work/root/srv/linefeed/serials.csv.new"
sed -i 1iserial "$work/root/srv/linefeed/serials.csv.new"
in_root chown linefeed:linefeed /srv/linefeed/serials.csv.new
in_root install -d -o linefeed -g linefeed -m 0750 /var/lib/linefeed /run/linefeed # as systemd does
if [[ -x $work/root/usr/sbin/linefeedd ]]; then
    in_root install -d -o linefeed -g linefeed -m 2770 /srv/linefeed/line1
    cat >> "$work/root/etc/linefeed/linefeed.yaml" <<YAML
layouts: {serials: {}}
printers: {line1: {address: "tcp://127.0.0.1:$port", queue: {autostart: true}}}
folders: {line1: {path: /srv/linefeed/line1, layout: serials, printer: line1, autostart: true, settle: rename}}
YAML
    as_service linefeedd --config /etc/linefeed/linefeed.yaml --check-config > /dev/null || fail "linefeedd --check-config"
    become_service linefeedd --config /etc/linefeed/linefeed.yaml > "$work/line.out" 2>&1 &
    line=$!
    for _ in {1..100}; do
        [[ ! -d $work/root/srv/linefeed/line1/processing ]] || break
        sleep 0.1
    done
    mv "$work/root/srv/linefeed/serials.csv.new" "$work/root/srv/linefeed/line1/serials.csv"
else
    mv "$work/root/srv/linefeed/serials.csv.new" "$work/root/srv/linefeed/serials.csv"
    become_service linefeed print /srv/linefeed/serials.csv --printer "tcp://127.0.0.1:$port" --spool /var/lib/linefeed/spool.db > "$work/line.out" 2>&1 &
    line=$!
fi
jobs+=("$line")
wait_for_prints 200

step "upgrade in mid-job"
touch "$work/root/tmp/active"
install_file "$work/upgrade.deb"
grep "^linefeed:" "$work/apt.log" || fail "the upgrade does not say that the service goes on"
[[ $(in_root dpkg-query --show --showformat='${Version}' linefeed) == *+upgrade1 ]] || fail "the upgrade is not installed"
told=$(told_systemd linefeedd)
[[ $told == "" ]] || fail "an upgrade tells systemd: $told"
[[ $(tape_lines) -lt $records ]] || fail "the job was over before the upgrade"
kill -0 "$line" 2> /dev/null || fail "the upgrade has ended what printed"
in_root linefeed-backup --spool /var/lib/linefeed/spool.db || fail "a backup in mid-job"
wait_for_prints "$records"
if [[ -x $work/root/usr/sbin/linefeedd ]]; then
    kill -TERM "$line"
fi
code=0
wait "$line" || code=$?
[[ $code -eq 0 ]] || { cat "$work/line.out" >&2; fail "what printed has ended with exit code $code"; }
cut -d , -f 3 "$work/root/srv/linefeed/tape.csv" | sed 1d | cmp - <(seq -f 'serial %06g' 1 "$records") || fail "the tape is not what was to be printed"
as_service linefeed ledger 1 --spool /var/lib/linefeed/spool.db --verify

step "remove"
cp "$work/root/var/lib/linefeed/spool.db" "$work/spool.db"
give_up remove
told=$(told_systemd linefeedd)
[[ $told == "stop linefeedd.service" ]] || fail "removal tells systemd: $told"
[[ ! -e $work/root/usr/bin/linefeed && -e $work/root/etc/linefeed/linefeed.yaml ]] || fail "remove takes the programs and nothing else"
cmp "$work/spool.db" "$work/root/var/lib/linefeed/spool.db" || fail "remove has touched the spool"

step "purge"
rm -r "$work/root/srv/linefeed" "$work/root/run/linefeed" # the plant's, and systemd's
give_up purge
grep linefeed: "$work/apt.log"
last=$(cd "$work/root" && find ./var/backups/linefeed -name spool.db)
cmp "$work/spool.db" "$work/root/$last" || fail "the ledger is gone"
expect_left ./var/backups/linefeed
rm -r "$work/root/var/backups/linefeed"

step "install and purge, nothing printed"
install_file "$package"
in_root install -d -o linefeed -g linefeed -m 0750 /var/lib/linefeed
give_up purge
expect_left ""

printf '\ntest-deb.sh: OK (%s s)\n' "$SECONDS"
