"""linefeed check-config as a plant uses it: the effective settings on stdout, or every problem with its place on stderr."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import harness

CONFIG = pathlib.Path(__file__).resolve().parents[2] / "config"


class CheckConfig(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="linefeed-")
        self.addCleanup(directory.cleanup)
        self.directory = pathlib.Path(directory.name)

    def write(self, text, name="linefeed.yaml"):
        file = self.directory / name
        file.write_text(text, encoding="utf-8")
        return file

    def check(self, file, *options, **variables):
        environment = {key: value for key, value in os.environ.items() if not key.startswith("LINEFEED_")}
        done = subprocess.run([str(harness.BIN / "linefeed"), "check-config", str(file), *options], env={**environment, **variables},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=harness.PATIENCE_S, check=False)
        return harness.Result(done.returncode, done.stdout, done.stderr)

    def accept(self, *arguments, **variables):
        result = self.check(*arguments, **variables)
        self.assertEqual((0, ""), (result.code, result.err), str(result))
        return result

    def refuse(self, *arguments, **variables):
        result = self.check(*arguments, **variables)
        self.assertEqual((2, ""), (result.code, result.out), str(result))
        return result.err.splitlines()

    def test_the_example_is_good(self):
        result = self.accept(CONFIG / "linefeed.yaml", "-o", "json")
        self.assertEqual("tcp://192.168.1.20:3000", result.json()["printers"]["line1"]["address"])
        self.assertEqual(8631, result.json()["http"]["port"])

    def test_what_it_shows_is_a_configuration_with_the_same_settings(self):
        shown = self.accept(CONFIG / "linefeed.yaml").out
        self.assertEqual(shown, self.accept(self.write(shown)).out)
        as_json = self.accept(CONFIG / "linefeed.yaml", "-o", "json").out
        self.assertEqual(as_json, self.accept(self.write(as_json), "-o", "json").out)

    def test_variables_go_before_the_file(self):
        file = self.write("http: {port: 80}\n")
        result = self.accept(file, "-o", "json", LINEFEED_HTTP_PORT="81", LINEFEED_SPOOL="/data/spool.db", LINEFEED_BIN_DIR="/x")
        self.assertEqual((81, "/data/spool.db"), (result.json()["http"]["port"], result.json()["spool"]))
        self.assertEqual(['LINEFEED_HTTP_PROT: no setting has this name; did you mean "LINEFEED_HTTP_PORT"?'],
                         self.refuse(file, LINEFEED_HTTP_PROT="81"))

    def test_all_problems_are_told_with_their_places(self):
        file = self.write("errors: errors.yaml\nhttp:\n  port: 010\n  prot: 1\nprinters:\n  p:\n    address: serial:/dev/ttyS0\n")
        self.write("unlisted: acknowledge\n", "errors.yaml")
        lines = self.refuse(file, "-o", "json")
        self.assertEqual([f"{file}:3:9: http.port", f"{file}:4:3: http.prot", f"{file}:7:14: printers.p.address",
                          f"{self.directory}/errors.yaml:1:11: unlisted"], [line.split(": ", 2)[0] + ": " + line.split(": ", 2)[1] for line in lines])
        self.assertIn("leave leading zeros out", lines[0])
        self.assertIn('did you mean "port"?', lines[1])
        self.assertIn("or serial:///dev/ttyUSB0?baud=115200&flow=rtscts", lines[2])
        self.assertIn("expected report or stop", lines[3])

    def test_more_problems_than_anybody_reads_are_counted(self):
        lines = self.refuse(self.write("".join(f"key{number}: 1\n" for number in range(150))))
        self.assertEqual((101, "and 50 more"), (len(lines), lines[-1]))

    def test_files_that_cannot_be_read(self):
        self.assertEqual([f"{self.directory}/none.yaml: No such file or directory"], self.refuse(self.directory / "none.yaml"))
        self.assertEqual([f"{self.directory}: not a file"], self.refuse(self.directory))
        self.assertEqual(1, len(self.refuse(self.write(""))))

    def test_usage(self):
        for arguments in ((), ("a", "b"), ("a", "-o", "xml")):
            done = subprocess.run([str(harness.BIN / "linefeed"), "check-config", *arguments], capture_output=True, text=True, timeout=harness.PATIENCE_S, check=False)
            self.assertEqual(2, done.returncode, arguments)

    def test_the_disk_is_full(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([str(harness.BIN / "linefeed"), "check-config", str(CONFIG / "linefeed.yaml")], stdout=full, stderr=subprocess.PIPE, timeout=harness.PATIENCE_S, check=False)
        self.assertEqual(1, done.returncode)


if __name__ == "__main__":
    harness.main()
