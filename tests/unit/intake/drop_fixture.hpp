// A drop folder in a directory of its own, in virtual time: step() is given the time, so a test waits for nothing.
#pragma once

#include "intake/drop_folder.hpp"
#include "intake_fixture.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <sstream>

namespace linefeed::intake {

/// What a drop folder tells, as lines; can break off and crash.
class DropRecorder final : public DropEvents {
public:
    void finished(const DropReport& report) override {
        reports.push_back(report);
        lines.push_back(report.name + ": " + std::string{to_string(report.verdict)});
    }
    void importing(const std::string& name, bool left_over) override {
        if (left_over) {
            left_over_names.push_back(name);
        }
    }
    void note(const std::string& name, const std::string& words) override { notes.push_back(name + ": " + words); }
    bool progress(const std::string&, std::uint64_t, double) override {
        ++progress_calls;
        return !break_off;
    }
    void reached(DropStep step) override {
        if (on_step) {
            on_step(step);
        }
    }

    std::vector<DropReport> reports;
    std::vector<std::string> lines;
    std::vector<std::string> notes;
    std::vector<std::string> left_over_names;
    int progress_calls = 0;
    bool break_off = false;
    std::function<void(DropStep)> on_step;
};

class DropTest : public IntakeTest {
protected:
    void SetUp() override {
        IntakeTest::SetUp();
        settings.folder = directory / "in";
        settings.mode = WatchMode::inotify;
        std::filesystem::create_directory(settings.folder);
        start_spool();
    }
    void start_spool() {
        batches.reset();
        spool.reset();
        spool.emplace(spool::Spool::open(directory / "spool.db", {}).value());
        batches.emplace(*spool);
    }
    void start() {
        folder.reset();
        auto opened = DropFolder::open(settings, *batches, events);
        ASSERT_TRUE(opened.has_value()) << opened.error().message;
        folder.emplace(std::move(*opened));
    }
    /// As after a crash: nothing but the disk is left.
    void start_anew() {
        folder.reset();
        start_spool();
        start();
    }
    void drop(const std::string& name, const std::string& content = "name\nMeier\n") const {
        std::ofstream{settings.folder / name, std::ios::binary} << content;
    }
    /// Steps, the time jumping, until nothing is left to wait for. Returns the failure that ended it.
    std::optional<Failure> run() {
        for (int steps = 0; steps < 100'000; ++steps) {
            const auto next = folder->step(now);
            if (!next) {
                return next.error();
            }
            if (next->idle) {
                return std::nullopt;
            }
            now = next->more ? now : std::max(now, next->at);
        }
        ADD_FAILURE() << "the folder does not come to rest";
        return std::nullopt;
    }
    /// Steps for a time.
    void run_for(Duration time) {
        for (const Instant end = now + time; now < end; now += std::chrono::milliseconds{100}) {
            for (bool more = true; more;) {
                const auto next = folder->step(now);
                ASSERT_TRUE(next.has_value()) << next.error().message;
                more = next->more;
            }
        }
    }
    /// The names in a folder below the drop folder (or in itself), reports and the lock left out, in order.
    std::vector<std::string> names_in(const std::string& inner) const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator{settings.folder / inner}) {
            const std::string name = entry.path().filename();
            const bool other = name == "processing" || name == "done" || name == "failed" || name == ".lock";
            if (!other && !name.ends_with(".report.json")) {
                names.push_back(name);
            }
        }
        std::ranges::sort(names);
        return names;
    }
    nlohmann::json report_of(const std::string& place) const {
        std::ifstream file{settings.folder / (place + ".report.json")};
        std::stringstream text;
        text << file.rdbuf();
        return nlohmann::json::parse(text.str(), nullptr, false);
    }
    std::vector<std::string> staying() const {
        std::vector<std::string> lines;
        for (const auto& [name, why] : folder->staying()) {
            lines.push_back(name + ": " + why);
        }
        return lines;
    }
    std::size_t jobs() { return spool->jobs().value().size(); }

    DropSettings settings;
    DropRecorder events;
    std::optional<spool::Spool> spool;
    std::optional<SpoolBatches> batches;
    std::optional<DropFolder> folder;
    Instant now{std::chrono::hours{1}};
};

} // namespace linefeed::intake
