"""Printers that deviate from the manual (firmware habits) get every record exactly once, too."""

import harness
from harness import names, rows


class Habits(harness.TestCase):
    def run_with(self, *options, blank_at_the_end=False):
        records = names(600)
        printer = self.simulator("--rate", 300, *options)
        result = self.print(self.write_csv(rows(records)), printer)
        self.assert_code(0, result)
        printed = printer.prints()
        if blank_at_the_end:
            # The next product may come out with the blank end marker on it: nothing that can be taken for a record.
            self.assertLessEqual(len(printed), len(records) + 1)
            self.assertEqual([(601, " ")][:len(printed) - len(records)], [(n, t or " ") for n, t in printed[len(records):]])
            printed = printed[:len(records)]
        self.judge(records, printed)
        again = self.print(self.directory / "names.csv", printer)
        self.assert_code(0, again)
        summary = printer.stop()
        self.assert_clean(summary)
        return summary, result

    def test_stop_point_ignored(self):
        _, result = self.run_with("--habit", "ignore-stop-at", blank_at_the_end=True)
        self.assertIn("stop point", result.err)

    def test_stop_point_kept_only_while_printing(self):
        self.run_with("--habit", "stop-at-only-while-printing")

    def test_stale_mail_status(self):
        self.run_with("--habit", "stale-mail-status")

    def test_sixth_value(self):
        self.run_with("--habit", "sixth-value")

    def test_five_value_status_and_error_bit_24(self):
        self.run_with("--habit", "five-value-status", "--habit", "error-bit-24")

    def test_no_total_counter(self):
        self.run_with("--habit", "no-total-counter")

    def test_cr_lf(self):
        self.run_with("--habit", "crlf")

    def test_lf_cr(self):
        self.run_with("--habit", "lfcr")

    def test_length_prefixes_left_on(self):
        self.run_with("--length-prefix")

    def test_echo_left_on(self):
        self.run_with("--echo")

    def test_length_prefixes_and_echo_left_on(self):
        self.run_with("--length-prefix", "--echo", "--habit", "crlf")

    def test_blocks_left_on(self):
        self.run_with("--block-length", 64)

    def test_a_printer_without_escapes(self):
        self.run_with("--profile", "jet3")

    def test_the_printer_says_what_it_is(self):
        file = self.write_csv([["a^b"], ["a\\b"]])
        old = self.simulator("--profile", "jet3")
        refused = self.print(file, old, "--profile", "auto")
        self.assert_code(5, refused)
        self.assertIn("without escapes", refused.out + refused.err)
        self.assertEqual([], old.prints())
        new = self.simulator("--profile", "jet2neo", "--habit", "ignore-stop-at=off", "--rate", 300)
        self.assert_code(0, self.print(file, new, "--profile", "auto"))
        self.assertEqual([(1, "a^b"), (2, "a\\b")], new.prints())

    def test_several_habits_at_once(self):
        self.run_with("--habit", "stale-mail-status", "--habit", "stop-at-only-while-printing", "--habit", "sixth-value",
                      "--habit", "lfcr", "--echo", "--reply-delay", 20)


if __name__ == "__main__":
    harness.main()
