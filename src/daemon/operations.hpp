// What people and programs can ask of the service: one interface for the command line, HTTP and the tests of both.
// Names and texts of files and printers are raw bytes here; whoever shows them escapes them.
#pragma once

#include "base/failure.hpp"
#include "base/record_number.hpp"
#include "base/time.hpp"
#include "protocol/printer_error.hpp"
#include "spool/job.hpp"
#include "spool/ledger.hpp"
#include "spool/ledger_history.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::daemon {

/// Who asks. It stands in the audit log and, where he decides about records, in the ledger.
struct Caller {
    std::string name; ///< "anna (uid 1000)", "token mes", "folder line1", "linefeedd"
};

/// Where a job stands, see the design, section 5.
enum class JobPhase {
    importing, ///< its records are still being read
    ready,     ///< complete; in no queue
    queued,    ///< waits in the queue of its printer
    arming,    ///< preflight, flush, stop point, first fill
    printing,
    stopping,  ///< the line is being stopped and the truth found out
    stopped,   ///< can be resumed
    in_doubt,  ///< an operator must decide about records first
    finished,  ///< every record is printed, or was left out by an operator
    cancelled, ///< by an operator; what was printed stays in the ledger
    failed,    ///< its source could not be read to the end, and nothing of it is printed
};
[[nodiscard]] std::string_view to_string(JobPhase phase);

struct JobView {
    spool::JobId id{};
    std::string name;    ///< the file's
    std::string source;  ///< its path
    std::string printer; ///< empty = belongs to none yet
    std::string layout;  ///< name in the settings; empty = given with the import
    JobPhase phase = JobPhase::ready;
    std::string message; ///< why it stands, and what to do; one line, may be empty
    bool autostart = false;
    std::optional<std::uint32_t> place; ///< in its printer's queue, from 1
    RecordRange records;
    RecordCount printed;
    RecordCount in_doubt;
    RecordCount open;    ///< issued, fate not known yet
    RecordCount skipped; ///< in doubt, and not printed again
    std::optional<RecordNumber> last_printed;
    RecordRange next;            ///< what would be printed next; empty = nothing
    std::int64_t created_ns = 0; ///< wall time since the Unix epoch
    std::string created_by;      ///< Caller::name
};

/// Records in doubt with what is printed on them.
struct DoubtView {
    struct Record {
        RecordNumber number;
        std::vector<std::string> fields; ///< UTF-8
    };
    std::vector<Record> records; ///< the first of them
    RecordCount count;
    /// Why the last product does not tell which of them are printed; empty = it does.
    std::string hole;
    std::int64_t as_of = 0; ///< what of the ledger is seen here: for SettleRequest
};

enum class LinkState { down, connecting, up };
[[nodiscard]] std::string_view to_string(LinkState state);

enum class PrinterPhase {
    idle,     ///< nothing is being printed by linefeed
    checking, ///< preflight
    arming,
    printing,
    stopping,
};
[[nodiscard]] std::string_view to_string(PrinterPhase phase);

/// Quantiles are not kept here: histograms go to the metrics.
struct PrinterFigures {
    std::uint32_t fifo_depth = 0;          ///< entries, as `=SM` reports it
    std::uint32_t fifo_entries = 0;        ///< last reported
    std::uint32_t credit = 0;              ///< records that may still be sent
    double rate_per_s = 0;                 ///< measured print rate
    std::optional<double> lead_time_s;     ///< from the newest sent record's arrival to its PrintGo, predicted
    std::optional<double> time_to_empty_s; ///< of the FIFO
    std::optional<double> data_left_s;     ///< of the job and what is chained behind it
};

struct PrinterView {
    std::string name;
    std::string address; ///< tcp://…
    std::string profile;
    LinkState link = LinkState::down;
    bool watched = false; ///< looked at also while idle: `link` is by the last look then
    PrinterPhase phase = PrinterPhase::idle;
    std::string machine; ///< state in words as last reported; empty = never heard of
    std::string nozzle;  ///< in words; empty = never heard of
    std::optional<bool> cover_open;
    std::string serial_number;       ///< `?VS`; empty = never heard of
    std::string known_serial_number; ///< of the machine that jobs may start on; empty = whichever answers first
    std::string firmware;
    std::string probe;          ///< what the last probe found, JSON; empty = not probed since it is this machine
    std::int64_t probed_ns = 0; ///< wall time
    std::optional<std::uint64_t> total_prints; ///< `?CC`
    protocol::PrinterError error{};            ///< pending, as last reported
    std::string error_meaning;                 ///< of the table of error numbers; empty = not listed
    std::string error_advice;
    bool panel_suspended = false;    ///< `!US` is held
    std::optional<spool::JobId> job; ///< that which is armed or printed
    std::vector<spool::JobId> queue; ///< in order
    bool autostart = false;
    PrinterFigures figures;
    std::vector<std::string> warnings; ///< one line each: what and what to do
    std::int64_t heard_ns = 0;         ///< wall time of the last frame; 0 = never
    /// An operator has stopped it, or a job waited there before the service was started: nothing starts by itself until
    /// somebody starts a job.
    bool held = false;

