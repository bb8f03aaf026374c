"""The subcommands of linefeed against a real linefeedd with real (simulated) printers: every command as an operator uses it, wrong
input, no service, and a service that dies while somebody looks on. The judge is the printer's tape."""

import contextlib
import csv
import grp
import io
import json
import os
import pty
import re
import socket
import subprocess
import time

import harness

JOB_OF = re.compile(r"job (\d+)")


class ServiceTest(harness.TestCase):
    """A test with a linefeedd that has one printer, `line1`, and a folder."""

    simulator_options = ("--rate", "1000")

    def setUp(self):
        super().setUp()
        self.printer = self.simulator(*self.simulator_options)
        self.link = self.proxy(self.printer)
        self.socket = self.directory / "linefeed.sock"
        self.port = harness.free_port()
        self.folder = self.directory / "folder"
        self.folder.mkdir()
        self.config = self.directory / "linefeed.yaml"
        self.configure()
        self.service = None
        self.addCleanup(self.kill_service)

    def configure(self, level="info", more=""):
        self.config.write_text(f"""
spool: {self.spool}
control: {{socket: {self.socket}, group: "{grp.getgrgid(os.getgid()).gr_name}"}}
http: {{port: {self.port}{more}}}
logging: {{target: stderr, level: {level}}}
layouts:
  names: {{columns: [name]}}
printers:
  line1: {{address: "{self.link.address}"}}
folders:
  in: {{path: {self.folder}, layout: names, printer: line1}}
""", encoding="utf-8")

    def start_service(self):
        environment = {key: value for key, value in os.environ.items() if not key.startswith("LINEFEED_") and key != "NOTIFY_SOCKET"}
        with open(self.directory / "linefeedd.log", "ab") as log:
            self.service = subprocess.Popen([str(harness.BIN / "linefeedd"), "--config", str(self.config)], env=environment,
                                            stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        deadline = time.monotonic() + harness.PATIENCE_S
        while self.linefeed("status").code != 0:
            if time.monotonic() > deadline or self.service.poll() is not None:
                self.fail("linefeedd did not start: " + (self.directory / "linefeedd.log").read_text(encoding="utf-8", errors="replace")[-2000:])
            time.sleep(0.05)

    def kill_service(self):
        if self.service is not None:
            self.service.kill()
            self.service.wait()
            self.service = None

    def command(self, *arguments):
        return [str(harness.BIN / "linefeed"), *map(str, arguments), "--socket", str(self.socket)]

    def follow(self, *arguments):
        job = harness.Job(self.command(*arguments))
        self.addCleanup(job.kill)
        return job

    def linefeed(self, *arguments):
        return self.follow(*arguments).wait()

    def done(self, *arguments):
        result = self.linefeed(*arguments)
        self.assertEqual((0, ""), (result.code, result.err), str(arguments) + str(result))
        return result

    def refused(self, code, *arguments, words=()):
        result = self.linefeed(*arguments)
        self.assert_one_clear_line(code, result, *words)
        return result

    def job(self, number):
        return self.done("job", number, "-o", "json").json()

    def imported(self, records, *options, name="names.csv"):
        """The number of the new job."""
        file = self.write_csv(harness.rows(records), name=name)
        return int(JOB_OF.search(self.done("import", file, "--printer", "line1", "--layout", "names", *options).out)[1])

    def wait_for_phase(self, number, *phases):
        deadline = time.monotonic() + harness.PATIENCE_S
        while (job := self.job(number))["phase"] not in phases:
            self.assertLess(time.monotonic(), deadline, job)
            time.sleep(0.05)
        return job


class ServiceCommands(ServiceTest):
    def setUp(self):
        super().setUp()
        self.start_service()

    def test_a_job_from_its_file_to_its_ledger(self):
        records = harness.names(2000)
        number = self.imported(records)
        self.assertEqual(("queued", 1), (self.job(number)["phase"], self.job(number)["place"]))
        self.assertRegex(self.done("jobs").out, rf"(?m)^ *{number}  queued +line1 +0 of 2000 .*names\.csv  place 1 in the queue$")
        result = self.linefeed("start", number, "--wait")
        self.assert_code(0, result)
        self.assertIn("finished, 2000 of 2000 records printed", result.out)
        self.assert_printed(records, self.printer)
        self.assertEqual([number], [job["id"] for job in self.done("jobs", "--phase", "finished", "-o", "json").json()])
        self.assertEqual([], self.done("jobs", "--phase", "printing,stopped", "-o", "json").json())

        self.assertIn("issued 2000 = 2000 printed + 0 in_doubt", self.done("ledger", number).out)
        self.assertIn("every hash right", self.done("ledger", number, "--verify").out)
        table = list(csv.DictReader(io.StringIO(self.done("ledger", number, "--export", "csv").out)))
        self.assertEqual([(str(k), text, "printed") for k, text in records], [(row["number"], row["fields"], row["state"]) for row in table])
        part = [json.loads(line) for line in self.done("ledger", number, "--records", "7-8", "-o", "json").out.splitlines()]
        self.assertEqual([(7, [records[6][1]]), (8, [records[7][1]])], [(line["number"], line["fields"]) for line in part])
        from_file = harness.Job([str(harness.BIN / "linefeed"), "ledger", str(number), "--export", "csv", "--spool", str(self.spool)]).wait()
        self.assertEqual(table, list(csv.DictReader(io.StringIO(from_file.out))), "the file tells the same as the service")

        kinds = [json.loads(line)["kind"] for line in self.done("events", "--job", number, "-o", "json").out.splitlines()]
        self.assertEqual(sorted(set(kinds), key=kinds.index), kinds, "each once")
        self.assertLess(kinds.index("job.started"), kinds.index("job.finished"))
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        audit = self.done("audit", "-o", "json").json()
        self.assertEqual({"import", "start"}, {entry["what"] for entry in audit if user in entry["who"]} & {"import", "start"}, audit)

    def test_stop_and_resume(self):
        records = harness.names(6000)
        number = self.imported(records)
        self.assertEqual(number, self.done("start", "--printer", "line1", "-o", "json").json()["id"])
        self.printer.wait_for_prints(500)
        stopped = self.done("stop")
        self.assertRegex(stopped.out, rf"^line1: stopped\n  job {number} \(names\.csv\): stopped, \d+ of 6000 records printed, next \d+")
        self.assertEqual("stopped", self.job(number)["phase"])
        self.assert_code(0, self.linefeed("resume", number, "--wait"))
        self.assert_printed(records, self.printer)
        self.assertIn("idle", self.done("printers").out)

    def test_ctrl_c_ends_the_looking_on_and_not_the_job(self):
        number = self.imported(harness.names(20000))
        looking = self.follow("start", number, "--wait")
        self.printer.wait_for_prints(200)
        looking.signal(harness.INTERRUPT)
        result = looking.wait()
        self.assert_code(1, result)
        self.assertIn(f"job {number} goes on without you looking", result.err)
        before = len(self.printer.prints())
        self.printer.wait_for_prints(before + 500)
        self.done("stop", "line1")

    def test_records_are_printed_once_more_with_a_reason_and_a_yes(self):
        records = harness.names(50)
        number = self.imported(records)
        self.assert_code(0, self.linefeed("start", number, "--wait"))
        again = ("reprint", number, "--records", "3-4,9", "--reason", "smeared")
        self.refused(2, *again, words=("3 records once more (3-4, 9)", "--yes"))
        self.assertEqual("finished", self.job(number)["phase"])
        self.done(*again, "--yes")
        self.assertEqual(("stopped", 3), (self.job(number)["phase"], self.job(number)["next"]["first"]))
        self.assert_code(0, self.linefeed("resume", number, "--wait"))
        self.assert_printed(records + [records[2], records[3], records[8]], self.printer)

    def test_cancel_and_queue(self):
        first = self.imported(harness.names(10))
        file = self.write_csv(harness.rows(harness.names(10, first=100)), name="others.csv")
        second = int(JOB_OF.search(self.done("import", file, "--layout", "names").out)[1])
        self.assertEqual(("ready", None), (self.job(second)["phase"], self.job(second)["place"]))
        self.done("queue", second, "line1")
        self.assertEqual(2, self.job(second)["place"])
        self.refused(2, "cancel", first, words=("give up job", "--yes"))
        self.done("cancel", first, "--yes")
        self.assertEqual(("cancelled", 1), (self.job(first)["phase"], self.job(second)["place"]))
        self.assert_code(0, self.linefeed("start", "--printer", "line1", "--wait"))
        self.assertEqual("finished", self.job(second)["phase"])

    def test_import_says_what_becomes_of_each_file(self):
        number = self.imported(harness.names(10))
        same = self.done("import", self.directory / "names.csv", "--layout", "names")
        self.assertIn(f"is job {number} already", same.out)
        again = self.done("import", self.directory / "names.csv", "--layout", "names", "--again", "-o", "json").json()
        self.assertNotEqual(number, again["job"])
        sent = self.done("import", self.write_csv([["upload"]], name="a b.csv"), "--layout", "names", "--upload", "-o", "json").json()
        self.assertEqual("a b.csv", self.job(sent["job"])["name"])
        bad = self.write_bytes("name\ngood\n東\n".encode(), name="bad.csv")
        for how in ((), ("--upload",)):
            result = self.linefeed("import", bad, "--layout", "names", *how)
            self.assert_code(5, result)
            self.assertIn("bad.csv: line 3, column name: ", result.err)
        self.refused(5, "import", self.directory / "none.csv", words=("none.csv",))
        self.refused(5, "import", self.directory, words=("is a directory",))
        self.refused(2, "import", bad, "--layout", "nome", words=("nome",))

    def test_printers_folders_and_the_service(self):
        self.assertRegex(self.done("printers").out, r"(?m)^line1 ")
        self.assertIn("address", self.done("printer", "line1").out)
        self.assertEqual("line1", self.done("printer", "line1", "-o", "json").json()["name"])
        preflight = self.linefeed("printer", "line1", "preflight", "-o", "json")
        self.assertEqual(preflight.code, 0 if preflight.json()["ok"] else 4, str(preflight))
        self.assert_code(0, self.linefeed("printer", "line1", "preflight"))
        self.assert_code(0, self.linefeed("start", self.imported(harness.names(5)), "--wait"))
        self.assertTrue(any("=MR" in frame["text"] for frame in self.done("printer", "line1", "frames", "-o", "json").json()))
        self.assertIn("->", self.done("printer", "line1", "frames").out)
        self.refused(4, "printer", "line1", "acknowledge", 10202, words=("10202", "no error"))
        self.refused(4, "printer", "line1", "acknowledge", words=("no error",))
        self.done("printer", "line1", "suspend", "--hold", 30)
        self.assertTrue(self.done("printer", "line1", "-o", "json").json()["panel_suspended"])
        self.done("printer", "line1", "release")
        self.assertFalse(self.done("printer", "line1", "-o", "json").json()["panel_suspended"])
        self.assertEqual(["in"], [folder["name"] for folder in self.done("folders", "-o", "json").json()])
        self.assertIn(str(self.folder), self.done("folders").out)
        self.assertIn("ready", self.done("status").out)
        self.assertEqual("line1: stopped\n", self.done("stop", "--all").out)

    def test_reload_whole_or_not_at_all(self):
        self.configure(level="debug")
        self.assertIn("logging.level", self.done("reload").out)
        self.assertIn("nothing has changed", self.done("reload").out)
        self.config.write_text("htp: {}\n", encoding="utf-8")
        result = self.linefeed("reload")
        self.assert_code(2, result)
        self.assertIn("htp", result.err)
        self.done("status")

    def test_the_doctor_looks_at_both_sides(self):
        report = self.linefeed("doctor", "--config", self.config, "-o", "json")
        checks = {finding["check"]: finding["severity"] for finding in report.json()["items"]}
        for check in ("socket", "version", "configuration", "clock", "spool disk"):
            self.assertIn(check, checks)
        self.assertEqual(("ok", "ok", "ok"), (checks["socket"], checks["version"], checks["configuration"]), str(report))
        self.assertEqual(report.code, 0 if report.json()["ok"] else 1, str(report))
        self.config.write_text("htp: {}\n", encoding="utf-8")
        self.assert_code(1, self.linefeed("doctor", "--config", self.config))

    def test_watch_gives_lines_where_there_is_no_terminal(self):
        number = self.imported(harness.names(20000))
        self.done("start", number)
        for options in ((), ("-o", "json")):
            watching = self.follow("watch", "--interval", "0.2", *options)
            time.sleep(1.5)
            watching.signal(harness.INTERRUPT)
            result = watching.wait()
            self.assertEqual((0, ""), (result.code, result.err), str(result))
            lines = result.out.splitlines()
            self.assertGreaterEqual(len(lines), 2)
            if options:
                self.assertEqual(number, json.loads(lines[-1])["printers"][0]["job"])
            else:
                self.assertRegex(lines[-1], rf"  line1: printing, job {number}, .*, printed [\d.]+ % of 20000$")
        self.done("stop")

    def test_watch_draws_on_a_terminal_and_leaves_it_as_it_was(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        watching = subprocess.Popen(self.command("watch", "--interval", "0.2"), stdin=subprocess.DEVNULL, stdout=theirs, stderr=subprocess.PIPE,
                                    env={**os.environ, "TERM": "xterm"})
        self.addCleanup(watching.communicate)
        self.addCleanup(watching.kill)
        os.close(theirs)
        drawn = b""
        while b"line1" not in drawn:
            drawn += os.read(ours, 65536)
        watching.send_signal(harness.INTERRUPT)
        with contextlib.suppress(OSError):  # the terminal's other end is closed
            while more := os.read(ours, 65536):
                drawn += more
        self.assertEqual(0, watching.wait(timeout=harness.PATIENCE_S))
        self.assertTrue(drawn.startswith(b"\x1b[?1049h\x1b[?25l"), drawn[:50])
        self.assertTrue(drawn.endswith(b"\x1b[?25h\x1b[?1049l"), drawn[-50:])

    def test_over_tcp_with_a_token(self):
        looking = [str(harness.BIN / "linefeed"), "status", "--url", f"http://127.0.0.1:{self.port}"]
        self.assert_code(0, harness.Job(looking).wait())
        changing = [str(harness.BIN / "linefeed"), "reload", "--url", f"http://127.0.0.1:{self.port}"]
        self.assertNotEqual(0, harness.Job(changing).wait().code, "without a token nobody may change anything")
        self.kill_service()
        tokens = self.directory / "tokens"
        tokens.write_text(self.new_token("display", "viewer")["line"] + "\n", encoding="utf-8")
        tokens.chmod(0o600)
        self.configure(more=", tokens_file: tokens")
        self.start_service()
        made = self.new_token("mes", "operator")
        token = self.directory / "token"
        token.write_text(made["token"] + "\n", encoding="utf-8")
        with_token = ["--token-file", str(token)]
        self.assertNotEqual(0, harness.Job(changing + with_token).wait().code, "the service does not know it yet")
        with tokens.open("a", encoding="utf-8") as file:
            file.write(made["line"] + "\n")
        self.done("reload")
        self.assert_code(0, harness.Job(changing + with_token).wait())
        before = tokens.read_text(encoding="utf-8")
        tokens.write_text("nonsense\n", encoding="utf-8")
        self.refused(2, "reload", words=("the old settings stay", "tokens:1"))
        self.assertNotEqual(0, harness.Job(changing + with_token).wait().code, "refused, as the file is wrong still")
        self.assert_code(0, harness.Job(looking + with_token).wait())
        tokens.write_text(before, encoding="utf-8")
        self.assert_code(0, harness.Job(changing + with_token).wait())
        file = self.write_csv([["über TCP"]])
        sent = harness.Job([str(harness.BIN / "linefeed"), "import", str(file), "--layout", "names", *changing[2:], *with_token]).wait()
        self.assert_code(0, sent)
        self.assertNotEqual(0, harness.Job(looking).wait().code)

    def new_token(self, name, role):
        return harness.Job([str(harness.BIN / "linefeed"), "token", "new", name, "--role", role, "-o", "json"]).wait().json()


class ServiceTrouble(ServiceTest):
    simulator_options = ("--rate", "500")

    def test_without_a_service(self):
        file = self.write_csv([["x"]])
        for arguments in (("status",), ("jobs",), ("job", 1), ("start", 1), ("resume", 1), ("stop", "line1"), ("stop",), ("printers",), ("printer", "line1"),
                          ("printer", "line1", "frames"), ("folders",), ("events",), ("events", "-f"), ("audit",), ("reload",), ("watch",),
                          ("import", file), ("ledger", 1), ("settle", 1), ("cancel", 1, "--yes"), ("queue", 1, "line1"),
                          ("reprint", 1, "--records", "1", "--reason", "x", "--yes")):
            self.refused(3, *arguments, words=(f"there is no service at {self.socket}", "systemctl status linefeedd"))
        report = self.linefeed("status", "-o", "json")
        self.assertEqual(("unreachable", 3), (report.json()["result"], report.json()["exit_code"]))
        self.assert_code(3, self.linefeed("doctor"))
        with socket.socket(socket.AF_UNIX) as dead:  # left by a service that was killed
            dead.bind(str(self.socket))
        self.refused(3, "status", words=("linefeedd",))

    def test_wrong_input(self):
        self.start_service()
        number = self.imported(harness.names(5))
        for arguments, words in (
                (("job", 99), ("99",)), (("job", "x"), ("JOB",)), (("job", 0), ("JOB",)), (("start",), ("--printer",)), (("start", 99), ("99",)),
                (("start", "--printer", "line9"), ("line9",)), (("stop", "line9"), ("line9",)), (("printer", "line9"), ("line9",)),
                (("queue", number, "line9"), ("line9",)), (("resume", 99), ("99",)), (("cancel", 99, "--yes"), ("99",)),
                (("jobs", "--phase", "done"), ("--phase",)), (("jobs", "--limit", "0"), ("--limit",)), (("ledger", 99), ("99",)),
                (("ledger", number, "--records", "x"), ("N-M",)), (("settle", number, "--printed", "1"), ("no record of job",)),
                (("settle", number, "--printed", "1", "--last-printed", "1"), ("exclude each other",)),
                (("reprint", number, "--records", "9-7", "--reason", "x", "--yes"), ("9-7",)),
                (("reprint", number, "--records", "1", "--reason", " ", "--yes"), ("--reason",)),
                (("reprint", number, "--records", "1", "--yes"), ("--reason",)), (("reprint", number, "--records", "1", "--reason", "x", "--yes"), ("1",)),
                (("printer", "line1", "acknowledge", "0"), ("ERROR",)), (("printer", "line1", "suspend", "--hold", "0"), ("--hold",)),
                (("status", "--url", "http://x:1"), ("exclude each other",)), (("events", "--after", "-1"), ("--after",)), (("nothing",), ())):
            self.refused(2, *arguments, words=words)
        self.assertEqual("queued", self.job(number)["phase"])

    def test_events_are_shown_once_each_over_a_service_that_dies(self):
        self.start_service()
        number = self.imported(harness.names(3000))
        following = self.follow("events", "-f", "--limit", "0", "-o", "json")
        time.sleep(0.5)
        self.done("start", number)
        self.printer.wait_for_prints(200)
        self.kill_service()
        time.sleep(0.5)
        self.start_service()
        self.done("status")
        time.sleep(4)  # it comes again after a moment
        shown_last = [json.loads(line) for line in self.done("events", "-o", "json", "--limit", "1").out.splitlines()][0]["id"]
        following.signal(harness.INTERRUPT)
        result = following.wait()
        shown = [json.loads(line)["id"] for line in result.out.splitlines()]
        everything = [json.loads(line)["id"] for line in self.done("events", "--after", shown[0] - 1, "-o", "json").out.splitlines()]
        self.assertEqual([event for event in everything if event <= shown_last], [event for event in shown if event <= shown_last])
        self.assertEqual(1, result.err.count("waiting for it"), result.err)

    def test_somebody_who_waits_is_told_what_became_of_the_job(self):
        self.start_service()
        number = self.imported(harness.names(3000))
        waiting = self.follow("start", number, "--wait")
        self.printer.wait_for_prints(200)
        self.kill_service()
        time.sleep(0.5)
        self.start_service()
        result = waiting.wait()
        self.assertIn(result.code, (4, 6), str(result))
        self.assertIn("waiting for it", result.err)
        self.assertIn(self.job(number)["phase"], ("stopped", "in_doubt"))

    def test_a_printer_that_is_away_is_no_stopped_job(self):
        self.start_service()
        number = self.imported(harness.names(10))
        self.link.close()
        self.assert_code(3, self.linefeed("start", number, "--wait"))

    def test_a_start_that_the_printer_does_not_allow_is_stopped(self):
        self.printer = self.simulator("--cover-open")
        self.link = self.proxy(self.printer)
        self.configure()
        self.start_service()
        number = self.imported(harness.names(10))
        result = self.linefeed("start", number, "--wait")
        self.assert_code(4, result)
        self.assertIn("cover", result.out)
        self.assert_code(4, self.linefeed("printer", "line1", "preflight"))

    def test_records_in_doubt_wait_for_a_word(self):
        self.printer = self.simulator("--rate", 50, "--print-ms", 9, "--habit", "abort-print-on-stop", "--stop-at-print", 20)
        self.link = self.proxy(self.printer)
        self.configure()
        self.start_service()
        records = harness.names(30)
        number = self.imported(records)
        self.assert_code(6, self.linefeed("start", number, "--wait"))
        shown = self.linefeed("settle", number)
        self.assert_code(6, shown)
        self.assertRegex(shown.out, rf"(?m)^ +20  {records[19][1]}$")
        again = self.linefeed("resume", number)
        self.assert_code(6, again)
        self.assertIn(records[19][1], again.out)
        self.assertIn("IN DOUBT", self.done("jobs").out)
        self.assertIn(records[19][1], self.done("job", number).out)
        self.refused(2, "settle", number, "--printed", "21", words=("21",))
        self.assertEqual("in_doubt", self.job(number)["phase"])
        self.assertEqual(20, len(self.printer.prints()), "nothing is printed before the operator has decided")
        self.assert_code(0, self.linefeed("resume", number, "--last-printed", records[19][1], "--wait"))
        self.assert_printed(records, self.printer)


if __name__ == "__main__":
    harness.main()
