"""Runs the real programs against each other, in a directory of their own, and judges the tape.

The judge stands outside: it knows the records that were to be printed and reads what stuck to the products (the simulator's tape),
never what linefeed says about itself.
"""

import contextlib
import csv
import io
import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest

BIN = pathlib.Path(os.environ.get("LINEFEED_BIN_DIR", pathlib.Path(__file__).resolve().parents[2] / "build/release/bin"))
LONG = os.environ.get("LINEFEED_LONG_TESTS", "") not in ("", "0")
PATIENCE_S = 60  # longest wait for a program that should end by itself
TAPE_DELAY_S = 5
# Ports for what cannot say which one it was given: below those that the kernel deals out, a row for each test process, so that tests that
# run at once do not meet.
ROWS, PORTS_IN_ROW = 2000, 10
FIRST_PORT = 10000 + os.getpid() % ROWS * PORTS_IN_ROW
ports = itertools.cycle(range(FIRST_PORT, FIRST_PORT + PORTS_IN_ROW))


def free_port():
    """Where nobody listens."""
    for port in itertools.islice(ports, PORTS_IN_ROW):
        with contextlib.suppress(OSError), socket.create_server(("127.0.0.1", port)):
            return port
    raise AssertionError(f"no port is free from {FIRST_PORT} on")


class Result:
    """How a run of linefeed ended."""

    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err

    # What stderr may hold besides the one line that says what is wrong: progress, notices, and the sum of bad rows.
    CONTEXT = re.compile(r"linefeed: (imported \d+ records|importing +\d|importing .* as job \d+ while it is printed$|printing( +\d| +record \d|$)|acknowledged|stopping the line$|nothing is imported: "
                         r"|the printer (reports (?!error )|(was|is) still printing|does not keep the stop point)|opening the nozzle|the printer runs empty soon: "
                         r"|the file ends with record \d+, before --to$)")

    @property
    def errors(self):
        """The lines on stderr that are not mere context."""
        return [line for line in self.err.splitlines() if not self.CONTEXT.match(line)]

    def json(self):
        return json.loads(self.out)

    def __str__(self):
        return f"exit code {self.code}\nstdout: {self.out}\nstderr: {self.err}"


class Simulator:
    """linefeed-sim as a process of its own. stop() gives the summary."""

    def __init__(self, directory, *options):
        self.directory = pathlib.Path(directory)
        number = len(list(self.directory.glob("tape*.csv"))) + 1
        self.tape_file = self.directory / f"tape{number}.csv"
        self.summary_file = self.directory / f"summary{number}.json"
        self.summary = None
        command = [str(BIN / "linefeed-sim"), "--listen", "127.0.0.1:0", "--tape", str(self.tape_file),
                   "--summary-json", str(self.summary_file), *map(str, options)]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        greeting = self.process.stdout.readline()
        match = re.search(r"listening on .*:(\d+)\s*$", greeting)
        if not match:
            self.process.kill()
            raise AssertionError(f"linefeed-sim did not start: {greeting!r} {self.process.communicate()[1]!r}")
        self.port = int(match.group(1))

    @property
    def address(self):
        return f"tcp://127.0.0.1:{self.port}"

    def stop(self):
        if self.process.poll() is None:
            self.process.terminate()
        _, err = self.process.communicate(timeout=PATIENCE_S)
        if self.summary is None and self.process.returncode == 0:
            self.summary = json.loads(self.summary_file.read_text(encoding="utf-8"))
        if self.process.returncode != 0:
            raise AssertionError(f"linefeed-sim ended with {self.process.returncode}: {err}")
        return self.summary

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def prints(self):
        """(number, text) of everything on the tape so far, complete lines only."""
        tape = self.tape_file.read_bytes()
        rows = list(csv.reader(io.StringIO(tape[:tape.rfind(b"\n") + 1].decode("utf-8"), newline="")))
        return [(int(number), what) for _, number, what in rows[1:]]

    def wait_for_prints(self, count, patience_s=PATIENCE_S):
        deadline = time.monotonic() + patience_s
        while len(self.prints()) < count:
            if time.monotonic() > deadline:
                raise AssertionError(f"only {len(self.prints())} of {count} prints within {patience_s} s")
            time.sleep(0.02)