    /// Not the one that jobs may start on.
    [[nodiscard]] bool other_machine() const {
        return !known_serial_number.empty() && !serial_number.empty() && known_serial_number != serial_number;
    }
};

enum class Severity { ok, warning, problem };
[[nodiscard]] std::string_view to_string(Severity severity);

/// One line of a preflight or of the doctor.
struct Finding {
    std::string check; ///< a stable name: "reachable", "identity", "ready", "cover", "errors", "job_file", …
    Severity severity = Severity::ok;
    std::string words;  ///< what was found
    std::string advice; ///< what to do; empty if ok
};

/// A frame of a conversation; or consecutive mail records that went out together; or bytes that are no frame.
struct FrameView {
    std::int64_t time_ns = 0; ///< wall time
    bool sent = false;        ///< by linefeed
    std::string bytes;        ///< raw; at most 128 of them; of several records, the first one's; none: no frame
    std::uint32_t size = 0;   ///< of the whole frame with its CR, or of all the records
    RecordRange records{};    ///< not empty: the numbers of the mail records, all of which this entry stands for
    std::uint64_t id = 0;     ///< its place in the conversation, both ways counted together
};

struct EventView {
    std::uint64_t id = 0; ///< ascending, without end, also over restarts
    std::int64_t time_ns = 0;
    /// "job.queued", "job.started", "job.finished", "printer.error", "printer.warning", "folder.imported", … : what
    /// stands in events.hpp
    std::string kind;
    std::string printer; ///< may be empty
    std::optional<spool::JobId> job;
    std::optional<RecordNumber> record;
    std::string message; ///< one line
};

struct AuditView {
    std::uint64_t id = 0;
    std::int64_t time_ns = 0;
    std::string who;
    std::string what;   ///< "start", "stop", "reprint", …
    std::string object; ///< "printer line1", "job 12"
    std::string detail; ///< JSON of what was asked; one line
    bool done = true;   ///< false: refused, and why stands in detail
};

struct FolderView {
    std::string name;
    std::filesystem::path path;
    std::string printer;
    std::string layout;
    bool works = true;
    std::string message; ///< why not, or what it waits for
    struct Staying {
        std::string name;
        std::string why;
    };
    std::vector<Staying> staying; ///< the first of them
    std::uint64_t imported = 0;   ///< since the start
    std::uint64_t duplicates = 0;
    std::uint64_t failed = 0;
};

struct ImportRequest {
    std::filesystem::path file{}; ///< absolute; readable by the service
    std::string name{};           ///< shown instead of the file's own, e.g. of an upload; empty = the file's
    std::string layout{};         ///< name in the settings; empty = the default layout
    std::string printer{};        ///< queue it there; empty = no queue
    bool autostart = false;       ///< may start by itself if its printer's queue does so too
    bool again = false;           ///< import the same content once more, as a new job
    bool sent = false;            ///< came as a body: what lies beside it belongs to others
};

struct ImportAnswer {
    std::optional<spool::JobId> job;
    bool duplicate = false; ///< it was there already
    std::string report;     ///< JSON of intake::ImportReport: the rows that are bad
};

/// What an operator knows about records in doubt: exactly one is given. See daemon/operator_word.hpp for what is
/// refused.
struct SettleRequest {
    enum class Policy { skip, reprint };
    std::optional<Policy> policy{};
    std::optional<std::string> last_printed{}; ///< number or text of the record on the last product
    std::optional<std::string> printed{};      ///< "N-M,N" or "none"
    /// DoubtView::as_of of what the operator has seen: refused if anything else is in doubt by now. Absent = what is in
    /// doubt now, whatever that is.
    std::optional<std::int64_t> as_of{};
};

struct ReprintRequest {
    std::string records{}; ///< "N-M,N"
    std::string reason{};  ///< not empty
};

struct JobFilter {
    std::string printer{};          ///< empty = all
    std::vector<JobPhase> phases{}; ///< empty = all
    spool::JobId after{};           ///< newest first: those older than this one; 0 = from the newest
    std::size_t limit = 100;        ///< 1…1000
};

