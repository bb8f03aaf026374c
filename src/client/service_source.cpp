#include "client/command.hpp"
#include "client/job_source.hpp"

#include <algorithm>
#include <limits>

namespace linefeed::client {

namespace {

std::string records_of(RecordRange range) {
    return std::to_string(range.first().value()) + '-' + std::to_string(range.last().value());
}

class ServiceSource final : public JobSource {
public:
    explicit ServiceSource(const ServicePlace& place)
        : service_(place) {}

    Result<std::vector<Json>> jobs(const JobQuery& query) override {
        constexpr std::size_t page = 1000;
        std::string phases;
        for (const std::string& phase : query.phases) {
            phases += (phases.empty() ? "&phase=" : ",") + api::url_encoded(phase);
        }
        return service_.list("/api/v1/jobs?limit=" + std::to_string(std::clamp<std::size_t>(query.limit, 1, page)) +
                                 (query.printer.empty() ? "" : "&printer=" + api::url_encoded(query.printer)) + phases,
                             query.limit);
    }

    Result<Json> job(std::int64_t id) override { return service_.get(job_path(id)); }

    Result<std::vector<Json>> history(std::int64_t id, std::optional<RecordRange> records) override {
        return service_.list(job_path(id, "/ledger?limit=1000") + (records ? "&records=" + records_of(*records) : ""),
                             std::numeric_limits<std::size_t>::max());
    }

    Result<void> records(std::int64_t id, RecordRange records,
                         const std::function<bool(const Json&)>& on_record) override {
        return service_.each(job_path(id, "/records?limit=1000&records=") + records_of(records), on_record);
    }

    Result<std::int64_t> verify() override {
        const auto verified = service_.post("/api/v1/ledger/verify");
        if (!verified) {
            return verified.error();
        }
        return number(*verified, "rows");
    }

private:
    Service service_;
};

} // namespace

std::unique_ptr<JobSource> service_source(const ServicePlace& place) {
    return std::make_unique<ServiceSource>(place);
}

Result<std::unique_ptr<JobSource>> open_job_source(const JobSourceOptions& options) {
    const auto place = find_service(options.service);
    if (!place) {
        return place.error();
    }
    if (!options.spool.empty()) {
        if (!options.service.socket.empty() || !options.service.url.empty()) {
            return Failure{FailureKind::usage,
                           "--spool reads a file, --socket and --url ask a service: only one of them"};
        }
        return spool_source(options.spool);
    }
    if (place->chosen) {
        return service_source(*place);
    }
    std::error_code error;
    if (std::filesystem::exists(place->address.socket, error)) {
        say("asking the service at " + to_string(place->address) + " (--spool FILE reads a file instead)");
        return service_source(*place);
    }
    say("there is no service at " + to_string(place->address) + ": reading " + options.default_spool.string());
    return spool_source(options.default_spool);
}

} // namespace linefeed::client
