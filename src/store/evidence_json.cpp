#include "store/evidence_json.hpp"

#include "spool/json_text.hpp"

#include <nlohmann/json.hpp>

#include <utility>

namespace linefeed::store {

using spool::JsonObject;

namespace {

using Json = nlohmann::json;

std::string mail_array(const protocol::MailStatus& mail) {
    return spool::json_array({std::to_string(mail.depth), std::to_string(mail.entries),
                              std::to_string(mail.last_printed.value()), std::to_string(mail.stop_at.value()),
                              mail.last_print_finished ? "1" : "0"});
}

/// Takes the values of an object as it is parsed, since a parsed object ends the process when memory runs out
/// (json_text.hpp). Values of another type than ours are taken for absent.
class ObjectReader : public nlohmann::json_sax<Json> {
public:
    bool key(std::string& name) override {
        key_ = depth_ == 1 ? name : "";
        return true;
    }
    bool string(std::string& value) override {
        take_text(key_, value);
        return scalar();
    }
    bool number_unsigned(std::uint64_t value) override {
        take_number(key_, value);
        return scalar();
    }
    bool number_integer(std::int64_t /*value*/) override { return scalar(); }
    bool number_float(double /*value*/, const std::string& /*text*/) override { return scalar(); }
    bool null() override { return scalar(); }
    bool boolean(bool value) override {
        take_flag(key_, value);
        return scalar();
    }
    bool binary(Json::binary_t& /*value*/) override { return scalar(); }
    bool start_object(std::size_t /*elements*/) override { return open(); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t /*elements*/) override { return open(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t /*place*/, const std::string& /*token*/, const Json::exception& /*why*/) override {
        return false;
    }

private:
    virtual void take_text(std::string_view /*key*/, std::string& /*value*/) {}
    virtual void take_number(std::string_view key, std::uint64_t value) = 0;
    virtual void take_flag(std::string_view /*key*/, bool /*value*/) {}

    bool scalar() {
        key_.clear();
        return true;
    }
    bool open() {
        ++depth_;
        return scalar();
    }
    bool close() {
        --depth_;
        return true;
    }

    std::string key_; ///< of the next value, in the outermost object only
    int depth_ = 0;
};

class RunStartReader : public ObjectReader {
public:
    [[nodiscard]] std::optional<RunStart> finish() && {
        return has_printer_ ? std::optional{std::move(start_)} : std::nullopt;
    }

private:
    void take_text(std::string_view key, std::string& value) override {
        if (key == "printer") {
            start_.printer = value;
            has_printer_ = true;
        } else if (key == "serial_number") {
            start_.serial_number = value;
        }
    }
    void take_number(std::string_view key, std::uint64_t value) override {
        if (key == "total_before") {
            start_.total_before = static_cast<std::uint32_t>(value);
        } else if (key == "last_printed_before") {
            start_.last_printed_before = RecordNumber{static_cast<std::uint32_t>(value)};
        } else if (key == "follows_job") {
            followed().job = spool::JobId{static_cast<std::int64_t>(value)};
        } else if (key == "follows_run") {
            followed().run = spool::RunId{static_cast<std::int64_t>(value)};
        }
    }
    FollowedRun& followed() { return start_.follows ? *start_.follows : start_.follows.emplace(); }

    RunStart start_;
    bool has_printer_ = false;
};

class RunEndReader : public ObjectReader {
public:
    [[nodiscard]] const RunEnd& end() const { return end_; }

private:
    void take_number(std::string_view key, std::uint64_t value) override {
        if (key == "broken_off") {
            end_.broken_off = RecordNumber{static_cast<std::uint32_t>(value)};
        }
    }
    void take_flag(std::string_view key, bool value) override {
        end_.unclear = end_.unclear || (key == "unclear" && value);
    }

    RunEnd end_;
};

} // namespace

std::string run_start_json(const std::string& printer, const feeder::BeginRun& begin,
                           const std::optional<FollowedRun>& follows) {
    JsonObject json;
    json.add("printer", printer);
    if (begin.printer.version) {
        json.add("serial_number", begin.printer.version->serial_number)
            .add("type", begin.printer.version->type)
            .add("firmware", begin.printer.version->firmware);
    }
    if (begin.printer.total_prints) {
        json.add("total_before", *begin.printer.total_prints);
    }
    if (begin.printer.job_name) {
        json.add("job", *begin.printer.job_name);
    }
    if (follows) {
        json.add("follows_job", static_cast<std::int64_t>(follows->job))
            .add("follows_run", static_cast<std::int64_t>(follows->run));
    }
    return json.add("last_printed_before", begin.last_printed_before.value()).text();
}

std::optional<RunStart> parse_run_start(const std::string& text) {
    RunStartReader reader;
    if (!Json::sax_parse(text, &reader)) {
        return std::nullopt;
    }
    return std::move(reader).finish();
}

std::string mail_json(const protocol::MailStatus& mail) {
    return JsonObject{}.add_json("sm", mail_array(mail)).text();
}

std::string settle_json(const feeder::Settle& settle) {
    JsonObject json;
    json.add("basis", to_string(settle.verdict.basis)).add_json("sm", mail_array(settle.evidence.mail));
    if (settle.evidence.printer.total_prints) {
        json.add("total", *settle.evidence.printer.total_prints);
    }
    if (settle.evidence.printer.version) {
        json.add("serial_number", settle.evidence.printer.version->serial_number);
    }
    if (settle.evidence.restarted) {
        json.add_json("restarted", "true");
    }
    return json.text();
}

std::string outcome_json(const feeder::Outcome& outcome) {
    JsonObject json;
    json.add("outcome", to_string(outcome.code)).add("machine", to_string(outcome.machine));
    if (!outcome.error.none()) {
        json.add("error", outcome.error.raw);
    }
    if (outcome.broken_off != RecordNumber{}) {
        json.add("broken_off", outcome.broken_off.value());
    }
    if (outcome.unclear) {
        json.add_json("unclear", "true");
    }
    return json.text();
}

std::optional<RunEnd> parse_run_end(const std::string& text) {
    RunEndReader reader;
    return Json::sax_parse(text, &reader) ? std::optional{reader.end()} : std::nullopt;
}

} // namespace linefeed::store
