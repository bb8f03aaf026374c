"""`linefeed drop` as a process: files dropped in every manner, a thousand at once, kill -9 at random moments. The judge reads the
folder and the records in the spool, never what linefeed says about itself.

LINEFEED_SEED=N repeats the moments of a run (not the machine's scheduling).
"""

import collections
import json
import os
import random
import signal
import sqlite3
import time

import harness
from harness import names, rows

ROUNDS = 300 if harness.LONG else 30


class DropCase(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.folder = self.directory / "in"
        self.folder.mkdir()

    def drop(self, *options, folder=None, **keywords):
        """linefeed drop as a process that is still running."""
        job = harness.Job([str(harness.BIN / "linefeed"), "drop", str(folder or self.folder), "--spool", str(self.spool),
                           *map(str, options)], **keywords)
        self.addCleanup(job.kill)
        return job

    def once(self, *options, **keywords):
        return self.drop("--once", *options, **keywords).wait()

    def put(self, name, content, manner="rename"):
        """In place, by renaming, or in place with a mark."""
        file = self.folder / name
        target = self.folder / f".{name}.part" if manner == "rename" else file
        target.write_text(content, encoding="utf-8")
        if manner == "rename":
            target.rename(file)
        elif manner == "mark":
            (self.folder / f"{name}.done").touch()

    def inside(self, inner):
        """The files in processing/, done/ or failed/, without reports."""
        return sorted(file.name for file in (self.folder / inner).iterdir()
                      if not file.name.endswith(".report.json") and file.name != ".lock")

    def dropped(self):
        """What still lies in the folder itself."""
        return sorted(set(os.listdir(self.folder)) - {"processing", "done", "failed"})

    def report(self, place):
        return json.loads((self.folder / f"{place}.report.json").read_text(encoding="utf-8"))

    def wait_for(self, condition, what):
        deadline = time.monotonic() + harness.PATIENCE_S
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"not within {harness.PATIENCE_S} s: {what}")
            time.sleep(0.01)

    def stored(self):
        """The texts of all records of all jobs, in order of the jobs."""
        database = sqlite3.connect(f"file:{self.spool}?mode=ro", uri=True)
        try:
            self.assertEqual([("ok",)], database.execute("PRAGMA integrity_check").fetchall())
            self.assertEqual([], database.execute("SELECT id FROM jobs WHERE state <> 'ready'").fetchall())
            frames = b"".join(frames for (frames,) in database.execute("SELECT frames FROM pages ORDER BY job, first"))
        finally:
            database.close()
        return [frame.split(b"\t")[1].decode("latin-1") for frame in frames.split(b"\r") if frame]

    def assert_all_reported(self):
        for end in ("done", "failed"):
            for name in self.inside(end):
                self.assertEqual(f"{end}/{name}", self.report(f"{end}/{name}")["kept_as"])


