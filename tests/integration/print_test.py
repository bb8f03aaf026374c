"""A file end to end: CSV and SQLite, columns, charsets, delimiters, ranges, output."""

import os
import sqlite3
import subprocess

import harness
from harness import names, rows


class Judge(harness.TestCase):
    """The judge of all these tests does find what it is there to find."""

    def test_doubles_gaps_order_and_wrong_texts(self):
        expected = names(10)
        self.judge(expected, list(expected))
        swapped = [*expected[:3], expected[4], expected[3], *expected[5:]]
        for printed in (expected[:-1], expected[1:], expected + expected[-1:], expected[:4] + expected[3:], expected[:4] + expected[5:],
                        swapped, [*expected[:9], (10, "somebody else")], []):
            with self.assertRaises(AssertionError):
                self.judge(expected, printed)

    def test_an_untidy_printer(self):
        good = {"doubles": 0, "gaps": 0, "underruns": 0, "without_record": 0, "damaged_frames": 0, "highest_fill": 256,
                "errors": {"1223": 1}}
        self.assert_clean(good)
        for bad in ({"doubles": 1}, {"gaps": 1}, {"underruns": 1}, {"damaged_frames": 1}, {"highest_fill": 257}, {"errors": {"1015": 1}},
                    {"errors": {"5043": 1}}, {"without_record": 1}):
            with self.assertRaises(AssertionError):
                self.assert_clean({**good, **bad})


class PrintCsv(harness.TestCase):
    def test_three_thousand_records_at_a_thousand_a_second(self):
        records = names(3000)
        printer = self.simulator("--rate", 1000)
        result = self.print(self.write_csv(rows(records)), printer)
        self.assert_done(result)
        self.assertIn("printed 3000 of 3000 records (1-3000), last printed 3000", result.out)
        self.assert_printed(records, printer)
        summary = printer.stop()
        self.assert_clean(summary)
        self.assertEqual(1, summary["connections"])

    def test_the_same_command_again_prints_nothing(self):
        records = names(200)
        file = self.write_csv(rows(records))
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer))
        result = self.print(file, printer)
        self.assert_done(result)
        self.assertIn("printed 200 of 200", result.out)
        self.assert_printed(records, printer)

    def test_a_touched_or_renamed_file_is_still_the_same_job(self):
        records = names(50)
        file = self.write_csv(rows(records))
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer))
        file.touch()
        self.assert_done(self.print(file, printer))
        self.assert_done(self.print(file.rename(self.directory / "other.csv"), printer))
        self.assert_printed(records, printer)

    def test_a_new_job_prints_the_file_again_when_told(self):
        records = names(50)
        file = self.write_csv(rows(records))
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer))
        self.assert_done(self.print(file, printer, "--new-job"))
        self.assert_printed(records + records, printer)

    def test_delimiters_line_ends_and_a_byte_order_mark(self):
        for delimiter, options in ((",", ()), (";", ()), ("\t", ()), (";", ("--delimiter", ";")), ("\t", ("--delimiter", "tab")),
                                   ("|", ("--delimiter", "|"))):
            for newline in ("\n", "\r\n"):
                for encoding in ("utf-8", "utf-8-sig"):
                    with self.subTest(delimiter=delimiter, newline=newline, encoding=encoding, options=options):
                        self.setUp()
                        file = self.write_csv([["ä", "1"], ["b", "2"]], header=("name", "code"), delimiter=delimiter, newline=newline,
                                              encoding=encoding)
                        printer = self.simulator("--rate", 500)
                        self.assert_done(self.print(file, printer, "--columns", "name,code", *options))
                        self.assert_printed([(1, "ä\t1"), (2, "b\t2")], printer)
                        printer.stop()

    def test_quoted_fields_without_header(self):
        file = self.write_bytes('"Müller, Anna",007\n"say ""hi""",0123456789012345678901234567890\n'.encode())
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer, "--no-header", "--columns", "2,1"))
        self.assert_printed([(1, "007\tMüller, Anna"), (2, '0123456789012345678901234567890\tsay "hi"')], printer)

    def test_a_part_of_the_file(self):
        records = names(3000)
        file = self.write_csv(rows(records))
        printer = self.simulator("--rate", 1000)
        result = self.print(file, printer, "--from", 2118, "--to", 2617)
        self.assert_done(result)
        self.assertIn("printed 500 of 500 records (2118-2617), last printed 2617", result.out)
        self.assert_printed(records[2117:2617], printer)

    def test_parts_one_after_the_other_and_then_the_rest(self):
        records = names(300)
        file = self.write_csv(rows(records))
        printer = self.simulator("--rate", 500)
        for options in (("--from", 101, "--to", 200), ("--to", 50), ()):
            self.assert_done(self.print(file, printer, *options))
        self.assert_printed(records[100:200] + records[:50] + records[50:100] + records[200:], printer)

    def test_a_base_moves_the_numbers(self):
        records = names(40)
        file = self.write_csv(rows(records))
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer, "--base", 22117))
        self.assert_printed([(22117 + number, text) for number, text in records], printer)


