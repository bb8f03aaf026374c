#include "service/spool_access.hpp"

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

} // namespace linefeed::service
