#include "service/spool_access.hpp"

#include <chrono>

namespace linefeed::service {

Result<SpoolAccess::Reader> SpoolAccess::take_reader() {
    {
        const std::lock_guard lock{mutex_};
        if (!readers_.empty()) {
            Reader reader = std::move(readers_.back());
            readers_.pop_back();
            return reader;
        }
    }
    auto opened = spool::Spool::open_for_reading(file_, {});
    if (!opened) {
        return Failure{FailureKind::storage, opened.error().message};
    }
    return std::make_unique<spool::Spool>(std::move(*opened));
}

void SpoolAccess::give_back(Reader reader) {
    const std::lock_guard lock{mutex_};
    if (readers_.size() < max_idle_readers) {
        readers_.push_back(std::move(reader));
    }
}

Result<void> SpoolAccess::remove_job(spool::JobId job) {
    while (true) {
        const auto more = write([job](spool::Spool& spool) { return spool.remove_job_step(job); });
        if (!more && more.error().kind == FailureKind::storage) {
            const std::lock_guard lock{mutex_};
            leftovers_.push_back(job);
        }
        if (!more || !*more) {
            return more ? Result<void>{} : more.error();
        }
    }
}

void SpoolAccess::remove_leftovers() {
    constexpr auto patience = std::chrono::milliseconds{500};
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < deadline) {
        spool::JobId job{};
        {
            const std::lock_guard lock{mutex_};
            if (leftovers_.empty()) {
                return;
            }
            job = leftovers_.back();
        }
        const auto more = write([job](spool::Spool& spool) { return spool.remove_job_step(job); });
        if (!more && more.error().kind == FailureKind::storage) {
            return;
        }
        if (!more || !*more) {
            const std::lock_guard lock{mutex_};
            std::erase(leftovers_, job);
        }
    }
}

} // namespace linefeed::service
