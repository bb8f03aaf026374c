// The record pages at hand in memory, ahead of what has been sent. They belong to the store; the session gives each
// back when the last of its bytes has been written.
#pragma once

#include "base/bounded_list.hpp"
#include "base/record_page.hpp"
#include "session/outbox.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace linefeed::session {

/// Most pages lent to one session at a time.
inline constexpr std::size_t max_pages = 16;

/// Consecutive pages, oldest first.
class PageWindow {
public:
    /// Precondition: follows the newest page without a gap; fewer than max_pages are held.
    void add(const RecordPage* page);
    /// What was staged.
    struct Staged {
        std::string_view first; ///< the frame of the first record
        std::size_t bytes = 0;  ///< of all
    };
    /// Stages the frames of `range`, all of which must be here.
    Staged stage(RecordRange range, Outbox& outbox) const;
    /// The frame of a record that is here.
    [[nodiscard]] std::string_view frame_of(RecordNumber number) const;
    /// The oldest page, if every record of it is at or below `sent_through`; it leaves the window.
    [[nodiscard]] const RecordPage* take_done(RecordNumber sent_through);
    /// The oldest page, whatever its state; nullptr if none is left.
    [[nodiscard]] const RecordPage* take_any();
    /// The last number at hand. Precondition: not empty.
    [[nodiscard]] RecordNumber last() const;
    [[nodiscard]] bool empty() const { return size_ == 0; }

private:
    [[nodiscard]] const RecordPage& at(std::size_t index) const { return *pages_[(oldest_ + index) % max_pages]; }

    std::array<const RecordPage*, max_pages> pages_{};
    std::size_t oldest_ = 0;
    std::size_t size_ = 0;
};

} // namespace linefeed::session