class Drop(DropCase):
    def check_manners(self, mode):
        job = self.drop("--mode", mode, "--settle", "quiet=300ms", "--rescan", "0.2", "-o", "json")
        self.wait_for(lambda: (self.folder / "processing/.lock").exists(), "the folders")
        self.put("renamed.csv", "name\nA\n")
        self.put("marked.csv", "name\nB\n", "mark")
        with open(self.folder / "slow.csv", "w", encoding="utf-8") as slow:
            slow.write("name\n")
            for text in "CDEFGHIJKLM":
                slow.write(f"{text}\n")
                slow.flush()
                time.sleep(0.1)
        self.put("bad.csv", "name\nX\x01\n", "in place")
        self.wait_for(lambda: len(self.inside("done") + self.inside("failed")) == 4, "four files")
        self.put("again.csv", "name\nA\n")
        self.wait_for(lambda: len(self.inside("done")) == 4, "the duplicate")
        job.signal(harness.INTERRUPT)
        result = job.wait()
        self.assert_code(0, result)
        verdicts = {line["name"]: line["verdict"] for line in map(json.loads, result.out.splitlines())}
        self.assertEqual({"renamed.csv": "imported", "marked.csv": "imported", "slow.csv": "imported", "bad.csv": "failed",
                          "again.csv": "duplicate"}, verdicts)
        self.assertEqual(sorted("ABCDEFGHIJKLM"), sorted(self.stored()))
        self.assertEqual([], self.dropped())
        self.assertEqual(["bad.csv"], self.inside("failed"))
        self.assertEqual(2, self.report("failed/bad.csv")["import"]["reported"][0]["line"])
        self.assert_all_reported()
        self.assertIn("linefeed: bad.csv: rejected: 1 of 1 rows cannot be printed; the first: line 2, column name", result.err)

    def test_every_manner_by_inotify(self):
        self.check_manners("inotify")

    def test_every_manner_by_polling(self):
        self.check_manners("poll")

    def test_a_thousand_at_once(self):
        with open(self.directory / "messages", "w", encoding="utf-8") as messages:
            job = self.drop("--settle", "quiet=200ms", messages=messages)
        self.wait_for(lambda: (self.folder / "processing/.lock").exists(), "the folders")
        start = time.monotonic()
        for number in range(1000):
            self.put(f"f{number:04}.csv", f"name\nrecord {number}\n", ("rename", "mark", "in place")[number % 3])
        self.wait_for(lambda: len(self.inside("done")) == 1000, "a thousand files")
        print(f"\n1000 files: {time.monotonic() - start:.1f} s", flush=True)
        job.signal(harness.TERMINATE)
        self.assert_code(0, job.wait())
        self.assertEqual(sorted(f"record {number}" for number in range(1000)), sorted(self.stored()))
        self.assertEqual([], self.dropped())
        self.assert_all_reported()

    def test_what_is_dropped_can_be_printed(self):
        records = names(200)
        self.write_csv(rows(records), name="in/batch.csv")
        self.assert_code(0, self.once("--columns", "name"))
        printer = self.simulator("--rate", 500)
        done = self.folder / "done/batch.csv"
        result = self.print(done, printer, "--columns", "name", "-o", "json")
        self.assert_done(result)
        self.assertEqual(1, result.json()["job"])
        self.assert_printed(records, printer)
        # What is printed is not imported again either.
        self.put("once more.csv", done.read_text(encoding="utf-8"))
        self.once("--columns", "name")
        self.assertEqual("duplicate", self.report("done/once more.csv")["verdict"])

    def test_names_are_shown_escaped(self):
        self.put("a\n\x1b[2Jb.csv", "name\nA\n")
        result = self.once("--settle", "rename")
        self.assert_code(0, result)
        self.assertIn("a\\x0A\\x1B[2Jb.csv: imported", result.err)
        self.assertTrue(all(line.isprintable() for line in result.err.splitlines()), result.err)

    def test_exit_codes(self):
        self.assert_code(0, self.once())
        self.put("bad.csv", "name\n\x01\n")
        self.assert_code(5, self.once("--settle", "rename"))
        self.assert_one_clear_line(2, self.once("--settle", "soon"), "--settle soon", "quiet=2s")
        self.assert_one_clear_line(2, self.once(folder=self.directory / "missing"), "missing")
        first = self.drop()
        self.wait_for(lambda: (self.spool.with_name("spool.db.lock")).exists(), "the spool")
        time.sleep(0.2)
        self.assert_one_clear_line(1, self.once(), "in use by another linefeed")
        first.kill()

    def test_files_that_stay_are_named(self):
        (self.folder / "dir.csv").mkdir()
        self.put("unmarked.csv", "name\nA\n")
        result = self.once("--settle", "done")
        self.assert_code(0, result)
        self.assertIn("dir.csv: stays for now: this is a directory", result.err)
        self.assertIn("unmarked.csv: stays for now: its .done is missing", result.err)

    def test_a_long_import_is_broken_off_and_taken_up(self):
        count = 1_000_000
        self.put("long.csv", "name\n" + "".join(f"record number {number}\n" for number in range(count)))
        job = self.drop("--settle", "rename")
        self.wait_for(lambda: self.spool.exists() and (self.folder / "processing/long.csv").exists(), "the claim")
        job.signal(harness.INTERRUPT)
        self.assert_one_clear_line_besides(4, job.wait())
        self.assertEqual(["long.csv"], self.inside("processing"))
        self.assert_code(0, self.once())
        self.assertEqual(["long.csv"], self.inside("done"))
        self.assertEqual(count, len(self.stored()))

    def assert_one_clear_line_besides(self, code, result):
        """One line that says what has happened, besides that of the start."""
        self.assert_code(code, result)
        self.assertEqual(1, len([line for line in result.errors if "watching" not in line]), str(result))


class DropKill(DropCase):
    """A batch is in the spool once, whenever the process is killed."""

    def test_killed_at_random_moments(self):
        seed = int(os.environ.get("LINEFEED_SEED", random.randrange(2**32)))
        draw = random.Random(seed)
        start = time.monotonic()
        expected = collections.Counter()
        batches, verdicts, kills = 0, collections.Counter(), 0
        try:
            for _ in range(ROUNDS):
                job = self.drop("--settle", "quiet=20ms", "--mode", draw.choice(["inotify", "poll"]), "--rescan", "0.05")
                for _ in range(draw.randint(0, 4)):
                    batches += 1
                    kind = draw.choice(["good", "good", "good", "large", "bad", "again"])
                    records = [f"batch {batches} record {k}" for k in range(draw.choice([1, 5]) if kind != "large" else 3000)]
                    if kind == "again":
                        records = ["the same"]
                    content = "name\n" + "".join(f"{record}\n" for record in records)
                    name = draw.choice([f"b{batches}.csv", "daily.csv"])
                    while (self.folder / name).exists():
                        time.sleep(0.005) # those who drop wait for their turn
                        if job.process.poll() is not None:
                            self.fail("linefeed drop has ended by itself")
                    self.put(name, content + ("\x01\n" if kind == "bad" else ""), draw.choice(["rename", "mark", "in place"]))
                    verdicts["failed" if kind == "bad" else "batch"] += 1
                    if kind == "again":
                        expected["the same"] = 1
                    elif kind != "bad":
                        expected.update(records)
                time.sleep(draw.uniform(0, 0.12))
                job.kill()
                self.assertEqual(-signal.SIGKILL, job.process.returncode)
                kills += 1
            self.once("--settle", "quiet=20ms")
            self.assertEqual(expected, collections.Counter(self.stored()))
            self.assertEqual([], self.dropped())
            self.assertEqual([], self.inside("processing"))
            self.assertEqual(verdicts["batch"], len(self.inside("done")))
            self.assertEqual(verdicts["failed"], len(self.inside("failed")))
            self.assert_all_reported()
        except Exception as error:
            raise AssertionError(f"seed {seed}: {error}") from error
        print(f"\nkill -9: {kills} rounds, {batches} batches, {sum(expected.values())} records, none lost, none doubled; "
              f"seed {seed}; {time.monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    harness.main()
