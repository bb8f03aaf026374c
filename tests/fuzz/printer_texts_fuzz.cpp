// Texts that people and files give about a printer: addresses, profiles, paths, clocks, arguments of tasks with the raw
// frames among them, manifests of backups, recorded conversations. What is read can be written, and reads the same.
#include "base/assert.hpp"
#include "link/printer_address.hpp"
#include "printer/backup_manifest.hpp"
#include "printer/conversation.hpp"
#include "printer/host_time.hpp"
#include "printer/printer_path.hpp"
#include "printer/tasks.hpp"
#include "protocol/profile.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace {

using namespace linefeed;
using namespace linefeed::printer;

void read_settings(const std::string& text) {
    if (const auto address = link::parse_printer_address(text)) {
        LINEFEED_ASSERT(link::parse_printer_address(to_string(*address)) == address);
    }
    if (const auto profile = protocol::parse_profile(text)) {
        const auto again = protocol::parse_profile(to_string(*profile));
        LINEFEED_ASSERT(again && again->own == profile->own);
    }
    if (const auto clock = read_clock(text)) {
        LINEFEED_ASSERT(ahead_of(*clock, *clock) == std::chrono::seconds::zero());
    }
}

void read_paths(const std::string& text) {
    for (const auto escapes : {protocol::EscapeMode::none, protocol::EscapeMode::backslash}) {
        if (const auto path = printer_path(text, escapes)) {
            LINEFEED_ASSERT(path_bytes(path_text(*path)) == *path);
            static_cast<void>(saved_as(*path));
        }
        static_cast<void>(printer_file(text, escapes));
        static_cast<void>(printer_job(text, escapes));
    }
}

void read_files(const std::string& text) {
    if (const auto manifest = parse_manifest(text)) {
        const auto again = parse_manifest(manifest_json(*manifest));
        LINEFEED_ASSERT(again && *again == *manifest);
    }
    static_cast<void>(parse_partial(text));
    if (const auto utterance = read_line(text)) {
        const auto again = read_line(to_line(*utterance));
        LINEFEED_ASSERT(again && *again == *utterance);
    }
}

void read_arguments(const std::string& text) {
    for (const Task& task : tasks()) {
        if (const auto arguments = Arguments::parse(task.arguments, text)) {
            static_cast<void>(danger_of(task, *arguments));
        }
    }
}

/// What `linefeed printer P send` is given.
void read_raw_frame(const std::string& text) {
    const Task* const send = find_task("send");
    if (const auto arguments =
            Arguments::from_texts(send->arguments, std::vector{std::pair{std::string{"frame"}, text}})) {
        static_cast<void>(danger_of(*send, *arguments));
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(data, data + size);
    read_settings(text);
    read_paths(text);
    read_files(text);
    read_arguments(text);
    read_raw_frame(text);
    return 0;
}
