#include "service/batches.hpp"

#include "intake/grown_batch.hpp"

#include <filesystem>
#include <utility>

namespace linefeed::service {

namespace {

/// What is written in one step: an intent that a feeder waits for stands behind it at most.
constexpr std::size_t step_bytes = std::size_t{1024} * 1024;

std::size_t bytes_of(const RecordPage& page) {
    return page.frames.size() + page.ends.size() * sizeof(std::uint32_t);
}

} // namespace

/// A job that grows on the store thread, step by step.
class Batches::Target final : public intake::ImportTarget {
public:
    explicit Target(Batches& batches)
        : batches_(batches) {}
    ~Target() override { Target::refuse(); }
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;

    [[nodiscard]] Result<void> begin(const spool::JobSpec& spec) override {
        return batches_.spool_.write([&](spool::Spool& spool) -> Result<void> {
            auto job = spool.begin_import(spec);
            if (!job) {
                return job.error();
            }
            job_ = std::move(*job);
            return {};
        });
    }
    [[nodiscard]] Result<void> add(RecordPage page) override {
        waiting_bytes_ += bytes_of(page);
        waiting_.push_back(std::move(page));
        if (waiting_bytes_ < step_bytes) {
            return {};
        }
        return batches_.spool_.write([this](spool::Spool&) -> Result<void> {
            auto added = hand_over();
            return added ? job_->flush() : added;
        });
    }
    /// What is stored is removed; what the disk does not let go now goes later.
    void refuse() override {
        waiting_.clear();
        waiting_bytes_ = 0;
        if (!job_) {
            return;
        }
        const spool::JobId id = job_->id();
        static_cast<void>(batches_.spool_.write([this](spool::Spool&) -> Result<void> {
            job_->give_up();
            return {};
        }));
        job_.reset();
        static_cast<void>(batches_.spool_.remove_job(id));
    }
    [[nodiscard]] Result<spool::Job> commit(std::string import_report) override {
        auto job = batches_.spool_.write([&](spool::Spool& spool) -> Result<spool::Job> {
            if (auto added = hand_over(); !added) {
                return added.error();
            }
            auto committed = batches_.commit(spool, *job_, import_report);
            if (committed) {
                job_.reset();
            }
            return committed;
        });
        return job;
    }

private:
    [[nodiscard]] Result<void> hand_over() {
        for (const RecordPage& page : std::exchange(waiting_, {})) {
            if (auto added = job_->add(page); !added) {
                return added;
            }
        }
        waiting_bytes_ = 0;
        return {};
    }

    Batches& batches_;
    std::optional<spool::JobImport> job_;
    std::vector<RecordPage> waiting_;
    std::size_t waiting_bytes_ = 0;
};

Result<std::optional<intake::KnownBatch>> Batches::find(const spool::JobSpec& spec) {
    if (again_) {
        return std::optional<intake::KnownBatch>{};
    }
    auto found = spool_.write([&](spool::Spool& spool) -> Result<intake::FoundBatch> {
        auto batch = intake::find_batch(spool, spec);
        if (batch && batch->gives_way) {
            if (auto begun = spool.remove_job_step(*batch->gives_way); !begun) {
                return begun.error();
            }
        }
        return batch;
    });
    if (!found) {
        return found.error();
    }
    if (found->gives_way) {
        if (auto removed = spool_.remove_job(*found->gives_way); !removed) {
            return removed.error();
        }
    }
    return std::move(found->known);
}

Result<intake::BatchImport> Batches::import(intake::RowSource& source, const spool::JobSpec& spec,
                                            const intake::ImportOptions& options) {
    earlier_.reset();
    Target target{*this};
    intake::GrownCheck grown{spec, [this](const auto& what) { return spool_.read(what); }};
    auto outcome = intake::import_source(source, target, spec, options.refuse_grown ? grown.in(options) : options);
    if (!outcome) {
        return outcome.error();
    }
    intake::BatchImport batch{std::move(outcome->report), std::move(outcome->job), {}};
    if (earlier_) {
        if (auto removed = spool_.remove_job(batch.job->id); !removed) {
            return removed.error();
        }
        batch.job.reset();
        batch.earlier = std::move(earlier_);
    } else if (batch.job) {
        records_ += batch.job->records.count().value();
    }
    return batch;
}

/// The job and its ticket: a job without is one that nobody would start. If its records are there already it begins to
/// go in the same step, before another import can give way to it.
Result<spool::Job> Batches::commit(spool::Spool& spool, spool::JobImport& job, const std::string& report) {
    auto committed = job.commit(report);
    if (!committed || again_) {
        const auto written = committed ? write_ticket(spool, *committed) : Result<void>{committed.error()};
        return written ? committed : written.error();
    }
    auto earlier = intake::earlier_job(spool, *committed);
    if (!earlier) {
        return earlier.error();
    }
    earlier_ = std::move(*earlier);
    const auto done = earlier_ ? spool.remove_job_step(committed->id) : Result<bool>{false};
    if (!done) {
        return done.error();
    }
    const auto written = earlier_ ? Result<void>{} : write_ticket(spool, *committed);
    return written ? committed : written.error();
}

Result<void> Batches::write_ticket(spool::Spool& spool, const spool::Job& job) {
    spool::Ticket ticket = ticket_;
    ticket.job = job.id;
    if (ticket.name.empty()) {
        ticket.name = std::filesystem::path{job.spec.source.path}.filename().string();
    }
    if (enqueue_) {
        const auto place = spool.last_place(ticket.printer);
        if (!place) {
            return place.error();
        }
        ticket.place = *place;
    }
    return spool.write_ticket(ticket);
}

Result<bool> Batches::adopt(const spool::Job& job) {
    return spool_.write([&](spool::Spool& spool) -> Result<bool> {
        const auto ticket = spool.ticket(job.id);
        if (!ticket || *ticket) {
            return ticket ? Result<bool>{false} : ticket.error();
        }
        const auto ledger = spool.ledger_state(job.id);
        if (!ledger || !ledger->segments().empty()) {
            return ledger ? Result<bool>{false} : ledger.error();
        }
        auto written = write_ticket(spool, job);
        return written ? Result<bool>{true} : written.error();
    });
}

} // namespace linefeed::service
