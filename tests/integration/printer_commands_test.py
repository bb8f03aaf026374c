"""`linefeed printer P …`: every look and change against a simulated printer, through the service and directly; a printer that is
silent, one that is gone, wrong input, and a line at 500 a second that nobody may disturb. The judge is the printer's tape."""

import json
import socket
import time

import harness
from service_commands_test import ServiceTest

LOOKS = ("status", "info", "counters", "errors", "events", "inputs", "outputs", "clock", "config", "service", "hydraulics", "actors",
         "mailing", "parameter", "parameter height", "text", "query sm", "query EL", "query PR 1", "query JB")
CHANGES = ("nozzle close", "nozzle open", "motor open", "motor close", "fonts reload", "counters --stop-after 0", "counters reset",
           "counter limit 1 start 5", "counter reset 0", "outputs take", "outputs set 3 on", "outputs give-back", "clock --set",
           "clock --set=2026-11-26T10:00:00", "parameter delay --set 700", "display off", "display on", "mailing stop-at 0",
           "send ?RS", "send --crc ?JL")
DESTRUCTIVE = ("flush", "power off", "restart", "factory-reset", "send !FF", r"send $DFFFSDISK\\Jobs\\none.job", "send *BEGINLJSCRIPT")


class Direct(harness.TestCase):
    """Without a service, as at commissioning."""

    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", "500", "--counter", "1-9999")
        self.address = self.printer.address

    def linefeed(self, *words, address=None):
        job = harness.Job([str(harness.BIN / "linefeed"), "printer", address or self.address, *map(str, words)])
        self.addCleanup(job.kill)
        return job.wait()

    def done(self, words, *more):
        result = self.linefeed(*words.split(), *more)
        self.assertEqual((0, ""), (result.code, result.err), words + str(result))
        return result

    def json(self, words, *more):
        return self.done(words, "-o", "json", *more).json()

    def test_every_look_and_change(self):
        for words in (*LOOKS, *CHANGES):
            self.assertTrue(isinstance(self.json(words), dict), words)
            self.done(words)

    def test_what_a_look_says(self):
        status = self.json("status")
        self.assertEqual(("ready for print start", 5, "open", None), (status["machine"], status["machine_code"], status["nozzle"], status["error"]))
        self.assertEqual(256, status["mailing"]["depth"])
        self.assertRegex(self.done("status").out, r"(?m)^machine +ready for print start$")
        self.assertEqual(700, self.json("parameter delay --set 700")["parameters"][0]["value"])
        self.assertEqual([700], [entry["value"] for entry in self.json("parameter 1")["parameters"]])
        self.assertEqual("DRINK BEFORE 12", self.json("text", "--set", "DRINK BEFORE 12")["text"])
        answer = self.json("query SM")["answers"][0]
        self.assertEqual(("=SM", "mailing status", r"^0=SM256\t0\t0\t0\t1"), (answer["command"], answer["what"], answer["raw"]))
        self.assertEqual(["!OK", "=NR", "=JL"], [a["command"] for a in self.json("send --crc ?JL")["answers"]])

    def test_what_the_printer_says_that_it_is(self):
        self.printer.stop()
        printer = self.simulator("--profile", "jet3")
        self.address = printer.address
        self.assertIn("COUNTER.JOB", self.done("jobs").out.upper())
        self.assert_one_clear_line(4, self.linefeed("counter", "limit", "1", "start", "5"), "jet3 knows no =CP")
        self.assert_one_clear_line(4, self.linefeed("counter", "reset", "2"), "the job has no counters")

    def test_not_done(self):
        self.done("power off --yes")
        for words in ("nozzle open", "print start", "counters reset", "suspend --hold 1"):
            self.assert_one_clear_line(4, self.linefeed(*words.split()), "standby")
        self.done("power on")

    def test_monitor_of_what_says_nothing(self):
        silent = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(silent.close)
        result = self.linefeed("monitor", "--for", "1", address=f"tcp://127.0.0.1:{silent.getsockname()[1]}")
        self.assertEqual(3, result.code, str(result))
        self.assertIn("<- no answer", result.err)

    def test_destructive_ones_need_a_word(self):
        for words in DESTRUCTIVE:
            result = self.linefeed(*words.split())
            self.assert_one_clear_line(2, result, "--yes")
        self.assertEqual(0, self.json("flush --yes")["entries"])
        self.assert_one_clear_line(4, self.linefeed("restart", "--yes"), "standby")
        self.assertEqual("standby", self.json("power off --yes")["machine"])
        self.done("restart --yes")

    def test_wrong_input_changes_nothing(self):
        for words in ("nozzle", "nozzle ajar", "parameter size", "parameter height --set 200", "query S", "query SM1", "query",
                      "send RS", "send ?RS\r!FF", r"send ?RS\q", "counters --product x", "counter limit 1 middle 5", "outputs set 9 on",
                      "outputs set 1 maybe", "clock --set=yesterday", "mode fill 0", "preflight", "frames", "acknowledge 0"):
            result = self.linefeed(*words.split(" "))
            self.assert_one_clear_line(2, result)
        self.assert_one_clear_line(2, self.linefeed("status", address="udp://127.0.0.1"))
        self.assert_one_clear_line(4, self.linefeed("ack"), "no error")
        problem = self.linefeed("outputs", "set", "9", "on", "-o", "json")
        self.assertEqual(("usage", 2), (problem.json()["result"], problem.json()["exit_code"]))

    def test_a_printer_that_is_gone_or_silent(self):
        self.printer.kill()
        self.assert_one_clear_line(3, self.linefeed("status"), self.address)
        silent = self.simulator("--fault", "frame 1 mute")
        self.assert_one_clear_line(3, self.linefeed("mailing", address=silent.address), "does not answer ?SM")
        self.assert_one_clear_line(3, self.linefeed("flush", "--yes", address=silent.address), "nothing is done")

    def test_record_and_replay(self):
        file = self.directory / "conversation.jsonl"
        self.done("status")  # clears the word that the job has changed
        self.done("record", file, "--for", "0.3", "--interval", "0.05")
        self.assert_one_clear_line(2, self.linefeed("record", file, "--for", "0.1"), "already")
        self.done("record", file, "--for", "0.3", "--interval", "0.05", "--replace")
        lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
        self.assertEqual({"sent", "received"}, {line["direction"] for line in lines})
        away = "tcp://127.0.0.1:1"
        before = file.read_bytes()
        self.assert_one_clear_line(3, self.linefeed("record", file, "--replace", address=away), away)
        self.assertEqual(before, file.read_bytes(), "a printer that is away leaves what was recorded")
        other = self.directory / "other.jsonl"
        self.assert_one_clear_line(3, self.linefeed("record", other, address=away), away)
        self.assertFalse(other.exists(), "and nothing in the way of the next try")
        shown = self.done("replay", file, "--fast").out
        self.assertRegex(shown, r"-> \?RS  machine state\?")
        self.assertRegex(shown, r"<- =SM  mailing status: depth 256, entries 0")
        self.assertIn(" 0 differ\n", self.done("replay", file, "--fast", "--against", self.address).out)
        self.done("nozzle close")
        now = self.linefeed("replay", file, "--fast", "--against", self.address, "-o", "json")
        self.assertEqual(1, now.code, now)
        self.assertTrue(all(d["expected"] != d["got"] for d in now.json()["differences"]))
        bad = self.directory / "bad.jsonl"
        bad.write_text("{}\n", encoding="utf-8")
        self.assert_one_clear_line(5, self.linefeed("replay", bad), "line 1")
        self.assert_one_clear_line(5, self.linefeed("replay", self.directory / "none"))
        risky = self.directory / "risky.jsonl"
        risky.write_text('{"time_ns":1,"direction":"sent","bytes":"^0!FF\\\\x0D"}\n', encoding="utf-8")
        self.assert_one_clear_line(2, self.linefeed("replay", risky, "--against", self.address), "--yes")

    def test_monitor(self):
        out = self.done("monitor", "--for", "0.3", "--interval", "0.05", "-o", "json").out
        frames = [json.loads(line) for line in out.splitlines()]
        self.assertLessEqual({"?RS", "=RS", "?SM", "=SM"}, {frame["command"] for frame in frames})

    def test_while_it_prints_nothing_is_lost(self):
        records = harness.names(1500)
        job = self.start(self.write_csv(harness.rows(records)), self.printer)
        self.printer.wait_for_prints(200)
        for words in ("flush", "power off", "restart", "factory-reset", "send !FF"):
            self.assert_one_clear_line(4, self.linefeed(*words.split(), "--yes"), "stop it first")
        for words in LOOKS[:6]:
            self.done(words)
        self.assert_done(job.wait())
        self.assert_printed(records, self.printer)


