"""Bad input, one by one: one clear line, the right exit code, and nothing lost. Each test stands between two halves of a good print,
which has to come out whole."""

import os
import socket
import sqlite3
import threading

import harness
from harness import names, rows


class BadInput(harness.TestCase):
    GOOD = names(20)

    def setUp(self):
        super().setUp()
        self.good_file = self.write_csv(rows(self.GOOD), name="good.csv")
        self.good_printer = self.simulator("--rate", 500)
        self.assert_done(self.print(self.good_file, self.good_printer, "--to", 10))

    def tearDown(self):
        self.assert_done(self.print(self.good_file, self.good_printer))
        self.assert_printed(self.GOOD, self.good_printer)
        verified = harness.Job([str(harness.BIN / "linefeed"), "ledger", "1", "--verify", "--spool", str(self.spool)]).wait()
        self.assert_code(0, verified)
        super().tearDown()

    def refuse(self, file, code, *words, options=(), printer=None):
        """linefeed refuses, with one clear line, and prints nothing."""
        before = self.good_printer.prints()
        result = self.print(file, printer or self.good_printer, *options)
        self.assert_one_clear_line(code, result, *words)
        self.assertEqual(before, self.good_printer.prints())
        return result


class BadFiles(BadInput):
    def test_missing_file(self):
        self.refuse(self.directory / "missing.csv", 5, "missing.csv")

    def test_directory(self):
        self.refuse(self.directory, 5, "directory")

    def test_empty_file(self):
        self.refuse(self.write_bytes(b""), 5, "empty")

    def test_byte_order_mark_only(self):
        self.refuse(self.write_bytes(b"\xef\xbb\xbf"), 5)

    def test_header_only(self):
        self.refuse(self.write_bytes(b"name,code\n"), 5)

    def test_blank_lines_only(self):
        self.refuse(self.write_bytes(b"\n\n\n"), 5)

    def test_utf_16(self):
        self.refuse(self.write_bytes("name\nAnna\n".encode("utf-16")), 5)

    def test_unreadable_file(self):
        file = self.write_csv([["x"]])
        file.chmod(0)
        if os.access(file, os.R_OK):
            self.skipTest("this user may read everything")
        self.refuse(file, 5)

    def test_fifo(self):
        path = self.directory / "pipe"
        os.mkfifo(path)
        self.refuse(path, 5, "pipe")

    def test_quote_that_never_closes(self):
        self.refuse(self.write_bytes(b'name\n"Anna\nBerta\n'), 5)

    def test_ragged_row(self):
        self.refuse(self.write_bytes(b"name,code\nAnna,1\nBerta\nClara,3\n"), 5, "line 3")


class BadFields(BadInput):
    def refuse_field(self, field, *words, code=5, options=()):
        """A field, quoted, on line 3 of a CSV file."""
        content = b'name,code\nAnna,1\n"' + field + b'",2\n'
        return self.refuse(self.write_bytes(content), code, "line 3", "name", *words, options=options)

    def test_invalid_utf_8(self):
        self.refuse_field(b"M\xfcller", "UTF-8")

    def test_3000_bytes(self):
        content = b"name\nAnna\n" + b"x" * 3000 + b"\n"
        self.refuse(self.write_bytes(content), 5, "line 3", "2048")

    def test_tab(self):
        self.refuse_field(b"a\tb", "TAB")

    def test_cr(self):
        self.refuse_field(b"a\rb", "CR")

    def test_line_break(self):
        self.refuse_field(b"a\nb", "LF")

    def test_nul(self):
        self.refuse_field(b"a\0b", "NUL")

    def test_caret_and_backslash_without_escapes(self):
        for character in (b"^", b"\\"):
            self.refuse_field(b"a" + character + b"b", character.decode(), "jet3", options=("--profile", "jet3"))

    def test_caret_and_backslash_with_escapes(self):
        printer = self.simulator("--rate", 500)
        self.assert_done(self.print(self.write_csv([["a^b"], ["a\\b"]]), printer, "--profile", "jet3up"))
        self.assert_printed([(1, "a^b"), (2, "a\\b")], printer)

    def test_caret_and_backslash_by_what_the_printer_says(self):
        """Only records that need an escape are refused, and nothing is printed of them."""
        printer = self.simulator("--rate", 500, "--profile", "jet2neo-v71")
        result = self.print(self.write_csv([["fine"], ["a\\b"]]), printer)
        self.assert_one_clear_line(5, result, "knows no escapes", "escapes=on")
        self.assert_done(self.print(self.write_csv([["fine"]], name="fine.csv"), printer))
        self.assert_printed([(1, "fine")], printer)

    def test_outside_the_charset(self):
        self.refuse_field("Łódź".encode(), "U+0141")

    def test_outside_the_bmp(self):
        self.refuse_field("a😀".encode(), "U+1F600", options=("--encoding", "unicode-hex"))
        self.refuse_field("a😀".encode(), "U+1F600")

    def test_256_fields(self):
        fields = [f"f{k}" for k in range(256)]
        self.refuse(self.write_csv([fields], header=fields), 5, "256 fields", "255")

    def test_a_field_that_reads_as_properties(self):
        self.refuse(self.write_csv([["{o1}"]]), 5, "line 2")

    def test_many_bad_rows_are_all_named_and_then_counted(self):
        content = b"name\n" + b"good\nba\x01d\n" * 150
        result = self.print(self.write_bytes(content), self.good_printer)
        self.assert_code(5, result)
        lines = result.err.splitlines()
        self.assertEqual(102, len(lines), result.err)
        self.assertIn("line 3,", lines[0])
        self.assertIn("and 50 more bad rows", lines[100])
        self.assertIn("150 of 300 rows", lines[101])


