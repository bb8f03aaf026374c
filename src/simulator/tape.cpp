// Lines, text and the thread that writes them, see tape.hpp.
#include "simulator/tape.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace linefeed::simulator {
namespace {

constexpr std::string_view header = "time_ns,number,text\n";
constexpr std::size_t hex_digits = 4;
constexpr char32_t replacement_character = 0xFFFD;

void append_utf8(std::string& out, char32_t c) {
    const auto byte = [&out](char32_t value) { out += static_cast<char>(static_cast<unsigned char>(value)); };
    if (c < 0x80) {
        byte(c);
    } else if (c < 0x800) {
        byte(0xC0 | (c >> 6));
        byte(0x80 | (c & 0x3F));
    } else {
        byte(0xE0 | (c >> 12));
        byte(0x80 | ((c >> 6) & 0x3F));
        byte(0x80 | (c & 0x3F));
    }
}

void append_bytes(std::string& out, std::string_view field, protocol::Charset charset) {
    for (const char byte : field) {
        append_utf8(out, protocol::from_single_byte(static_cast<unsigned char>(byte), charset));
    }
}

/// False, with `out` as before, if the field is not made of hex digits in fours.
bool append_hex(std::string& out, std::string_view field) {
    if (field.size() % hex_digits != 0) {
        return false;
    }
    std::string text;
    for (std::size_t i = 0; i < field.size(); i += hex_digits) {
        std::uint16_t unit = 0;
        const char* end = field.data() + i + hex_digits;
        const auto result = std::from_chars(field.data() + i, end, unit, 16);
        if (result.ec != std::errc{} || result.ptr != end) {
            return false;
        }
        const bool surrogate = unit >= 0xD800 && unit <= 0xDFFF;
        append_utf8(text, surrogate ? replacement_character : char32_t{unit});
    }
    out += text;
    return true;
}

} // namespace

std::string to_utf8(std::string_view text, protocol::Charset charset) {
    std::string out;
    for (bool first = true;; first = false) {
        if (!first) {
            out += '\t';
        }
        const std::size_t end = text.find('\t');
        const std::string_view field = text.substr(0, end);
        if (charset != protocol::Charset::unicode_hex) {
            append_bytes(out, field, charset);
        } else if (!append_hex(out, field)) {
            append_bytes(out, field, protocol::Charset::latin1);
        }
        if (end == std::string_view::npos) {
            return out;
        }
        text.remove_prefix(end + 1);
    }
}

std::string tape_line(std::int64_t time_ns, RecordNumber number, std::string_view utf8_text) {
    std::string line = std::to_string(time_ns) + ',' + std::to_string(number.value()) + ',';
    if (utf8_text.find_first_of("\",\r\n") == std::string_view::npos) {
        line += utf8_text;
    } else {
        line += '"';
        for (const char c : utf8_text) {
            line.append(c == '"' ? 2 : 1, c);
        }
        line += '"';
    }
    line += '\n';
    return line;
}

Result<std::unique_ptr<Tape>> Tape::open(const std::string& path) {
    constexpr mode_t readable_by_all = 0644;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, readable_by_all);
    if (descriptor < 0) {
        return Failure{FailureKind::storage, "cannot write the tape " + path + ": " + std::strerror(errno)};
    }
    std::unique_ptr<Tape> tape{new Tape{path, descriptor}};
    tape->write(header);
    return tape;
}

Tape::Tape(std::string path, int descriptor)
    : path_(std::move(path))
    , descriptor_(descriptor)
    , writer_([this] { run(); }) {}

Tape::~Tape() {
    static_cast<void>(close());
    ::close(descriptor_);
}

void Tape::write(std::string_view line) {
    {
        const std::lock_guard lock{mutex_};
        waiting_ += line;
    }
    changed_.notify_one();
}

Result<void> Tape::close() {
    {
        const std::lock_guard lock{mutex_};
        closing_ = true;
    }
    changed_.notify_one();
    if (writer_.joinable()) {
        writer_.join();
    }
    if (error_ != 0) {
        return Failure{FailureKind::storage, "the tape " + path_ + " is not complete: " + std::strerror(error_)};
    }
    return {};
}

void Tape::run() {
    std::string batch;
    std::unique_lock lock{mutex_};
    while (true) {
        changed_.wait(lock, [this] { return closing_ || !waiting_.empty(); });
        if (waiting_.empty()) {
            return;
        }
        batch.clear();
        batch.swap(waiting_);
        if (error_ != 0) {
            continue; // a line that was cut stays the last one
        }
        lock.unlock();
        const int error = write_all(batch);
        lock.lock();
        error_ = error;
    }
}

int Tape::write_all(std::string_view bytes) const {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

} // namespace linefeed::simulator
