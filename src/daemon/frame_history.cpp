#include "daemon/frame_history.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace linefeed::daemon {

namespace {

/// What to add to monotonic time now to get wall time, ns.
std::int64_t wall_minus_monotonic_ns() {
    using std::chrono::nanoseconds;
    const auto wall = std::chrono::duration_cast<nanoseconds>(std::chrono::system_clock::now().time_since_epoch());
    const auto steady = std::chrono::duration_cast<nanoseconds>(std::chrono::steady_clock::now().time_since_epoch());
    return (wall - steady).count();
}

} // namespace

void FrameHistory::on_frame_received(std::string_view frame, Instant at) {
    write(received_, frame, frame.size() + 1, {}, at);
}

void FrameHistory::on_damage_received(std::uint64_t bytes, Instant at) {
    write(received_, {}, bytes, {}, at);
}

void FrameHistory::on_command_sent(std::string_view frame, Instant at) {
    write(sent_, frame, frame.size(), {}, at);
}

void FrameHistory::on_records_sent(RecordRange records, std::string_view first, std::size_t bytes, Instant at) {
    write(sent_, first, bytes, records, at);
}

void FrameHistory::write(Ring& ring, std::string_view head, std::uint64_t size, RecordRange records,
                         Instant at) noexcept {
    Entry entry;
    entry.place = next_place_++;
    entry.time_ns = at.time_since_epoch().count();
    entry.size = size;
    entry.bytes = static_cast<std::uint32_t>(std::min(head.size(), bytes_kept));
    entry.records = records;
    std::ranges::copy(head.substr(0, entry.bytes), entry.text.begin());
    ring.write(entry);
}

/// Every word is stored with release order, behind the odd version: whoever reads one of them knows that the version
/// has changed.
void FrameHistory::Ring::write(const Entry& entry) noexcept {
    const std::uint64_t index = written_.load(std::memory_order_relaxed);
    Place& place = places_[index % places];
    std::array<std::uint64_t, entry_words> words{};
    words[0] = entry.place;
    words[1] = static_cast<std::uint64_t>(entry.time_ns);
    words[2] = entry.size;
    words[3] = std::uint64_t{entry.records.first().value()} << 32 | entry.bytes;
    words[4] = entry.records.count().value();
    std::memcpy(words.data() + head_words, entry.text.data(), entry.text.size());

    place.version.store(2 * index + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < entry_words; ++i) {
        place.words[i].store(words[i], std::memory_order_release);
    }
    place.version.store(2 * index + 2, std::memory_order_release);
    written_.store(index + 1, std::memory_order_release);
}

void FrameHistory::Ring::read(std::vector<Entry>& entries) const {
    const std::uint64_t end = written_.load(std::memory_order_acquire);
    for (std::uint64_t index = end - std::min<std::uint64_t>(end, frames_kept); index < end; ++index) {
        Entry entry;
        if (read(places_[index % places], index, entry)) {
            entries.push_back(entry);
        }
    }
}

bool FrameHistory::Ring::read(const Place& place, std::uint64_t index, Entry& entry) {
    const std::uint64_t whole = 2 * index + 2;
    if (place.version.load(std::memory_order_acquire) != whole) {
        return false;
    }
    std::array<std::uint64_t, entry_words> words{};
    for (std::size_t i = 0; i < entry_words; ++i) {
        words[i] = place.words[i].load(std::memory_order_acquire);
    }
    if (place.version.load(std::memory_order_relaxed) != whole) {
        return false;
    }
    entry.place = words[0];
    entry.time_ns = static_cast<std::int64_t>(words[1]);
    entry.size = words[2];
    entry.bytes = static_cast<std::uint32_t>(words[3]);
    entry.records = RecordRange{RecordNumber{static_cast<std::uint32_t>(words[3] >> 32)}, RecordCount{words[4]}};
    std::memcpy(entry.text.data(), words.data() + head_words, entry.text.size());
    return true;
}

std::vector<FrameView> FrameHistory::frames() const {
    std::vector<Entry> entries;
    entries.reserve(2 * frames_kept);
    received_.read(entries);
    const std::size_t received = entries.size();
    sent_.read(entries);
    std::for_each(entries.begin() + static_cast<std::ptrdiff_t>(received), entries.end(),
                  [](Entry& entry) { entry.sent = true; });
    std::ranges::sort(entries, {}, &Entry::place);

    const std::int64_t to_wall_ns = wall_minus_monotonic_ns();
    std::vector<FrameView> views;
    views.reserve(entries.size());
    for (const Entry& entry : entries) {
        FrameView& view = views.emplace_back();
        view.id = entry.place;
        view.time_ns = entry.time_ns + to_wall_ns;
        view.sent = entry.sent;
        view.bytes.assign(entry.text.data(), entry.bytes);
        view.size = static_cast<std::uint32_t>(entry.size);
        view.records = entry.records;
    }
    return views;
}

void FrameHistory::keep() {
    auto now = frames();
    const std::lock_guard lock{outside_};
    kept_ = std::move(now);
}

std::vector<FrameView> FrameHistory::kept() const {
    const std::lock_guard lock{outside_};
    return kept_;
}

} // namespace linefeed::daemon
