#include "daemon/log_target.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <sys/uio.h>
#include <syslog.h>
#include <unistd.h>

#define SD_JOURNAL_SUPPRESS_LOCATION // ours, not that of this file
#include <systemd/sd-journal.h>

namespace linefeed::daemon {

namespace {

constexpr const char* journal_socket = "/run/systemd/journal/socket";

int priority(config::LogLevel level) {
    switch (level) {
    case config::LogLevel::trace:
    case config::LogLevel::debug:
        return LOG_DEBUG;
    case config::LogLevel::info:
        return LOG_INFO;
    case config::LogLevel::warning:
        return LOG_WARNING;
    case config::LogLevel::error:
        return LOG_ERR;
    }
    assertion_failed("LogLevel", __FILE__, __LINE__);
}

std::string_view word(config::LogLevel level) {
    switch (level) {
    case config::LogLevel::trace:
        return "trace";
    case config::LogLevel::debug:
        return "debug";
    case config::LogLevel::info:
        return "info";
    case config::LogLevel::warning:
        return "warning";
    case config::LogLevel::error:
        return "error";
    }
    assertion_failed("LogLevel", __FILE__, __LINE__);
}

std::string lower_case(std::string_view text) {
    std::string lower{text};
    std::ranges::transform(lower, lower.begin(),
                           [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return lower;
}

class StandardErrorTarget final : public LogTarget {
public:
    void write(const LogLine& line) override {
        std::string text = time_of(line);
        text.append(" ").append(word(line.level)).append(" ").append(line.component).append(": ").append(line.message);
        const char* before = " (";
        for (const auto& [name, value] : line.fields) {
            text.append(before).append(lower_case(name)).append(" ").append(value);
            before = ", ";
        }
        text += line.fields.empty() ? "\n" : ")\n";
        // One call for a line, so that lines of several processes do not mix; there is nobody to tell if it fails.
        [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    }

private:
    static std::string time_of(const LogLine& line) {
        const auto since_epoch = std::chrono::duration_cast<std::chrono::milliseconds>(line.time.time_since_epoch());
        const std::time_t seconds = since_epoch.count() / 1000;
        std::tm parts{};
        ::gmtime_r(&seconds, &parts);
        std::array<char, 32> date{};
        std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &parts);
        std::array<char, 8> fraction{};
        std::snprintf(fraction.data(), fraction.size(), ".%03dZ", static_cast<int>(since_epoch.count() % 1000));
        return std::string{date.data()} + fraction.data();
    }
};

class JournalTarget final : public LogTarget {
public:
    explicit JournalTarget(JournalSend send)
        : send_(std::move(send)) {}

    void write(const LogLine& line) override {
        std::vector<std::string> fields{
            "MESSAGE=" + std::string{line.message}, "PRIORITY=" + std::to_string(priority(line.level)),
            "SYSLOG_IDENTIFIER=linefeedd", "LINEFEED_COMPONENT=" + std::string{line.component}};
        for (const auto& [name, value] : line.fields) {
            fields.push_back("LINEFEED_" + std::string{name} + "=" + std::string{value});
        }
        if (!line.file.empty()) {
            fields.push_back("CODE_FILE=" + std::string{line.file});
            fields.push_back("CODE_LINE=" + std::to_string(line.line));
            fields.push_back("CODE_FUNC=" + std::string{line.function});
        }
        std::vector<iovec> pieces;
        pieces.reserve(fields.size());
        for (std::string& field : fields) {
            pieces.push_back({field.data(), field.size()});
        }
        if (send_(pieces.data(), static_cast<int>(pieces.size())) < 0) {
            standard_error_.write(line);
        }
    }

private:
    JournalSend send_;
    StandardErrorTarget standard_error_;
};

} // namespace

std::unique_ptr<LogTarget> journal_target(JournalSend send) {
    return std::make_unique<JournalTarget>(std::move(send));
}

std::unique_ptr<LogTarget> standard_error_target() {
    return std::make_unique<StandardErrorTarget>();
}

std::unique_ptr<LogTarget> make_log_target(config::LogTarget wanted) {
    // Without a journal sd_journal_sendv() reports success.
    const bool journal = wanted == config::LogTarget::journald && ::access(journal_socket, W_OK) == 0;
    return journal ? journal_target([](const iovec* fields, int count) { return ::sd_journal_sendv(fields, count); })
                   : standard_error_target();
}

} // namespace linefeed::daemon
