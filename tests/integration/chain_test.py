"""Jobs that follow each other without a stop of the line (queue.chain: seamless): a service, its printer, and a queue of three. The judge
reads the tape: every record of each job once, in order, the first of a follower with number 0, one start of the line for all of them. Then
the same with a stop, a killed service and a cut link while records of two jobs are in the printer.

LINEFEED_LONG_TESTS=1: at more moments.
"""

import collections
import contextlib
import csv
import io
import sqlite3
import time

import harness
import service
from harness import LONG

RATE = 300
COUNTS = (1500, 900, 1200)
MOST_PERIODS = 4  # between two products, where the line does not stop
WORK_OFF_S = 120
ROUNDS = 10 if LONG else 4  # moments around the change from one job to the next


class ChainCase(harness.TestCase):
    """A service with one printer, behind a link that can be cut, and three files."""

    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", RATE)
        self.link = self.proxy(self.printer)
        self.service = service.Service(self.directory, {
            "layouts": {"codes": {"columns": ["code"]}},
            "printers": {"line1": {"address": self.link.address, "queue": {"autostart": True, "chain": "seamless"}}}})
        self.addCleanup(self.service.kill)
        self.service.start()
        self.operator = service.Operator(self.service, "line1", self.printer)
        self.texts = [[f"{name}-{k:05d}" for k in range(1, count + 1)] for name, count in zip("ABC", COUNTS)]

    def queue(self, texts, autostart=True):
        """A job that waits at the printer, or starts at once."""
        name = f"{texts[0]}.csv"
        file = self.write_csv([[text] for text in texts], name=name, header=("code",))
        return self.service.post("jobs", {"file": str(file), "layout": "codes", "printer": "line1", "autostart": autostart})["job"]

    def queue_all(self):
        return [self.queue(texts) for texts in self.texts]

    def wait_for(self, job, phase):
        self.service.wait_for(lambda: self.service.job(job)["phase"] == phase, words=f"{phase} of job {job}")

    def wait_for_all(self, jobs):
        for job in jobs:
            self.wait_for(job, "finished")

    def work_off(self, patience_s=WORK_OFF_S):
        deadline = time.monotonic() + patience_s
        while not self.operator.step():
            self.assertLess(time.monotonic(), deadline, f"{self.service.jobs()}\n{self.service.printer('line1')}\n{self.service.log()}")
            time.sleep(0.1)

    def starts(self):
        return self.link.said().count("!GO")

    def on_wire(self, *jobs):
        """(number, text) of these jobs as the tape should show them where each follows the one before it."""
        lines = []
        for place, texts in enumerate(jobs):
            lines += [(0 if place > 0 and k == 1 else k, text) for k, text in enumerate(texts, 1)]
        return lines

    def longest_gap_s(self):
        tape = self.printer.tape_file.read_text(encoding="utf-8")
        times = [int(row[0]) for row in list(csv.reader(io.StringIO(tape)))[1:]]
        return max(after - before for before, after in zip(times, times[1:])) / 1e9

    def wait_for_tape(self, count):
        with contextlib.suppress(AssertionError):  # what is missing the judge tells
            self.printer.wait_for_prints(count, harness.TAPE_DELAY_S)

    def judge_texts(self, *jobs):
        """Each text once, and those of a job in order; where records were in doubt, the operator has looked at the products."""
        expected = [text for texts in jobs for text in texts]
        self.wait_for_tape(len(expected))
        printed = [text for _, text in self.printer.prints()]
        self.assertEqual([], [text for text, times in collections.Counter(printed).items() if times > 1][:5], "printed twice")
        self.assertEqual([], sorted(set(expected) - set(printed))[:5], "not printed")
        self.assertEqual(expected, printed, "in order")

    def states(self, job):
        """How many records of the job the ledger has in each state."""
        with contextlib.closing(sqlite3.connect(f"file:{self.service.spool}?mode=ro", uri=True)) as spool:
            return dict(spool.execute("SELECT state, sum(records) FROM ledger_segments WHERE job = ? GROUP BY state", (job,)).fetchall())

    def judge_ledger(self, jobs, counts=COUNTS):
        for job, count in zip(jobs, counts):
            self.assertEqual({"printed": count}, self.states(job), f"job {job}")
            result = harness.Job([str(harness.BIN / "linefeed"), "ledger", str(job), "--verify", "--spool", str(self.service.spool)]).wait()
            self.assert_code(0, result)

    def events(self):
        return [(event["kind"], event.get("job")) for event in self.service.items("events?limit=1000")]


