"""Printing while the file is still being read (--while-importing): every record once, in order, whatever interrupts the import or the run.

The source is a query that takes its time for every row, so that the import is surely under way while the line prints.
"""

import contextlib
import os
import random
import sqlite3
import time

import harness
import interruption
from harness import names

STREAM = "--while-importing"
RATE = 150  # of the line; the source gives about three times as much


def counting(steps):
    return f"(WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c WHERE x < {steps}) SELECT max(x) FROM c)"


def steps_per_ms():
    """How far SQLite counts in a millisecond here and now."""
    steps = 200_000
    with contextlib.closing(sqlite3.connect(":memory:")) as database:
        started = time.process_time()
        database.execute("SELECT " + counting(steps)).fetchall()
        return steps / (time.process_time() - started) / 1000


class SlowSource(interruption.Interruption):
    """A database whose rows take time: `row_ms` each."""

    count = 900
    row_ms = 2.0

    @classmethod
    def setUpClass(cls):
        cls.steps = max(1, int(cls.row_ms * steps_per_ms()))

    def setUp(self):
        super().setUp()
        self.file = self.write_database(self.records)

    def write_database(self, records, name="names.db"):
        path = self.directory / name
        with contextlib.closing(sqlite3.connect(path)) as database, database:
            database.execute("CREATE TABLE names (id INTEGER PRIMARY KEY, name TEXT)")
            database.executemany("INSERT INTO names VALUES (?, ?)", records)
        return path

    def query(self):
        """The names in order. What takes time stands in a condition that always holds."""
        return "--query", f"SELECT name FROM names WHERE {counting(f'{self.steps} + 0 * names.id')} > 0 ORDER BY id"

    def options(self):
        return (STREAM, *self.query())

    def update(self, statement, *values):
        with contextlib.closing(sqlite3.connect(self.file)) as database, database:
            database.execute(statement, values)

    def jobs_in_spool(self):
        with contextlib.closing(sqlite3.connect(f"file:{self.spool}?mode=ro", uri=True)) as spool:
            return spool.execute("SELECT state, records FROM jobs ORDER BY id").fetchall()

    def assert_importing(self):
        """The import has not come to its end, and what is printed is in the spool."""
        [(state, records)] = self.jobs_in_spool()
        self.assertEqual("importing", state)
        self.assertLess(records, self.count)
        return records

    def start_printing(self, printer, prints=50, *options):
        job = self.start(self.file, printer, *self.options(), *options)
        printer.wait_for_prints(prints)
        return job

    def go_on(self, printer, *printers_before):
        return self.finish(printer, *printers_before, options=self.options())


