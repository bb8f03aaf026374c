// The pages of a spool: written while a job is imported, read while it is printed.
#include "spool/checksum.hpp"
#include "spool/spool_state.hpp"

#include <new>

namespace linefeed::spool {

namespace {

/// Pages are written in transactions of about this size, so that the WAL stays small whatever the size of the source.
constexpr std::size_t import_transaction_bytes = std::size_t{8} * 1024 * 1024;

std::string pack_ends(const std::vector<std::uint32_t>& ends) {
    std::string packed;
    packed.reserve(ends.size() * 4);
    for (const std::uint32_t end : ends) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            packed += static_cast<char>((end >> shift) & 0xFFU);
        }
    }
    return packed;
}

std::vector<std::uint32_t> unpack_ends(std::string_view packed) {
    std::vector<std::uint32_t> ends(packed.size() / 4);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        for (unsigned byte = 0; byte < 4; ++byte) {
            ends[i] |= std::uint32_t{static_cast<unsigned char>(packed[i * 4 + byte])} << (8 * byte);
        }
    }
    return ends;
}

/// The invariant of RecordPage.
bool is_consistent(const RecordPage& page) {
    std::uint32_t previous = 0;
    for (const std::uint32_t end : page.ends) {
        if (end <= previous) {
            return false;
        }
        previous = end;
    }
    return previous == page.frames.size() && previous > 0;
}

Failure damaged_page(const std::string& path, JobId job, RecordNumber number) {
    return {FailureKind::storage, path + ": the spool is damaged: the page with record " +
                                      std::to_string(number.value()) + " of job " +
                                      std::to_string(static_cast<std::int64_t>(job)) + " does not match its checksum"};
}

} // namespace

struct JobImport::State {
    Spool::State* spool;
    Job job;
    Sha256 content;
    std::uint64_t records = 0;
    std::vector<RecordPage> waiting; ///< pages for the next transaction
    std::size_t waiting_bytes = 0;
    std::optional<Failure> failed; ///< why it cannot be completed
    bool committed = false;

    [[nodiscard]] Result<void> write_waiting();
    [[nodiscard]] Result<void> write_page(const RecordPage& page);
    [[nodiscard]] Result<void> write_job();
};

