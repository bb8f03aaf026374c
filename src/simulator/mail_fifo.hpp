// The mailing FIFO of the printer (protocol, section 5): a ring of records, the first of which is loaded for the next
// print. The slots keep their memory, so a line of millions of prints allocates only at its beginning.
#pragma once

#include "base/record_number.hpp"
#include "base/time.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace linefeed::simulator {

/// One record in the printer.
struct MailSlot {
    RecordNumber number;
    bool has_number = true;        ///< false: none that could be read, so that it is no lawful record; `number` is 0
    Instant arrived;               ///< when its last byte was read
    bool starts_sequence = false;  ///< it found the FIFO empty, so any number is lawful
    std::uint32_t prints_left = 1; ///< more than 1 only for number 0 with `rN`
    std::string text;              ///< the fields joined by TAB, as the job's font reads them: not decoded
};

/// At most `depth` records, in order of arrival.
class MailFifo {
public:
    /// Precondition: depth ≥ 1.
    explicit MailFifo(std::uint32_t depth);

    [[nodiscard]] std::uint32_t depth() const { return static_cast<std::uint32_t>(slots_.size()); }
    /// Records in the printer, the loaded one included.
    [[nodiscard]] std::uint32_t records() const { return records_; }
    /// What `=SM` shows: the loaded record is not counted.
    [[nodiscard]] std::uint32_t entries() const { return records_ == 0 ? 0 : records_ - 1; }
    [[nodiscard]] bool full() const { return records_ == depth(); }
    /// The record loaded for the next print; null when there is none.
    [[nodiscard]] MailSlot* loaded() { return records_ == 0 ? nullptr : &slots_[first_]; }
    [[nodiscard]] const MailSlot* loaded() const { return records_ == 0 ? nullptr : &slots_[first_]; }

    /// Adds a record at the end, to be filled in by the caller (`text` may hold an old one). Precondition: not full.
    [[nodiscard]] MailSlot& push();
    /// Takes the loaded record out. Precondition: not empty.
    void pop();
    void clear();

private:
    std::vector<MailSlot> slots_;
    std::uint32_t first_ = 0;
    std::uint32_t records_ = 0;
};

} // namespace linefeed::simulator
