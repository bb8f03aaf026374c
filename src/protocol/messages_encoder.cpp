// Encodes messages as the manual writes them, see messages.hpp.
#include "base/assert.hpp"
#include "protocol/decimal.hpp"
#include "protocol/messages.hpp"

#include <initializer_list>

namespace linefeed::protocol {

namespace {

/// One `=XX` frame: its head when constructed, TABs between the values, its CR with end().
class ParameterWriter {
public:
    ParameterWriter(std::string& out, Parameter parameter)
        : out_(out) {
        out_.append({'^', printer_address, static_cast<char>(Group::parameter)});
        out_.append(code(parameter));
    }

    template <std::integral Number>
    void number(Number value) {
        separate();
        append_decimal(out_, value);
    }
    void empty() { separate(); }
    void text(std::string_view value, EscapeMode escapes) {
        LINEFEED_ASSERT(value.find_first_of("\t\r") == std::string_view::npos);
        separate();
        append_escaped(out_, value, escapes);
    }
    void end() { out_.push_back('\r'); }

private:
    void separate() {
        if (!first_) {
            out_.push_back('\t');
        }
        first_ = false;
    }

    std::string& out_;
    bool first_ = true;
};

} // namespace

void append_message(std::string& out, const MachineStatus& status) {
    ParameterWriter writer{out, Parameter::RS};
    writer.number(static_cast<int>(status.nozzle));
    writer.number(static_cast<int>(status.machine));
    writer.number(status.error.raw);
    writer.number(status.cover_open ? 1 : 0);
    writer.number(status.speed);
    if (status.job_changed) {
        writer.number(*status.job_changed ? 1 : 0);
    }
    writer.end();
}

void append_message(std::string& out, const MailStatus& status) {
    ParameterWriter writer{out, Parameter::SM};
    writer.number(status.depth);
    writer.number(status.entries);
    writer.number(status.last_printed.value());
    writer.number(status.stop_at.value());
    writer.number(status.last_print_finished ? 1 : 0);
    if (status.print_go_count) {
        writer.number(*status.print_go_count);
    }
    writer.end();
}

void append_message(std::string& out, const StopAt& stop) {
    ParameterWriter writer{out, Parameter::CM};
    writer.number(stop.number.value());
    writer.end();
}

void append_message(std::string& out, const Counters& counters) {
    // The total counter is read only: the printer sends it, the host leaves it out.
    ParameterWriter writer{out, Parameter::CC};
    const auto value = [&writer](const std::optional<std::uint32_t>& number) {
        number ? writer.number(*number) : writer.empty();
    };
    value(counters.product);
    value(counters.stop_after);
    if (counters.total) {
        value(counters.total);
    }
    writer.end();
}

void append_message(std::string& out, const VersionInfo& version, EscapeMode escapes) {
    ParameterWriter writer{out, Parameter::VS};
    for (const std::string* const field :
         {&version.fpga, &version.rip, &version.sdc, &version.fep, &version.kernel, &version.system_type,
          &version.language_pack, &version.font_pack, &version.firmware, &version.type, &version.serial_number}) {
        writer.text(*field, escapes);
    }
    writer.end();
}

void append_message(std::string& out, const JobName& job, EscapeMode escapes) {
    ParameterWriter writer{out, Parameter::JL};
    writer.text(job.path, escapes);
    writer.end();
}

} // namespace linefeed::protocol