class Streaming(SlowSource):
    def test_prints_while_the_file_is_read(self):
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer)
        self.assert_importing()
        result = job.wait()
        self.assert_done(result)
        self.assert_printed(self.records, printer)
        self.assertEqual([("ready", self.count)], self.jobs_in_spool())
        summary = printer.stop()
        self.assert_clean(summary)
        self.assertIn("1223", summary["errors"], "the printer has stopped itself behind the last record")

    def test_the_same_command_again_prints_nothing(self):
        printer = self.simulator("--rate", RATE)
        self.go_on(printer)
        self.assert_done(self.go_on(printer))

    def test_stop_point_ignored(self):
        printer = self.simulator("--rate", RATE, "--habit", "ignore-stop-at")
        self.start_printing(printer).wait()
        self.assertEqual(self.records, self.ours(printer))

    def test_interrupted_in_mid_import(self):
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer)
        self.assert_importing()
        job.signal(harness.INTERRUPT)
        result = job.wait()
        self.assert_stopped(result, "stopped on request")
        self.assert_importing()
        printed = len(printer.prints())
        self.assertEqual(printed + 1, self.continues_with(result))
        self.go_on(printer)

    def test_goes_on_without_the_option(self):
        """Then the rest of the file is read before the next record is printed."""
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer)
        job.signal(harness.INTERRUPT)
        job.wait()
        self.finish(printer, options=self.query())

    def test_printer_error_in_mid_import(self):
        printer = self.simulator("--rate", RATE, "--error-at-print", "60:12113")
        result = self.start_printing(printer).wait()
        self.assert_stopped(result, "12113")
        self.assert_importing()
        self.finish(printer, options=(*self.options(), "--acknowledge", "12113"))

    def test_stopped_at_the_printer_in_mid_import(self):
        printer = self.simulator("--rate", RATE, "--stop-at-print", 60)
        self.assert_stopped(self.start_printing(printer).wait(), "stopped at the printer")
        self.go_on(printer)

    def test_part_of_a_file(self):
        printer = self.simulator("--rate", RATE)
        result = self.print(self.file, printer, *self.options(), "--from", 300, "--to", 500)
        self.assert_done(result)
        self.assert_printed(self.records[299:500], printer)
        self.assertEqual([("ready", self.count)], self.jobs_in_spool())

    def test_end_before_to(self):
        printer = self.simulator("--rate", RATE)
        result = self.print(self.file, printer, *self.options(), "--to", 5000)
        self.assert_done(result)
        self.assertIn(f"the file ends with record {self.count}, before --to", result.err)
        self.assert_printed(self.records, printer)

    def test_source_slower_than_the_line(self):
        """The printer runs empty: linefeed has warned, and the same command continues, until all is printed."""
        printer = self.simulator("--rate", 2000)
        starts = 0
        result = None
        while starts < 8 and (result is None or result.code == 4):
            result = self.print(self.file, printer, *self.options())
            starts += 1
            if result.code == 4:
                self.assertIn("the printer runs empty soon", result.err)
                self.assertIn("the printer ran empty, because the records were read more slowly", result.err)
        self.assert_code(0, result)
        self.assertGreater(starts, 1)
        self.assert_printed(self.records, printer)


class StreamingSmall(harness.TestCase):
    def test_smaller_than_the_fifo(self):
        for count in (1, 2, 10, 255, 256, 257):
            records = names(count)
            file = self.write_csv(harness.rows(records), name=f"names{count}.csv")
            printer = self.simulator("--rate", 1000)
            self.assert_done(self.print(file, printer, STREAM))
            self.assert_printed(records, printer)
            self.assert_clean(printer.stop())

    def test_nothing_in_it(self):
        for content in (b"", b"name\n"):
            result = self.print(self.write_bytes(content), self.simulator("--rate", 100), STREAM)
            self.assert_one_clear_line(5, result)

    def test_bad_row_before_the_first_product(self):
        printer = self.simulator("--rate", 100)
        result = self.print(self.write_bytes(b"name,code\na,1\nb\nc,3\n"), printer, STREAM)
        self.assert_one_clear_line(5, result, "line 3", "1 field instead of 2")
        self.assertEqual([], printer.prints())