struct ServiceStatus {
    std::string version;
    std::int64_t started_ns = 0;
    bool ready = false;
    std::vector<Finding> checks; ///< storage, feed thread, folders, each printer: what /readyz?verbose shows
    std::string real_time;       ///< what the operating system granted, for people
};

struct HistogramView {
    std::vector<double> bounds_s;      ///< upper bounds, ascending
    std::vector<std::uint64_t> counts; ///< one more than bounds_s: the last one holds what is above; not cumulative
    double sum_s = 0;
};

/// All since the start of the service.
struct PrinterMetrics {
    std::string printer;
    std::uint64_t records_sent = 0;
    std::uint64_t records_printed = 0;
    std::uint64_t records_in_doubt = 0; ///< that came to be in doubt
    std::uint64_t records_unused = 0;
    std::uint64_t underruns = 0; ///< the FIFO ran empty while the job had records
    std::uint64_t refills = 0;
    std::uint64_t links_lost = 0;
    std::uint64_t frames_unexpected = 0;
    std::uint64_t bytes_damaged = 0;
    HistogramView lead_time; ///< per record reported printed: from its being written to its print, as far as known
    HistogramView refill;    ///< from the answer that gave credit to the refill handed to the kernel
};

struct ServiceMetrics {
    std::vector<PrinterMetrics> printers;
    std::uint64_t intake_records = 0;
    std::uint64_t intake_files_imported = 0;
    std::uint64_t intake_files_duplicate = 0;
    std::uint64_t intake_files_failed = 0;
    HistogramView ledger_commit;
};

/// A file that goes to a printer.
struct PrinterFile {
    std::string path{};              ///< in the printer
    std::filesystem::path content{}; ///< a file of ours
    bool replace = false;            ///< one of that name
};

/// Any thread but the feed and the store thread; calls may wait for the store. FailureKind::usage = the request is
/// wrong (unknown name, wrong phase), with what to do instead; ::stopped = it conflicts with what goes on.
class Operations {
public:
    virtual ~Operations() = default;

    [[nodiscard]] virtual ServiceStatus status() = 0;

    [[nodiscard]] virtual ServiceMetrics metrics() = 0;

    [[nodiscard]] virtual std::vector<PrinterView> printers() = 0;
    [[nodiscard]] virtual std::optional<PrinterView> printer(std::string_view name) = 0;
    /// Asks the printer; takes as long as it needs to answer.
    [[nodiscard]] virtual Result<std::vector<Finding>> preflight(std::string_view printer) = 0;
    /// The last frames each way, oldest first; of the last error if there was one and `error`.
    [[nodiscard]] virtual Result<std::vector<FrameView>> frames(std::string_view printer, bool error) = 0;

    /// What can be seen of the printer itself: carries out the look of this name (printer/tasks.hpp). `arguments` is a
    /// JSON object, empty = none; so is the answer. Asks the printer, over a connection of its own.
    [[nodiscard]] virtual Result<std::string> inspect(std::string_view printer, std::string_view what,
                                                      std::string_view arguments) = 0;

    /// The content of a file of the printer; empty also if there is none.
    [[nodiscard]] virtual Result<std::string> read_file(std::string_view printer, std::string_view path) = 0;

    [[nodiscard]] virtual Result<std::vector<JobView>> jobs(const JobFilter& filter) = 0;
    [[nodiscard]] virtual Result<std::optional<JobView>> job(spool::JobId id) = 0;
    [[nodiscard]] virtual Result<DoubtView> doubt(spool::JobId id) = 0;

    /// What is printed on records of a job, ascending; those that it does not have are left out. At most 1000 at once.
    [[nodiscard]] virtual Result<std::vector<DoubtView::Record>> records(spool::JobId id, RecordRange records) = 0;
    /// Records of a job with their fate, ascending. At most 1001 stretches at once; what follows them is asked for
    /// next.
    [[nodiscard]] virtual Result<std::vector<spool::HistoryStretch>> history(spool::JobId id, RecordRange records) = 0;
    [[nodiscard]] virtual Result<std::vector<spool::LedgerRow>> ledger(spool::JobId id, std::int64_t after,
                                                                       std::size_t limit) = 0;
    /// How many rows the chain has; the failure names the first wrong one.
    [[nodiscard]] virtual Result<std::int64_t> verify_ledger() = 0;

