// The pages of a spool while a job is imported: written in transactions of bounded size, so that the WAL stays small
// whatever the size of the source. An import that goes on where an earlier one was broken off is given all pages once
// more from the first: what is stored is compared, so that nothing rests on the belief that a file is still the same.
#include "spool/checksum.hpp"
#include "spool/page_codec.hpp"
#include "spool/spool_state.hpp"

#include <algorithm>
#include <new>
#include <utility>

namespace linefeed::spool {

namespace {

constexpr std::size_t import_transaction_bytes = std::size_t{8} * 1024 * 1024;
/// The WAL is copied into the database whenever so much has come in: that takes two syncs more, so not behind each
/// transaction where those are small.
constexpr std::size_t checkpoint_bytes = std::size_t{8} * 1024 * 1024;
/// What a transaction adds to the WAL at most besides its records: whole pages of the database, however few records.
constexpr std::size_t transaction_overhead_bytes = std::size_t{64} * 1024;

/// The records of `page` from `first` on.
RecordPage tail_of(const RecordPage& page, RecordNumber first) {
    const auto skipped = static_cast<std::size_t>((first - page.first).value());
    const std::uint32_t offset = page.ends[skipped - 1];
    RecordPage tail{first, {page.ends.begin() + static_cast<std::ptrdiff_t>(skipped), page.ends.end()}, {}};
    std::ranges::for_each(tail.ends, [offset](std::uint32_t& end) { end -= offset; });
    tail.frames = page.frames.substr(offset);
    return tail;
}

} // namespace

struct JobImport::State {
    Spool::State* spool;
    Job job; ///< as stored, and what is to be stored next
    Sha256 content{};
    std::uint64_t records = 0;            ///< added
    std::uint64_t stored = 0;             ///< durable, perhaps by an earlier import
    bool new_source = false;              ///< the job is known under another fingerprint
    std::optional<RecordPage> compared{}; ///< the page that was read back last
    std::vector<RecordPage> waiting{};    ///< pages for the next transaction
    std::size_t waiting_bytes = 0;
    std::size_t behind_checkpoint_bytes = 0; ///< written since the last checkpoint
    std::optional<Failure> failed{};         ///< why it cannot be completed
    bool committed = false;

    [[nodiscard]] Result<void> compare(const RecordPage& page);
    /// Writes what waits, durably.
    [[nodiscard]] Result<void> write();
    /// No record follows: what is left is written with the job's final description.
    [[nodiscard]] Result<void> finish(ImportState state, std::string import_report);
    [[nodiscard]] Result<void> write_waiting();
    [[nodiscard]] Result<void> write_page(const RecordPage& page);
    [[nodiscard]] Result<void> write_job();
};

/// Each record of `page` that is stored must be stored as it is.
Result<void> JobImport::State::compare(const RecordPage& page) {
    const RecordNumber last_stored = job.spec.base + RecordCount{stored};
    RecordNumber number = page.first;
    while (number <= std::min(page.range().last(), last_stored)) {
        if (!compared || !compared->range().contains(number)) {
            auto read = spool->read_page(job.id, number);
            if (!read) {
                return read.error();
            }
            compared = std::move(*read);
        }
        const RecordRange both = RecordRange::closed(number, std::min(compared->range().last(), page.range().last()));
        if (compared->slice(both) != page.slice(both)) {
            return Failure{FailureKind::input, job.spec.source.path + ": the records " +
                                                   std::to_string(both.first().value()) + " to " +
                                                   std::to_string(both.last().value()) +
                                                   " are not those that were imported from it before"};
        }
        if (both.last() == page.range().last() || both.last() == last_stored) {
            break;
        }
        number = both.last().next();
    }
    return {};
}

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
    if (auto written = new_source ? spool->write_source(job.id, job.spec.source) : Result<void>{}; !written) {
        return written;
    }
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
        if (page.first == job.spec.base.next()) {
            if (auto done = spool->write_head(job.id, page); !done) {
                return done;
            }
        }
    }
    job.records = records == 0 ? RecordRange{} : RecordRange{job.spec.base.next(), RecordCount{records}};
    if (auto done = write_job(); !done) {
        return done;
    }
    if (auto done = transaction->commit(); !done) {
        return done;
    }
    stored = records;
    new_source = false;
    waiting.clear();
    behind_checkpoint_bytes += std::exchange(waiting_bytes, 0) + transaction_overhead_bytes;
    if (const auto ledger = spool->ledgers.find(static_cast<std::int64_t>(job.id)); ledger != spool->ledgers.end()) {
        ledger->second.records = job.records;
        ledger->second.complete = job.state == ImportState::ready;
    }
    if (behind_checkpoint_bytes < checkpoint_bytes && job.state == ImportState::importing) {
        return {};
    }
    behind_checkpoint_bytes = 0;
    if (auto copied = spool->database->checkpoint_passive(); !copied) {
        return copied.error();
    }
    return {};
}

Result<void> JobImport::State::write() {
    if (auto writable = spool->check_writable(); !writable) {
        return writable;
    }
    if (auto written = write_waiting(); !written) {
        failed = written.error();
        return spool->failed_write(written.error());
    }
    return {};
}