class StreamingBadRows(SlowSource):
    bad = 700

    def setUp(self):
        super().setUp()
        self.update("UPDATE names SET name = NULL WHERE id = ?", self.bad)

    def print_to_the_bad_row(self, printer):
        result = self.print(self.file, printer, *self.options())
        self.assert_code(5, result)
        self.assertIn(f"line {self.bad}, column name: the value is NULL", result.err)
        self.assertIn(f"the line has stopped behind record {self.bad - 1}", result.err)
        self.assertIn(f"mend the file behind record {self.bad - 1}", result.out)
        self.assert_printed(self.records[:self.bad - 1], printer)
        self.assertEqual([("importing", self.bad - 1)], self.jobs_in_spool())
        return result

    def mend(self):
        self.update("UPDATE names SET name = ? WHERE id = ?", self.records[self.bad - 1][1], self.bad)

    def test_stops_before_it_and_goes_on_when_it_is_mended(self):
        printer = self.simulator("--rate", RATE)
        self.print_to_the_bad_row(printer)
        again = self.print(self.file, printer, *self.options())
        self.assert_code(5, again)
        self.assertIn(f"line {self.bad}, column name: the value is NULL", again.err)
        self.mend()
        self.go_on(printer)
        self.assertIn("1223", printer.stop()["errors"], "the line was stopped by the stop point")

    def test_names_every_bad_row(self):
        self.update("UPDATE names SET name = NULL WHERE id = 800")
        result = self.print_to_the_bad_row(self.simulator("--rate", RATE))
        self.assertIn("line 800, column name: the value is NULL", result.err)
        self.assertIn(f"2 of {self.count} rows", result.err)

    def test_mended_file_must_begin_with_what_is_printed(self):
        printer = self.simulator("--rate", RATE)
        self.print_to_the_bad_row(printer)
        self.mend()
        self.update("UPDATE names SET name = 'somebody else' WHERE id = 5")
        result = self.print(self.file, printer, *self.options())
        self.assert_one_clear_line(5, result, "are not those that were imported from it before", "--new-job")
        self.assert_printed(self.records[:self.bad - 1], printer)

    def test_interrupted_before_the_bad_row(self):
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer, 300)
        job.signal(harness.INTERRUPT)
        self.assert_code(4, job.wait())
        self.print_to_the_bad_row(printer)

    def test_without_the_option_nothing_more_is_printed(self):
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer)
        job.signal(harness.INTERRUPT)
        job.wait()
        printed = len(printer.prints())
        result = self.print(self.file, printer, *self.query())
        self.assert_code(5, result)
        self.assertIn("nothing more is printed: 1 of 900 rows cannot be printed", result.err)
        self.assertEqual(printed, len(printer.prints()))
        self.mend()
        self.finish(printer, options=self.query())

    def test_skipped_where_that_is_wanted(self):
        printer = self.simulator("--rate", RATE)
        result = self.print(self.file, printer, *self.options(), "--skip-bad")
        self.assert_code(0, result)
        self.assertIn("left out 1 bad rows of 900", result.err)
        texts = [text for number, text in self.records if number != self.bad]
        self.assert_printed(list(enumerate(texts, 1)), printer)


class StreamingChangedFiles(SlowSource):
    def break_off(self):
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer)
        job.signal(harness.INTERRUPT)
        self.assert_code(4, job.wait())
        self.assert_importing()
        return printer, printer.prints()

    def assert_refused(self, printer, printed, *words, options=None, file=None):
        result = self.print(file or self.file, printer, *(self.options() if options is None else options))
        self.assert_one_clear_line(5, result, *words)
        self.assertEqual(printed, printer.prints())

    def test_grown(self):
        printer, printed = self.break_off()
        more = "x" * 3000  # whole pages, so that the file is larger
        for number in range(20):
            self.update("INSERT INTO names VALUES (?, ?)", self.count + 1 + number, more)
        for options in (self.options(), self.query()):
            self.assert_refused(printer, printed, "has changed since job 1 was begun", "--new-job", options=options)

    def test_changed_in_what_is_read(self):
        printer, printed = self.break_off()
        self.update("UPDATE names SET name = 'Somebody 000003' WHERE id = 3")
        self.assert_refused(printer, printed, "the records ", " are not those that were imported from it before")

    def test_read_in_another_way(self):
        printer, printed = self.break_off()
        self.assert_refused(printer, printed, "the way to read it has changed",
                            options=(STREAM, "--query", "SELECT name FROM names ORDER BY id DESC"))

    def test_put_back(self):
        """The same content, written anew."""
        printer, _ = self.break_off()
        content = self.file.read_bytes()
        self.file.unlink()
        self.file.write_bytes(content)
        self.go_on(printer)

    def test_changed_while_it_is_read(self):
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer)
        self.assert_importing()
        os.utime(self.file, ns=(1, 1))
        result = job.wait()
        self.assert_one_clear_line(5, result, "the file was changed while it was read")
        self.assert_ledger_honest(printer)

    def test_a_copy_is_not_printed_anew(self):
        printer, printed = self.break_off()
        copy = self.directory / "copy.db"
        copy.write_bytes(self.file.read_bytes())
        for options in (self.options(), self.query()):
            self.assert_refused(printer, printed, "begins with the records of job 1", "--new-job", options=options, file=copy)
        self.go_on(printer)

    def test_a_copy_of_a_finished_file_is_known(self):
        printer = self.simulator("--rate", RATE)
        self.go_on(printer)
        copy = self.directory / "copy.db"
        copy.write_bytes(self.file.read_bytes())
        self.assert_done(self.print(copy, printer, *self.options()))
        self.assert_printed(self.records, printer)

    def test_a_new_job_instead_of_going_on(self):
        printer, printed = self.break_off()
        result = self.print(self.file, printer, *self.options(), "--new-job")
        self.assert_one_clear_line(2, result, "continue it without --new-job")
        self.assertEqual(printed, printer.prints())


