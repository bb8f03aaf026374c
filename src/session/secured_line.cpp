#include "session/secured_line.hpp"

#include "base/assert.hpp"
#include "protocol/crc32.hpp"
#include "protocol/frame_encoder.hpp"

#include <algorithm>

namespace linefeed::session {

using protocol::Parameter;

namespace {

/// Inquiries that nobody else makes here, so that an answer belongs to this one.
constexpr std::array syncs{Parameter::SC, Parameter::DS, Parameter::SH, Parameter::MC, Parameter::IC, Parameter::OC};

} // namespace

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

void SecuredLine::drop_inquiries() {
    for (std::size_t i = 0; i < size_; ++i) {
        if (waiting(i).kind == Kind::inquiry) {
            waiting(i).kind = Kind::record; // of which there are none
        }
    }
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
            state_ = State::sent;
            tries_ = 0;
            echoed_ = false;
            return &current_;
        }
    }
    return nullptr;
}

std::string_view SecuredLine::announced(Instant now) {
    std::string sync;
    if (state_ == State::syncing) {
        protocol::append_inquiry(sync, syncs.at(sync_));
    }
    const std::string_view frame = state_ == State::syncing ? std::string_view{sync} : current_.bytes;
    announced_.clear();
    const std::uint32_t crc = protocol::crc32(frame.substr(0, frame.size() - 1));
    protocol::append_frame(announced_, protocol::Group::parameter, "NR" + std::to_string(crc));
    announced_ += frame;
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

SecuredLine::Step SecuredLine::on_right() {
    const bool proven = state_ == State::sent && current_.kind != Kind::inquiry;
    return proven ? settled(Step::next) : Step::wait;
}

SecuredLine::Step SecuredLine::on_refused() {
    if (state_ == State::idle) {
        return Step::wait;
    }
    echoed_ = false; // it has come, but not as it was sent
    if (++tries_ < max_tries) {
        return Step::send;
    }
    return settled(current_.kind == Kind::record    ? Step::unproven
                   : current_.kind == Kind::inquiry ? Step::lost
                                                    : Step::next);
}

SecuredLine::Step SecuredLine::on_answer(Parameter what) {
    if (!is(what)) {
        return Step::wait;
    }
    if (state_ == State::sent || echoed_ || current_.kind == Kind::once) {
        return settled(Step::next);
    }
    state_ = State::sent;
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
    if (state_ == State::syncing) {
        patience_ = std::min(2 * patience_, most_patience);
        if (++syncs_ < max_syncs) {
            return sync();
        }
        return settled(current_.kind == Kind::inquiry ? Step::lost : Step::next);
    }
    if (current_.kind == Kind::record && !echoed_) {
        return settled(Step::unproven);
    }
    // Whether it is repeated or not: a late word must not be taken for that on the next frame.
    if (++tries_ == max_tries) {
        return settled(current_.kind == Kind::inquiry ? Step::lost : Step::next);
    }
    syncs_ = 0;
    return sync();
}

SecuredLine::Step SecuredLine::sync() {
    state_ = State::syncing;
    sync_ = (sync_ + 1) % syncs.size();
    return Step::send;
}

std::optional<Instant> SecuredLine::deadline() const {
    return busy() ? std::optional{deadline_} : std::nullopt;
}

void SecuredLine::clear() {
    size_ = 0;
    state_ = State::idle;
}

} // namespace linefeed::session
