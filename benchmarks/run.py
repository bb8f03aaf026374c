#!/usr/bin/env python3
"""Runs the benchmarks of this directory, one after the other, and prints their tables.

usage: benchmarks/run.py [--quick] [--bin DIR] [--json FILE] [--list] [NAME…]

--quick is a slice for CI: short runs, and the exit code is 1 if a check fails, also when the benchmark is run once more: a shared machine has
bad moments. Checks are ratios and counts within one run, never absolute times. Without --quick checks are only told. The programs are taken from --bin, LINEFEED_BIN_DIR or build/release/bin; build with
LINEFEED_TESTS=ON, on a machine that does nothing else.

A benchmark is a file `bench_<name>.py` or `<name>_benchmark.py` here with
    NAME = "name"          # what it is called on the command line and in the JSON
    DESCRIPTION = "…"      # one line
    def run(quick): …      # -> dict
The dict has "table": lines to print; "checks": [{"check": "what must hold", "ok": True}, …], which may be absent; and whatever else belongs
into the JSON. Programs are found through LINEFEED_BIN_DIR (benchlib.BIN). A file without NAME and run is passed over. A benchmark
that has no slice for CI gives {"table": []} when quick. What it cannot do it says by raising an exception: the others still run.
"""
import argparse
import importlib.util
import json
import os
import pathlib
import platform
import signal
import sys
import time
import traceback

HERE = pathlib.Path(__file__).resolve().parent


def load_benchmarks():
    """The modules by name."""
    sys.path.insert(0, str(HERE))
    found = {}
    for path in sorted([*HERE.glob("bench_*.py"), *HERE.glob("*_benchmark.py")]):
        spec = importlib.util.spec_from_file_location(path.stem, path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        if hasattr(module, "NAME") and hasattr(module, "run"):
            found[module.NAME] = module
    return found


def run_once(module, quick):
    try:
        return module.run(quick)
    except Exception as error:  # the other benchmarks still run
        traceback.print_exc()
        return {"table": [], "checks": [{"check": f"it runs: {error}", "ok": False}]}


def run_one(module, quick):
    started = time.monotonic()
    result = run_once(module, quick)
    failed = [check["check"] for check in result.get("checks", []) if not check["ok"]]
    if quick and failed:
        print(f"once more, since this does not hold: {'; '.join(failed)}", flush=True)
        result = run_once(module, quick)
    result["seconds"] = time.monotonic() - started
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--bin", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME")
    arguments = parser.parse_args()
    if arguments.bin:
        os.environ["LINEFEED_BIN_DIR"] = str(arguments.bin.resolve())
    benchmarks = load_benchmarks()
    if arguments.list:
        for name, module in benchmarks.items():
            print(f"{name:16} {module.DESCRIPTION}")
        return 0
    for name in arguments.names:
        if name not in benchmarks:
            parser.error(f"there is no benchmark {name}; there are {', '.join(benchmarks)}")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that the processes of the benchmark end with it
    results = {}
    failed = 0
    for name in arguments.names or benchmarks:
        print(f"\n=== {name}: {benchmarks[name].DESCRIPTION}", flush=True)
        results[name] = run_one(benchmarks[name], arguments.quick)
        for line in results[name]["table"]:
            print(line)
        for check in results[name].get("checks", []):
            failed += not check["ok"]
            print(f"{'holds' if check['ok'] else 'DOES NOT HOLD'}: {check['check']}")
        print(f"({results[name]['seconds']:.0f} s; load average at the end {os.getloadavg()[0]:.1f})", flush=True)
    if arguments.json:
        machine = {"system": platform.platform(), "processors": os.cpu_count(), "time": time.strftime("%Y-%m-%dT%H:%M:%S%z")}
        arguments.json.write_text(json.dumps({"machine": machine, "quick": arguments.quick, "benchmarks": results}, indent=1) + "\n",
                                  encoding="utf-8")
    return 1 if arguments.quick and failed else 0


if __name__ == "__main__":
    sys.exit(main())