class StreamingFailures(SlowSource):
    """The source or the spool gives up in the middle; the line stops cleanly, and the same command goes on when that is mended."""

    def test_source_that_cannot_be_read_any_further(self):
        content = self.file.read_bytes()
        page_bytes = int.from_bytes(content[16:18], "big")
        self.file.write_bytes(content[:-page_bytes] + b"\xff" * page_bytes)  # the last rows
        printer = self.simulator("--rate", RATE)
        result = self.print(self.file, printer, *self.options())
        self.assert_one_clear_line(5, result, "the file is damaged")
        printed = self.ours(printer)
        self.assertGreater(len(printed), 0)
        self.judge(self.records[:len(printed)], printed)
        self.assert_ledger_honest(printer)
        [(state, records)] = self.jobs_in_spool()
        self.assertEqual("importing", state)
        self.assertGreaterEqual(records, len(printed))
        again = self.print(self.file, printer, *self.options())
        self.assert_code(5, again)
        self.judge(self.records[:len(self.ours(printer))], self.ours(printer))

    def test_source_that_is_gone(self):
        """What was opened is read to its end."""
        printer = self.simulator("--rate", RATE)
        job = self.start_printing(printer)
        self.assert_importing()
        self.file.unlink()
        self.assert_done(job.wait())
        self.assert_printed(self.records, printer)

    def test_disk_that_takes_no_more(self):
        """The import and the ledger cannot be written any further: nothing is printed that is not known to be."""
        printer = self.simulator("--rate", RATE)
        limited = ["sh", "-c", "trap '' XFSZ; ulimit -f 4000; exec \"$@\"", "sh"]
        job = harness.Job([*limited, *self.command(self.file, printer, *self.options())])
        self.addCleanup(job.kill)
        result = job.wait()
        self.assert_code(4, result)
        self.assertIn("the line is stopped", result.err)
        self.assertIn("the disk cannot be written", result.err)
        self.assertGreater(len(printer.prints()), 0)
        self.assertLess(len(printer.prints()), self.count)
        self.assert_ledger_honest(printer)
        self.finish_by_products(printer, options=self.options())


class StreamingKill(SlowSource):
    row_ms = 1.0

    def test_killed_again_and_again(self):
        """kill -9 in mid-import while printing; the printer prints on what it holds, and may still print when linefeed is back."""
        seed = int(os.environ.get("LINEFEED_SEED", random.randrange(2**32)))
        chance = random.Random(seed)
        printer = self.simulator("--rate", 300)
        kills = in_mid_import = 0
        with self.subTest(seed=seed):
            while kills < (40 if harness.LONG else 8):
                job = self.start(self.file, printer, *self.options())
                time.sleep(chance.uniform(0.05, 0.6))
                if job.process.poll() is not None:
                    break
                job.kill()
                kills += 1
                in_mid_import += self.is_importing()
                self.assert_ledger_honest_about_prints(printer)
                time.sleep(chance.choice([0, 0.05, 0.3]))
            self.finish_by_products(printer, options=self.options())
        print(f"\nkill -9 while importing: {kills} kills, {in_mid_import} of them in mid-import; seed {seed}", flush=True)
        self.assertGreater(in_mid_import, 0)

    def is_importing(self):
        jobs = self.jobs_in_spool() if self.spool.exists() else []
        return bool(jobs) and jobs[0][0] == "importing"

    def assert_ledger_honest_about_prints(self, printer):
        """Everything on a product is in the spool, as a record of the job: it would be found after a power failure."""
        printed = [number for number, _ in printer.prints()]
        jobs = self.jobs_in_spool() if self.spool.exists() else []
        self.assertLessEqual(max(printed, default=0), jobs[0][1] if jobs else 0)


if __name__ == "__main__":
    harness.main()
