"""linefeed-backup and linefeed-restore with real processes: copies of a spool that is being written, and what may be printed after a
copy of yesterday was put in its place. The judge is the tape: every number once, though the restored spool has forgotten some of them.
"""

import json
import os
import resource
import shutil
import signal
import sqlite3
import subprocess
import time

import harness
from harness import names, rows

BIN = harness.BIN.resolve()
SCRIPTS = BIN.parent / "deploy"


class BackupCase(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.backups = self.directory / "backups"
        self.backups.mkdir()

    def script(self, name, *options, path="", **keywords):
        done = subprocess.run([str(SCRIPTS / name), *map(str, options)], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                              env={**os.environ, "PATH": f"{path}{BIN}:{os.environ['PATH']}"}, timeout=harness.PATIENCE_S, **keywords)
        return harness.Result(done.returncode, done.stdout, done.stderr)

    def back_up(self, *options, **keywords):
        return self.script("linefeed-backup", "--spool", self.spool, "--to", self.backups, *options, **keywords)

    def restore(self, *options, **keywords):
        return self.script("linefeed-restore", "--spool", self.spool, *options, **keywords)

    def copies(self):
        return sorted(self.backups.glob("spool-*.db"))

    def new_copy(self):
        before = self.copies()
        if before:
            time.sleep(1.1)  # names are of the second
        self.assert_code(0, self.back_up())
        new, = set(self.copies()) - set(before)
        return new

    def ledger(self, spool, *options, job=1):
        done = subprocess.run([str(harness.BIN / "linefeed"), "ledger", str(job), "--spool", str(spool), *options],
                              capture_output=True, text=True, timeout=harness.PATIENCE_S, check=False)
        return harness.Result(done.returncode, done.stdout, done.stderr)

    def counts(self, spool, job=1):
        return json.loads(self.ledger(spool, "-o", "json", job=job).out)["counts"]

    def make_spool(self, count=50):
        """A job that is printed to its end."""
        simulator = self.simulator("--rate", 500)
        file = self.write_csv(rows(names(count)))
        self.assert_done(self.print(file, simulator))
        return file, simulator

    def print_part(self, file, simulator, until):
        """The operator stops the line when so many products are on the tape."""
        job = self.start(file, simulator)
        simulator.wait_for_prints(until)
        job.signal(harness.INTERRUPT)
        self.assert_code(4, job.wait())


class Backup(BackupCase):
    def test_copies_a_spool_that_is_being_written_and_disturbs_nobody(self):
        expected = names(4000)
        simulator = self.simulator("--rate", 500)
        job = self.start(self.write_csv(rows(expected)), simulator)
        printed = []
        for already in (200, 1200, 2200):
            simulator.wait_for_prints(already)
            copy = self.new_copy()
            self.assertIsNone(job.process.poll(), "the line had come to its end before the copy was there")
            self.assertEqual(0, self.ledger(copy, "--verify").code)
            counts = self.counts(copy)
            self.assertGreater(counts["printed"] + counts["open"], already - 50)
            printed.append(counts["printed"])
        self.assertEqual(sorted(printed), printed)
        self.assert_done(job.wait())
        self.assert_printed(expected, simulator)
        self.assert_clean(simulator.stop())

    def test_keeps_as_many_as_it_is_told(self):
        self.make_spool()
        for year in (2021, 2022, 2023):
            (self.backups / f"spool-{year}0101T000000Z.db").touch()
        (self.backups / "spool-of-the-old-line.db").touch()
        self.assert_code(0, self.back_up("--keep", 2))
        kept = [copy.name for copy in self.copies()]
        self.assertEqual(["spool-20230101T000000Z.db", "spool-of-the-old-line.db"], [kept[0], kept[-1]])
        self.assertEqual(3, len(kept), kept)

    def test_refuses_a_spool_whose_ledger_was_changed(self):
        self.make_spool()
        with sqlite3.connect(self.spool) as database:
            database.execute("DROP TRIGGER ledger_rows_do_not_change")
            database.execute("UPDATE ledger SET evidence = '{}' WHERE kind = 'printed'")
        database.close()
        result = self.back_up()
        self.assert_code(1, result)
        self.assertIn("the print ledger", result.err)
        self.assertEqual([], self.copies())

    def test_refuses_a_database_that_is_damaged(self):
        self.make_spool(2000)
        content = bytearray(self.spool.read_bytes())
        for place in range(4096 * 3, len(content) - 4096, 4096):
            content[place:place + 64] = b"\xff" * 64
        self.spool.write_bytes(content)
        self.assert_code(1, self.back_up())
        self.assertEqual([], self.copies())

    def test_leaves_nothing_behind_when_the_disk_is_full(self):
        self.make_spool(2000)
        result = self.back_up(preexec_fn=lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
                                                  resource.setrlimit(resource.RLIMIT_FSIZE, (16384, 16384))))
        self.assert_code(1, result)
        self.assertIn("cannot be copied", result.err)
        self.assertEqual([".lock"], os.listdir(self.backups))

    def test_takes_up_after_one_that_was_killed(self):
        self.make_spool()
        (self.backups / ".spool-20260101T000000Z.db.part").touch()
        self.assert_code(0, self.back_up())
        self.assertEqual([".lock", self.copies()[0].name], sorted(os.listdir(self.backups)))

    def test_refuses_wrong_use(self):
        self.make_spool()
        for code, options in ((2, ["--keep", "0"]), (2, ["--keep"]), (2, ["--what"]), (1, ["--to", self.directory / "nowhere"]),
                              (1, ["--spool", self.directory / "nowhere.db"]), (1, ["--spool", self.backups])):
            result = self.back_up(*options)
            self.assert_code(code, result)
            self.assertEqual(1, len(result.err.splitlines()), str(result))
        self.assertEqual([], self.copies())


