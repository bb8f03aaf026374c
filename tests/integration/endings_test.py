"""SIGTERM to linefeedd at the worst moments: while it looks at the printer, arms it, prints, or imports. The service ends by itself, with
exit code 0 and in a time that has a bound; what it has left in the ledger is the truth, which the tape tells; and the job goes on to
its end with every record on one product, in order.
"""

import concurrent.futures
import time

import harness
import plant_test
import service
from harness import names, rows

RATE = 300
COUNT = 600
# The unit gives it 2 min (TimeoutStopSec). A printer that does not answer takes its time-outs, one that does next to nothing.
MUTE_S, ANSWERING_S = 30, 10


class EndingCase(plant_test.PlantCase):
    simulator_options = ()

    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", RATE, *self.simulator_options)
        self.link = self.proxy(self.printer)
        self.drops = self.folder("drop")
        self.service = self.make_service({
            "layouts": {"names": {"columns": ["name"]}},
            "printers": {"line1": {"address": self.link.address}},
            "folders": {"drop": {"path": str(self.drops), "layout": "names", "printer": "line1", "settle": "rename"}}}).start()
        self.records = names(COUNT)

    def import_records(self):
        file = self.write_csv(rows(self.records))
        return self.service.post("jobs", {"file": str(file), "layout": "names", "printer": "line1"})["job"]

    def wait_for_phase(self, phase):
        self.service.wait_for(lambda: self.service.printer("line1")["phase"] == phase, words=f"the phase {phase}")

    def end(self, within_s):
        started = time.monotonic()
        self.assertEqual(0, self.service.stop(patience_s=within_s), self.service.log())
        print(f"{self.id()}: ended within {time.monotonic() - started:.1f} s", flush=True)

    def judge_what_was_left(self, job):
        """What the ledger says to be printed is on a product; what is on a product, it says to be printed or in doubt."""
        on_tape = {number for number, _ in self.printer.prints()}
        stretches = self.service.items(f"jobs/{job}/ledger?limit=1000")
        printed, unsure = ({number for stretch in stretches if stretch["state"] in states for number in range(stretch["first"], stretch["last"] + 1)}
                           for states in (("printed",), ("in_doubt", "open")))
        self.assertEqual(set(), printed - on_tape, "the ledger has what is on no product")
        self.assertEqual(set(), on_tape - printed - unsure, "on a product, and the ledger does not know of it")
        return unsure

    def start_again(self, job):
        """Nothing goes on by itself."""
        self.service.start()
        self.assertIn(self.service.job(job)["phase"], ("queued", "stopped", "in_doubt"))
        return self.judge_what_was_left(job)

    def finish(self, job):
        operator = service.Operator(self.service, "line1", self.printer)
        self.service.wait_for(operator.step, words="the end of the job")
        self.assertEqual("finished", self.service.job(job)["phase"])
        self.assert_printed(self.records, self.printer)
        self.assertEqual(set(), self.judge_what_was_left(job))
        self.service.post("ledger/verify")
        return operator


class Endings(EndingCase):
    def test_while_it_looks_at_a_printer_that_does_not_answer(self):
        job = self.import_records()
        self.link.mute()
        self.service.post(f"jobs/{job}/start")
        self.wait_for_phase("checking")
        self.end(MUTE_S)
        self.link.heal()
        self.start_again(job)
        self.assertEqual([], self.printer.prints())
        self.finish(job)

    def test_while_it_arms_a_printer_behind_a_network_that_holds_the_first_records(self):
        job = self.import_records()
        self.link.refill_wanted = True
        self.service.post(f"jobs/{job}/start")
        self.service.wait_for(lambda: not self.link.open.is_set(), words="the first records")
        self.assertEqual("arming", self.service.printer("line1")["phase"])
        self.end(MUTE_S)
        self.link.heal()  # now they arrive: nobody is there any more who knows of it
        self.start_again(job)
        self.finish(job)

    def test_while_it_prints(self):
        job = self.import_records()
        self.service.post(f"jobs/{job}/start")
        self.printer.wait_for_prints(COUNT // 3)
        self.end(ANSWERING_S)
        self.assertEqual(set(), self.start_again(job), "a printer that answers leaves nothing in doubt")
        self.assertEqual(0, self.finish(job).asked)

    def test_while_the_network_is_mute_in_mid_job(self):
        job = self.import_records()
        self.service.post(f"jobs/{job}/start")
        self.printer.wait_for_prints(COUNT // 3)
        self.link.mute()
        self.end(MUTE_S)
        self.link.heal()
        self.start_again(job)
        self.finish(job)


class EndingsInArming(EndingCase):
    """One job, ended at every stage of its start again and again."""

    simulator_options = ("--reply-delay", 40)
    DELAYS_MS = (0, 50, 100, 150, 200, 300, 400, 500, 600, 700, 800, 1000)

    def test_at_every_stage_of_a_start(self):
        job = self.import_records()
        phases = set()
        for delay_ms in self.DELAYS_MS:
            self.service.post(f"jobs/{job}/start")
            time.sleep(delay_ms / 1000)
            phases.add(self.service.printer("line1")["phase"])
            self.end(ANSWERING_S)
            self.assertEqual(set(), self.start_again(job), "a printer that answers leaves nothing in doubt")
        self.assertLessEqual({"checking", "arming", "printing"}, phases, "moments that are worth a test")
        self.assertEqual(0, self.finish(job).asked)


class EndingsInImport(EndingCase):
    ROWS = 1_500_000

    def setUp(self):
        super().setUp()
        self.large = self.directory / "large.csv"
        self.large.write_text("name\n" + "".join(f"record number {k}\n" for k in range(1, self.ROWS + 1)), encoding="ascii")

    def judge_import(self):
        """The batch is there once, whole, and prints from its first record on."""
        made, = self.service.jobs()
        self.assertEqual(self.ROWS, made["records"]["count"])
        self.service.post(f"jobs/{made['id']}/start")
        self.printer.wait_for_prints(100)
        self.service.post("printers/line1/stop")
        printed = self.printer.prints()
        self.assertEqual([(k, f"record number {k}") for k in range(1, len(printed) + 1)], printed)

    def test_a_dropped_file(self):
        self.large.rename(self.drops / "large.csv")
        self.service.wait_for(lambda: "importing" in self.service.get("/api/v1/folders")["items"][0]["message"], words="the import")
        self.end(ANSWERING_S)
        self.assertEqual(["large.csv"], self.inside(self.drops, "processing"))
        self.service.start()
        self.service.wait_for(lambda: self.inside(self.drops, "done"), words="the import")
        self.judge_import()

    def test_a_file_that_an_operator_imports(self):
        order = {"file": str(self.large), "layout": "names", "printer": "line1"}
        with concurrent.futures.ThreadPoolExecutor() as threads:
            asked = threads.submit(self.service.post, "jobs", order)
            self.service.wait_for(lambda: [job for job in self.service.jobs() if job["phase"] == "importing"], words="the import")
            self.end(ANSWERING_S)
            with self.assertRaises((service.Problem, OSError)) as refused:
                asked.result()
        print(f"who had asked for it was told: {refused.exception}", flush=True)
        self.service.start()
        self.assertEqual([], [job for job in self.service.jobs() if job["phase"] not in ("failed", "cancelled")])
        self.service.post("jobs", order)
        self.judge_import()


if __name__ == "__main__":
    harness.main()
