// Power fails at every write, truncation, deletion and sync of a spool's life, and what was not synced is lost, kept or
// torn in several ways each time. What is found afterwards must open and be the world before or after the call in
// progress. A part of them loses power again while the spool is being opened, and after it has gone on.
#include "life.hpp"
#include "long_tests.hpp"
#include "scratch_directory.hpp"
#include "support/crash_vfs.hpp"
#include "world.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <sstream>

namespace linefeed::test {
namespace {

/// What the spool may say: `before`, or `after`.
struct Expected {
    const World& before;
    const World& after;
};

/// Lives lives, and looks at what a power failure leaves of them.
class Judge {
public:
    /// Lives one life; at every `stride`-th change the power fails in `variants` ways. On a `lying` disk nothing is
    /// ever synced, though it says so.
    void live(std::uint64_t seed, std::uint64_t stride, std::uint64_t variants, bool large_import, bool lying = false) {
        CrashVfs disk{"power-loss-original"};
        disk.set_ignores_syncs(lying);
        Life life{life_path_, disk.name(), seed};
        chance_ = Chance{seed ^ 0xC0FFEE};
        std::uint64_t change = 0;
        disk.before_change = [&](DiskCall) {
            if (!problem_.empty() || ++change % stride != 0) {
                return;
            }
            ++changes_;
            for (std::uint64_t variant = 0; variant < variants && problem_.empty(); ++variant) {
                const Survival survival = all_survivals[(change + variant) % std::size(all_survivals)];
                const std::string place = "seed " + std::to_string(seed) + ", change " + std::to_string(change) +
                                          ", variant " + std::to_string(variant);
                check(disk.image(survival, chance_.next()), {life.before(), life.after()}, place);
            }
        };
        const auto lived = large_import ? life.run_large_import() : life.run();
        disk.before_change = nullptr;
        if (!lived) {
            say("seed " + std::to_string(seed), lived.error().message);
        } else if (problem_.empty()) {
            check(disk.image(Survival::nothing, 0), {life.after(), life.after()}, "the end");
        }
    }

    /// Empty = everything was right.
    [[nodiscard]] const std::string& problem() const { return problem_; }
    [[nodiscard]] std::uint64_t changes() const { return changes_; }

    void print_figures() const {
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
        std::cout << "power failures: " << crashes_ << " at " << changes_ << " changes (" << crashes_while_opening_
                  << " of them while opening again, " << crashes_after_going_on_ << " after going on), "
                  << seconds.count() << " s\n";
    }

private:
    /// Opens what survived and compares.
    void check(const DiskImage& image, const Expected& expected, const std::string& place) {
        copy_.load(renamed(image));
        std::optional<DiskImage> again;
        if (chance_.below(4) == 0) {
            copy_.before_change = [this, &again, left = chance_.below(30)](DiskCall) mutable {
                if (left-- == 0) {
                    again = some_image();
                }
            };
        }
        const std::optional<World> world = open_and_observe(expected, place);
        if (world && again) {
            ++crashes_while_opening_;
            copy_.load(*again);
            if (!open_and_observe({*world, *world}, place + ", and again while opening")) {
                return;
            }
        }
        if (world && !world->jobs.empty() && chance_.below(4) == 0) {
            go_on(*world, place);
        }
    }

    /// A row that is acknowledged after the recovery survives the next power failure.
    void go_on(World world, const std::string& place) {
        std::optional<DiskImage> image;
        {
            auto spool = open_copy();
            const auto& [job, what] = *world.jobs.begin();
            const auto run = spool ? spool->begin_run(job, what.records, "{}") : Result<spool::RunId>{spool.error()};
            if (!run) {
                say(place + ", going on", run.error().message);
                return;
            }
            world.rows.push_back({job, {spool::LedgerKind::run_started, *run, what.records, "{}"}});
            image = some_image();
            copy_.kill();
        }
        ++crashes_after_going_on_;
        copy_.load(*image);
        static_cast<void>(open_and_observe({world, world}, place + ", and again after going on"));
    }

    /// Absent if it is not as expected, which is then the problem. Nothing is open afterwards.
    [[nodiscard]] std::optional<World> open_and_observe(const Expected& expected, const std::string& place) {
        ++crashes_;
        auto spool = open_copy();
        copy_.before_change = nullptr;
        const auto world = spool ? observe(*spool) : Result<World>{spool.error()};
        copy_.kill(); // closing writes, too: the life itself covers that
        if (!world) {
            say(place, world.error().message);
            return std::nullopt;
        }
        if (*world != expected.before && *world != expected.after) {
            std::ostringstream text;
            text << "found\n" << *world << "\ninstead of\n" << expected.before << "\nor\n" << expected.after;
            say(place, text.str());
            return std::nullopt;
        }
        if (const std::string found = integrity(path_, copy_.name()); found != "ok") {
            say(place, found);
            return std::nullopt;
        }
        return *world;
    }

    void say(const std::string& place, const std::string& what) {
        if (problem_.empty()) {
            problem_ = place + ": " + what;
        }
    }

    [[nodiscard]] Result<spool::Spool> open_copy() {
        return spool::Spool::open(path_, {[] { return std::int64_t{1}; }, copy_.name()});
    }

    /// Only one spool at a time may be open at one path: the lock is a real file.
    [[nodiscard]] DiskImage renamed(const DiskImage& image) const {
        DiskImage files;
        for (const auto& [name, content] : image) {
            files[path_ + name.substr(life_path_.size())] = content;
        }
        return files;
    }

    [[nodiscard]] DiskImage some_image() {
        return copy_.image(all_survivals[chance_.below(std::size(all_survivals))], chance_.next());
    }

    ScratchDirectory scratch_{"power-loss"};
    CrashVfs copy_{"power-loss-copy"}; ///< where what survived is opened
    const std::string path_ = scratch_.path() / "copy.db";
    const std::string life_path_ = scratch_.path() / "life.db";
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    Chance chance_{0};
    std::string problem_;
    std::uint64_t changes_ = 0;
    std::uint64_t crashes_ = 0;
    std::uint64_t crashes_while_opening_ = 0;
    std::uint64_t crashes_after_going_on_ = 0;
};

TEST(PowerLoss, shouldLeaveEverythingAcknowledgedAfterEveryChange) {
    Judge judge;
    const std::uint64_t wanted = long_tests() ? 100'000 : 600;
    const std::uint64_t variants = long_tests() ? 3 : 5;
    for (std::uint64_t seed = 1; judge.changes() < wanted && judge.problem().empty(); ++seed) {
        judge.live(seed, 1, variants, false);
    }
    judge.print_figures();
    EXPECT_EQ(judge.problem(), "");
}

TEST(PowerLoss, shouldLeaveAnImportOfManyTransactionsWholeOrNotAtAll) {
    Judge judge;
    judge.live(1, long_tests() ? 37 : 1009, 5, true);
    judge.print_figures();
    EXPECT_EQ(judge.problem(), "");
}

/// The judge can fail: it notices a disk that does not do what it was told.
TEST(PowerLoss, shouldBeNoticedOnADiskThatDoesNotSync) {
    Judge judge;
    judge.live(1, 1, 5, false, true);
    EXPECT_NE(judge.problem(), "");
}

} // namespace
} // namespace linefeed::test