Result<void> JobImport::State::write_page(const RecordPage& page) {
    auto statement = spool->database->prepare(
        "INSERT INTO pages (job, first, records, ends, frames, crc) VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
    if (!statement) {
        return statement.error();
    }
    const std::string ends = pack_ends(page.ends);
    return statement->bind(1, static_cast<std::int64_t>(job.id))
        .bind(2, std::int64_t{page.first.value()})
        .bind(3, static_cast<std::int64_t>(page.ends.size()))
        .bind_blob(4, ends)
        .bind_blob(5, page.frames)
        .bind(6, std::int64_t{page_checksum(job.id, page.first, ends, page.frames)})
        .run();
}

Result<void> JobImport::State::write_job() {
    auto statement =
        spool->database->prepare("UPDATE jobs SET state = ?2, records = ?3, frame_bytes = ?4, content_sha256 = ?5, "
                                 "import_report = ?6 WHERE id = ?1");
    if (!statement) {
        return statement.error();
    }
    return statement->bind(1, static_cast<std::int64_t>(job.id))
        .bind(2, std::string_view{job.state == ImportState::ready ? "ready" : "importing"})
        .bind(3, static_cast<std::int64_t>(job.records.count().value()))
        .bind(4, static_cast<std::int64_t>(job.frame_bytes))
        .bind(5, job.content_sha256)
        .bind(6, job.import_report)
        .run();
}

Result<void> JobImport::State::write_waiting() {
    auto transaction = Transaction::begin(*spool->database);
    if (!transaction) {
        return transaction.error();
    }
    for (const RecordPage& page : waiting) {
        if (auto done = write_page(page); !done) {
            return done;
        }
    }
    job.records = records == 0 ? RecordRange{} : RecordRange{job.spec.base.next(), RecordCount{records}};
    if (auto done = write_job(); !done) {
        return done;
    }
    if (auto done = transaction->commit(); !done) {
        return done;
    }
    waiting.clear();
    waiting_bytes = 0;
    if (auto copied = spool->database->checkpoint_passive(); !copied) {
        return copied.error();
    }
    return {};
}

JobImport::JobImport(std::unique_ptr<State> state)
    : state_(std::move(state)) {}
JobImport::JobImport(JobImport&&) noexcept = default;

JobImport& JobImport::operator=(JobImport&& other) noexcept {
    std::swap(state_, other.state_); // what this one held is removed when `other` goes
    return *this;
}

JobImport::~JobImport() {
    if (state_ == nullptr || state_->committed || state_->spool->broken) {
        return;
    }
    // What cannot be removed now is removed when the spool is opened again.
    try {
        if (auto removed = state_->spool->remove_job_in_steps(state_->job.id); !removed) {
            static_cast<void>(state_->spool->failed_write(removed.error()));
        }
    } catch (const std::bad_alloc&) { // perhaps the very one that ended the import: a destructor lets none out
    }
}

JobId JobImport::id() const {
    return state_->job.id;
}

Result<void> JobImport::add(const RecordPage& page) {
    LINEFEED_ASSERT(!state_->committed && is_consistent(page));
    LINEFEED_ASSERT(page.first == state_->job.spec.base + RecordCount{state_->records + 1});
    if (state_->failed) {
        return *state_->failed;
    }
    state_->content.update(page.frames);
    state_->records += page.ends.size();
    state_->job.frame_bytes += page.frames.size();
    state_->waiting_bytes += page.frames.size() + page.ends.size() * sizeof(std::uint32_t);
    state_->waiting.push_back(page);
    if (state_->waiting_bytes < import_transaction_bytes) {
        return {};
    }
    if (auto writable = state_->spool->check_writable(); !writable) {
        return writable;
    }
    if (auto written = state_->write_waiting(); !written) {
        state_->failed = written.error();
        return state_->spool->failed_write(written.error());
    }
    return {};
}

Result<Job> JobImport::commit(std::string import_report) {
    LINEFEED_ASSERT(!state_->committed);
    if (state_->failed) {
        return *state_->failed;
    }
    if (auto writable = state_->spool->check_writable(); !writable) {
        return writable.error();
    }
    if (state_->records == 0) {
        return Failure{FailureKind::input, "there is no record to print"};
    }
    const Sha256Digest digest = state_->content.finish();
    state_->job.content_sha256 = to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
    state_->job.import_report = std::move(import_report);
    state_->job.state = ImportState::ready;
    if (auto written = state_->write_waiting(); !written) {
        state_->failed = written.error();
        return state_->spool->failed_write(written.error());
    }
    state_->committed = true;
    return state_->job;
}

Result<JobImport> Spool::begin_import(const JobSpec& spec) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable.error();
    }
    Job job;
    job.spec = spec;
    job.created_ns = state_->wall_clock_ns();
    auto statement = state_->database->prepare(
        "INSERT INTO jobs (source_path, source_size, source_modified_ns, source_inode, source_companion, layout, base, "
        "created_ns, state) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, 'importing')");
    if (!statement) {
        return statement.error();
    }
    statement->bind(1, spec.source.path)
        .bind(2, static_cast<std::int64_t>(spec.source.size_bytes))
        .bind(3, spec.source.modified_ns)
        .bind(4, static_cast<std::int64_t>(spec.source.inode))
        .bind(5, spec.source.companion)
        .bind(6, spec.layout)
        .bind(7, std::int64_t{spec.base.value()})
        .bind(8, job.created_ns);
    if (auto done = statement->run(); !done) {
        return state_->failed_write(done.error());
    }
    job.id = JobId{state_->database->last_insert_id()};
    return JobImport{
        std::unique_ptr<JobImport::State>{new JobImport::State{state_.get(), std::move(job), {}, 0, {}, 0, {}, false}}};
}

Result<RecordPage> Spool::read_page(JobId id, RecordNumber number) {
    auto statement = state_->database->prepare("SELECT first, records, ends, frames, crc FROM pages WHERE job = ?1 AND "
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
        return Failure{FailureKind::storage, state_->database->path() + ": job " +
                                                 std::to_string(static_cast<std::int64_t>(id)) + " has no record " +
                                                 std::to_string(number.value())};
    }
    const std::string_view ends = statement->blob(2);
    RecordPage page{range->first(), unpack_ends(ends), std::string{statement->blob(3)}};
    const bool intact = page_checksum(id, page.first, ends, page.frames) == statement->number(4);
    if (!intact || page.ends.size() != range->count().value() || !is_consistent(page)) {
        return damaged_page(state_->database->path(), id, number);
    }
    return page;
}

} // namespace linefeed::spool