class ThroughService(ServiceTest):
    simulator_options = ("--rate", "500", "--counter", "1-9999")

    def setUp(self):
        super().setUp()
        self.start_service()

    def test_every_look_and_change_says_the_same_as_directly(self):
        for words in (*LOOKS, *CHANGES):
            self.assertTrue(isinstance(self.done("printer", "line1", *words.split(), "-o", "json").json(), dict), words)
        for words in ("info", "config", "outputs", "parameter"):
            direct = harness.Job([str(harness.BIN / "linefeed"), "printer", self.printer.address, words]).wait()
            self.assertEqual(direct.out, self.done("printer", "line1", words).out)
        audit = [entry for entry in self.done("audit", "-o", "json").json() if entry["what"] == "command"]
        self.assertTrue(any("nozzle close" in json.dumps(entry["detail"]) for entry in audit), audit)
        self.refused(2, "printer", "line1", "flush")
        self.done("printer", "line1", "flush", "--yes")
        self.refused(2, "printer", "line9", "info")
        self.refused(2, "printer", "line1", "outputs", "set", "9", "on")

    def test_a_line_that_prints_is_not_disturbed(self):
        records = harness.names(2000)
        number = self.imported(records)
        self.done("start", number)
        self.printer.wait_for_prints(200)
        for words in (*DESTRUCTIVE, "print stop", "print start", "nozzle close", "fonts reload", "mailing stop-at 5", r"send =MR5\tx"):
            yes = ("--yes",) if words in DESTRUCTIVE or words.startswith("send") else ()
            self.refused(4, "printer", "line1", *words.split(), *yes, words=("stop it first",))
        for words in LOOKS[:6]:
            self.done("printer", "line1", *words.split())
        shown = self.linefeed("printer", "line1", "monitor", "--for", "0.5")
        self.assert_code(0, shown)
        self.assertRegex(shown.out, "<- =SM  mailing status: depth 256")
        self.wait_for_phase(number, "finished")
        self.assert_printed(records, self.printer)
        audit = [entry for entry in self.done("audit", "-o", "json").json() if entry["what"] == "command"]
        self.assertTrue(audit and not any(entry["done"] for entry in audit), audit)

    def test_what_the_fifo_knows_is_not_flushed_away(self):
        number = self.imported(harness.names(4000))
        self.done("start", number)
        self.printer.wait_for_prints(200)
        self.kill_service()
        self.start_service()
        while self.printer_busy():
            time.sleep(0.05)
        self.refused(4, "printer", "line1", "flush", "--yes", words=(f"job {number}",))

    def printer_busy(self):
        """The line prints what it has in its FIFO, then stops by itself."""
        direct = harness.Job([str(harness.BIN / "linefeed"), "printer", self.printer.address, "status", "-o", "json"]).wait()
        return direct.json()["machine"] == "printing"


if __name__ == "__main__":
    harness.main()
