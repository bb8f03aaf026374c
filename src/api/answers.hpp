// What handlers have in common: pages, things that may not exist, answers.
#pragma once

#include "api/exchange.hpp"
#include "api/json_text.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace linefeed::api {

[[nodiscard]] Answer json_answer(const Json& json, int status = 200);

/// Which part of a list is asked for.
struct PageRequest {
    std::uint64_t after = 0;
    std::size_t limit = 100;
};
inline constexpr std::size_t max_page = 1000;
/// An after that is larger than any id fits in JSON's integers all the same.
inline constexpr std::uint64_t max_id = 9'223'372'036'854'775'807;

/// The parameters `after` and `limit`.
[[nodiscard]] Checked<PageRequest> read_page(const Query& query);
/// The address of what follows a page with `got` elements, of which `last` was the last; null if it was not full.
/// `target` is encoded, and may have parameters.
[[nodiscard]] Json next_page(std::string_view target, const PageRequest& page, std::size_t got, std::uint64_t last);

/// The job of the request's path. ProblemType::not_found if it is no number.
[[nodiscard]] Checked<spool::JobId> job_id(const Request& request);

/// What an operation on the job, or the printer, of a path failed with: not_found if there is no such thing.
[[nodiscard]] Problem job_problem(const Failure& failure, spool::JobId id, Services& services);
[[nodiscard]] Problem printer_problem(const Failure& failure, std::string_view printer, Services& services);
[[nodiscard]] Problem no_such_job(std::string_view id);
[[nodiscard]] Problem no_such_printer(std::string_view name, Services& services);

} // namespace linefeed::api