    [[nodiscard]] virtual std::vector<FolderView> folders() = 0;
    /// Those after `after`, ascending; at most `limit`.
    [[nodiscard]] virtual Result<std::vector<EventView>> events(std::uint64_t after, std::size_t limit) = 0;
    /// The id of the newest event; 0 = there is none.
    [[nodiscard]] virtual Result<std::uint64_t> last_event() = 0;
    /// Called, on any thread and without blocking, when there are events; the returned number ends it.
    [[nodiscard]] virtual std::uint64_t subscribe(std::function<void()> on_events) = 0;
    /// When it returns, the subscriber is not called any more.
    virtual void unsubscribe(std::uint64_t subscription) = 0;
    [[nodiscard]] virtual Result<std::vector<AuditView>> audit(std::uint64_t after, std::size_t limit) = 0;
    /// The id of the newest line; 0 = there is none.
    [[nodiscard]] virtual Result<std::uint64_t> last_audit() = 0;

    // What changes something. Each leaves a line in the audit log, also where it is refused.
    /// Returns when the file is read to its end, or will not be opened again: an upload is removed then.
    [[nodiscard]] virtual Result<ImportAnswer> import(const Caller& caller, const ImportRequest& request) = 0;
    /// Behind the last of that printer's queue. A job that has printed belongs to its printer.
    [[nodiscard]] virtual Result<void> enqueue(const Caller& caller, spool::JobId id, std::string_view printer) = 0;
    /// Starts, or goes on with, a job that is ready, queued or stopped; returns once the start has begun. The
    /// preflight's findings are events, and JobView::message.
    [[nodiscard]] virtual Result<void> start(const Caller& caller, spool::JobId id) = 0;
    /// The first of the printer's queue. As start(), it ends what stop() has begun.
    [[nodiscard]] virtual Result<spool::JobId> start_next(const Caller& caller, std::string_view printer) = 0;
    /// Stops what the printer prints, and returns when the truth is in the ledger. From now on nothing starts there by
    /// itself, until somebody starts a job; also after a restart.
    [[nodiscard]] virtual Result<void> stop(const Caller& caller, std::string_view printer) = 0;
    /// Not while it prints. It leaves its queue.
    [[nodiscard]] virtual Result<void> cancel(const Caller& caller, spool::JobId id) = 0;
    /// Printed or skipped records are to be printed again: the job becomes stopped, with those records next.
    [[nodiscard]] virtual Result<void> reprint(const Caller& caller, spool::JobId id,
                                               const ReprintRequest& request) = 0;
    [[nodiscard]] virtual Result<void> settle(const Caller& caller, spool::JobId id, const SettleRequest& request) = 0;
    /// `!EQ`, if that error (PrinterError::code()) is what the printer still shows.
    [[nodiscard]] virtual Result<void> acknowledge(const Caller& caller, std::string_view printer,
                                                   std::uint32_t error) = 0;
    /// From now on jobs may start on the machine with this serial number, if that is what the printer says.
    [[nodiscard]] virtual Result<void> accept_printer(const Caller& caller, std::string_view printer,
                                                      const std::string& serial_number) = 0;
    /// `!US`, held until it is taken back, the service ends or nobody has asked again for `hold`.
    [[nodiscard]] virtual Result<void> suspend_panel(const Caller& caller, std::string_view printer, bool suspend,
                                                     Duration hold) = 0;
    /// Does something to the printer: carries out the change of this name (printer/tasks.hpp), as inspect() a look.
    /// FailureKind::stopped: not while a job is on the line, for what disturbs the feeding or loses what is in the
    /// printer; and nothing that empties the FIFO while the fate of records in it is open.
    [[nodiscard]] virtual Result<std::string> command(const Caller& caller, std::string_view printer,
                                                      std::string_view what, std::string_view arguments) = 0;
    /// Writes a file of the printer. FailureKind::stopped: it would be replaced, and a job is on the line.
    [[nodiscard]] virtual Result<void> write_file(const Caller& caller, std::string_view printer,
                                                  const PrinterFile& file) = 0;
    /// As SIGHUP: what has changed, one line each.
    [[nodiscard]] virtual Result<std::vector<std::string>> reload(const Caller& caller) = 0;

    /// The answer that was given to this key before, if any: a request that comes twice is carried out once. Durable
    /// for 24 hours.
    struct Remembered {
        std::string request_hash;
        int status = 0;
        std::string body;
    };
    [[nodiscard]] virtual Result<std::optional<Remembered>> remembered(const Caller& caller, std::string_view key) = 0;
    /// Durable at return; replaces what was remembered of this caller and key.
    [[nodiscard]] virtual Result<void> remember(const Caller& caller, std::string_view key,
                                                const Remembered& answer) = 0;
};

} // namespace linefeed::daemon
