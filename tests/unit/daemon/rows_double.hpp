// A source of rows that the test has in its hand: it gives the rows that are there, waits for more, breaks off.
#pragma once

#include "intake/row_source.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace linefeed::daemon {

/// Flow: give() and end() or break_off(), from another thread than that which reads.
class RowsDouble {
public:
    /// Rows with one field, "row 1", "row 2" …; with an empty problem they are good.
    void give(std::uint64_t count, const std::string& problem = {}) {
        const std::lock_guard lock{mutex_};
        problems_.insert(problems_.end(), count, problem);
        changed_.notify_all();
    }
    void end() { finish({}); }
    void break_off(const std::string& why) { finish(Failure{FailureKind::input, why}); }

    /// Blocks until so many rows, which have been given, are read.
    void wait_until_read(std::size_t count) {
        std::unique_lock lock{mutex_};
        changed_.wait(lock, [&] { return read_ >= count; });
    }

    /// To be read by one thread; the double must outlive it.
    [[nodiscard]] std::unique_ptr<intake::RowSource> source() { return std::make_unique<Source>(*this); }

private:
    class Source final : public intake::RowSource {
    public:
        explicit Source(RowsDouble& rows)
            : rows_(rows) {}

        Result<bool> next(intake::Row& row) override {
            std::unique_lock lock{rows_.mutex_};
            rows_.changed_.wait(lock, [this] { return at_ < rows_.problems_.size() || rows_.over_; });
            if (at_ == rows_.problems_.size()) {
                return rows_.failure_ ? Result<bool>{*rows_.failure_} : Result<bool>{false};
            }
            row.problem = rows_.problems_[at_++];
            rows_.read_ = at_;
            rows_.changed_.notify_all();
            row.line = at_;
            text_ = "row " + std::to_string(at_);
            row.fields = row.problem.empty() ? std::vector<std::string_view>{text_} : std::vector<std::string_view>{};
            return true;
        }
        const std::vector<std::string>& column_names() const override { return names_; }
        double progress() const override { return 0.5; }
        std::uint64_t most_rows() const override { return 1'000'000; }

    private:
        RowsDouble& rows_;
        std::size_t at_ = 0;
        std::string text_;
        std::vector<std::string> names_{"name"};
    };

    void finish(std::optional<Failure> failure) {
        const std::lock_guard lock{mutex_};
        failure_ = std::move(failure);
        over_ = true;
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::string> problems_;
    std::size_t read_ = 0;
    std::optional<Failure> failure_;
    bool over_ = false;
};

} // namespace linefeed::daemon
