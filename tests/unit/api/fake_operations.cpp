#include "fake_operations.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

namespace linefeed::api {

using namespace daemon;

namespace {

constexpr std::int64_t some_time_ns = 1'795'000'000'123'456'789;

JobView some_job(std::int64_t id, std::string name, JobPhase phase) {
    JobView job;
    job.id = spool::JobId{id};
    job.name = std::move(name);
    job.source = "/srv/linefeed/" + job.name;
    job.phase = phase;
    job.records = RecordRange::closed(RecordNumber{1}, RecordNumber{5000});
    job.next = job.records;
    job.created_ns = some_time_ns;
    job.created_by = "anna (uid 1000)";
    return job;
}

Failure unknown(std::string what) {
    return {FailureKind::usage, "there is no " + std::move(what)};
}

std::string of_job(spool::JobId id) {
    return "job " + std::to_string(static_cast<std::int64_t>(id));
}

} // namespace

FakeOperations::FakeOperations() {
    PrinterView line1;
    line1.name = "line1";
    line1.address = "tcp://192.168.1.20:3000";
    line1.profile = "jet3up";
    line1.link = LinkState::up;
    line1.machine = "ready";
    line1.nozzle = "open";
    line1.serial_number = "12\xFF\"\n";
    line1.firmware = "6.1";
    line1.total_prints = 123456789;
    line1.error = {1223};
    line1.error_meaning = "last record printed";
    line1.queue = {spool::JobId{12}};
    line1.figures = {256, 200, 56, 812.5, 0.21, 0.25, 6.0};
    line1.warnings = {"the ink is low: order some"};
    line1.heard_ns = some_time_ns;
    PrinterView line2;
    line2.name = "Straße 2";
    line2.address = "tcp://192.168.1.21:3000";
    line2.profile = "jet3up";
    printers_ = {line1, line2};
    jobs_.emplace(spool::JobId{11}, some_job(11, "names\xE4.csv", JobPhase::finished));
    JobView queued = some_job(12, "codes.csv", JobPhase::queued);
    queued.printer = "line1";
    queued.layout = "names";
    queued.place = 1;
    queued.last_printed = RecordNumber{17};
    jobs_.emplace(queued.id, queued);
    jobs_.emplace(spool::JobId{13}, some_job(13, "lots.db", JobPhase::in_doubt));
    jobs_[spool::JobId{13}].in_doubt = RecordCount{3};
    jobs_[spool::JobId{13}].printer = "line1";
    add_event("job.imported", "codes.csv");
    add_event("job.queued", "at line1");
}

void FakeOperations::add_event(std::string kind, std::string message) {
    std::vector<std::function<void()>> subscribers;
    {
        const std::lock_guard lock{mutex_};
        EventView event;
        event.id = events_.size() + 1;
        event.time_ns = some_time_ns;
        event.kind = std::move(kind);
        event.printer = "line1";
        event.job = spool::JobId{12};
        event.message = std::move(message);
        events_.push_back(std::move(event));
        for (const auto& [id, subscriber] : subscribers_) {
            subscribers.push_back(subscriber);
        }
    }
    for (const auto& subscriber : subscribers) {
        subscriber();
    }
}

std::string FakeOperations::last_change() {
    return with_lock([&] {
        return audit_.empty() ? std::string{}
                              : audit_.back().who + ": " + audit_.back().what + ' ' + audit_.back().object;
    });
}

std::optional<ImportRequest> FakeOperations::last_import() {
    return with_lock([&] { return last_import_; });
}

std::uint64_t FakeOperations::last_import_bytes() {
    return with_lock([&] { return last_import_bytes_; });
}

ServiceStatus FakeOperations::status() {
    return {"0.1.0",
            some_time_ns,
            !with_lock([&] { return failure_.has_value(); }),
            {{"storage", Severity::ok, "the spool can be written", ""},
             {"printer line1", Severity::warning, "the ink is low", "order some"}},
            "SCHED_FIFO 50, memory locked"};
}

ServiceMetrics FakeOperations::metrics() {
    ServiceMetrics metrics;
    PrinterMetrics line1;
    line1.printer = "line1";
    line1.records_sent = 1000;
    line1.records_printed = 900;
    line1.lead_time = {{0.003, 0.03, 0.3}, {0, 10, 890, 0}, 90.5};
    line1.refill = {{0.001, 0.01}, {5, 5, 1}, 0.07};
    PrinterMetrics line2;
    line2.printer = "quoted \"line\"\\\n\xFF";
    metrics.printers = {line1, line2};
    metrics.intake_records = 5000;
    metrics.intake_files_imported = 2;
    metrics.ledger_commit = {{0.005, 0.05}, {7, 2, 0}, 0.04};
    return metrics;
}

std::vector<PrinterView> FakeOperations::printers() {
    return with_lock([&] { return printers_; });
}

std::optional<PrinterView> FakeOperations::printer(std::string_view name) {
    return with_lock([&]() -> std::optional<PrinterView> {
        const auto found =
            std::find_if(printers_.begin(), printers_.end(), [&](const PrinterView& p) { return p.name == name; });
        return found == printers_.end() ? std::nullopt : std::optional{*found};
    });
}

Result<void> FakeOperations::check_printer(std::string_view name) {
    return printer(name) ? Result<void>{} : Result<void>{unknown("printer " + std::string{name})};
}

Result<void> FakeOperations::check_job(spool::JobId id) {
    return with_lock([&] { return jobs_.contains(id) ? Result<void>{} : Result<void>{unknown(of_job(id))}; });
}

Result<void> FakeOperations::change(const Caller& caller, std::string what, std::string object) {
    while (held_) {
        std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    const std::lock_guard lock{mutex_};
    AuditView entry;
    entry.id = audit_.size() + 1;
    entry.time_ns = some_time_ns;
    entry.who = caller.name;
    entry.what = std::move(what);
    entry.object = std::move(object);
    entry.detail = "{}";
    entry.done = !failure_;
    audit_.push_back(entry);
    return failure_ ? Result<void>{*failure_} : Result<void>{};
}

Result<std::vector<Finding>> FakeOperations::preflight(std::string_view printer) {
    if (const auto known = check_printer(printer); !known) {
        return known.error();
    }
    if (auto failure = with_lock([&] { return failure_; })) {
        return *failure;
    }
    return std::vector<Finding>{{"reachable", Severity::ok, "the printer answers", ""},
                                {"nozzle", Severity::problem, "the nozzle is closed", "open it at the panel"}};
}

Result<std::vector<FrameView>> FakeOperations::frames(std::string_view printer, bool error) {
    if (const auto known = check_printer(printer); !known) {
        return known.error();
    }
    return std::vector<FrameView>{
        {some_time_ns, true, error ? "^0?RS\r" : "^0?SM\r", 6, {}},
        {some_time_ns + 1, false, std::string{"^0=SM256\t\x00\xFF\r", 12}, 12, {}},
        {some_time_ns + 2, true, "^0=MR17\tabc\r", 120, RecordRange::closed(RecordNumber{17}, RecordNumber{26})}};
}

Result<std::vector<JobView>> FakeOperations::jobs(const JobFilter& filter) {
    const std::lock_guard lock{mutex_};
    if (failure_) {
        return *failure_;
    }
    std::vector<JobView> found;
    for (auto job = jobs_.rbegin(); job != jobs_.rend() && found.size() < filter.limit; ++job) {
        const bool in_phase = filter.phases.empty() || std::find(filter.phases.begin(), filter.phases.end(),
                                                                 job->second.phase) != filter.phases.end();
        if (in_phase && (filter.printer.empty() || job->second.printer == filter.printer) &&
            (filter.after == spool::JobId{} || job->first < filter.after)) {
            found.push_back(job->second);
        }
    }
    return found;
}

Result<std::optional<JobView>> FakeOperations::job(spool::JobId id) {
    const std::lock_guard lock{mutex_};
    const auto found = jobs_.find(id);
    return found == jobs_.end() ? std::optional<JobView>{} : std::optional{found->second};
}

Result<DoubtView> FakeOperations::doubt(spool::JobId id) {
    if (const auto known = check_job(id); !known) {
        return known.error();
    }
    return DoubtView{{{RecordNumber{17}, {"Müller", "\xFF"}}, {RecordNumber{18}, {"", "b"}}}, RecordCount{3}, ""};
}

Result<std::vector<spool::HistoryStretch>> FakeOperations::history(spool::JobId id, RecordRange records) {
    if (const auto known = check_job(id); !known) {
        return known.error();
    }
    std::vector<spool::HistoryStretch> stretches;
    for (std::uint32_t first = 1; first < 500; first += 10) {
        const RecordRange range = RecordRange::closed(std::max(RecordNumber{first}, records.first()),
                                                      std::min(RecordNumber{first + 9}, records.last()));
        if (!range.empty()) {
            stretches.push_back({range, spool::RecordState::printed, spool::RunId{3}, some_time_ns, some_time_ns + 5,
                                 R"({"sm":[256,0,17,0,1]})"});
        }
    }
    return stretches;
}

Result<std::vector<spool::LedgerRow>> FakeOperations::ledger(spool::JobId id, std::int64_t after, std::size_t limit) {
    if (const auto known = check_job(id); !known) {
        return known.error();
    }
    std::vector<spool::LedgerRow> rows;
    for (std::int64_t sequence = after + 1; sequence <= 7 && rows.size() < limit; ++sequence) {
        rows.push_back(
            {sequence,
             id,
             {spool::LedgerKind::intent, spool::RunId{3}, RecordRange::closed(RecordNumber{1}, RecordNumber{9}), ""},
             some_time_ns,
             std::string(64, '0'),
             std::string(64, 'a')});
    }
    return rows;
}

Result<std::vector<DoubtView::Record>> FakeOperations::records(spool::JobId id, RecordRange records) {
    if (const auto known = check_job(id); !known) {
        return known.error();
    }
    std::vector<DoubtView::Record> found;
    for (std::uint64_t k = 0; k < records.count().value(); ++k) {
        found.push_back({records.first() + RecordCount{k}, {"serial " + std::to_string(k), "\xE4"}});
    }
    return found;
}

Result<std::int64_t> FakeOperations::verify_ledger() {
    const std::lock_guard lock{mutex_};
    return failure_ ? Result<std::int64_t>{*failure_} : Result<std::int64_t>{7};
}

std::vector<FolderView> FakeOperations::folders() {
    return {{"names",
             "/srv/linefeed/na\xFFmes",
             "line1",
             "names",
             false,
             "it is not there",
             {{"b\n.csv", "too large"}},
             5,
             1,
             2}};
}

Result<std::vector<EventView>> FakeOperations::events(std::uint64_t after, std::size_t limit) {
    const std::lock_guard lock{mutex_};
    std::vector<EventView> found;
    for (std::size_t k = std::max<std::size_t>(after, pruned_); k < events_.size() && found.size() < limit; ++k) {
        found.push_back(events_[k]);
    }
    return found;
}

Result<std::uint64_t> FakeOperations::last_event() {
    return with_lock([&] { return std::uint64_t{events_.size()}; });
}

std::uint64_t FakeOperations::subscribe(std::function<void()> on_events) {
    const std::lock_guard lock{mutex_};
    subscribers_.emplace(next_subscription_, std::move(on_events));
    return next_subscription_++;
}

void FakeOperations::unsubscribe(std::uint64_t subscription) {
    with_lock([&] { return subscribers_.erase(subscription); });
}

Result<std::vector<AuditView>> FakeOperations::audit(std::uint64_t after, std::size_t limit) {
    const std::lock_guard lock{mutex_};
    std::vector<AuditView> found;
    for (std::size_t k = after; k < audit_.size() && found.size() < limit; ++k) {
        found.push_back(audit_[k]);
    }
    return found;
}

Result<std::uint64_t> FakeOperations::last_audit() {
    return std::uint64_t{audit_size()};
}

Result<ImportAnswer> FakeOperations::import(const Caller& caller, const ImportRequest& request) {
    if (const auto changed = change(caller, "import", request.file.string()); !changed) {
        return changed.error();
    }
    std::ifstream file{request.file, std::ios::binary};
    if (!file) {
        return Failure{FailureKind::input, "cannot read " + request.file.string()};
    }
    std::uint64_t bytes = 0;
    std::string content;
    for (std::array<char, 65536> piece{}; file.read(piece.data(), piece.size()) || file.gcount() > 0;) {
        bytes += static_cast<std::uint64_t>(file.gcount());
        content.append(piece.data(), std::min<std::size_t>(static_cast<std::size_t>(file.gcount()), 1000));
    }
    const std::lock_guard lock{mutex_};
    last_import_ = request;
    last_import_bytes_ = bytes;
    if (content.starts_with("bad")) {
        return ImportAnswer{std::nullopt, false, R"({"rejected":[{"row":2,"why":"too long"}]})"};
    }
    const spool::JobId id{static_cast<std::int64_t>(jobs_.size()) + 11};
    const auto [known, is_new] = contents_.emplace(content, id);
    if (!is_new && !request.again) {
        return ImportAnswer{known->second, true, "{}"};
    }
    jobs_.emplace(id, some_job(static_cast<std::int64_t>(id), request.name, JobPhase::ready));
    return ImportAnswer{id, false, R"({"rows":5000})"};
}

Result<void> FakeOperations::enqueue(const Caller& caller, spool::JobId id, std::string_view printer) {
    const auto known = check_job(id);
    const auto changed = change(caller, "queue", of_job(id) + " at " + std::string{printer});
    return known ? changed : known;
}

Result<void> FakeOperations::start(const Caller& caller, spool::JobId id) {
    const auto known = check_job(id);
    const auto changed = change(caller, "start", of_job(id));
    return known ? changed : known;
}

Result<spool::JobId> FakeOperations::start_next(const Caller& caller, std::string_view printer) {
    const auto changed = change(caller, "start", "printer " + std::string{printer});
    return changed ? Result<spool::JobId>{spool::JobId{12}} : Result<spool::JobId>{changed.error()};
}

Result<void> FakeOperations::stop(const Caller& caller, std::string_view printer) {
    const auto known = check_printer(printer);
    const auto changed = change(caller, "stop", "printer " + std::string{printer});
    return known ? changed : known;
}

Result<void> FakeOperations::cancel(const Caller& caller, spool::JobId id) {
    const auto known = check_job(id);
    const auto changed = change(caller, "cancel", of_job(id));
    return known ? changed : known;
}

Result<void> FakeOperations::reprint(const Caller& caller, spool::JobId id, const ReprintRequest& request) {
    const auto known = check_job(id);
    const auto changed = change(caller, "reprint", of_job(id) + ' ' + request.records + ": " + request.reason);
    return known ? changed : known;
}

Result<void> FakeOperations::settle(const Caller& caller, spool::JobId id, const SettleRequest& request) {
    const auto known = check_job(id);
    const std::string word = request.policy ? (*request.policy == SettleRequest::Policy::skip ? "skip" : "reprint")
                             : request.last_printed ? "last " + *request.last_printed
                                                    : "printed " + request.printed.value_or("?");
    const auto changed = change(caller, "settle", of_job(id) + ' ' + word);
    return known ? changed : known;
}

Result<void> FakeOperations::acknowledge(const Caller& caller, std::string_view printer, std::uint32_t error) {
    const auto known = check_printer(printer);
    const auto changed = change(caller, "acknowledge", std::string{printer} + ' ' + std::to_string(error));
    return known ? changed : known;
}

Result<std::string> FakeOperations::inspect(std::string_view printer, std::string_view what,
                                            std::string_view arguments) {
    if (const auto known = check_printer(printer); !known) {
        return known.error();
    }
    return R"({"what":")" + std::string{what} + R"(","arguments":)" + std::string{arguments} + '}';
}

Result<std::string> FakeOperations::read_file(std::string_view printer, std::string_view path) {
    const auto known = check_printer(printer);
    return known ? Result<std::string>{"content of " + std::string{path}} : known.error();
}

Result<void> FakeOperations::write_file(const Caller& caller, std::string_view printer,
                                        const daemon::PrinterFile& file) {
    const auto known = check_printer(printer);
    return known ? change(caller, "write file",
                          std::string{printer} + ' ' + file.path + ' ' +
                              std::to_string(std::filesystem::file_size(file.content)) +
                              (file.replace ? " replaced" : ""))
                 : known.error();
}

Result<std::string> FakeOperations::command(const Caller& caller, std::string_view printer, std::string_view what,
                                            std::string_view arguments) {
    const auto known = check_printer(printer);
    const auto changed = change(caller, "command", std::string{printer} + ' ' + std::string{what});
    if (!known || !changed) {
        return known ? changed.error() : known.error();
    }
    return R"({"what":")" + std::string{what} + R"(","arguments":)" + std::string{arguments} + '}';
}

Result<void> FakeOperations::accept_printer(const Caller& caller, std::string_view printer,
                                            const std::string& serial_number) {
    const auto known = check_printer(printer);
    const auto changed = change(caller, "accept", std::string{printer} + ' ' + serial_number);
    return known ? changed : known;
}

Result<void> FakeOperations::suspend_panel(const Caller& caller, std::string_view printer, bool suspend,
                                           Duration hold) {
    const auto known = check_printer(printer);
    const auto changed = change(caller, suspend ? "suspend" : "give back",
                                std::string{printer} + ' ' +
                                    std::to_string(std::chrono::duration_cast<std::chrono::seconds>(hold).count()));
    return known ? changed : known;
}

Result<std::vector<std::string>> FakeOperations::reload(const Caller& caller) {
    if (const auto changed = change(caller, "reload", ""); !changed) {
        return changed.error();
    }
    return on_reload ? on_reload() : std::vector<std::string>{"http.max_body: 16 MiB, was 8 MiB"};
}

Result<std::optional<Operations::Remembered>> FakeOperations::remembered(const Caller& caller, std::string_view key) {
    const std::lock_guard lock{mutex_};
    if (remember_failure_) {
        return *remember_failure_;
    }
    const auto found = remembered_.find({caller.name, std::string{key}});
    return found == remembered_.end() ? std::optional<Remembered>{} : std::optional{found->second};
}

Result<void> FakeOperations::remember(const Caller& caller, std::string_view key, const Remembered& answer) {
    const std::lock_guard lock{mutex_};
    if (remember_failure_) {
        return *remember_failure_;
    }
    remembered_[{caller.name, std::string{key}}] = answer;
    return {};
}

} // namespace linefeed::api
