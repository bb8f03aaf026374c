#include "config/checks.hpp"

#include "config/names.hpp"

#include <algorithm>
#include <arpa/inet.h>

namespace linefeed::config {

namespace {

constexpr std::chrono::seconds shortest_watch_interval{1};

template <typename List>
struct CapacityOf;
template <typename T, std::size_t Capacity>
struct CapacityOf<BoundedList<T, Capacity>> {
    static constexpr std::size_t value = Capacity;
};

template <typename T>
std::vector<std::string> names(const std::vector<T>& elements) {
    std::vector<std::string> names;
    names.reserve(elements.size());
    for (const T& element : elements) {
        names.push_back(element.name);
    }
    return names;
}

/// A name that was read must be one of `known`.
void check_reference(const std::string& key, const std::string& name, std::string_view what,
                     const std::vector<std::string>& known, Context& context) {
    if (!context.was_read(key) || std::find(known.begin(), known.end(), name) != known.end()) {
        return;
    }
    const std::string meant = did_you_mean(name, known);
    context.refuse(key, "there is no " + std::string{what} + ' ' + in_quotes(name) +
                            (known.empty() ? "; none is configured"
                                           : (meant.empty() ? ";" : meant) + " there is: " + one_of(known)));
}

void check_printer(const PrinterSettings& printer, Context& context) {
    const std::string key = "printers." + printer.name;
    if (printer.pacing.poll_min > printer.pacing.poll_max) {
        const std::string set = context.was_read(key + ".poll_min") ? key + ".poll_min" : key + ".poll_max";
        context.refuse(set, "poll_min must not be longer than poll_max");
    }
    if (printer.watch_interval != Duration{0} && printer.watch_interval < shortest_watch_interval) {
        context.refuse(key + ".watch_interval", "must be 0 s (never), or 1 s at least");
    }
}

void check_layout(const LayoutSettings& layout, Context& context) {
    const std::string key = "layouts." + layout.name;
    if (layout.table && layout.query) {
        context.refuse(key + ".query", "table and query exclude each other");
    }
    if (layout.table || layout.query) {
        const std::string sqlite = layout.table ? "table" : "query";
        const auto refuse = [&](const std::string& csv) {
            context.refuse(join(key, csv),
                           "is for CSV files, " + sqlite + " for SQLite databases: they exclude each other");
        };
        if (layout.delimiter) {
            refuse("delimiter");
        }
        if (!layout.header) {
            refuse("header");
        }
    }
    if (layout.columns.empty()) {
        return;
    }
    for (const auto& [column, charset] : layout.column_encodings) {
        if (std::find(layout.columns.begin(), layout.columns.end(), column) == layout.columns.end()) {
            context.refuse(key + ".column_encodings", "column " + in_quotes(column) + " is not among columns");
        }
    }
    for (const std::string& column : layout.graphics) {
        if (std::find(layout.columns.begin(), layout.columns.end(), column) == layout.columns.end()) {
            context.refuse(key + ".graphics", "column " + in_quotes(column) + " is not among columns");
        }
    }
}

void check_addresses(const Settings& settings, Context& context) {
    for (auto printer = settings.printers.begin(); printer != settings.printers.end(); ++printer) {
        const std::string key = "printers." + printer->name + ".address";
        const auto same = std::find_if(settings.printers.begin(), printer,
                                       [&](const PrinterSettings& other) { return other.address == printer->address; });
        if (context.was_read(key) && same != printer) {
            context.refuse(key, "is the address of printer " + same->name + " already");
        }
    }
}

/// Whether `inner` is `outer` or lies in it.
bool lies_in(const std::filesystem::path& inner, const std::filesystem::path& outer) {
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

void check_folder_paths(const Settings& settings, Context& context) {
    for (auto folder = settings.folders.begin(); folder != settings.folders.end(); ++folder) {
        const std::string key = "folders." + folder->name + ".path";
        if (!context.was_read(key)) {
            continue;
        }
        for (auto other = settings.folders.begin(); other != folder; ++other) {
            if (context.was_read("folders." + other->name + ".path") &&
                (lies_in(folder->path, other->path) || lies_in(other->path, folder->path))) {
                context.refuse(key, folder->path == other->path ? "is the path of folder " + other->name + " already"
                                                                : "it and that of folder " + other->name +
                                                                      " lie in each other: keep them apart");
                break;
            }
        }
    }
}

/// A folder is emptied of all that fits its pattern: nothing that the service itself needs may lie there.
void check_own_files(const Settings& settings, Context& context) {
    const auto check = [&](const std::string& key, const std::filesystem::path& file) {
        for (const FolderSettings& folder : settings.folders) {
            const std::string path = "folders." + folder.name + ".path";
            if (context.was_read(path) && lies_in(file, folder.path)) {
                context.refuse(context.was_read(key) ? key : path,
                               in_quotes(file.string()) + " lies in folder " + folder.name + ": keep it apart");
            }
        }
    };
    check("spool", settings.spool);
    check("errors", settings.errors_file.value_or(""));
    check("http.tokens_file", settings.http.tokens_file.value_or(""));
    check("control.socket", settings.control.socket);
}

void check_folder(const FolderSettings& folder, const Settings& settings, Context& context) {
    const std::string key = "folders." + folder.name;
    check_reference(key + ".layout", folder.layout, "layout", names(settings.layouts), context);
    check_reference(key + ".printer", folder.printer, "printer", names(settings.printers), context);
    const PrinterSettings* const printer = settings.printer(folder.printer);
    if (folder.autostart && printer != nullptr && !printer->queue.autostart) {
        context.refuse(key + ".autostart", "has no effect: printers." + printer->name +
                                               ".queue.autostart is false; both must be true for jobs to start by "
                                               "themselves");
    }
}

void check_http(const HttpSettings& http, Context& context) {
    if (!http.tokens_file && !is_loopback(http.listen)) {
        context.refuse("http.listen",
                       in_quotes(http.listen) + " is reached from other machines: that needs http.tokens_file");
    }
}

} // namespace

std::vector<std::uint32_t> acknowledged_numbers(const ErrorTable& table, const PrinterSettings& printer) {
    std::vector<std::uint32_t> numbers;
    for (const auto& [number, policy] : printer.errors) {
        if (policy == ErrorPolicy::acknowledge) {
            numbers.push_back(number);
        }
    }
    for (const ErrorEntry& entry : table.entries) {
        if (entry.policy == ErrorPolicy::acknowledge && !printer.errors.contains(entry.number)) {
            numbers.push_back(entry.number);
        }
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

bool is_loopback(std::string_view address) {
    const std::string terminated{address};
    in_addr four{};
    if (::inet_pton(AF_INET, terminated.c_str(), &four) == 1) {
        constexpr std::uint32_t loopback_network = 127;
        return ntohl(four.s_addr) >> 24U == loopback_network;
    }
    in6_addr six{};
    return ::inet_pton(AF_INET6, terminated.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

void check_settings(const Settings& settings, Context& context) {
    check_http(settings.http, context);
    for (const LayoutSettings& layout : settings.layouts) {
        check_layout(layout, context);
    }
    for (const PrinterSettings& printer : settings.printers) {
        check_printer(printer, context);
    }
    check_addresses(settings, context);
    for (const FolderSettings& folder : settings.folders) {
        check_folder(folder, settings, context);
    }
    check_folder_paths(settings, context);
    check_own_files(settings, context);
}

void check_policies(const Settings& settings, Context& context) {
    constexpr std::size_t most = CapacityOf<decltype(feeder::FeederSettings::acknowledge)>::value;
    for (const PrinterSettings& printer : settings.printers) {
        const std::size_t count = acknowledged_numbers(settings.errors, printer).size();
        if (count > most) {
            const std::string key = "printers." + printer.name;
            context.refuse(context.was_read(key + ".errors") ? key + ".errors" : key,
                           "with the table of error numbers, " + std::to_string(count) +
                               " numbers would be acknowledged; at most " + std::to_string(most));
        }
    }
}

} // namespace linefeed::config
