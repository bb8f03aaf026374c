"""The commands of README.md, as they are written there, in a directory that looks like the one they are meant for. The judge is the tape.

They use fixed ports: each test has a network of its own, which takes root; without, they meet whatever else uses these ports.
"""

import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

import harness

ROOT = pathlib.Path(__file__).resolve().parents[2]
NETWORK = ["unshare", "--net", "sh", "-c", 'ip link set lo up && exec "$@"', "sh"]


def has_own_network():
    return os.geteuid() == 0 and subprocess.run([*NETWORK, "true"], capture_output=True, check=False).returncode == 0


def blocks(heading):
    """What is indented below a heading, piece by piece."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    section = re.search(rf"(?ms)^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", text).group(1)
    return [re.sub("(?m)^    ", "", block) for block in re.findall(r"(?m)(?:^    .*\n(?:\n(?=    ))?)+", section)]


class Readme(harness.TestCase):
    def setUp(self):
        super().setUp()
        if not has_own_network():
            raise unittest.SkipTest("a network of its own takes root")
        (self.directory / "build/release").mkdir(parents=True)
        (self.directory / "build/release/bin").symlink_to(harness.BIN.resolve())
        (self.directory / "config").symlink_to(ROOT / "config")
        self.home = subprocess.Popen([*NETWORK, "cat"], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL)  # holds the network
        self.addCleanup(self.home.communicate)
        while subprocess.run(self.inside("ip", "route", "get", "127.0.0.1"), capture_output=True, check=False).returncode != 0:
            time.sleep(0.05)
        self.terminals = []
        self.addCleanup(self.close_terminals)

    def inside(self, *command):
        return ["nsenter", f"--net=/proc/{self.home.pid}/ns/net", "--", *command]

    def terminal(self, commands):
        """They run one after the other, and the first that fails ends it."""
        environment = {"HOME": str(self.directory), "PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"}
        process = subprocess.Popen(self.inside("bash", "-e", "-m", "-c", commands), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   text=True, cwd=self.directory, env=environment, start_new_session=True)
        self.terminals.append(process)
        return process

    def close_terminals(self):
        """With all that was started in them."""
        for process in self.terminals:
            for name in filter(str.isdigit, os.listdir("/proc")):
                try:
                    if os.getsid(int(name)) == process.pid:
                        os.kill(int(name), signal.SIGKILL)
                except ProcessLookupError:
                    continue
            process.communicate()

    def type(self, commands):
        process = self.terminal(commands)
        out, _ = process.communicate(timeout=2 * harness.PATIENCE_S)
        self.assertEqual(0, process.returncode, f"{commands}\n{out}")
        return out

    def wait_for_port(self, port):
        deadline = time.monotonic() + harness.PATIENCE_S
        while subprocess.run(self.inside("bash", "-c", f"exec 3<> /dev/tcp/127.0.0.1/{port}"), capture_output=True, check=False).returncode != 0:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)

    def assert_tape(self, expected):
        """The simulator writes its tape behind the print."""
        deadline = time.monotonic() + harness.TAPE_DELAY_S
        while True:
            lines = (self.directory / "tape.csv").read_text(encoding="utf-8").splitlines()[1:]
            printed = [tuple(line.split(",")[1:]) for line in lines]
            if len(printed) >= len(expected) or time.monotonic() > deadline:
                break
            time.sleep(0.02)
        self.assertEqual(expected, printed)

    def test_five_minutes_with_a_file_of_your_own(self):
        printer, look, print_it = blocks("Five minutes with a file of your own")[:3]
        self.terminal(printer)
        self.wait_for_port(3000)
        self.assertIn("M<FC>ller", self.type(look))
        self.assertIn("Weiß", self.type(print_it))
        self.assert_tape([("1", "Müller"), ("2", "Weiß")])
        self.type(print_it)
        self.assert_tape([("1", "Müller"), ("2", "Weiß")])

    def test_the_drop_folder(self):
        watch, drop, again = blocks("Drop folder")[:3]
        self.terminal(blocks("Five minutes with a file of your own")[0])
        self.wait_for_port(3000)
        watching = self.terminal(watch)
        while not (self.directory / "batches/processing/.lock").exists():
            time.sleep(0.05)
        *look, print_it = drop.splitlines()
        self.assertIn('"imported"', self.type("\n".join(look)))
        for process in pathlib.Path("/proc").glob("[0-9]*"):  # Ctrl-C: it goes to what runs in the foreground of that terminal
            try:
                if os.getsid(int(process.name)) == watching.pid and (process / "comm").read_text() == "linefeed\n":
                    os.kill(int(process.name), signal.SIGINT)
            except (ProcessLookupError, FileNotFoundError):
                continue
        watching.wait(harness.PATIENCE_S)
        self.type(print_it)
        self.assert_tape([("1", "Müller"), ("2", "Weiß")])
        self.assertIn('"duplicate"', self.type(again))

    def test_the_path_of_a_plant(self):
        out = self.type("\n".join(blocks("The service")))
        names = [(str(k), f"Name {k:04d}") for k in range(1, 2001)]
        self.assert_tape([*names, ("17", "Name 0017"), ("1", "Müller"), ("2", "Weiß")])
        for words in ("2 of 2 records printed", "every hash right", "smeared"):
            self.assertIn(words, out)
        self.assertEqual(2001, len((self.directory / "ledger.csv").read_text(encoding="utf-8").splitlines()))


if __name__ == "__main__":
    harness.main()
