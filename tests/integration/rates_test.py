"""The line at its rates: no double, no gap, no underrun, the FIFO never over its depth, whatever the printer's answers take."""

import harness
from harness import LONG, names, rows

SLICE_S = 60 if LONG else 5


class LineTest(harness.TestCase):
    def run_line(self, rate, seconds, *simulator_options, depth=256):
        records = names(int(rate * seconds))
        printer = self.simulator("--rate", rate, "--depth", depth, *simulator_options)
        result = self.print(self.write_csv(rows(records)), printer, patience_s=seconds + harness.PATIENCE_S)
        summary = printer.stop()
        self.assert_code(0, result)
        self.assert_printed(records, printer)
        self.assert_clean(summary, depth)
        print(f"\n  {rate}/s for {seconds} s, depth {depth} {' '.join(map(str, simulator_options))}: smallest lead time "
              f"{summary['smallest_lead_ms']:.1f} ms, fill at a PrintGo {summary['lowest_fill']}, highest {summary['highest_fill']}, "
              f"platform stalls {summary['platform_stalls']} (longest {summary['longest_stall_ms']:.1f} ms)", flush=True)
        self.assertGreaterEqual(summary["smallest_lead_ms"], 3)
        return summary


class Rates(LineTest):
    def test_50_a_second(self):
        self.run_line(50, SLICE_S)

    def test_500_a_second(self):
        self.run_line(500, SLICE_S)

    def test_1000_a_second(self):
        self.run_line(1000, SLICE_S)

    def test_500_a_second_with_jitter(self):
        self.run_line(500, SLICE_S, "--jitter", 45)


class ReplyDelays(LineTest):
    def test_1_ms(self):
        self.run_line(1000, 3, "--reply-delay", 1)

    def test_20_ms(self):
        self.run_line(500, 3, "--reply-delay", 20)

    def test_100_ms(self):
        self.run_line(300, 3, "--reply-delay", 100)


class Depths(LineTest):
    def test_depth_3(self):
        self.run_line(10, 4, depth=3)

    def test_depth_16(self):
        self.run_line(50, 4, depth=16)

    def test_depth_16_with_slow_answers(self):
        self.run_line(40, 4, "--reply-delay", 20, depth=16)


if __name__ == "__main__":
    harness.main()
