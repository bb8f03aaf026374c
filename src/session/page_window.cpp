#include "session/page_window.hpp"

#include <algorithm>

namespace linefeed::session {

void PageWindow::add(const RecordPage* page) {
    LINEFEED_ASSERT(page != nullptr && size_ < max_pages);
    LINEFEED_ASSERT(empty() || page->first == last().next());
    pages_[(oldest_ + size_) % max_pages] = page;
    ++size_;
}

PageWindow::Staged PageWindow::stage(RecordRange range, Outbox& outbox) const {
    RecordNumber next = range.first();
    Staged staged;
    for (std::size_t i = 0; i < size_; ++i) {
        const RecordRange here = at(i).range();
        if (here.last() < next) {
            continue;
        }
        const RecordNumber last = std::min(here.last(), range.last());
        const std::string_view slice = at(i).slice(RecordRange::closed(next, last));
        outbox.stage_slice(slice);
        if (next == range.first()) {
            staged.first = at(i).slice({next, RecordCount{1}});
        }
        staged.bytes += slice.size();
        if (last == range.last()) {
            return staged;
        }
        next = last.next();
    }
    assertion_failed("the records to send are at hand", __FILE__, __LINE__);
}

std::string_view PageWindow::frame_of(RecordNumber number) const {
    for (std::size_t i = 0; i < size_; ++i) {
        if (at(i).range().contains(number)) {
            return at(i).slice({number, RecordCount{1}});
        }
    }
    assertion_failed("the record to send is at hand", __FILE__, __LINE__);
}

const RecordPage* PageWindow::take_done(RecordNumber sent_through) {
    return !empty() && at(0).range().last() <= sent_through ? take_any() : nullptr;
}

const RecordPage* PageWindow::take_any() {
    if (empty()) {
        return nullptr;
    }
    const RecordPage* page = pages_[oldest_];
    oldest_ = (oldest_ + 1) % max_pages;
    --size_;
    return page;
}

RecordNumber PageWindow::last() const {
    LINEFEED_ASSERT(!empty());
    return at(size_ - 1).range().last();
}

} // namespace linefeed::session
