#include "api/answers.hpp"
#include "api/handlers.hpp"
#include "api/views.hpp"
#include "printer/tasks.hpp"

namespace linefeed::api::handlers {

namespace {

/// Of PrinterError::code(): 25 bits.
constexpr std::int64_t max_error_code = (1 << 25) - 1;
constexpr std::int64_t max_hold_s = 86'400;
constexpr std::int64_t default_hold_s = 60;

Outcome printer_done(const Request& request, const Result<void>& result, Services& services) {
    if (!result) {
        return printer_problem(result.error(), request.parameter, services);
    }
    return json_answer({{"printer", visible(request.parameter)}});
}

Outcome start_begun(spool::JobId id) {
    return json_answer({{"job", static_cast<std::int64_t>(id)}}, 202);
}

/// A job that is named is started on this printer or not at all.
Outcome start_named(const Request& request, spool::JobId id, Services& services) {
    const auto job = services.operations.job(id);
    if (!job) {
        return to_problem(job.error());
    }
    const std::string number = std::to_string(static_cast<std::int64_t>(id));
    if (!*job) {
        return no_such_job(number);
    }
    if ((*job)->printer != request.parameter) {
        return Problem{ProblemType::not_valid,
                       "job " + number + " is " +
                           ((*job)->printer.empty() ? "in no printer's queue" : "one of printer " + (*job)->printer),
                       "queue it at " + request.parameter + " first, or start another"};
    }
    const auto started = services.operations.start(request.caller, id);
    if (!started) {
        return job_problem(started.error(), id, services);
    }
    return start_begun(id);
}

/// JSON that the service's core has made.
Answer text_answer(std::string json) {
    Answer answer;
    answer.body = std::move(json);
    return answer;
}

} // namespace

Outcome printers(const Request& /*request*/, Services& services) {
    return json_answer({{"items", items_json(services.operations.printers())}});
}

Outcome printer(const Request& request, Services& services) {
    const auto printer = services.operations.printer(request.parameter);
    if (!printer) {
        return no_such_printer(request.parameter, services);
    }
    return json_answer(to_json(*printer));
}

Outcome frames(const Request& request, Services& services) {
    const auto error = request.query.flag("error");
    if (!error) {
        return error.error();
    }
    const auto frames = services.operations.frames(request.parameter, *error);
    if (!frames) {
        return printer_problem(frames.error(), request.parameter, services);
    }
    return json_answer({{"items", items_json(*frames)}});
}

Outcome preflight(const Request& request, Services& services) {
    const auto findings = services.operations.preflight(request.parameter);
    if (!findings) {
        return printer_problem(findings.error(), request.parameter, services);
    }
    return json_answer(findings_json(*findings));
}

Outcome start_printer(const Request& request, Services& services) {
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    const auto job = body->number("job", 1, static_cast<std::int64_t>(max_id));
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    if (!services.operations.printer(request.parameter)) {
        return no_such_printer(request.parameter, services);
    }
    if (job) {
        return start_named(request, spool::JobId{*job}, services);
    }
    const auto started = services.operations.start_next(request.caller, request.parameter);
    if (!started) {
        return printer_problem(started.error(), request.parameter, services);
    }
    return start_begun(*started);
}

Outcome stop_printer(const Request& request, Services& services) {
    return printer_done(request, services.operations.stop(request.caller, request.parameter), services);
}

Outcome acknowledge(const Request& request, Services& services) {
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    const auto error = body->required_number("error", 1, max_error_code);
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    return printer_done(
        request, services.operations.acknowledge(request.caller, request.parameter, static_cast<std::uint32_t>(error)),
        services);
}

Outcome accept_printer(const Request& request, Services& services) {
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    const std::string serial_number = body->required_text("serial_number");
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    return printer_done(request, services.operations.accept_printer(request.caller, request.parameter, serial_number),
                        services);
}

Outcome read_file(const Request& request, Services& services) {
    auto bytes = services.operations.read_file(request.parameter, request.query.text("path"));
    if (!bytes) {
        return printer_problem(bytes.error(), request.parameter, services);
    }
    return Answer{.content_type = media::bytes, .body = *std::move(bytes)};
}

Outcome write_file(const Request& request, Services& services) {
    const auto replace = request.query.flag("replace");
    if (!replace) {
        return replace.error();
    }
    return printer_done(request,
                        services.operations.write_file(request.caller, request.parameter,
                                                       {request.query.text("path"), *request.upload, *replace}),
                        services);
}

Outcome inspect(const Request& request, Services& services) {
    Json arguments = Json::object();
    if (const printer::Task* const task = printer::find_task(request.what)) {
        auto typed = printer::Arguments::from_texts(task->arguments, request.query.all());
        if (!typed) {
            return to_problem(typed.error());
        }
        arguments = typed->json();
    }
    const auto seen = services.operations.inspect(request.parameter, request.what, dump(arguments));
    return seen ? Outcome{text_answer(*seen)} : printer_problem(seen.error(), request.parameter, services);
}

Outcome command(const Request& request, Services& services) {
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    const std::string what = body->required_text("what");
    const Json arguments = body->rest();
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    const auto done = services.operations.command(request.caller, request.parameter, what, dump(arguments));
    return done ? Outcome{text_answer(*done)} : printer_problem(done.error(), request.parameter, services);
}

Outcome suspend(const Request& request, Services& services) {
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    const bool suspended = body->required_flag("suspend");
    const std::chrono::seconds hold{body->number("hold_s", 1, max_hold_s).value_or(default_hold_s)};
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    return printer_done(request, services.operations.suspend_panel(request.caller, request.parameter, suspended, hold),
                        services);
}

} // namespace linefeed::api::handlers