class Proxy:
    """Stands between linefeed and the printer: listens in (said()), and for faults of the network alone: cut(), mute(), hold() and
    heal(). `crumbs`: what the printer says arrives byte by byte."""

    def __init__(self, simulator, crumbs=False):
        self.simulator = simulator
        self.crumbs = crumbs
        self.muted = False
        self.open = threading.Event()
        self.open.set()
        self.refill_wanted = False
        self.sockets = []
        self.heard = []  # of linefeed, one entry for each read
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    @property
    def address(self):
        return f"tcp://127.0.0.1:{self.port}"

    def accept(self):
        with contextlib.suppress(OSError):
            while True:
                host, _ = self.listener.accept()
                printer = socket.create_connection(("127.0.0.1", self.simulator.port))
                for end in (host, printer):
                    end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self.sockets += [host, printer]
                threading.Thread(target=self.pump, args=(host, printer, False), daemon=True).start()
                threading.Thread(target=self.pump, args=(printer, host, True), daemon=True).start()

    def pump(self, source, sink, from_printer):
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                if from_printer and self.muted:
                    continue
                if not from_printer:
                    self.heard.append(data)
                    if self.refill_wanted and b"=MR" in data:
                        self.refill_wanted = False
                        self.open.clear()
                    self.open.wait()
                step = 1 if self.crumbs and from_printer else len(data)
                for place in range(0, len(data), step):
                    sink.sendall(data[place:place + step])
        for end in (source, sink):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
        source.close()

    def said(self):
        """What linefeed has said so far, as ["?RS", "=MR1", "!GO", …]: of parameters only the first."""
        frames = b"".join(self.heard).split(b"\r")[:-1]
        return [frame.lstrip(b"\n")[2:].split(b"\t")[0].decode("ascii") for frame in frames]

    def mute(self):
        """From now on no answer of the printer comes through."""
        self.muted = True

    def hold(self):
        """From now on nothing that linefeed says comes through; it will, later."""
        self.open.clear()

    def hold_refill(self, patience_s=PATIENCE_S):
        """Waits for the next refill and holds it, and everything behind it."""
        self.refill_wanted = True
        deadline = time.monotonic() + patience_s
        while self.refill_wanted:
            if time.monotonic() > deadline:
                raise AssertionError(f"no refill within {patience_s} s")
            time.sleep(0.001)

    def heal(self):
        self.muted = False
        self.open.set()

    def cut(self):
        sockets, self.sockets = self.sockets, []
        for end in sockets:
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
        self.open.set()

    def close(self):
        with contextlib.suppress(OSError):
            self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        self.cut()


class Client:
    """Somebody else who talks to the printer, or its panel: what it takes for a key pressed at a moment of the test's choice."""

    def __init__(self, simulator):
        self.socket = socket.create_connection(("127.0.0.1", simulator.port))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.answers = self.socket.makefile("rb")

    def send(self, *frames):
        self.socket.sendall(b"".join(b"^0" + frame.encode("latin-1") + b"\r" for frame in frames))

    def ask(self, inquiry):
        """Sends an inquiry and gives the answer's parameters."""
        self.send(inquiry)
        line = b""
        while not (line.endswith(b"\r") and line.strip()):
            byte = self.answers.read(1)
            if not byte:
                raise AssertionError("the printer has closed the connection")
            line += byte
        return line.strip()[5:].decode("latin-1").split("\t")

    def close(self):
        self.answers.close()
        self.socket.close()


