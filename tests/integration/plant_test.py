"""A whole plant in one test: linefeedd, three printers, three drop folders, batches dropped in every manner while a printer is stopped,
a link is cut and the service is killed. The judge reads the tapes and the folders: every record of every batch on one product, in order, and
every file accounted for.

LINEFEED_LONG_TESTS=1: more and larger files in Flood.
"""

import collections
import json
import os
import time

import harness
import service
from harness import LONG

RATE = 300
RECORDS = 200  # of a batch


class PlantCase(harness.TestCase):
    def make_service(self, settings):
        made = service.Service(self.directory, settings)
        self.addCleanup(made.kill)
        return made

    def folder(self, name):
        path = self.directory / name
        path.mkdir()
        return path

    def texts(self, batch, count=RECORDS):
        return [f"{batch}-{k:05d}" for k in range(1, count + 1)]

    def put(self, folder, name, texts, manner):
        """In place, renamed into place, or with a companion."""
        self.put_bytes(folder, name, "".join(f"{line}\n" for line in ("code", *texts)).encode(), manner)

    def put_bytes(self, folder, name, content, manner):
        file = folder / name
        target = folder / f".{name}.part" if manner == "rename" else file
        with open(target, "wb") as output:  # in two halves: nobody may take the first for the whole
            output.write(content[:len(content) // 2])
            output.flush()
            time.sleep(0.03)
            output.write(content[len(content) // 2:])
        if manner == "rename":
            target.rename(file)
        elif manner == "done-companion":
            (folder / f"{name}.done").touch()

    def inside(self, folder, inner):
        return sorted(file.name for file in (folder / inner).iterdir() if not file.name.endswith(".report.json") and file.name != ".lock")

    def waiting(self, folder):
        return sorted(set(os.listdir(folder)) - {"processing", "done", "failed"})

    def report(self, folder, inner, name):
        return json.loads((folder / inner / f"{name}.report.json").read_text(encoding="utf-8"))


class Plant(PlantCase):
    MANNERS = {"line1": "in-place", "line2": "rename", "line3": "done-companion"}

    def setUp(self):
        super().setUp()
        self.printers = {name: self.simulator("--rate", RATE, "--serial-number", f"SN-{name}") for name in self.MANNERS}
        self.link = self.proxy(self.printers["line2"])
        addresses = {name: printer.address for name, printer in self.printers.items()} | {"line2": self.link.address}
        self.folders = {name: self.folder(f"drop-{name}") for name in self.MANNERS}
        self.service = self.make_service({
            "layouts": {"codes": {"columns": ["code"]}},
            "printers": {name: {"address": address, "queue": {"autostart": True}} for name, address in addresses.items()},
            "folders": {name: {"path": str(path), "layout": "codes", "printer": name, "pattern": "*.csv", "autostart": True,
                               "settle": self.MANNERS[name], "poll_interval": "500 ms"} for name, path in self.folders.items()}})
        self.operators = {name: service.Operator(self.service, name, printer) for name, printer in self.printers.items()}
        self.wanted = collections.defaultdict(list)  # printer -> batches, each a list of texts

    def drop(self, line, name, batch=None, count=RECORDS):
        """A batch that is to be printed."""
        texts = self.texts(batch or f"{line}-{name}", count)
        self.wanted[line].append(texts)
        self.put(self.folders[line], name, texts, self.MANNERS[line])

    def printed(self, line):
        return len(self.printers[line].prints())

    def wait_until_printing(self, line, count):
        self.service.wait_for(lambda: self.printed(line) >= count, words=f"print {count} of {line}")

    def work_off(self, lines, patience_s=120):
        deadline = time.monotonic() + patience_s
        while not all([self.operators[line].step() and not self.waiting(self.folders[line]) for line in lines]):
            self.assertLess(time.monotonic(), deadline, f"{self.service.jobs()}\n{[self.service.printer(p) for p in lines]}\n{self.service.log()}")
            time.sleep(0.1)

    def test_every_batch_is_printed_once_and_every_file_accounted_for(self):
        self.service.start()
        for number in range(1, 4):
            for line in self.MANNERS:
                self.drop(line, f"batch{number}.csv")
        # A printer is stopped by an operator.
        self.wait_until_printing("line3", 120)
        self.service.post("printers/line3/stop")
        at_stop = self.printed("line3")
        # A link is cut in mid-job.
        self.wait_until_printing("line2", 150)
        self.link.cut()
        self.service.wait_for(lambda: self.service.printer("line2")["phase"] == "idle", words="the end of the job on line2")
        # More arrives in the meantime, some of it of no use.
        for line in self.MANNERS:
            self.drop(line, "batch4.csv")
            manner = self.MANNERS[line]
            self.put(self.folders[line], "again.csv", self.texts(f"{line}-batch1.csv"), manner)
            self.put_bytes(self.folders[line], "bad.csv", b"code\nfine\n\xff\xfe\x00\n", manner)
            (self.folders[line] / "link.csv").symlink_to("/etc/passwd")
            if manner == "done-companion":
                (self.folders[line] / "link.csv.done").touch()
        time.sleep(1)
        self.assertEqual(at_stop, self.printed("line3"), "a stopped line must not go on by itself")
        # The service is killed while line1 prints.
        self.drop("line1", "batch5.csv", count=3 * RECORDS)
        self.wait_until_printing("line1", 3 * RECORDS + 100)
        self.service.kill()
        self.drop("line2", "batch6.csv")
        self.drop("line3", "bätch 6\n.csv", batch="line3-six")
        self.service.start()
        for job in self.service.jobs():
            self.assertNotIn(job["phase"], ("arming", "printing", "stopping"), "nothing prints by itself after a restart")
        self.drop("line1", "batch1.csv", batch="line1-another")  # a name that was there before
        self.work_off(self.MANNERS)
        self.assertEqual(0, self.service.stop(), self.service.log())
        self.judge_lines()
        self.judge_files()

    def judge_lines(self):
        for line, printer in self.printers.items():
            printed = [text for _, text in printer.prints()]
            expected = sorted(text for batch in self.wanted[line] for text in batch)
            self.assertEqual([], [text for text, times in collections.Counter(printed).items() if times > 1][:5], f"{line}: printed twice")
            self.assertEqual(expected, sorted(printed), line)
            for batch in self.wanted[line]:
                places = [printed.index(text) for text in (batch[0], batch[-1])]
                self.assertEqual(batch, printed[places[0]:places[1] + 1], f"{line}: each batch in one piece, in order")

    def judge_files(self):
        for line, folder in self.folders.items():
            self.assertEqual([], self.waiting(folder))
            self.assertEqual([], self.inside(folder, "processing"))
            done, failed = self.inside(folder, "done"), self.inside(folder, "failed")
            self.assertEqual(len(self.wanted[line]) + 1, len(done), done)  # and again.csv
            self.assertEqual(["bad.csv", "link.csv"], failed)
            self.assertEqual("duplicate", self.report(folder, "done", "again.csv")["verdict"])
            self.assertIn("row", self.report(folder, "failed", "bad.csv")["reason"])
            for name in done:
                report = self.report(folder, "done", name)
                self.assertIn(report["verdict"], ("imported", "duplicate"))
                self.assertEqual(f"done/{name}", report["kept_as"])


class Flood(PlantCase):
    """Many files, and a large one, while another job prints: nobody at the line notices."""

    RATE = 1000
    FILES = 10_000 if LONG else 500
    LARGE_BYTES = 2 << 30 if LONG else 40 << 20
    MAX_MEMORY_MIB = 256

    def setUp(self):
        super().setUp()
        self.printer = self.simulator("--rate", self.RATE)
        self.drops = self.folder("drop")
        self.service = self.make_service({
            "layouts": {"codes": {"columns": ["code"]}},
            "printers": {"line1": {"address": self.printer.address}, "line2": {"address": "tcp://127.0.0.1:9"}},
            "folders": {"drop": {"path": str(self.drops), "layout": "codes", "printer": "line2", "pattern": "*.csv", "settle": "rename"}}}).start()

    def print_meanwhile(self, seconds):
        """A job at full rate, long enough for what is to happen; gives its records."""
        texts = self.texts("meanwhile", self.RATE * seconds)
        file = self.write_csv([[text] for text in texts], name="meanwhile.csv", header=("code",))
        job = self.service.post("jobs", {"file": str(file), "layout": "codes", "printer": "line1"})["job"]
        self.service.post(f"jobs/{job}/start")
        self.printer.wait_for_prints(self.RATE)
        return texts, job

    def judge_line(self, texts, job):
        self.service.wait_for(lambda: self.service.job(job)["phase"] == "finished", patience_s=600, words="the end of the job")
        self.assert_printed(list(enumerate(texts, 1)), self.printer)
        self.assert_clean(self.printer.stop())
        peak = self.service.peak_memory_mib()
        print(f"{self.id()}: {len(texts)} prints at {self.RATE}/s, no underrun; peak memory of linefeedd {peak:.1f} MiB", flush=True)
        self.assertLess(peak, self.MAX_MEMORY_MIB)

    def test_many_small_files(self):
        texts, job = self.print_meanwhile(300 if LONG else 15)
        for number in range(self.FILES):
            self.put_bytes_at_once(f"small{number:05d}.csv", f"code\nS{number:05d}-1\nS{number:05d}-2\n".encode())
        started = time.monotonic()
        self.service.wait_for(lambda: len(self.inside(self.drops, "done")) == self.FILES, patience_s=900, words="the import of all files")
        print(f"{self.FILES} files in {time.monotonic() - started:.1f} s behind the last of them", flush=True)
        self.judge_line(texts, job)
        self.assertEqual([], self.waiting(self.drops))
        self.assertEqual([], self.inside(self.drops, "failed"))
        self.assertEqual(self.FILES, len(self.service.jobs("line2")))

    def put_bytes_at_once(self, name, content):
        part = self.drops / f".{name}"
        part.write_bytes(content)
        part.rename(self.drops / name)

    def test_a_large_file(self):
        texts, job = self.print_meanwhile(400 if LONG else 15)
        row = "x" * 190
        rows = self.LARGE_BYTES // 200
        part = self.drops / ".large"
        with open(part, "w", encoding="ascii") as output:
            output.write("code\n")
            for first in range(0, rows, 1000):
                output.write("".join(f"{k:08d}{row}\n" for k in range(first, min(first + 1000, rows))))
        part.rename(self.drops / "large.csv")
        self.service.wait_for(lambda: self.inside(self.drops, "done"), patience_s=900, words="the import of the large file")
        self.judge_line(texts, job)
        self.assertEqual([rows], [made["records"]["count"] for made in self.service.jobs("line2")])


if __name__ == "__main__":
    harness.main()
