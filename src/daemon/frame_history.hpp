// The last frames between linefeed and a printer, for the post-mortem of every error: written on the feed thread into
// rings that exist from the start, read by any thread at any time without holding the feed thread up.
#pragma once

#include "daemon/operations.hpp"
#include "session/frame_observer.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string_view>
#include <vector>

namespace linefeed::daemon {

/// Of one printer, over all its runs. Each way has its own ring, so that a talkative printer does not push out what was
/// sent. Records that go out together are one entry with the first one's bytes: a refill of hundreds pushes nothing
/// out. Flow: one run at a time writes; frames() whenever wanted; keep() when something went wrong.
class FrameHistory final : public session::FrameObserver {
public:
    static constexpr std::size_t frames_kept = 100; ///< each way
    static constexpr std::size_t bytes_kept = 128;  ///< of each frame

    // Feed thread
    void on_frame_received(std::string_view frame, Instant at) override;
    void on_damage_received(std::uint64_t bytes, Instant at) override;
    void on_command_sent(std::string_view frame, Instant at) override;
    void on_records_sent(RecordRange records, std::string_view first, std::size_t bytes, Instant at) override;

    // Any other thread
    /// Oldest first.
    [[nodiscard]] std::vector<FrameView> frames() const;
    /// Keeps what frames() gives now, instead of what was kept before.
    void keep();
    [[nodiscard]] std::vector<FrameView> kept() const;

private:
    struct Entry {
        std::uint64_t place = 0;  ///< in the conversation, both ways counted together
        std::int64_t time_ns = 0; ///< monotonic
        std::uint64_t size = 0;
        std::uint32_t bytes = 0; ///< of them here
        bool sent = false;
        RecordRange records;
        std::array<char, bytes_kept> text{};
    };

    /// A ring with one writer. Each place has a version that is odd while it is written: a reader who meets one that
    /// is odd, or changes meanwhile, leaves that entry out. There are more places than entries are read, so that those
    /// have been overwritten long before they are wanted.
    class Ring {
    public:
        void write(const Entry& entry) noexcept;
        /// Appends the last frames_kept entries, or fewer if there were not so many.
        void read(std::vector<Entry>& entries) const;

    private:
        static constexpr std::size_t places = 128;
        static constexpr std::size_t head_words = 5;
        static constexpr std::size_t entry_words = head_words + bytes_kept / sizeof(std::uint64_t);

        struct Place {
            std::atomic<std::uint64_t> version{0}; ///< 2 n + 2 once entry n is whole
            std::array<std::atomic<std::uint64_t>, entry_words> words{};
        };
        [[nodiscard]] static bool read(const Place& place, std::uint64_t index, Entry& entry);

        std::array<Place, places> places_;
        std::atomic<std::uint64_t> written_{0};
    };

    void write(Ring& ring, std::string_view head, std::uint64_t size, RecordRange records, Instant at) noexcept;

    Ring received_;
    Ring sent_;
    std::uint64_t next_place_ = 0;
    mutable std::mutex outside_; ///< guards what was kept; the feed thread never takes it
    std::vector<FrameView> kept_;
};

} // namespace linefeed::daemon
