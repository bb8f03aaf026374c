#include "api/answers.hpp"
#include "api/handlers.hpp"
#include "api/views.hpp"

#include <limits>

namespace linefeed::api::handlers {

namespace {

constexpr std::size_t max_name = 255;
constexpr std::size_t max_reason = 1000;

Outcome job_done(spool::JobId id, const Result<void>& result, Services& services, int status = 200) {
    if (!result) {
        return job_problem(result.error(), id, services);
    }
    return json_answer({{"job", static_cast<std::int64_t>(id)}}, status);
}

Checked<daemon::ImportRequest> named_file(const Request& request) {
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    daemon::ImportRequest import;
    import.file = body->required_text("file");
    import.name = body->text("name").value_or("");
    import.layout = body->text("layout").value_or("");
    import.printer = body->text("printer").value_or("");
    import.autostart = body->flag("autostart").value_or(false);
    import.again = body->flag("again").value_or(false);
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    if (!request.query.all().empty()) {
        return Problem{ProblemType::malformed, "the parameters of the query are for a file that is sent as the body",
                       "put them into the JSON"};
    }
    if (!request.over_unix_socket) {
        return Problem{ProblemType::not_permitted, "a path is taken over the Unix socket only",
                       "send the file itself as the body, with Content-Type text/csv or application/vnd.sqlite3"};
    }
    if (!import.file.is_absolute()) {
        return Problem{ProblemType::not_valid, "\"file\" must be an absolute path", "let it begin with /"};
    }
    return import;
}

Checked<daemon::ImportRequest> sent_file(const Request& request) {
    daemon::ImportRequest import;
    import.file = *request.upload;
    import.sent = true;
    import.name = request.query.text("name");
    import.layout = request.query.text("layout");
    import.printer = request.query.text("printer");
    const auto autostart = request.query.flag("autostart");
    const auto again = request.query.flag("again");
    if (!autostart || !again) {
        return autostart ? again.error() : autostart.error();
    }
    import.autostart = *autostart;
    import.again = *again;
    if (import.name.empty()) {
        import.name = "upload";
    }
    return import;
}

} // namespace

Outcome import(const Request& request, Services& services) {
    const auto import = request.upload ? sent_file(request) : named_file(request);
    if (!import) {
        return import.error();
    }
    if (import->name.size() > max_name) {
        return Problem{ProblemType::not_valid, "the name is longer than " + std::to_string(max_name) + " bytes",
                       "give a shorter one"};
    }
    const auto imported = services.operations.import(request.caller, *import);
    if (!imported) {
        return to_problem(imported.error());
    }
    if (!imported->job && !imported->duplicate) {
        return Problem{ProblemType::input_rejected, "the file has rows that cannot be printed",
                       "see report, mend them, and send it again", imported->report};
    }
    Answer answer = json_answer(to_json(*imported), imported->duplicate ? 200 : 201);
    if (imported->job) {
        answer.location = "/api/v1/jobs/" + std::to_string(static_cast<std::int64_t>(*imported->job));
    }
    return answer;
}

Outcome queue_job(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    const std::string printer = body->required_text("printer");
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    return job_done(*id, services.operations.enqueue(request.caller, *id, printer), services);
}

Outcome start_job(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    return job_done(*id, services.operations.start(request.caller, *id), services, 202);
}

Outcome cancel_job(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    return job_done(*id, services.operations.cancel(request.caller, *id), services);
}

Outcome reprint_job(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    const daemon::ReprintRequest reprint{body->required_text("records"), body->required_text("reason")};
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    if (reprint.reason.size() > max_reason) {
        return Problem{ProblemType::not_valid, "the reason is longer than " + std::to_string(max_reason) + " bytes",
                       "give a shorter one"};
    }
    return job_done(*id, services.operations.reprint(request.caller, *id, reprint), services);
}

Outcome settle_job(const Request& request, Services& services) {
    const auto id = job_id(request);
    if (!id) {
        return id.error();
    }
    auto body = BodyReader::parse(request.body);
    if (!body) {
        return body.error();
    }
    daemon::SettleRequest settle;
    const auto policy = body->text("in_doubt");
    settle.last_printed = body->text("last_printed");
    settle.printed = body->text("printed");
    settle.as_of = body->number("as_of", 0, std::numeric_limits<std::int64_t>::max());
    if (const auto right = body->finish(); !right) {
        return right.error();
    }
    if (policy && *policy != "skip" && *policy != "reprint") {
        return Problem{ProblemType::not_valid, "\"in_doubt\" must be skip or reprint",
                       "skip: do not print them again; reprint: print them again"};
    }
    if (policy) {
        settle.policy =
            *policy == "skip" ? daemon::SettleRequest::Policy::skip : daemon::SettleRequest::Policy::reprint;
    }
    if (int{settle.policy.has_value()} + int{settle.last_printed.has_value()} + int{settle.printed.has_value()} != 1) {
        return Problem{ProblemType::not_valid, "exactly one of in_doubt, last_printed and printed must be given",
                       "say what you know: the last product, all that are printed, or what to do with those in doubt"};
    }
    return job_done(*id, services.operations.settle(request.caller, *id, settle), services);
}

} // namespace linefeed::api::handlers