class Restore(BackupCase):
    def test_no_number_is_printed_twice_after_a_backup_of_yesterday_is_restored(self):
        expected = names(3000)
        file = self.write_csv(rows(expected))
        simulator = self.simulator("--rate", 500)
        job = self.start(file, simulator)
        simulator.wait_for_prints(500)
        copy = self.new_copy()  # in mid-job, with records on their way
        simulator.wait_for_prints(1500)
        job.signal(harness.INTERRUPT)
        self.assert_code(4, job.wait())
        already = len(simulator.prints())

        result = self.restore("--replace-good-spool", copy)
        self.assert_code(0, result)
        self.assertIn("IS NOT KNOWN", result.err)
        self.assertRegex(result.err, r"job 1 .*names\.csv: \d+ records in doubt, \d+-3000")
        for _ in range(2):
            self.assert_code(6, self.print(file, simulator))
            self.assertEqual(already, len(simulator.prints()))
        self.assert_done(self.print(file, simulator, "--last-printed", already))
        self.assert_printed(expected, simulator)
        self.assertEqual(0, self.ledger(self.spool, "--verify").code)

    def test_an_operator_may_say_that_no_more_was_printed(self):
        expected = names(300)
        file = self.write_csv(rows(expected))
        simulator = self.simulator("--rate", 1000)
        self.print_part(file, simulator, 10)
        copy = self.new_copy()
        self.spool.unlink()
        self.assert_code(0, self.restore(copy))
        self.assert_code(6, self.print(file, simulator))
        self.assert_done(self.print(file, simulator, "--printed", "none"))  # nothing was printed after the backup
        self.assert_printed(expected, simulator)

    def test_nothing_is_asked_where_nothing_was_printed_since(self):
        expected = names(300)
        file = self.write_csv(rows(expected))
        simulator = self.simulator("--rate", 1000)
        self.print_part(file, simulator, 50)
        copy = self.new_copy()
        self.spool.unlink()
        result = self.restore("--nothing-printed-since", "moved to another machine", copy)
        self.assert_code(0, result)
        self.assertEqual("", result.err)
        self.assert_done(self.print(file, simulator))
        self.assert_printed(expected, simulator)

    def test_refuses_to_replace_a_spool_that_is_whole(self):
        self.make_spool()
        copy = self.new_copy()
        before = self.spool.read_bytes()
        result = self.restore(copy)
        self.assert_code(1, result)
        self.assertIn("whole", result.err)
        self.assertEqual(before, self.spool.read_bytes())

    def test_replaces_a_spool_that_is_damaged_and_keeps_it(self):
        self.make_spool()
        copy = self.new_copy()
        self.spool.write_bytes(b"\0" * 4096 + self.spool.read_bytes()[4096:])
        damaged = self.spool.read_bytes()
        self.assert_code(0, self.restore(copy))
        self.assertEqual(50, self.counts(self.spool)["printed"])
        kept, = self.spool.parent.glob("spool.db.replaced-*Z")
        self.assertEqual(damaged, kept.read_bytes())

    def test_refuses_a_backup_that_is_damaged_and_changes_nothing(self):
        self.make_spool()
        copy = self.new_copy()
        foreign = self.directory / "foreign.db"
        database = sqlite3.connect(foreign)
        database.execute("CREATE TABLE jobs(id, state, records)")
        database.close()
        content = copy.read_bytes()
        copy.write_bytes(content[:4096] + b"\xff" * 4096 + content[8192:])
        before = sorted(os.listdir(self.spool.parent))
        for bad in (copy, foreign, self.write_bytes(b"no database"), self.write_bytes(b"", "empty.db")):
            self.assert_code(1, self.restore("--replace-good-spool", bad))
            self.assertEqual(before, sorted(os.listdir(self.spool.parent)))
        self.assertEqual(0, self.ledger(self.spool, "--verify").code)

    def test_refuses_while_the_spool_is_in_use(self):
        file, simulator = self.make_spool()
        copy = self.new_copy()
        job = self.start(self.write_csv(rows(names(2000)), "more.csv"), simulator)
        simulator.wait_for_prints(100)
        result = self.restore("--replace-good-spool", copy)
        self.assert_code(1, result)
        self.assertIn("is in use", result.err)
        self.assert_done(job.wait())

    def test_is_gone_on_with_wherever_it_was_killed(self):
        # At each step of the exchange: mv, rm and sync kill the script instead of doing their work, from the n-th call on.
        self.make_spool()
        copy = self.new_copy()
        bin_directory = self.directory / "bin"
        bin_directory.mkdir()
        for program in ("mv", "rm", "sync"):
            killer = bin_directory / program
            killer.write_text("#!/bin/sh\n"
                              f'echo x >> "{self.directory}/calls"\n'
                              f'[ "$(wc -l < "{self.directory}/calls")" -lt "$KILL_AT" ] || kill -9 $PPID\n'
                              f'exec {shutil.which(program)} "$@"\n', encoding="utf-8")
            killer.chmod(0o755)
        kills = marks = 0
        for step in range(1, 30):
            (self.directory / "calls").write_text("", encoding="utf-8")
            os.environ["KILL_AT"] = str(step)
            result = self.restore("--replace-good-spool", copy, path=f"{bin_directory}:")
            mark = self.spool.parent / "restore-unfinished"
            marks += mark.exists()
            if not mark.exists():
                self.assertEqual(0, self.ledger(self.spool, "--verify").code)
            if result.code == 0:
                break
            kills += 1
            self.assert_code(-9, result)
            self.assert_code(0, self.restore("--replace-good-spool", copy))
            self.assertFalse(mark.exists())
            self.assertEqual(0, self.ledger(self.spool, "--verify").code)
            self.assertEqual(50, self.counts(self.spool)["printed"])
        self.assertEqual(0, result.code, "there was no end of it")
        self.assertGreaterEqual(kills, 8)
        self.assertGreaterEqual(marks, 4)

    def test_names_the_batches_that_were_imported_after_the_backup(self):
        folder = self.directory / "in's"
        folder.mkdir()
        config = self.write_bytes(f"""spool: {self.spool}
layouts: {{names: {{}}}}
printers: {{line1: {{address: "tcp://127.0.0.1:3000"}}}}
folders: {{names: {{path: "{folder}", layout: names, printer: line1}}}}
""".encode(), "linefeed.yaml")
        command = [str(harness.BIN / "linefeed"), "drop", str(folder), "--once", "--settle", "rename", "--spool", str(self.spool)]
        for name in ("known.csv", "lost.csv"):
            self.write_csv(rows(names(5 + len(name))), f"in's/{name}")
            subprocess.run(command, check=True, capture_output=True, timeout=harness.PATIENCE_S)
            if name == "known.csv":
                copy = self.new_copy()
        result = self.script("linefeed-restore", "--config", config, "--replace-good-spool", copy)
        self.assert_code(0, result)
        self.assertIn("in's/done/lost.csv.report.json", result.err)
        self.assertNotIn("known.csv.report.json", result.err)
        self.write_csv(rows(names(3)), "in's/new.csv")
        subprocess.run(command, check=True, capture_output=True, timeout=harness.PATIENCE_S)
        report = json.loads((folder / "done/new.csv.report.json").read_text(encoding="utf-8"))
        self.assertGreater(report["job"], 2)  # that of lost.csv

    def test_refuses_wrong_use(self):
        self.make_spool()
        copy = self.new_copy()
        for code, options in ((2, []), (2, [copy, copy]), (2, ["--what", copy]), (2, ["--nothing-printed-since"]), (2, ["--nothing-printed-since", "", copy]),
                              (1, [self.directory / "nowhere.db"]), (1, ["--spool", self.directory / "nowhere" / "spool.db", copy])):
            self.assert_code(code, self.restore(*options))


if __name__ == "__main__":
    harness.main()
