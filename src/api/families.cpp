#include "api/families.hpp"

#include "api/json_text.hpp"

#include <limits>

namespace linefeed::api {

namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

/// One family that is being filled; whole when it goes.
class Filler {
public:
    Filler(Families& families, std::string name, std::string help, MetricType type)
        : families_(families)
        , family_{std::move(name), std::move(help), type, {}} {}
    Filler(const Filler&) = delete;
    Filler& operator=(const Filler&) = delete;
    ~Filler() { families_.push_back(std::move(family_)); }

    void add(Labels labels, double value) {
        ClientMetric metric;
        metric.label = std::move(labels);
        if (family_.type == MetricType::Counter) {
            metric.counter.value = value;
        } else {
            metric.gauge.value = value;
        }
        family_.metric.push_back(std::move(metric));
    }

    void add(Labels labels, const daemon::HistogramView& view) {
        ClientMetric metric;
        metric.label = std::move(labels);
        for (std::size_t k = 0; k < view.counts.size(); ++k) {
            metric.histogram.sample_count += view.counts[k];
            metric.histogram.bucket.push_back(
                {metric.histogram.sample_count,
                 k < view.bounds_s.size() ? view.bounds_s[k] : std::numeric_limits<double>::infinity()});
        }
        metric.histogram.sample_sum = view.sum_s;
        family_.metric.push_back(std::move(metric));
    }

private:
    Families& families_;
    MetricFamily family_;
};

Labels of_printer(std::string_view name) {
    return {{"printer", visible(name)}};
}

double seconds(std::int64_t ns) {
    constexpr double ns_per_s = 1e9;
    return static_cast<double>(ns) / ns_per_s;
}

/// A gauge of every printer for which `value` gives one.
template <typename Value>
void printer_gauge(Families& families, const std::vector<daemon::PrinterView>& printers, const char* name,
                   const char* help, Value&& value) {
    Filler gauge{families, name, help, MetricType::Gauge};
    for (const daemon::PrinterView& printer : printers) {
        if (const std::optional<double> number = value(printer)) {
            gauge.add(of_printer(printer.name), *number);
        }
    }
}

/// A counter or histogram of every printer.
template <typename Value>
void printer_total(Families& families, const std::vector<daemon::PrinterMetrics>& printers, const char* name,
                   const char* help, MetricType type, Value&& value) {
    Filler filler{families, name, help, type};
    for (const daemon::PrinterMetrics& printer : printers) {
        filler.add(of_printer(printer.printer), value(printer));
    }
}

bool shows_error(const daemon::PrinterView& printer) {
    return !printer.error.none() && printer.error.display() == protocol::ErrorDisplay::error;
}

void add_service(Families& families, daemon::Operations& operations) {
    const daemon::ServiceStatus status = operations.status();
    Filler{families, "linefeed_build_info", "The running program.", MetricType::Gauge}.add(
        {{"version", visible(status.version)}, {"compiler", __VERSION__}}, 1);
    Filler{families, "linefeed_start_time_seconds", "When the service was started, since the Unix epoch.",
           MetricType::Gauge}
        .add({}, seconds(status.started_ns));
    Filler folders{families, "linefeed_folder_up", "Whether the drop folder can be used.", MetricType::Gauge};
    for (const daemon::FolderView& folder : operations.folders()) {
        folders.add({{"folder", visible(folder.name)}}, folder.works ? 1 : 0);
    }
}

void add_printer_states(Families& families, const std::vector<daemon::PrinterView>& printers) {
    using View = daemon::PrinterView;
    using Number = std::optional<double>;
    // An idle printer that nobody looks at is connected to nobody: that is no fault.
    const auto in_use = [](const View& v, bool good) {
        return v.phase == daemon::PrinterPhase::idle && !v.watched ? Number{} : Number{good ? 1 : 0};
    };
    printer_gauge(families, printers, "linefeed_printer_up",
                  "Whether the printer is connected and shows no error; none while it is idle and not watched.",
                  [&](const View& v) { return in_use(v, v.link == daemon::LinkState::up && !shows_error(v)); });
    printer_gauge(families, printers, "linefeed_printer_link_up",
                  "Whether the printer is connected; none while it is idle and not watched.",
                  [&](const View& v) { return in_use(v, v.link == daemon::LinkState::up); });
    printer_gauge(families, printers, "linefeed_printer_cover_open", "Whether the head cover is open.",
                  [](const View& v) { return v.cover_open ? Number{*v.cover_open ? 1 : 0} : Number{}; });
    printer_gauge(families, printers, "linefeed_printer_other_machine",
                  "Whether another machine answers than the one that jobs may start on.",
                  [](const View& v) -> Number { return v.other_machine() ? 1 : 0; });
    printer_gauge(families, printers, "linefeed_printer_printing", "Whether linefeed prints on it.",
                  [](const View& v) -> Number { return v.phase == daemon::PrinterPhase::printing ? 1 : 0; });
    printer_gauge(families, printers, "linefeed_printer_error_code", "The number of the pending error; 0 = none.",
                  [](const View& v) -> Number { return v.error.none() ? 0 : v.error.code(); });
    printer_gauge(families, printers, "linefeed_printer_fifo_entries", "Entries in the mailing FIFO as last reported.",
                  [](const View& v) -> Number { return v.figures.fifo_entries; });
    printer_gauge(families, printers, "linefeed_printer_fifo_depth_entries", "How many entries the mailing FIFO has.",
                  [](const View& v) -> Number { return v.figures.fifo_depth; });
    printer_gauge(families, printers, "linefeed_printer_credit_records", "Records that may still be sent.",
                  [](const View& v) -> Number { return v.figures.credit; });
    printer_gauge(families, printers, "linefeed_printer_print_rate_per_second", "Measured prints per second.",
                  [](const View& v) -> Number { return v.figures.rate_per_s; });
    printer_gauge(families, printers, "linefeed_printer_time_to_empty_seconds", "Until the FIFO runs dry, predicted.",
                  [](const View& v) { return v.figures.time_to_empty_s; });
    printer_gauge(families, printers, "linefeed_printer_data_left_seconds",
                  "Until the job, and what is chained behind it, is printed.",
                  [](const View& v) { return v.figures.data_left_s; });
    printer_gauge(families, printers, "linefeed_printer_queue_jobs", "Jobs in the queue.",
                  [](const View& v) -> Number { return static_cast<double>(v.queue.size()); });
}

void add_records(Families& families, const std::vector<daemon::PrinterMetrics>& printers) {
    Filler records{families, "linefeed_printer_records_total",
                   "Records by what became of them; those in doubt count when they come to be.", MetricType::Counter};
    for (const daemon::PrinterMetrics& printer : printers) {
        const auto outcome = [&](const char* name, std::uint64_t count) {
            Labels labels = of_printer(printer.printer);
            labels.push_back({"outcome", name});
            records.add(std::move(labels), static_cast<double>(count));
        };
        outcome("sent", printer.records_sent);
        outcome("printed", printer.records_printed);
        outcome("in_doubt", printer.records_in_doubt);
        outcome("unused", printer.records_unused);
    }
}

void add_printer_totals(Families& families, const std::vector<daemon::PrinterMetrics>& printers) {
    using Of = daemon::PrinterMetrics;
    const auto counter = [&](const char* name, const char* help, std::uint64_t Of::*member) {
        printer_total(families, printers, name, help, MetricType::Counter,
                      [member](const Of& of) { return static_cast<double>(of.*member); });
    };
    add_records(families, printers);
    counter("linefeed_printer_underruns_total", "How often the FIFO ran empty while the job had records.",
            &Of::underruns);
    counter("linefeed_printer_refills_total", "Refills of the FIFO.", &Of::refills);
    counter("linefeed_printer_links_lost_total", "Connections that were lost.", &Of::links_lost);
    counter("linefeed_printer_frames_unexpected_total", "Frames that nobody had asked for.", &Of::frames_unexpected);
    counter("linefeed_printer_damaged_bytes_total", "Bytes that were no frames.", &Of::bytes_damaged);
    printer_total(families, printers, "linefeed_printer_lead_time_seconds",
                  "From a record's being written to its print, as far as known.", MetricType::Histogram,
                  [](const Of& of) -> const daemon::HistogramView& { return of.lead_time; });
    printer_total(families, printers, "linefeed_printer_refill_seconds",
                  "From the answer that gave credit to the refill handed to the kernel.", MetricType::Histogram,
                  [](const Of& of) -> const daemon::HistogramView& { return of.refill; });
}

/// Jobs' records that wait for an operator, by printer.
void add_in_doubt(Families& families, daemon::Operations& operations,
                  const std::vector<daemon::PrinterView>& printers) {
    Filler gauge{families, "linefeed_printer_in_doubt_records", "Records of its jobs that wait for an operator's word.",
                 MetricType::Gauge};
    for (const daemon::PrinterView& printer : printers) {
        daemon::JobFilter filter{printer.name, {daemon::JobPhase::in_doubt}, {}, 1000};
        if (const auto jobs = operations.jobs(filter)) {
            RecordCount records;
            for (const daemon::JobView& job : *jobs) {
                records += job.in_doubt;
            }
            gauge.add(of_printer(printer.name), static_cast<double>(records.value()));
        }
    }
}

void add_intake(Families& families, const daemon::ServiceMetrics& metrics) {
    Filler{families, "linefeed_intake_records_total", "Records imported.", MetricType::Counter}.add(
        {}, static_cast<double>(metrics.intake_records));
    Filler files{families, "linefeed_intake_files_total", "Files by what became of them.", MetricType::Counter};
    files.add({{"verdict", "imported"}}, static_cast<double>(metrics.intake_files_imported));
    files.add({{"verdict", "duplicate"}}, static_cast<double>(metrics.intake_files_duplicate));
    files.add({{"verdict", "failed"}}, static_cast<double>(metrics.intake_files_failed));
    Filler{families, "linefeed_ledger_commit_seconds", "Until a commit of the ledger was durable.",
           MetricType::Histogram}
        .add({}, metrics.ledger_commit);
}

} // namespace

Families service_families(daemon::Operations& operations) {
    Families families;
    const std::vector<daemon::PrinterView> printers = operations.printers();
    const daemon::ServiceMetrics metrics = operations.metrics();
    add_service(families, operations);
    add_printer_states(families, printers);
    add_in_doubt(families, operations, printers);
    add_printer_totals(families, metrics.printers);
    add_intake(families, metrics);
    return families;
}

} // namespace linefeed::api
