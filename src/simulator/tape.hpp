// The tape: what stuck to the products, one CSV line for each print, readable by others while the line runs. A thread
// of its own writes it, so that a slow disk never stops the conveyor.
#pragma once

#include "base/failure.hpp"
#include "base/record_number.hpp"
#include "protocol/charset.hpp"

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace linefeed::simulator {

/// The text of a record in UTF-8, its bytes read as the job's font reads them. Unicode-hex fields that are no hex
/// digits in fours are shown as Latin-1.
[[nodiscard]] std::string to_utf8(std::string_view text, protocol::Charset charset);

/// One line of the tape with its line feed: `time_ns,number,text`, quoted as RFC 4180 wants it.
[[nodiscard]] std::string tape_line(std::int64_t time_ns, RecordNumber number, std::string_view utf8_text);

/// Flow: open(); write() from one thread; close(). Lines reach the file within milliseconds.
class Tape {
public:
    /// Creates or empties the file and writes the header.
    [[nodiscard]] static Result<std::unique_ptr<Tape>> open(const std::string& path);
    ~Tape();
    Tape(const Tape&) = delete;
    Tape& operator=(const Tape&) = delete;

    void write(std::string_view line);
    /// Waits until everything is in the file. The failure if a write failed, now or before.
    [[nodiscard]] Result<void> close();

private:
    Tape(std::string path, int descriptor);
    void run();
    [[nodiscard]] int write_all(std::string_view bytes) const;

    const std::string path_;
    const int descriptor_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string waiting_;
    bool closing_ = false;
    int error_ = 0; ///< errno of the first write that failed
    std::thread writer_;
};

} // namespace linefeed::simulator