class PrintSqlite(harness.TestCase):
    def database(self, records):
        path = self.directory / "names.db"
        with sqlite3.connect(path) as database:
            database.execute("CREATE TABLE names(id INTEGER PRIMARY KEY, name TEXT, code TEXT)")
            database.execute("CREATE TABLE other(x)")
            database.executemany("INSERT INTO names VALUES (?, ?, ?)", [(number, text, f"{number:05d}") for number, text in records])
        database.close()
        return path

    def test_three_thousand_records_at_a_thousand_a_second(self):
        records = names(3000)
        printer = self.simulator("--rate", 1000)
        self.assert_done(self.print(self.database(records), printer, "--table", "names", "--columns", "name"))
        self.assert_printed(records, printer)
        self.assert_clean(printer.stop())

    def test_a_query_with_several_columns(self):
        records = names(100)
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(self.database(records), printer, "--query",
                                    "SELECT code, name, id FROM names WHERE id > 40 ORDER BY id DESC"))
        self.assert_printed([(place, f"{number:05d}\t{text}\t{number}")
                             for place, (number, text) in enumerate(reversed(records[40:]), 1)], printer)

    def test_columns_by_name_and_number(self):
        records = names(20)
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(self.database(records), printer, "--table", "names", "--columns", "code,2"))
        self.assert_printed([(number, f"{number:05d}\t{text}") for number, text in records], printer)


class Records(harness.TestCase):
    def test_unicode_hex(self):
        texts = ["Hello World", "Łódź", "日本語", "Müller", "€"]
        file = self.write_csv([[text] for text in texts])
        printer = self.simulator("--rate", 500, "--charset", "unicode-hex")
        self.assert_done(self.print(file, printer, "--encoding", "unicode-hex"))
        self.assert_printed(list(enumerate(texts, 1)), printer)

    def test_windows_1252(self):
        texts = ["5 €", "Müller", "„quoted“", "Šibenik – Žitnik", "™"]
        file = self.write_csv([[text] for text in texts])
        printer = self.simulator("--rate", 500, "--charset", "windows-1252")
        self.assert_done(self.print(file, printer, "--encoding", "windows-1252"))
        self.assert_printed(list(enumerate(texts, 1)), printer)

    def test_one_charset_for_each_column(self):
        file = self.write_csv([["Łódź", "Müller"]], header=("town", "name"))
        result = self.print(file, None, "--dry-run", "--encoding", "latin1,town=unicode-hex", "-o", "json")
        self.assert_done(result)
        self.assertEqual(["^0=MR1<TAB>014100F30064017A<TAB>M<FC>ller<CR>"], result.json()["frames"])

    def test_carets_and_backslashes_are_escaped(self):
        texts = ["^", "\\", "a^b\\c", "\\^", "C:\\temp\\^x"]
        file = self.write_csv([[text] for text in texts])
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer, "--profile", "jet3up"))
        self.assert_printed(list(enumerate(texts, 1)), printer)

    def test_properties(self):
        file = self.write_csv([["x"]])
        result = self.print(file, None, "--dry-run", "--mirrored", "--orientation", 180, "-o", "json")
        self.assert_done(result)
        self.assertEqual(["^0=MR1<TAB>x<TAB>{ho2}<CR>"], result.json()["frames"])

    def test_the_longest_record(self):
        text = "x" * 2000
        file = self.write_csv([[text]])
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer))
        self.assert_printed([(1, text)], printer)

    def test_255_fields(self):
        fields = [f"f{k}" for k in range(255)]
        file = self.write_csv([fields], header=fields)
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer))
        self.assert_printed([(1, "\t".join(fields))], printer)

    def test_an_empty_field(self):
        file = self.write_csv([["a", "", "c"], ["", "b", ""]], header=("x", "y", "z"))
        printer = self.simulator("--rate", 500)
        result = self.print(file, printer)
        self.assert_one_clear_line(0, result, "2 records", "placeholder")
        self.assert_printed([(1, "a\t\tc"), (2, "\tb\t")], printer)

    def test_skip_bad_prints_the_rest_without_gaps(self):
        file = self.write_bytes(b"name\nAnna\nBe\xffrta\nClara\nD\x01ora\nEva\n")
        printer = self.simulator("--rate", 500)
        result = self.print(file, printer, "--skip-bad")
        self.assert_code(0, result)
        self.assertIn("line 3", result.err)
        self.assertIn("line 5", result.err)
        self.assertIn("left out 2 bad rows of 5", result.err)
        self.assert_printed([(1, "Anna"), (2, "Clara"), (3, "Eva")], printer)


