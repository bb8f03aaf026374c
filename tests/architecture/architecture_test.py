"""The direction of the design holds in src/, and the checker that says so does find violations.

usage: architecture_test.py SRC [unittest arguments]
"""

import pathlib
import sys
import tempfile
import types
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import design_rules  # noqa: E402
import include_checker  # noqa: E402

SRC = pathlib.Path(__file__).resolve().parents[2] / "src"


class Design(unittest.TestCase):
    def test_every_include_follows_the_direction_of_the_design(self):
        self.assertEqual([], include_checker.check(SRC, design_rules))

    def test_the_whole_tree_was_read(self):
        folders = {entry.name for entry in SRC.iterdir() if entry.is_dir()}
        self.assertEqual(set(), set(design_rules.MAY_USE) - folders, "folders of the design that src/ does not have")
        self.assertTrue(all(any((SRC / folder).glob("*.hpp")) for folder in folders))


class Checker(unittest.TestCase):
    """Each test plants one violation in a small tree that is right otherwise."""

    TREE = {
        "base/number.hpp": "#pragma once\n#include <cstdint>\n",
        "base/number.cpp": '#include "base/number.hpp"\n',
        "base/CMakeLists.txt": "linefeed_library(base SOURCES number.cpp)\n",
        "protocol/messages.hpp": '#pragma once\n#include "base/number.hpp"\n',
        "protocol/frame.hpp": "#pragma once\n",
        "protocol/messages.cpp": '#include "protocol/messages.hpp"\n',
        "protocol/CMakeLists.txt": "linefeed_library(protocol SOURCES messages.cpp DEPENDS base LINKS ZLIB::ZLIB)\n",
        "feeder/feeder.hpp": '#pragma once\n#include "protocol/messages.hpp"\n// #include "link/tcp.hpp"\n',
        "feeder/feeder.cpp": '#include "feeder/feeder.hpp"\nconst char* const text = "steady_clock::now()"; // ::now() is for others\n',
        "feeder/CMakeLists.txt": "linefeed_library(feeder SOURCES feeder.cpp DEPENDS protocol)\n",
        "link/tcp.hpp": "#pragma once\n#include <boost/asio/ip/tcp.hpp>\n",
        "link/tcp.cpp": '#include "link/tcp.hpp"\nauto now() { return std::chrono::steady_clock::now(); }\n',
        "link/CMakeLists.txt": "linefeed_library(link SOURCES tcp.cpp LINKS linefeed::asio)\n",
        "simulator/tape.hpp": "#pragma once\n#include <thread>\n",
        "simulator/printer_model.hpp": "#pragma once\n",
        "simulator/CMakeLists.txt": "linefeed_library(simulator SOURCES printer_model.cpp)\n",
        "simulator/printer_model.cpp": '#include "simulator/printer_model.hpp"\n',
    }

    def problems(self, changes, rules=design_rules):
        with tempfile.TemporaryDirectory() as directory:
            for name, text in {**self.TREE, **changes}.items():
                path = pathlib.Path(directory) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return include_checker.check(directory, rules)

    def assert_found(self, changes, words, rules=design_rules):
        found = self.problems(changes, rules)
        self.assertTrue(any(words in problem for problem in found), f"nothing about {words!r} in {found}")

    def test_should_accept_a_tree_that_follows_the_design(self):
        self.assertEqual([], self.problems({}))

    def test_should_find_an_include_against_the_direction(self):
        self.assert_found({"base/number.cpp": '#include "protocol/messages.hpp"\n'}, "base must not use protocol")
        self.assert_found({"feeder/feeder.cpp": '#  include "link/tcp.hpp"\n'}, "feeder must not use link")

    def test_should_find_a_folder_that_the_design_does_not_have(self):
        self.assert_found({"helpers/misc.hpp": "#pragma once\n"}, "helpers: the design has no such folder")

    def test_should_find_an_include_of_a_missing_or_relative_file(self):
        self.assert_found({"base/number.cpp": '#include "number.hpp"\n'}, "is not a file of src/")
        self.assert_found({"base/number.cpp": '#include "../link/tcp.hpp"\n'}, "is not a file of src/")

    def test_should_find_bytes_in_the_feeder(self):
        self.assert_found({"feeder/feeder.cpp": '#include "protocol/frame.hpp"\n'}, "feeder may use only")

    def test_should_find_outside_headers_in_pure_code(self):
        for header in ("sqlite3.h", "boost/asio.hpp", "boost/asio/buffer.hpp", "thread", "random", "sys/socket.h", "unistd.h", "mutex"):
            self.assert_found({"feeder/feeder.cpp": f"#include <{header}>\n"}, f"pure code must not include <{header}>")
            self.assert_found({"simulator/printer_model.cpp": f"#include <{header}>\n"}, f"pure code must not include <{header}>")

    def test_should_find_a_clock_in_pure_code(self):
        self.assert_found({"feeder/feeder.cpp": "\nauto t = std::chrono::steady_clock::now();\n"}, "feeder.cpp:2: pure code reads a clock")
        self.assert_found({"feeder/feeder.cpp": "using Clock = std::chrono::system_clock;\nauto t = Clock::now ();\n"}, "reads a clock")
        self.assert_found({"simulator/printer_model.cpp": "auto t = std::time(nullptr);\n"}, "reads a clock")

    def test_should_find_pure_code_that_uses_an_edge(self):
        self.assert_found({"simulator/printer_model.cpp": '#include "simulator/tape.hpp"\n'}, 'must not use "simulator/tape.hpp"')

    def test_should_find_a_library_outside_its_folder(self):
        self.assert_found({"link/tcp.cpp": "#include <sqlite3.h>\n"}, "<sqlite3.h> belongs in intake, spool only")

    def test_should_find_includes_in_a_circle(self):
        self.assert_found({"base/number.hpp": '#pragma once\n#include "base/other.hpp"\n',
                           "base/other.hpp": '#pragma once\n#include "base/number.hpp"\n'}, "includes go in a circle")

    def test_should_find_a_design_in_a_circle(self):
        rules = types.SimpleNamespace(**{name: getattr(design_rules, name) for name in dir(design_rules) if name.isupper()})
        rules.MAY_USE = {**design_rules.MAY_USE, "base": {"link"}}
        self.assert_found({}, "the design itself goes in a circle", rules)

    def test_should_find_depends_that_disagree(self):
        self.assert_found({"protocol/CMakeLists.txt": "linefeed_library(protocol SOURCES messages.cpp)\n"},
                          "protocol includes base, but DEPENDS does not name it")
        self.assert_found({"base/CMakeLists.txt": "linefeed_library(base SOURCES number.cpp DEPENDS link)\n"},
                          "base must not depend on link")
        self.assert_found({"base/CMakeLists.txt": "add_library(base number.cpp)\n"}, "no linefeed_library(base")

    def test_should_find_a_source_that_is_not_built(self):
        self.assert_found({"base/forgotten.cpp": ""}, "forgotten.cpp is not built")

    def test_should_find_a_header_without_a_guard(self):
        self.assert_found({"base/number.hpp": "#include <cstdint>\n"}, "no #pragma once")


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        SRC = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
