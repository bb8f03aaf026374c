"""The direction of the design as data: which folder of src/ may use which, and where outside libraries may appear.

The checker (include_checker.py) reads these tables only, so a change of the design is a change of this file.
"""

# Folder of src/ -> folders it may include, besides itself.
MAY_USE = {
    "base": set(),
    "protocol": {"base"},
    "feeder": {"base", "protocol"},
    "session": {"base", "protocol", "feeder"},
    "link": {"base", "session"},
    "spool": {"base"},
    "store": {"base", "protocol", "feeder", "session", "spool"},
    "intake": {"base", "protocol", "spool"},
    "simulator": {"base", "protocol"},
    "config": {"base", "protocol", "feeder", "link"},
    "printer": {"base", "protocol", "link"},
    "daemon": {"base", "protocol", "feeder", "session", "link", "printer", "spool", "store", "intake", "config"},
    "api": {"base", "protocol", "link", "printer", "spool", "config", "daemon"},
    "service": {"base", "protocol", "feeder", "session", "link", "printer", "spool", "store", "intake", "config", "daemon"},
    "cli": {"base", "protocol", "feeder", "session", "link", "printer", "spool", "store", "intake", "config", "daemon"},
    "client": {"base", "protocol", "link", "printer", "spool", "intake", "config", "daemon", "api", "cli"},
    "linefeed": {"base", "protocol", "printer", "intake", "daemon", "cli", "client"},
    "linefeedd": {"base", "spool", "config", "daemon", "service", "api", "cli"},
}

# Folder -> folder -> the only headers of the second that the first may include: the feeder knows the message types, never bytes.
ONLY_HEADERS = {
    "feeder": {"protocol": {"commands.hpp", "messages.hpp", "printer_error.hpp"}},
}

# Files that touch the outside world within a folder that is otherwise pure, by name without extension.
EDGES = {
    "base": {"asio", "assert"},
    "simulator": {"client_session", "fleet", "hiccup_watch", "serial_line", "server", "simulator", "simulator_faults", "steady_instant", "sim_options", "sim_settings", "tape", "linefeed_sim_main"},
}

# No I/O, no clock, no random numbers, no thread: facts and time come in, what to do goes out.
PURE_FOLDERS = {"base", "protocol", "feeder", "session", "simulator"}

# Headers that no pure file may include, as regular expressions over the name between < and >.
IMPURE_HEADERS = [
    r"sqlite3(ext)?\.h",
    r"boost/(asio|beast|lockfree|thread)(/.*|\.hpp)?",
    r"thread|stop_token|mutex|shared_mutex|condition_variable|future|semaphore|latch|barrier|atomic",
    r"random|ctime|time\.h|csignal|signal\.h|pthread\.h",
    r"filesystem|fstream|iostream|syncstream",
    r"sys/.*|netinet/.*|arpa/.*|linux/.*|unistd\.h|fcntl\.h|poll\.h|termios\.h|netdb\.h",
]

# The same for what is written in the code (comments and string literals are taken out first).
IMPURE_CODE = {
    r"\b\w*[cC]lock\w*\s*::\s*now\s*\(": "reads a clock",
    r"::\s*now\s*\(": "reads a clock",
    r"\b(clock_gettime|gettimeofday|nanosleep|usleep)\s*\(": "reads a clock or sleeps",
    r"\bstd\s*::\s*(time|clock|rand|srand)\s*\(": "reads a clock or draws a random number",
    r"\bthis_thread\b": "knows of threads",
    r"\brandom_device\b|\bmt19937": "draws random numbers",
    r"\b(socket|connect|recv|send)\s*\(\s*AF_": "opens a socket",
    r"\bstd\s*::\s*(cout|cerr|clog|cin)\b": "writes to a terminal",
    r"\b(getenv|fopen)\s*\(": "reads its surroundings",
}

# Outside library -> the only folders that may include it.
LIBRARY_FOLDERS = {
    r"sqlite3(ext)?\.h": {"spool", "intake"},
    r"boost/(asio|beast)(/.*|\.hpp)?": {"base", "link", "printer", "simulator", "daemon", "api"},
    r"prometheus/.*": {"api"},
    r"CLI/.*": {"linefeed", "linefeedd", "simulator"},
    r"openssl/.*": {"spool", "printer", "api"},
    r"png\.h": {"printer", "intake"},
    r"yaml-cpp/.*": {"config"},
    r"spdlog/.*|systemd/.*": {"daemon"},
    r"nlohmann/.*": {"spool", "store", "simulator", "printer", "config", "daemon", "api", "cli", "client"},
}