Result<void> JobImport::State::finish(ImportState state, std::string import_report) {
    LINEFEED_ASSERT(!committed);
    if (failed) {
        return *failed;
    }
    if (records == 0 && stored == 0) {
        return Failure{FailureKind::input, "there is no record to print"};
    }
    if (records < stored) {
        return Failure{FailureKind::input, job.spec.source.path + ": it gives only " + std::to_string(records) +
                                               " records, of which " + std::to_string(stored) +
                                               " were imported from it before"};
    }
    const Sha256Digest digest = content.finish();
    job.content_sha256 = to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
    job.import_report = std::move(import_report);
    job.state = state;
    return write();
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
        const auto printed = state_->spool->stands_in_ledger(state_->job.id);
        if (!printed || *printed) {
            return;
        }
        if (auto removed = state_->spool->remove_job_in_steps(state_->job.id); !removed) {
            static_cast<void>(state_->spool->failed_write(removed.error()));
        }
    } catch (const std::bad_alloc&) { // perhaps the very one that ended the import: a destructor lets none out
    }
}

JobId JobImport::id() const {
    return state_->job.id;
}

RecordRange JobImport::durable() const {
    return {state_->job.spec.base.next(), RecordCount{state_->stored}};
}

RecordCount JobImport::added() const {
    return RecordCount{state_->records};
}

Result<void> JobImport::add(const RecordPage& page) {
    LINEFEED_ASSERT(!state_->committed && is_consistent(page));
    LINEFEED_ASSERT(page.first == state_->job.spec.base + RecordCount{state_->records + 1});
    if (state_->failed) {
        return *state_->failed;
    }
    if (auto same = state_->compare(page); !same) {
        state_->failed = same.error();
        return same;
    }
    state_->content.update(page.frames);
    state_->records += page.ends.size();
    state_->job.frame_bytes += page.frames.size();
    if (state_->records <= state_->stored) {
        return {};
    }
    const RecordNumber first_new = durable().first() + RecordCount{state_->stored};
    RecordPage fresh = page.first < first_new ? tail_of(page, first_new) : page;
    state_->waiting_bytes += fresh.frames.size() + fresh.ends.size() * sizeof(std::uint32_t);
    state_->waiting.push_back(std::move(fresh));
    return state_->waiting_bytes < import_transaction_bytes ? Result<void>{} : state_->write();
}

Result<void> JobImport::flush() {
    LINEFEED_ASSERT(!state_->committed);
    if (state_->failed) {
        return *state_->failed;
    }
    return state_->waiting.empty() ? Result<void>{} : state_->write();
}

Result<Job> JobImport::commit(std::string import_report) {
    if (auto finished = state_->finish(ImportState::ready, std::move(import_report)); !finished) {
        return finished.error();
    }
    state_->committed = true;
    return state_->job;
}

Result<Job> JobImport::stop(std::string import_report) {
    if (auto finished = state_->finish(ImportState::stopped, std::move(import_report)); !finished) {
        return finished.error();
    }
    state_->failed = Failure{FailureKind::internal, "the import is stopped"};
    return state_->job;
}

void JobImport::give_up() {
    state_.reset();
}

Result<JobImport> Spool::begin_import(const JobSpec& spec, std::string import_report) {
    if (auto writable = state_->check_writable(); !writable) {
        return writable.error();
    }
    Job job;
    job.spec = spec;
    job.import_report = std::move(import_report);
    job.created_ns = state_->wall_clock_ns();
    auto statement = state_->database->prepare(
        "INSERT INTO jobs (source_path, source_size, source_modified_ns, source_inode, source_companion, layout, base, "
        "created_ns, import_report, source_sha256, state) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, 'importing')");
    if (!statement) {
        return statement.error();
    }
    bind_source(*statement, 1, spec.source)
        .bind(6, spec.layout)
        .bind(7, std::int64_t{spec.base.value()})
        .bind(8, job.created_ns)
        .bind(9, job.import_report)
        .bind(10, spec.source_sha256);
    if (auto done = statement->run(); !done) {
        return state_->failed_write(done.error());
    }
    job.id = JobId{state_->database->last_insert_id()};
    return JobImport{std::unique_ptr<JobImport::State>{new JobImport::State{state_.get(), std::move(job)}}};
}

Result<JobImport> Spool::resume_import(const Job& job, const SourceFingerprint& source) {
    LINEFEED_ASSERT(job.state != ImportState::ready);
    if (auto writable = state_->check_writable(); !writable) {
        return writable.error();
    }
    auto import = std::unique_ptr<JobImport::State>{new JobImport::State{state_.get(), job}};
    import->stored = job.records.count().value();
    import->new_source = source != job.spec.source;
    import->job.spec.source = source;
    import->job.state = ImportState::importing;
    import->job.content_sha256.clear();
    import->job.frame_bytes = 0; // all frames come once more
    return JobImport{std::move(import)};
}

} // namespace linefeed::spool