class Output(harness.TestCase):
    def test_json_report(self):
        records = names(100)
        file = self.write_csv(rows(records))
        printer = self.simulator("--rate", 500)
        result = self.print(file, printer, "--from", 11, "-o", "json")
        self.assert_done(result)
        report = result.json()
        self.assertEqual("finished", report["result"])
        self.assertEqual(0, report["exit_code"])
        self.assertEqual({"first": 1, "last": 100}, report["records"])
        self.assertEqual({"first": 11, "last": 100}, report["wanted"])
        self.assertEqual((90, 100, 0), (report["printed"], report["last_printed"], report["in_doubt"]))
        self.assertIsNone(report["next"])
        self.assertEqual(str(file), report["file"])

    def test_json_of_a_refused_file(self):
        file = self.write_bytes(b"name\nAnna\nBe\xffrta\n")
        result = self.print(file, None, "--dry-run", "-o", "json")
        self.assert_code(5, result)
        report = result.json()
        self.assertEqual(("input_rejected", 5), (report["result"], report["exit_code"]))
        self.assertEqual((2, 1), (report["import"]["rows"], report["import"]["bad_rows"]))
        self.assertEqual(3, report["import"]["reported"][0]["line"])

    def test_json_of_a_failure(self):
        result = self.print(self.write_csv([["x"]]), "tcp://127.0.0.1:1", "-o", "json")
        self.assert_code(3, result)
        self.assertEqual(3, result.json()["exit_code"])

    def test_a_dry_run_shows_the_frames_and_sends_nothing(self):
        records = names(1000)
        printer = self.simulator("--rate", 500)
        result = self.print(self.write_csv(rows(records)), printer, "--dry-run", "--from", 10)
        self.assert_done(result)
        self.assertEqual("^0=MR10<TAB>M<FC>ller 000010<CR>", result.out.splitlines()[0])
        self.assertIn("dry run: 991 records (10-1000) can be printed; nothing was sent", result.out)
        self.assertFalse(self.spool.exists(), "a dry run leaves no job behind")
        self.assertEqual([], printer.prints())
        self.assertEqual(0, printer.stop()["connections"])

    def test_a_dry_run_tells_what_the_spool_knows(self):
        file = self.write_csv(rows(names(60)))
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(file, printer, "--to", 20))
        before = self.spool.read_bytes()
        part = self.print(file, None, "--dry-run", "--from", 11, "--to", 30)
        self.assert_done(part)
        self.assertIn("dry run: 20 records (11-30) can be printed; nothing was sent\n"
                      "job 1: 10 of them are printed; a run would begin with record 21\n", part.out)
        whole = self.print(file, None, "--dry-run", "-o", "json").json()
        self.assertEqual((60, 1, 20, 0, 21), tuple(whole[key] for key in ("records", "job", "printed", "in_doubt", "next")))
        self.assertIsNone(self.print(file, None, "--dry-run", "--new-job", "-o", "json").json()["job"])
        self.assertTrue(before == self.spool.read_bytes(), "nothing has changed")

    def test_progress_on_a_terminal(self):
        records = names(400)
        printer = self.simulator("--rate", 400)
        terminal, stderr = os.openpty()
        self.addCleanup(os.close, terminal)
        process = subprocess.Popen(self.command(self.write_csv(rows(records)), printer), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=stderr)
        os.close(stderr)
        shown = b""
        try:
            while data := os.read(terminal, 4096):
                shown += data
        except OSError:
            pass  # the other end is closed: the program has ended
        self.assertEqual(0, process.wait())
        self.assertRegex(shown.decode(), r"\r\x1b\[K\[#+-*\] printing +\d+\.\d %  record \d+ of 400  \d+/s  \d+ s left")
        self.assertTrue(shown.endswith(b"\r\x1b[K"), "the bar is gone at the end")
        self.assert_printed(records, printer)

    def test_version_and_help(self):
        for option, words in (("--version", "linefeed 0."), ("--help", "print")):
            result = harness.Job([str(harness.BIN / "linefeed"), option]).wait()
            self.assert_done(result)
            self.assertIn(words, result.out)


if __name__ == "__main__":
    harness.main()
