"""Reads every #include and every linefeed_library() of src/ and lists what contradicts the design.

check(src, rules) returns one line per violation, each beginning with the file; an empty list means the sources follow the design.
"""

import pathlib
import re

SOURCE_SUFFIXES = {".cpp", ".hpp", ".h", ".cc", ".ipp"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"\n]+)"|<([^>\n]+)>)', re.MULTILINE)
COMMENT_OR_STRING = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def without_comments(text, keep_strings):
    """The code with comments blanked, and string literals too unless kept. Lines stay where they are."""
    def blank(match):
        found = match.group(0)
        if keep_strings and not found.startswith("/"):
            return found
        return "\n" * found.count("\n") or " "
    return COMMENT_OR_STRING.sub(blank, text)


def includes_of(text):
    """([names in quotes], [names in angle brackets])"""
    found = INCLUDE.findall(without_comments(text, keep_strings=True))
    return [quoted for quoted, _ in found if quoted], [angled for _, angled in found if angled]


def is_pure(path, rules):
    return path.parts[0] in rules.PURE_FOLDERS and path.stem not in rules.EDGES.get(path.parts[0], set())


def check_quoted(path, name, src, rules):
    """What is wrong with #include "name" in src/path."""
    if not (src / name).is_file():
        return [f'{path}: "{name}" is not a file of src/ (write "folder/file.hpp")']
    target = pathlib.PurePosixPath(name)
    folder, other = path.parts[0], target.parts[0]
    problems = []
    if other != folder and other not in rules.MAY_USE[folder]:
        problems.append(f'{path}: {folder} must not use {other} ("{name}")')
    only = rules.ONLY_HEADERS.get(folder, {}).get(other)
    if only is not None and target.name not in only:
        problems.append(f'{path}: of {other}, {folder} may use only {", ".join(sorted(only))}, not "{name}"')
    if is_pure(path, rules) and other in rules.PURE_FOLDERS and target.stem in rules.EDGES.get(other, set()) - {"assert"}:
        problems.append(f'{path}: pure code must not use "{name}", which touches the outside world')
    return problems


def check_angled(path, name, rules):
    problems = []
    if is_pure(path, rules) and any(re.fullmatch(pattern, name) for pattern in rules.IMPURE_HEADERS):
        problems.append(f"{path}: pure code must not include <{name}>")
    for pattern, folders in rules.LIBRARY_FOLDERS.items():
        if re.fullmatch(pattern, name) and path.parts[0] not in folders:
            problems.append(f"{path}: <{name}> belongs in {', '.join(sorted(folders))} only")
    return problems


def check_code(path, text, rules):
    if not is_pure(path, rules):
        return []
    code = without_comments(text, keep_strings=False)
    problems = []
    for pattern, what in rules.IMPURE_CODE.items():
        match = re.search(pattern, code)
        if match:
            line = code.count("\n", 0, match.start()) + 1
            problems.append(f"{path}:{line}: pure code {what}: {match.group(0).strip()}")
    return problems


def find_cycle(graph):
    """One cycle of a directed graph {node: iterable of nodes}, as a list of nodes, or None."""
    state = {}
    for start in sorted(graph):
        stack = [(start, iter(sorted(graph.get(start, ()))))]
        if state.get(start):
            continue
        state[start] = "open"
        while stack:
            node, rest = stack[-1]
            following = next(rest, None)
            if following is None:
                state[node] = "done"
                stack.pop()
            elif state.get(following) == "open":
                names = [entry for entry, _ in stack]
                return names[names.index(following):] + [following]
            elif following not in state:
                state[following] = "open"
                stack.append((following, iter(sorted(graph.get(following, ())))))
    return None


def cmake_libraries(text):
    """{name: (sources, depends)} of the linefeed_library() calls."""
    libraries = {}
    text = re.sub(r"#[^\n]*", "", text)
    for call in re.finditer(r"linefeed_library\s*\(([^)]*)\)", text):
        words = call.group(1).split()
        lists, current = {"SOURCES": [], "DEPENDS": [], "LINKS": []}, None
        for word in words[1:]:
            if word in lists:
                current = word
            elif current:
                lists[current].append(word)
        libraries[words[0]] = (lists["SOURCES"], lists["DEPENDS"])
    return libraries


def check_cmake(folder, src, used, rules):
    """The library of a folder: named like it, complete, and with the DEPENDS that its includes need and the design allows."""
    file = src / folder / "CMakeLists.txt"
    path = pathlib.PurePosixPath(folder) / "CMakeLists.txt"
    if not file.is_file():
        return [f"{path}: missing"], set()
    text = file.read_text(encoding="utf-8")
    libraries = cmake_libraries(text)
    if folder not in libraries:
        return [f"{path}: no linefeed_library({folder} …)"], set()
    _, depends = libraries[folder]
    problems = []
    for other in depends:
        if other not in rules.MAY_USE[folder]:
            problems.append(f"{path}: {folder} must not depend on {other}")
    for other in sorted(used - set(depends)):
        problems.append(f"{path}: {folder} includes {other}, but DEPENDS does not name it")
    for source in sorted((src / folder).glob("*.cpp")):
        if not re.search(rf"(?<![\w-]){re.escape(source.name)}(?![\w-])", text):
            problems.append(f"{path}: {source.name} is not built")
    return problems, set(depends)


def check(src, rules):
    src = pathlib.Path(src)
    problems = []
    folders = sorted(entry.name for entry in src.iterdir() if entry.is_dir())
    for folder in folders:
        if folder not in rules.MAY_USE:
            problems.append(f"{folder}: the design has no such folder; add it to tests/architecture/design_rules.py")
    cycle = find_cycle(rules.MAY_USE)
    if cycle:
        problems.append("design_rules.py: the design itself goes in a circle: " + " -> ".join(cycle))

    used = {folder: set() for folder in folders}
    files = {}
    for file in sorted(src.rglob("*")):
        path = pathlib.PurePosixPath(file.relative_to(src).as_posix())
        if file.suffix not in SOURCE_SUFFIXES or path.parts[0] not in rules.MAY_USE:
            continue
        text = file.read_text(encoding="utf-8")
        quoted, angled = includes_of(text)
        files[str(path)] = quoted
        used[path.parts[0]].update(name.split("/")[0] for name in quoted if "/" in name)
        for name in quoted:
            problems += check_quoted(path, name, src, rules)
        for name in angled:
            problems += check_angled(path, name, rules)
        problems += check_code(path, text, rules)
        if file.suffix in {".hpp", ".h"} and "#pragma once" not in text:
            problems.append(f"{path}: no #pragma once")

    cycle = find_cycle(files)
    if cycle:
        problems.append("includes go in a circle: " + " -> ".join(cycle))
    depends = {}
    for folder in folders:
        if folder in rules.MAY_USE:
            found, depends[folder] = check_cmake(folder, src, used[folder] - {folder}, rules)
            problems += found
    cycle = find_cycle(depends)
    if cycle:
        problems.append("DEPENDS goes in a circle: " + " -> ".join(cycle))
    return problems
