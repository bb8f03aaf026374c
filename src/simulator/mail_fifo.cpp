// The ring of records, see mail_fifo.hpp.
#include "simulator/mail_fifo.hpp"

#include "base/assert.hpp"

namespace linefeed::simulator {

MailFifo::MailFifo(std::uint32_t depth)
    : slots_(depth) {
    LINEFEED_ASSERT(depth >= 1);
}

MailSlot& MailFifo::push() {
    LINEFEED_ASSERT(!full());
    MailSlot& slot = slots_[(std::size_t{first_} + records_) % slots_.size()];
    slot.starts_sequence = records_ == 0;
    slot.has_number = true;
    slot.prints_left = 1;
    ++records_;
    return slot;
}

void MailFifo::pop() {
    LINEFEED_ASSERT(records_ > 0);
    first_ = (first_ + 1) % depth();
    --records_;
}

void MailFifo::clear() {
    first_ = 0;
    records_ = 0;
}

} // namespace linefeed::simulator