class Job:
    """linefeed as a process that is still running. `messages`: a file for what it says on stderr, if that may be more than a pipe holds
    before anybody reads it."""

    def __init__(self, command, messages=subprocess.PIPE):
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=messages, text=True)

    def signal(self, number):
        self.process.send_signal(number)

    def wait(self, patience_s=PATIENCE_S):
        try:
            out, err = self.process.communicate(timeout=patience_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            out, err = self.process.communicate()
            raise AssertionError(f"linefeed did not end within {patience_s} s\nstdout: {out}\nstderr: {err}") from None
        return Result(self.process.returncode, out, err)

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


class TestCase(unittest.TestCase):
    """A test with a directory, a spool and printers that are gone when it ends."""

    maxDiff = 2000

    def setUp(self):
        self.directory = pathlib.Path(tempfile.mkdtemp(prefix="linefeed-"))
        self.addCleanup(shutil.rmtree, self.directory, ignore_errors=True)
        self.spool = self.directory / "state" / "spool.db"

    def simulator(self, *options):
        simulator = Simulator(self.directory, *options)
        self.addCleanup(simulator.kill)
        return simulator

    def proxy(self, simulator, **keywords):
        proxy = Proxy(simulator, **keywords)
        self.addCleanup(proxy.close)
        return proxy

    def client(self, simulator):
        client = Client(simulator)
        self.addCleanup(client.close)
        return client

    def command(self, file, printer, *options, spool=None):
        """`printer`: something with an address, an address, or None."""
        address = getattr(printer, "address", printer)
        return [str(BIN / "linefeed"), "print", str(file), *(["--printer", address] if address else []),
                "--spool", str(spool or self.spool), *map(str, options)]

    def start(self, file, printer, *options, **keywords):
        job = Job(self.command(file, printer, *options, **keywords))
        self.addCleanup(job.kill)
        return job

    def print(self, file, printer, *options, patience_s=PATIENCE_S, **keywords):
        return self.start(file, printer, *options, **keywords).wait(patience_s)

    def write_csv(self, rows, name="names.csv", header=("name",), delimiter=",", encoding="utf-8", newline="\n"):
        path = self.directory / name
        with open(path, "w", encoding=encoding, newline="") as file:
            writer = csv.writer(file, delimiter=delimiter, lineterminator=newline)
            writer.writerows([header] if header else [])
            writer.writerows(rows)
        return path

    def write_bytes(self, content, name="names.csv"):
        path = self.directory / name
        path.write_bytes(content)
        return path

    def assert_code(self, code, result):
        self.assertEqual(code, result.code, str(result))

    def assert_done(self, result):
        self.assert_code(0, result)
        self.assertEqual([], result.errors, str(result))

    def assert_one_clear_line(self, code, result, *words):
        """The right exit code, and exactly one line on stderr, which says what is wrong."""
        self.assert_code(code, result)
        self.assertEqual(1, len(result.errors), str(result))
        self.assertTrue(result.errors[0].startswith("linefeed: "), str(result))
        self.assertTrue(result.errors[0].isprintable(), str(result))
        for word in words:
            self.assertIn(word, result.errors[0])

    def assert_printed(self, expected, *simulators):
        """The tapes, one after the other, hold exactly `expected`: [(number, text)], each once, in order. A simulator writes its tape behind
        the print, so the last lines may be a moment late."""
        deadline = time.monotonic() + TAPE_DELAY_S
        while True:
            printed = [line for simulator in simulators for line in simulator.prints()]
            if len(printed) >= len(expected) or time.monotonic() > deadline:
                break
            time.sleep(0.02)
        self.judge(expected, printed)

    def judge(self, expected, printed):
        if expected == printed:
            return
        numbers = [number for number, _ in printed]
        doubles = sorted({number for number in numbers if numbers.count(number) > 1})[:10] if len(numbers) < 20000 else "?"
        missing = sorted(set(number for number, _ in expected) - set(numbers))[:10]
        wrong = next((f"place {place}: {want} was to be printed, {got} is on the tape"
                      for place, (want, got) in enumerate(zip(expected, printed)) if want != got), "the tape ends early or late")
        self.fail(f"{len(printed)} prints instead of {len(expected)}; doubles {doubles}; missing {missing}; first difference: {wrong}")

    def assert_clean(self, summary, depth=256):
        """Nothing went wrong at the printer, by its own account."""
        self.assertEqual((0, 0, 0), (summary["doubles"], summary["gaps"], summary["underruns"]), summary)
        self.assertEqual(0, summary["without_record"], "products that carry no record")
        self.assertEqual(0, summary["damaged_frames"], summary)
        self.assertLessEqual(summary["highest_fill"], depth, summary)
        self.assertNotIn("1015", summary["errors"], "the printer's FIFO ran over")
        self.assertNotIn("5043", summary["errors"], "the printer's FIFO ran empty")


def names(count, first=1):
    """[(number, text)] as the tape should show them."""
    stems = ["Müller", "Weiß", "Groß", "Schäfer", "König", "Möller", "Jürgens", "Ångström", "Señor", "O'Neil"]
    return [(k, f"{stems[k % len(stems)]} {k:06d}") for k in range(first, first + count)]


def rows(records):
    """The rows of a file with these records."""
    return [[text] for _, text in records]


INTERRUPT = signal.SIGINT
TERMINATE = signal.SIGTERM


def main():
    unittest.main(verbosity=2)
