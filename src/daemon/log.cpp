// Lines travel through spdlog's queue as one text: the message, then each field behind a unit separator, which cannot
// occur in what is printable.
#include "daemon/log.hpp"

#include "base/assert.hpp"
#include "daemon/feed_thread.hpp"
#include "protocol/printable.hpp"

#include <spdlog/async_logger.h>
#include <spdlog/details/null_mutex.h>
#include <spdlog/details/thread_pool.h>
#include <spdlog/sinks/base_sink.h>

#include <string>

namespace linefeed::daemon {

namespace {

using config::LogComponent;
using config::LogLevel;

constexpr char separator = '\x1F';

std::string_view name(LogComponent component) {
    switch (component) {
    case LogComponent::service:
        return "service";
    case LogComponent::printer:
        return "printer";
    case LogComponent::store:
        return "store";
    case LogComponent::intake:
        return "intake";
    case LogComponent::folder:
        return "folder";
    case LogComponent::api:
        return "api";
    }
    assertion_failed("LogComponent", __FILE__, __LINE__);
}

spdlog::level::level_enum to_spdlog(LogLevel level) {
    switch (level) {
    case LogLevel::trace:
        return spdlog::level::trace;
    case LogLevel::debug:
        return spdlog::level::debug;
    case LogLevel::info:
        return spdlog::level::info;
    case LogLevel::warning:
        return spdlog::level::warn;
    case LogLevel::error:
        return spdlog::level::err;
    }
    assertion_failed("LogLevel", __FILE__, __LINE__);
}

LogLevel from_spdlog(spdlog::level::level_enum level) {
    constexpr std::array levels{LogLevel::trace, LogLevel::debug, LogLevel::info, LogLevel::warning};
    const auto index = static_cast<std::size_t>(level);
    return index < levels.size() ? levels[index] : LogLevel::error;
}

void append_field(std::string& text, std::string_view name_of, std::string_view value) {
    text += separator;
    text.append(name_of).append("=").append(value);
}

/// The path from the sources' root on, whatever the build machine calls that.
std::string_view source_path(const char* file) {
    const std::string_view path = file == nullptr ? "" : file;
    constexpr std::string_view root = "/src/";
    const std::size_t at = path.rfind(root);
    return at == std::string_view::npos ? path : path.substr(at + 1);
}

/// Takes the lines out of the queue, on the queue's thread.
class Lines final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
public:
    Lines(std::unique_ptr<LogTarget> target, spdlog::details::thread_pool& queue)
        : target_(std::move(target))
        , queue_(queue) {}

protected:
    void sink_it_(const spdlog::details::log_msg& message) override {
        tell_lost();
        LogLine line;
        line.time = message.time;
        line.component = {message.logger_name.data(), message.logger_name.size()};
        line.level = from_spdlog(message.level);
        line.file = source_path(message.source.filename);
        line.line = static_cast<std::uint32_t>(message.source.line);
        line.function = message.source.funcname == nullptr ? "" : message.source.funcname;
        std::string_view rest{message.payload.data(), message.payload.size()};
        line.message = next(rest);
        while (!rest.empty()) {
            const std::string_view field = next(rest);
            const std::size_t equals = field.find('=');
            line.fields.emplace_back(field.substr(0, equals), field.substr(equals + 1));
        }
        target_->write(line);
    }
    void flush_() override {}

private:
    static std::string_view next(std::string_view& rest) {
        const std::string_view part = rest.substr(0, rest.find(separator));
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        return part;
    }

    void tell_lost() {
        const std::size_t lost = queue_.overrun_counter();
        if (lost == told_lost_) {
            return;
        }
        const std::string words =
            "lines of the log were lost because more came than could be written: " + std::to_string(lost - told_lost_) +
            " now, " + std::to_string(lost) + " since the start";
        told_lost_ = lost;
        LogLine line;
        line.time = std::chrono::system_clock::now();
        line.component = name(LogComponent::service);
        line.level = LogLevel::warning;
        line.message = words;
        target_->write(line);
    }

    std::unique_ptr<LogTarget> target_;
    spdlog::details::thread_pool& queue_; ///< whose thread calls
    std::size_t told_lost_ = 0;
};

} // namespace

Log::Log(const config::LoggingSettings& settings, std::unique_ptr<LogTarget> target, std::size_t lines_waiting)
    : queue_(std::make_shared<spdlog::details::thread_pool>(lines_waiting, 1)) {
    const auto lines = std::make_shared<Lines>(std::move(target), *queue_);
    for (std::size_t i = 0; i < loggers_.size(); ++i) {
        loggers_[i] = std::make_shared<spdlog::async_logger>(std::string{name(static_cast<LogComponent>(i))}, lines,
                                                             queue_, spdlog::async_overflow_policy::overrun_oldest);
    }
    set_levels(settings);
}

/// The queue's thread ends first: it works with all the rest.
Log::~Log() {
    queue_.reset();
}

spdlog::async_logger& Log::logger(LogComponent component) const {
    return *loggers_[static_cast<std::size_t>(component)];
}

void Log::write(LogComponent component, LogLevel level, std::string_view message, const LogFields& fields,
                const boost::source_location& place) {
    LINEFEED_ASSERT(!FeedThread::is_current());
    if (!wants(component, level)) {
        return;
    }
    std::string text = protocol::printable(message);
    if (fields.job) {
        append_field(text, "JOB", std::to_string(static_cast<std::int64_t>(*fields.job)));
    }
    if (!fields.printer.empty()) {
        append_field(text, "PRINTER", protocol::printable(fields.printer));
    }
    if (fields.record) {
        append_field(text, "RECORD", std::to_string(fields.record->value()));
    }
    const spdlog::source_loc source{place.file_name(), static_cast<int>(place.line()), place.function_name()};
    logger(component).log(source, to_spdlog(level), spdlog::string_view_t{text.data(), text.size()});
}

bool Log::wants(LogComponent component, LogLevel level) const {
    return logger(component).should_log(to_spdlog(level));
}

void Log::set_levels(const config::LoggingSettings& settings) {
    for (std::size_t i = 0; i < loggers_.size(); ++i) {
        loggers_[i]->set_level(to_spdlog(settings.level_of(static_cast<LogComponent>(i))));
    }
}

std::uint64_t Log::dropped() const {
    return queue_->overrun_counter();
}

} // namespace linefeed::daemon
