#include "support/sql_faults.hpp"

#include <sqlite3.h>

#include <limits>

namespace linefeed::test {

namespace {

constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

struct Questions {
    std::uint64_t asked = 0;
    std::uint64_t refused_at = never;
    bool refused = false;
};
Questions questions;

int answer(void* /*unused*/, int /*action*/, const char* /*a*/, const char* /*b*/, const char* /*c*/,
           const char* /*d*/) {
    if (questions.asked++ != questions.refused_at) {
        return SQLITE_OK;
    }
    questions.refused = true;
    return SQLITE_DENY;
}

int prepare_connection(sqlite3* connection, char** /*error*/, const void* /*api*/) {
    sqlite3_exec(connection, "PRAGMA cache_size = 1", nullptr, nullptr, nullptr);
    return sqlite3_set_authorizer(connection, answer, nullptr);
}

using EntryPoint = void (*)();
EntryPoint entry_point() {
    return reinterpret_cast<EntryPoint>(prepare_connection);
}

} // namespace

SqlFaults::SqlFaults() {
    questions = {};
    sqlite3_auto_extension(entry_point());
}

SqlFaults::~SqlFaults() {
    sqlite3_cancel_auto_extension(entry_point());
}

void SqlFaults::refuse(std::uint64_t question) {
    questions = {.refused_at = question};
}

void SqlFaults::refuse_nothing() {
    questions.refused_at = never;
}

bool SqlFaults::has_refused() const {
    return questions.refused;
}

} // namespace linefeed::test
