// The pages of a spool while a job is printed: each is verified whenever it is read.
#include "spool/checksum.hpp"
#include "spool/page_codec.hpp"
#include "spool/spool_state.hpp"

namespace linefeed::spool {

namespace {

Failure damaged_page(const std::string& path, JobId job, RecordNumber number) {
    return {FailureKind::storage, path + ": the spool is damaged: the page with record " +
                                      std::to_string(number.value()) + " of job " +
                                      std::to_string(static_cast<std::int64_t>(job)) + " does not match its checksum"};
}

} // namespace

Result<RecordPage> Spool::State::read_page(JobId id, RecordNumber number) {
    auto statement = database->prepare("SELECT first, records, ends, frames, crc FROM pages WHERE job = ?1 AND "
                                       "first <= ?2 ORDER BY first DESC LIMIT 1");
    if (!statement) {
        return statement.error();
    }
    const auto found = statement->bind(1, static_cast<std::int64_t>(id)).bind(2, std::int64_t{number.value()}).step();
    if (!found) {
        return found.error();
    }
    const auto range = *found ? stored_range(statement->number(0), statement->number(1)) : std::nullopt;
    if (!range || !range->contains(number)) {
        return Failure{FailureKind::storage, database->path() + ": job " +
                                                 std::to_string(static_cast<std::int64_t>(id)) + " has no record " +
                                                 std::to_string(number.value())};
    }
    const std::string_view ends = statement->blob(2);
    RecordPage page{range->first(), unpack_ends(ends), std::string{statement->blob(3)}};
    const bool intact = page_checksum(id, page.first, ends, page.frames) == statement->number(4);
    if (!intact || page.ends.size() != range->count().value() || !is_consistent(page)) {
        return damaged_page(database->path(), id, number);
    }
    return page;
}

Result<RecordPage> Spool::read_page(JobId id, RecordNumber number) {
    return state_->read_page(id, number);
}

Result<bool> Spool::has_escapes(JobId id) {
    auto statement = state_->database->prepare("SELECT 1 FROM pages INDEXED BY pages_with_escapes WHERE job = ?1 AND "
                                               "instr(frames, x'5C') > 0 LIMIT 1");
    if (!statement) {
        return statement.error();
    }
    return statement->bind(1, static_cast<std::int64_t>(id)).step();
}

} // namespace linefeed::spool
