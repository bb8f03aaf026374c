"""kill -9 at random moments: while importing, arming, printing, stopping. The printer goes on printing what it holds, runs empty,
or is found while it still prints; the same command again continues. Over all runs of a job every record is on the tape once, in order.

LINEFEED_SEED=N repeats the moments of a run (not the machine's scheduling).
"""

import os
import random
import sqlite3
import time
import unittest

import harness
from harness import names, rows

ROUNDS = 500 if harness.LONG else 30
MOST_ROUNDS_PER_JOB = 8
MOST_STARTS_PER_JOB = 40  # a job that needs more does not get on


class Kill(harness.TestCase):
    def setUp(self):
        super().setUp()
        self.seed = int(os.environ.get("LINEFEED_SEED", random.randrange(2**32)))
        self.random = random.Random(self.seed)
        self.kills = {"starting": 0, "printing": 0, "stopping": 0}
        self.ended_codes = {}
        self.asked = 0
        self.story = []

    def test_killed_at_random_moments(self):
        start = time.monotonic()
        jobs = 0
        records = 0
        try:
            while sum(self.kills.values()) < ROUNDS:
                jobs += 1
                records += self.one_job(jobs)
        except Exception as error:
            raise AssertionError(f"seed {self.seed}, job {jobs}: {error}\n" + "\n".join(self.story)) from error
        print(f"\nkill -9: {sum(self.kills.values())} rounds {self.kills}, {jobs} jobs, {records} records, 0 doubles, 0 gaps; "
              f"runs that ended by themselves, by exit code: {self.ended_codes}; last product read by the operator {self.asked} times; "
              f"seed {self.seed}; {time.monotonic() - start:.0f} s", flush=True)

    def one_job(self, number):
        """Kills and continues until the job is done; judges its tape. Returns its size."""
        self.story = []
        records = names(self.random.randint(500, 2000))
        rate = self.random.randint(1000, 2000)
        self.story.append(f"{len(records)} records at {rate}/s")
        file = self.write_csv(rows(records), name=f"names{number}.csv")
        spool = self.directory / f"spool{number}" / "spool.db"
        printer = self.simulator("--rate", rate, "--depth", self.random.choice([16, 64, 256]))
        options = ()
        rounds = self.random.randint(1, MOST_ROUNDS_PER_JOB)
        for _ in range(MOST_STARTS_PER_JOB):
            job = self.start(file, printer, *options, spool=spool)
            options = ()
            if rounds > 0 and self.kill(job, len(records) / rate):
                rounds -= 1
                continue
            result = job.wait()
            self.ended_codes[result.code] = self.ended_codes.get(result.code, 0) + 1
            self.story.append(f"ended by itself with {result.code}: {' '.join(result.errors)}")
            if result.code == 0:
                break
            self.assertIn(result.code, (4, 6), str(result))
            if result.code == 6:
                options = ("--last-printed", self.last_product(printer))
        else:
            raise AssertionError("the job does not get on")
        summary = printer.stop()
        self.judge(records, printer.prints())
        self.assertEqual((0, 0), (summary["doubles"], summary["gaps"]), summary)
        self.assert_ledger_right(spool, len(records))
        return len(records)

    def kill(self, job, printing_s):
        """Waits for a moment and kills. False if the job had ended before."""
        kind = self.random.choices(["starting", "printing", "stopping"], [30, 55, 15])[0]
        delay_s = self.random.uniform(0, 0.08 if kind == "starting" else printing_s + 0.3)
        time.sleep(delay_s)
        if kind == "stopping":
            if job.process.poll() is None:
                job.signal(harness.INTERRUPT)
            time.sleep(self.random.uniform(0, 0.05))
        job.kill()
        if job.process.returncode != -9:
            # It had been quicker. Its exit code says no more than the next start will.
            self.story.append(f"ended with {job.process.returncode} before it was killed")
            return False
        self.kills[kind] += 1
        pause_s = self.random.choice([0, 0, 0, self.random.uniform(0, 0.3), 0.4])
        self.story.append(f"killed when {kind} after {delay_s * 1000:.0f} ms, started again after {pause_s * 1000:.0f} ms")
        time.sleep(pause_s)
        return True

    def last_product(self, printer):
        """The operator looks at the last product."""
        self.asked += 1
        printed = printer.prints()
        return printed[-1][0] if printed else 0

    def assert_ledger_right(self, spool, count):
        """The chain holds, the database is sound, and the ledger says that every record is printed."""
        database = sqlite3.connect(f"file:{spool}?mode=ro", uri=True)
        try:
            self.assertEqual([("ok",)], database.execute("PRAGMA integrity_check").fetchall())
            # An import that was killed has used up its number.
            ((job, size),) = database.execute("SELECT id, records FROM jobs").fetchall()
            states = dict(database.execute("SELECT state, sum(records) FROM ledger_segments GROUP BY state"))
            self.assertEqual((count, {"printed": count}), (size, states))
        finally:
            database.close()
        verify = [str(harness.BIN / "linefeed"), "ledger", str(job), "--verify", "--spool", str(spool)]
        self.assert_code(0, harness.Job(verify).wait())


if __name__ == "__main__":
    unittest.main(verbosity=2)
