#include "protocol/secured_line.hpp"

#include "base/assert.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_encoder.hpp"

#include <algorithm>

namespace linefeed::protocol {

namespace {

/// Inquiries that are seldom made otherwise: an answer to the one that is put in between must belong to it.
constexpr std::array syncs{Parameter::SC, Parameter::DS, Parameter::SH, Parameter::MC, Parameter::IC, Parameter::OC};

} // namespace

Duration SecuredLine::repeats_take() {
    Duration sum = least_patience;
    Duration patience = least_patience;
    for (int sync = 0; sync < max_syncs; ++sync) {
        sum += patience;
        patience = std::min(2 * patience, most_patience);
    }
    return sum;
}

Duration LineSettings::time_of(std::size_t bytes) const {
    return bytes_per_second > 0 ? std::chrono::duration_cast<Duration>(
                                      std::chrono::duration<double>{static_cast<double>(bytes) / bytes_per_second})
                                : Duration::zero();
}

void SecuredLine::add(Frame frame) {
    LINEFEED_ASSERT(size_ < max_frames);
    waiting(size_) = std::move(frame);
    ++size_;
}

void SecuredLine::add_records(RecordRange records) {
    Frame frame;
    frame.kind = Kind::record;
    frame.records = records;
    add(std::move(frame));
}

std::optional<Parameter> SecuredLine::drop_inquiry() {
    for (std::size_t i = 0; i < size_; ++i) {
        if (waiting(i).kind == Kind::inquiry) {
            waiting(i).kind = Kind::record; // of which there are none
            return waiting(i).what;
        }
    }
    return std::nullopt;
}

void SecuredLine::drop_records() {
    for (std::size_t i = 0; i < size_; ++i) {
        waiting(i).records = {};
    }
}

std::optional<RecordNumber> SecuredLine::first_waiting() const {
    for (std::size_t i = 0; i < size_; ++i) {
        const Frame& frame = frames_[(oldest_ + i) % max_frames];
        if (!frame.records.empty()) {
            return frame.records.first();
        }
    }
    return std::nullopt;
}

const SecuredLine::Frame* SecuredLine::begin() {
    while (!busy() && size_ > 0) {
        Frame& first = waiting(0);
        const bool dropped = first.kind == Kind::record && first.records.empty();
        if (first.kind == Kind::record && !dropped) {
            current_ = {.kind = Kind::record, .number = first.records.first()};
            first.records = RecordRange::closed(current_.number.next(), first.records.last());
        } else if (!dropped) {
            current_ = std::move(first);
        }
        if (first.records.empty()) {
            oldest_ = (oldest_ + 1) % max_frames;
            --size_;
        }
        if (!dropped) {
            tries_ = 0;
            syncs_ = 0;
            echoed_ = false;
            disputed_ = false;
            proven_ = false;
            sent_ = !stray_ || current_.kind == Kind::command;
            if (sent_) {
                state_ = State::sent;
            } else {
                static_cast<void>(sync());
            }
            return &current_;
        }
    }
    return nullptr;
}

std::string_view SecuredLine::announced(Instant now) {
    std::string sync;
    if (state_ == State::syncing) {
        append_inquiry(sync, syncs.at(sync_));
    }
    const std::string_view frame = state_ == State::syncing ? std::string_view{sync} : current_.bytes;
    announced_.clear();
    sum_ = crc32(frame.substr(0, frame.size() - 1));
    append_frame(announced_, Group::parameter, "NR" + std::to_string(sum_));
    announced_ += frame;
    announced_at_ = now;
    deadline_ = now + line_.time_of(announced_.size() + answer_bytes) + patience_;
    return announced_;
}

bool SecuredLine::is(Parameter what) const {
    return state_ == State::syncing ? syncs.at(sync_) == what
                                    : state_ == State::sent && current_.kind == Kind::inquiry && current_.what == what;
}

SecuredLine::Step SecuredLine::settled(Step step) {
    state_ = State::idle;
    return step;
}

SecuredLine::Step SecuredLine::given_up() {
    return settled(current_.kind == Kind::inquiry                              ? Step::lost
                   : current_.kind == Kind::record && !(echoed_ && !disputed_) ? Step::unproven
                                                                               : Step::next);
}

/// What grew because answers got lost must not stay for ever.
void SecuredLine::note_answer(Instant now) {
    patience_ = std::clamp(2 * (now - announced_at_), least_patience, patience_);
}

SecuredLine::Step SecuredLine::on_right(Instant now) {
    if (state_ != State::sent) {
        return Step::wait;
    }
    if (current_.kind == Kind::inquiry) {
        deadline_ = std::max(deadline_, now + line_.answer_takes);
        return Step::wait;
    }
    note_answer(now);
    proven_ = !stray_;
    return stray_ ? begin_sync() : settled(Step::next);
}

SecuredLine::Step SecuredLine::on_refused() {
    if (state_ == State::idle) {
        return Step::wait;
    }
    if (++tries_ == max_tries) {
        return given_up();
    }
    if (syncing()) { // the inquiry is refused, or a late word has come: an answer to this one would not tell
        disputed_ = true;
        return sync();
    }
    echoed_ = false; // it has come, but not as it was sent
    return Step::send;
}

SecuredLine::Step SecuredLine::on_answer(Parameter what, Instant now) {
    if (!is(what)) {
        return Step::wait;
    }
    note_answer(now);
    stray_ = false; // answers keep their order
    proven_ = state_ == State::sent || (sent_ && echoed_ && !disputed_);
    if (proven_ || (sent_ && current_.kind == Kind::once)) {
        return settled(Step::next);
    }
    if (sent_ && current_.kind == Kind::record) {
        return settled(Step::unproven); // it may lie in the FIFO, and must not come twice
    }
    state_ = State::sent;
    sent_ = true;
    return Step::send;
}

void SecuredLine::on_echo(std::string_view frame) {
    echoed_ = echoed_ ||
              (state_ == State::sent && current_.bytes.starts_with(frame) && frame.size() + 1 == current_.bytes.size());
}

SecuredLine::Step SecuredLine::on_time(Instant now) {
    if (state_ == State::idle || now < deadline_) {
        return Step::wait;
    }
    stray_ = true;
    if (state_ == State::syncing) {
        patience_ = std::min(2 * patience_, most_patience);
        return ++syncs_ < max_syncs ? sync() : given_up();
    }
    const bool unproven = current_.kind == Kind::record && !echoed_;
    return !unproven && ++tries_ < max_tries ? begin_sync() : given_up();
}

SecuredLine::Step SecuredLine::begin_sync() {
    syncs_ = 0;
    return sync();
}

SecuredLine::Step SecuredLine::sync() {
    state_ = State::syncing;
    do {
        sync_ = (sync_ + 1) % syncs.size();
    } while (current_.kind == Kind::inquiry && current_.what == syncs.at(sync_));
    return Step::send;
}

std::optional<Instant> SecuredLine::deadline() const {
    return busy() ? std::optional{deadline_} : std::nullopt;
}

void SecuredLine::give_up() {
    stray_ = stray_ || busy();
    state_ = State::idle;
}

void SecuredLine::clear() {
    size_ = 0;
    state_ = State::idle;
    stray_ = false;
}

} // namespace linefeed::protocol
