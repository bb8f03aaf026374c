#include "start_judge.hpp"

namespace linefeed::test {

std::string StartJudge::judge() {
    std::string problem = judge_failed_start();
    return problem.empty() ? judge_what_is_left() : problem;
}

std::string StartJudge::judge_after_exception() {
    return run_.misprint().empty() ? judge_what_is_left() : run_.misprint();
}

std::string StartJudge::judge_failed_start() {
    const auto& failure = run_.failure();
    if (!run_.misprint().empty()) {
        return run_.misprint();
    }
    if (!failure) {
        ++unharmed_;
        const bool done = run_.storage_failed_replies() == 0 && run_.tape() == RecordNumber{ShortRun::records};
        return done ? "" : "the feeder was told of a failure that nobody names";
    }
    if (failure->kind != FailureKind::storage || failure->message.size() < 20) {
        return "not a clean error: " + failure->message;
    }
    if (run_.storage_failed_replies() > 1) {
        return "the feeder was told " + std::to_string(run_.storage_failed_replies()) + " times";
    }
    return {};
}

std::string StartJudge::judge_what_is_left() {
    const DiskImage image = disk_.image(Survival::nothing, 0);
    const ShortRun then = run_;
    if (auto problem = judge_next_start(); !problem.empty()) {
        return "restarted: " + problem;
    }
    run_ = then;
    disk_.load(image);
    if (auto problem = judge_next_start(); !problem.empty()) {
        return "without power: " + problem;
    }
    return {};
}

std::string StartJudge::judge_next_start() {
    if (auto missing = run_.missing(); !missing.empty()) {
        return missing;
    }
    run_.start();
    if (run_.failure()) {
        return "does not go on: " + run_.failure()->message;
    }
    if (!run_.misprint().empty()) {
        return run_.misprint();
    }
    const RecordNumber last{ShortRun::records};
    if (run_.tape() != last || run_.claims().printed_through != last) {
        return "it ends at record " + std::to_string(run_.tape().value());
    }
    return run_.missing();
}

} // namespace linefeed::test
