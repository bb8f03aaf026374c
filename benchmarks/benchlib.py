"""What the benchmarks share: the simulated printer and the hosts as processes, loads, and the judgement of a miss.

Times are nanoseconds of CLOCK_MONOTONIC, the same clock in all processes.
"""
import bisect
import contextlib
import json
import os
import pathlib
import re
import select
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = pathlib.Path(os.environ.get("LINEFEED_BIN_DIR", ROOT / "build/release/bin"))
CORES = os.cpu_count() or 1
DEPTH = 256
MARGIN_S = 0.003  # a record must lie in the printer for so long before its PrintGo (protocol, section 5)
HOST_PRIORITY = 50  # SCHED_FIFO, below the printer's
SETTLE_S = 20  # longest wait for what should happen at once


@contextlib.contextmanager
def workspace():
    """A directory on the disk of the build, where spools belong: /tmp may be memory."""
    base = ROOT / "build"
    base.mkdir(exist_ok=True)
    directory = pathlib.Path(tempfile.mkdtemp(prefix="bench-", dir=base))
    try:
        yield directory
    finally:
        shutil.rmtree(directory, ignore_errors=True)


def realtime_prefix(priority=80):
    """The printer is a machine of its own in reality: no load of the host's computer delays it. Empty if it is not permitted here."""
    prefix = ["chrt", "-f", str(priority)]
    try:
        allowed = subprocess.run([*prefix, "true"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0
    except OSError:
        allowed = False
    return prefix if allowed else []


def pin(core):
    return ["taskset", "-c", str(core)]


def cpu_seconds(pid):
    """CPU time of a process and its threads so far."""
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Printer:
    """linefeed-sim in a process of its own, on one processor, with precedence where permitted, counting misses instead of stopping."""

    def __init__(self, directory, rate, *options, printers=1, reply_delay_ms=0.0, depth=DEPTH):
        self.rate, self.depth, self.printers = rate, depth, printers
        self.report_file = pathlib.Path(tempfile.mkstemp(prefix="report", suffix=".json", dir=directory)[1])
        realtime = realtime_prefix()
        self.realtime = bool(realtime)
        self.process = subprocess.Popen(
            [*realtime, *pin(CORES - 1), str(BIN / "linefeed-sim"), "--listen", "127.0.0.1:0", "--rate", str(rate), "--depth", str(depth),
             "--reply-delay", str(reply_delay_ms), "--printers", str(printers), "--report", str(self.report_file), "--summary-json",
             "/dev/null", *options],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        self.ports = []
        for _ in range(printers):
            match = re.search(r":(\d+)\s*$", self.process.stdout.readline())
            if not match:
                self.kill()
                raise RuntimeError("linefeed-sim did not start")
            self.ports.append(int(match.group(1)))

    def progress(self):
        """(prints, misses) so far, of all printers together."""
        self.process.send_signal(signal.SIGUSR1)
        while not (line := self.process.stdout.readline()).startswith("{"):
            if not line:
                raise RuntimeError("linefeed-sim has ended")
        seen = json.loads(line)
        return seen["prints"], seen["misses"]

    def wait_for_prints(self, count=1):
        deadline = time.monotonic() + SETTLE_S
        while self.progress()[0] < count:
            if time.monotonic() > deadline:
                raise RuntimeError(f"fewer than {count} prints within {SETTLE_S} s")
            time.sleep(0.01)

    def stop(self):
        """The report."""
        self.process.terminate()
        self.process.communicate(timeout=SETTLE_S)
        return json.loads(self.report_file.read_text(encoding="ascii"))

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


class Tap:
    """Stands between linefeed and the printer, passes on what it gets, and remembers when the first record came by."""

    def __init__(self, printer_port):
        self.first_record_ns = None
        self.printer_port = printer_port
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.thread = threading.Thread(target=self.serve, daemon=True)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        with contextlib.suppress(OSError):
            self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        self.thread.join()

    def serve(self):
        while True:
            try:
                host, _ = self.listener.accept()
            except OSError:
                return
            with host, socket.create_connection(("127.0.0.1", self.printer_port)) as printer:
                for end in (host, printer):
                    end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                with contextlib.suppress(ConnectionError):
                    self.pass_on(host, printer)

    def pass_on(self, host, printer):
        """Until one of them has closed."""
        seen = b""
        while True:
            for end in select.select([host, printer], [], [])[0]:
                data = end.recv(65536)
                if not data:
                    return
                if end is host and self.first_record_ns is None:
                    seen = seen[-4:] + data
                    if b"=MR" in seen:
                        self.first_record_ns = time.monotonic_ns()
                (printer if end is host else host).sendall(data)


class Hiccups:
    """A watch on every processor, in a process of the benchmark, with the printer's precedence. After the block `stalls` is
    [[from_ns, to_ns], …]."""

    def __init__(self):
        self.process = subprocess.Popen([*realtime_prefix(), str(BIN / "bench_hiccup")], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        out, _ = self.process.communicate(timeout=SETTLE_S)
        self.stalls = json.loads(out)


def linefeed_host(directory, port, records, options=(), name="linefeed"):
    """`linefeed print` of so many records, with a spool of its own."""
    source = directory / f"records{records}.csv"
    if not source.exists():
        write_csv(source, records)
    spool = pathlib.Path(tempfile.mkdtemp(prefix=name, dir=directory)) / "spool.db"
    with open(directory / f"{name}.log", "ab") as log:
        return subprocess.Popen([str(BIN / "linefeed"), "print", str(source), "--printer", f"tcp://127.0.0.1:{port}", "--spool", str(spool),
                                 *options], stdin=subprocess.DEVNULL, stdout=log, stderr=log)


def control_host(mode, port, records):
    """One of the hosts in control_host.cpp."""
    return subprocess.Popen([*(realtime_prefix(HOST_PRIORITY) if mode == "bare" else []), str(BIN / "bench_control_host"), mode, str(port),
                             str(records)], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def linefeed_options(realtime=True):
    """Options for `linefeed print`: with a real-time feed thread, as a line would run it, where that is permitted; LINEFEED_BENCH_OPTIONS instead."""
    chosen = os.environ.get("LINEFEED_BENCH_OPTIONS")
    if chosen is not None:
        return tuple(shlex.split(chosen))
    return ("--realtime-priority", str(HOST_PRIORITY), "--lock-memory") if realtime and realtime_prefix() else ()


@contextlib.contextmanager
def line(host, directory, rate, records, **printer_options):
    """A printer that prints what `host` sends: single, manual, bare (control_host.cpp), or a tuple of linefeed's options. Gives (printer, process)."""
    printer = Printer(directory, rate, **printer_options)
    process = None
    try:
        port = printer.ports[0]
        process = control_host(host, port, records) if isinstance(host, str) else linefeed_host(directory, port, records, host)
        printer.wait_for_prints()
        yield printer, process
    finally:
        if process:
            process.kill()
            process.wait()
        printer.kill()


def write_csv(path, records):
    with open(path, "w", encoding="ascii") as file:
        file.write("serial\n")
        file.writelines(f"SN-{number:010d}-ABCDEFGHIJKLMNOP\n" for number in range(1, records + 1))


def end(process, patience_s):
    """Waits for the end, or kills. The exit code; None: it was killed."""
    try:
        return process.wait(timeout=patience_s)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return None


# --- loads ---------------------------------------------------------------------------------------------------------------------

LOADS = ("none", "CPU hogs", "import", "fsync", "all")


@contextlib.contextmanager
def load(name, directory):
    """The load from start to end of the block. Each of its processes is a session of its own, ended as a group."""
    commands = []
    if name in ("CPU hogs", "all"):
        commands += [[sys.executable, "-c", "while True: pass"]] * CORES
    if name in ("import", "all"):
        source = directory / "load.csv"
        if not source.exists():
            write_csv(source, 2_000_000)
        # --dry-run imports completely and durably into a spool of its own, and prints nothing
        commands.append(["sh", "-c", f"while :; do '{BIN}/linefeed' print '{source}' --dry-run >/dev/null 2>&1; done"])
    if name in ("fsync", "all"):
        writer = "import os,sys\nf=os.open(sys.argv[1],os.O_CREAT|os.O_WRONLY)\nwhile True: os.pwrite(f,os.urandom(65536),0); os.fsync(f)"
        commands.append([sys.executable, "-c", writer, str(directory / "fsync.bin")])
    processes = [subprocess.Popen(command, start_new_session=True, stdin=subprocess.DEVNULL, env={**os.environ, "TMPDIR": str(directory)})
                 for command in commands]
    try:
        yield
    finally:
        for process in processes:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


# --- judging -------------------------------------------------------------------------------------------------------------------


class Stalls:
    """The time in which no process could run, put together from all watches."""

    def __init__(self, *lists):
        self.merged = []
        for begun, ended in sorted(tuple(stall) for stalls in lists for stall in stalls):
            if self.merged and begun <= self.merged[-1][1]:
                self.merged[-1][1] = max(self.merged[-1][1], ended)
            else:
                self.merged.append([begun, ended])
        self.ends = [ended for _, ended in self.merged]

    def within(self, begun, ended):
        """Nanoseconds of stall between two instants."""
        total = 0
        for stall in self.merged[bisect.bisect_left(self.ends, begun):]:
            if stall[0] >= ended:
                break
            total += min(stall[1], ended) - max(stall[0], begun)
        return total

    def count(self):
        return len(self.merged)

    def longest_ms(self):
        return max((ended - begun for begun, ended in self.merged), default=0) / 1e6


def judge(report, hiccups, rate, depth=DEPTH):
    """The figures of one printer's run. A miss is the platform's if the record would have been in time without the stalls of the time that
    a full FIFO lasts; otherwise it was avoidable."""
    stalls = Stalls(report_stalls(report), hiccups)
    window_ns = (depth / rate + 0.010) * 1e9
    avoidable = excused = 0
    printers = report["printers"]
    for printer in printers:
        listed = printer["miss_at_late_lead_ns"]
        for at, _, lead in listed:
            if lead is not None and lead + stalls.within(at - window_ns, at) >= MARGIN_S * 1e9:
                excused += 1
            else:
                avoidable += 1
        avoidable += printer["misses"] - len(listed)
    prints = sum(printer["prints"] for printer in printers)
    misses = sum(printer["misses"] for printer in printers)

    def lead_ms(name):
        known = [printer["lead_ns"][name] for printer in printers if printer["lead_ns"][name] is not None]
        return min(known) / 1e6 if known else None

    spans = [printer["last_print_ns"] - printer["first_print_ns"] for printer in printers if printer["prints"] > 1]
    return {
        "n": prints + misses, "prints": prints, "misses": misses, "avoidable": avoidable, "platform": excused,
        "lead_ms": {name: lead_ms(name) for name in ("min", "p0.001", "p0.1", "p50")},  # of several printers the worst
        "lowest_fill": min((printer["lowest_fill"] for printer in printers if printer["lowest_fill"] is not None), default=None),
        "highest_fill": max(printer["highest_fill"] for printer in printers),
        "wrong_numbers": sum(printer["doubles"] + printer["missing_numbers"] for printer in printers),
        "rate_seen": (prints + misses) / (max(spans) / 1e9) if spans else 0.0,
        "stalls": stalls.count(), "longest_stall_ms": stalls.longest_ms(),
        "late_print_gos": sum(printer["late_print_gos"] for printer in printers),
    }


def report_stalls(report):
    """Stalls as the simulator saw them: by its own watch, and by PrintGos that were late."""
    return [*report["stalls_ns"], *(late for printer in report["printers"] for late in printer["late_due_at_ns"])]


def ms(value):
    return "-" if value is None else f"{value:.1f}"
