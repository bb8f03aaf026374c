// The spool as the service uses it: whoever changes something does so on the store thread, between two steps for the
// runs; whoever only looks has a connection of his own and holds up nobody.
#pragma once

#include "spool/spool.hpp"
#include "store/store_thread.hpp"

#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace linefeed::service {

/// Any thread but the feed and the store thread. The store thread must outlive it.
class SpoolAccess {
public:
    SpoolAccess(store::StoreThread& store, std::filesystem::path file)
        : store_(store)
        , file_(std::move(file)) {}

    /// `what(spool)` on the store thread; it returns a Result. It should take one transaction at most.
    template <typename What>
    [[nodiscard]] auto write(What&& what) -> std::invoke_result_t<What, spool::Spool&> {
        using Answer = std::invoke_result_t<What, spool::Spool&>;
        Answer answer = Failure{FailureKind::internal, "not done"};
        try {
            store_.call([&](spool::Spool& spool) { answer = what(spool); });
        } catch (const std::exception& error) {
            answer = Failure{FailureKind::internal, error.what()};
        }
        return answer;
    }
    /// `what(spool)` on this thread, with a spool that is open for reading; it returns a Result.
    template <typename What>
    [[nodiscard]] auto read(What&& what) -> std::invoke_result_t<What, spool::Spool&> {
        auto reader = take_reader();
        if (!reader) {
            return reader.error();
        }
        auto answer = what(**reader);
        give_back(std::move(*reader));
        return answer;
    }
    [[nodiscard]] store::StoreThread& store() { return store_; }

    /// A job of which nothing was printed, step by step: nobody waits for all of it. One that the disk does not let go
    /// is remembered.
    [[nodiscard]] Result<void> remove_job(spool::JobId job);
    /// Those that were remembered; returns within a second or so, whether or not all are gone.
    void remove_leftovers();

private:
    using Reader = std::unique_ptr<spool::Spool>;
    [[nodiscard]] Result<Reader> take_reader();
    void give_back(Reader reader);

    static constexpr std::size_t max_idle_readers = 4;

    store::StoreThread& store_;
    std::filesystem::path file_;
    std::mutex mutex_; ///< for what follows
    std::vector<Reader> readers_;
    std::vector<spool::JobId> leftovers_;
};

} // namespace linefeed::service