class BadDatabases(BadInput):
    def setUp(self):
        super().setUp()
        self.database = self.directory / "names.db"
        with sqlite3.connect(self.database) as database:
            database.execute("CREATE TABLE names(name TEXT, code TEXT)")
            database.executemany("INSERT INTO names VALUES (?, 'c')", [(f"name {k}" * 20,) for k in range(2000)])
            database.execute("CREATE TABLE other(x)")
        database.close()

    def test_locked(self):
        holder = sqlite3.connect(self.database)
        self.addCleanup(holder.close)
        holder.execute("BEGIN EXCLUSIVE")
        self.refuse(self.database, 5, "names.db", "lock", options=("--table", "names"))

    def test_corrupt(self):
        content = bytearray(self.database.read_bytes())
        content[4096:] = b"\xa5" * (len(content) - 4096)
        self.database.write_bytes(content)
        self.refuse(self.database, 5, "names.db", options=("--table", "names"))

    def test_corrupt_in_the_middle(self):
        content = bytearray(self.database.read_bytes())
        middle = len(content) // 2 // 4096 * 4096
        content[middle:middle + 4096] = b"\xa5" * 4096
        self.database.write_bytes(content)
        self.refuse(self.database, 5, "names.db", options=("--table", "names"))

    def test_cut_short(self):
        content = self.database.read_bytes()
        self.database.write_bytes(content[:len(content) // 2])
        self.refuse(self.database, 5, "names.db", options=("--table", "names"))

    def test_wrong_table(self):
        self.refuse(self.database, 2, "nmaes", options=("--table", "nmaes"))

    def test_wrong_column(self):
        self.refuse(self.database, 2, "nmae", options=("--table", "names", "--columns", "nmae"))

    def test_wrong_column_of_a_csv_file(self):
        self.refuse(self.write_csv([["x"]]), 2, "nmae", options=("--columns", "nmae"))

    def test_no_table_said(self):
        self.refuse(self.database, 2, "--table", options=())

    def test_a_query_that_is_none(self):
        self.refuse(self.database, 2, options=("--query", "SELEKT name FROM names"))

    def test_a_query_that_writes(self):
        self.refuse(self.database, 2, options=("--query", "DELETE FROM names"))
        with sqlite3.connect(self.database) as database:
            self.assertEqual([(2000,)], database.execute("SELECT count(*) FROM names").fetchall())
        database.close()

    def test_a_table_without_rows(self):
        self.refuse(self.database, 5, options=("--table", "other"))

    def test_a_blob_and_a_null(self):
        with sqlite3.connect(self.database) as database:
            database.execute("INSERT INTO other VALUES (x'00ff')")
        database.close()
        self.refuse(self.database, 5, options=("--table", "other"))


class BadOptions(BadInput):
    def refuse_options(self, *options, words=()):
        self.refuse(self.good_file, 2, *words, options=options)

    def test_unknown_option(self):
        self.refuse_options("--form", "7", words=("--form",))

    def test_values_out_of_range(self):
        self.refuse_options("--from", "21", words=("--from 21", "1 to 20"))
        self.refuse_options("--from", "0")
        self.refuse_options("--from", "-1")
        self.refuse_options("--from", "x")
        self.refuse_options("--to", "4294967296")
        self.refuse_options("--from", "9", "--to", "8")
        self.refuse_options("--orientation", "45")
        self.refuse_options("--reply-timeout", "0")

    def test_names_that_do_not_exist(self):
        self.refuse_options("--profile", "jet9", words=("jet9", "jet3up"))
        self.refuse_options("--encoding", "utf-9", words=("utf-9", "windows-1252"))
        self.refuse_options("--encoding", "town=latin1", words=("town",))
        self.refuse_options("-o", "xml")
        self.refuse_options("--delimiter", "ab")

    def test_options_that_do_not_fit(self):
        self.refuse_options("--table", "names")
        self.refuse_options("--table", "a", "--query", "b", words=("--table", "--query"))
        self.refuse_options("--last-printed", "5", "--printed", "5", words=("--last-printed", "--printed"))
        self.refuse_options("--last-printed", "5", "--in-doubt", "skip", words=("--last-printed", "--in-doubt skip"))
        self.refuse_options("--printed", "none", "--in-doubt", "reprint", words=("--printed", "--in-doubt reprint"))

    def test_a_number_space_that_is_too_small(self):
        file = self.write_csv([["a"], ["b"], ["c"]])
        result = self.print(file, self.good_printer, "--base", 4294967293)
        self.assertIn(result.code, (2, 5), str(result))
        self.assertEqual(1, len(result.errors), str(result))

    def test_no_printer(self):
        self.assert_one_clear_line(2, self.print(self.good_file, None), "--printer")

    def test_an_address_that_is_none(self):
        for address in ("printer", "http://127.0.0.1:3000", "tcp://127.0.0.1:0", "tcp://127.0.0.1:99999"):
            self.assert_one_clear_line(2, self.print(self.good_file, address), "tcp://HOST:PORT")

    def test_a_spool_that_cannot_be_made(self):
        blocked = self.write_bytes(b"", name="blocked")
        self.assert_one_clear_line(1, self.print(self.good_file, self.good_printer, spool=blocked / "spool.db"), "blocked")

    def test_a_spool_that_is_something_else(self):
        other = self.write_bytes(b"these are the accounts of 1987\n" * 100, name="accounts.db")
        before = other.read_bytes()
        self.assert_one_clear_line(1, self.print(self.good_file, self.good_printer, spool=other), "accounts.db")
        self.assertEqual(before, other.read_bytes(), "a file that is not ours stays as it is")


class BadPrinters(BadInput):
    def listener(self, answer):
        """A host at a port of its own that calls answer(connection) for each connection."""
        server = socket.create_server(("127.0.0.1", 0))
        connections = []

        def serve():
            try:
                while True:
                    connection, _ = server.accept()
                    connections.append(connection)
                    answer(connection)
            except OSError:
                pass

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()

        def close():
            server.shutdown(socket.SHUT_RDWR)
            server.close()
            thread.join()
            for connection in connections:
                connection.close()

        self.addCleanup(close)
        return f"tcp://127.0.0.1:{server.getsockname()[1]}"

    def refuse_printer(self, code, printer, *words, options=()):
        result = self.refuse(self.good_file, code, *words, options=options, printer=printer)
        self.assertIn("continues with record 11", result.out, "the ledger is where it was")

    def test_refused_port(self):
        with socket.socket() as taken:  # and nobody listens there
            taken.bind(("127.0.0.1", 0))
            self.refuse_printer(3, f"tcp://127.0.0.1:{taken.getsockname()[1]}", "cannot be reached", "refused")

    def test_host_that_does_not_exist(self):
        self.assert_one_clear_line(3, self.print(self.good_file, "tcp://no-such-printer.invalid:3000"), "no-such-printer.invalid")

    def test_host_that_does_not_take_the_connection(self):
        server = socket.socket()
        self.addCleanup(server.close)
        server.bind(("127.0.0.1", 0))
        server.listen(0)
        for _ in range(4):
            filler = socket.socket()
            self.addCleanup(filler.close)
            filler.setblocking(False)
            filler.connect_ex(server.getsockname())
        self.refuse_printer(3, f"tcp://127.0.0.1:{server.getsockname()[1]}", "no connection within 300 ms",
                            options=("--connect-timeout", 300))

    def test_host_that_never_answers(self):
        self.refuse_printer(3, self.listener(lambda connection: None), "does not answer", options=("--reply-timeout", 300))

    def test_host_that_hangs_up(self):
        self.refuse_printer(3, self.listener(lambda connection: connection.close()), "connection")

    def test_host_that_speaks_something_else(self):
        def answer(connection):
            connection.sendall(b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")

        self.refuse_printer(3, self.listener(answer), options=("--reply-timeout", 300))

    def test_printer_in_standby(self):
        self.refuse_printer(4, self.simulator("--standby"), "standby", options=("--reply-timeout", 500))

    def test_printer_that_is_silent_in_standby(self):
        self.refuse_printer(3, self.simulator("--standby", "--habit", "standby-silent"), "does not answer",
                            options=("--reply-timeout", 300))

    def test_cover_open(self):
        self.refuse_printer(4, self.simulator("--cover-open"), "cover")

    def test_nozzle_closed(self):
        self.refuse_printer(4, self.simulator("--nozzle-closed"), "nozzle", "--open-nozzle")

    def test_nozzle_opened_when_told(self):
        printer = self.simulator("--nozzle-closed", "--nozzle-opening-ms", 500, "--rate", 500)
        file = self.write_csv(rows(names(30)))
        result = self.print(file, printer, "--open-nozzle")
        self.assert_done(result)
        self.assertIn("opening the nozzle", result.err)
        self.assert_printed(names(30), printer)

    def test_printer_that_somebody_else_feeds(self):
        busy = self.simulator("--rate", 20)
        other = names(200)
        job = self.start(self.write_csv(rows(other)), busy, spool=self.directory / "other" / "spool.db")
        busy.wait_for_prints(3)
        self.refuse_printer(4, busy, "printing")
        job.signal(harness.INTERRUPT)
        self.assert_code(4, job.wait())
        self.judge(other[:len(busy.prints())], busy.prints())


if __name__ == "__main__":
    harness.main()