class Chain(ChainCase):
    def test_three_jobs_and_one_start(self):
        jobs = self.queue_all()
        self.wait_for_all(jobs)
        self.assert_printed(self.on_wire(*self.texts), self.printer)
        self.assertEqual(1, self.starts(), self.events())
        self.assertLess(self.longest_gap_s(), MOST_PERIODS / RATE)
        self.judge_ledger(jobs)
        events = self.events()
        self.assertNotIn("job.stopped", [kind for kind, _ in events])
        for kind in ("job.started", "job.printing", "job.finished"):
            self.assertEqual([(kind, job) for job in jobs], [event for event in events if event[0] == kind])
        self.assertEqual(0, self.printer.stop()["underruns"])

    def test_one_that_is_queued_in_the_last_second(self):
        first = self.queue(self.texts[0])
        self.printer.wait_for_prints(COUNTS[0] - 3 * RATE)
        second = self.queue(self.texts[1])
        self.wait_for_all([first, second])
        self.assert_printed(self.on_wire(*self.texts[:2]), self.printer)
        self.assertEqual(1, self.starts())

    def test_a_cancelled_job_is_passed_over(self):
        jobs = [self.queue(self.texts[0], autostart=False), *(self.queue(texts) for texts in self.texts[1:])]
        self.service.post(f"jobs/{jobs[1]}/cancel")
        self.service.post(f"jobs/{jobs[0]}/start")
        self.wait_for_all([jobs[0], jobs[2]])
        self.assert_printed(self.on_wire(self.texts[0], self.texts[2]), self.printer)
        self.assertEqual(1, self.starts())
        self.assertEqual("cancelled", self.service.job(jobs[1])["phase"])
        self.assertEqual({}, self.states(jobs[1]))

    def test_a_job_that_waits_for_a_person_holds_up_what_is_behind_it(self):
        jobs = [self.queue(self.texts[0]), self.queue(self.texts[1], autostart=False), self.queue(self.texts[2])]
        self.wait_for(jobs[0], "finished")
        time.sleep(1)
        self.assertEqual(["queued", "queued"], [self.service.job(job)["phase"] for job in jobs[1:]])
        self.service.post(f"jobs/{jobs[1]}/start")
        self.wait_for_all(jobs)
        self.assert_printed(self.on_wire(self.texts[0]) + self.on_wire(*self.texts[1:]), self.printer)
        self.assertEqual(2, self.starts())

    def test_a_stop_in_mid_follower(self):
        jobs = self.queue_all()
        self.printer.wait_for_prints(COUNTS[0] + COUNTS[1] // 2)
        self.service.post("printers/line1/stop")
        self.assertEqual(["finished", "stopped", "queued"], [self.service.job(job)["phase"] for job in jobs])
        time.sleep(1)
        self.assertEqual("stopped", self.service.job(jobs[1])["phase"], "nothing goes on by itself")
        self.service.post(f"jobs/{jobs[1]}/resume")
        self.wait_for_all(jobs)
        self.judge_texts(*self.texts)
        self.assertIn(self.starts(), (2, 3), "the third does not follow if its run was begun before the stop")
        self.judge_ledger(jobs)

    def test_a_stop_with_two_jobs_in_the_printer(self):
        jobs = self.queue_all()
        self.printer.wait_for_prints(COUNTS[0] - 60)
        self.service.post("printers/line1/stop")
        self.assertEqual("queued", self.service.job(jobs[2])["phase"])
        self.work_off()
        self.judge_texts(*self.texts)
        self.judge_ledger(jobs)


class ChainTrouble(ChainCase):
    def judge_standing(self, jobs, words):
        """Whatever was in the printer stands, and says so; nothing prints by itself."""
        phases = [self.service.job(job)["phase"] for job in jobs]
        for job, phase in zip(jobs, phases):
            self.assertIn(phase, ("finished", "stopped", "in_doubt", "queued"), f"job {job} {words}")
        self.assertIn(phases[1], ("stopped", "in_doubt", "queued"), words)
        self.assertEqual("queued", phases[2], words)
        texts = collections.Counter(text for _, text in self.printer.prints())
        self.assertLessEqual(max(texts.values()), 1, words)

    def test_killed_with_two_jobs_in_the_printer(self):
        for number in range(ROUNDS):
            with self.subTest(round=number):
                self.trouble(number, self.kill_and_start)

    def test_a_link_cut_with_two_jobs_in_the_printer(self):
        for number in range(ROUNDS):
            with self.subTest(round=number):
                self.trouble(number, self.cut)

    def kill_and_start(self):
        self.service.kill()
        self.service.start()

    def cut(self):
        self.link.cut()
        self.service.wait_for(lambda: self.service.printer("line1")["phase"] == "idle", words="the end of the run")

    def trouble(self, number, happens):
        """At another moment each time: from before the first record of the follower is sent until it is printed."""
        before = len(self.printer.prints())
        texts = [[f"{number}{text}" for text in job] for job in self.texts]
        jobs = [self.queue(job) for job in texts]
        if self.service.printer("line1")["held"]:
            self.service.post(f"jobs/{jobs[0]}/start")
        ahead = 240 - number * 300 // ROUNDS  # products of the first job that are still to come
        self.printer.wait_for_prints(before + COUNTS[0] - ahead)
        happens()
        self.judge_standing(jobs, f"{ahead} before the end of the first")
        self.work_off()
        self.wait_for_tape(before + sum(COUNTS))
        printed = [text for _, text in self.printer.prints()][before:]
        expected = [text for job in texts for text in job]
        self.assertEqual([], [text for text, times in collections.Counter(printed).items() if times > 1][:5], "printed twice")
        self.assertEqual(sorted(expected), sorted(printed))
        if not self.operator.asked:
            self.assertEqual(expected, printed, "in order")
        self.judge_ledger(jobs)


if __name__ == "__main__":
    harness.main()
