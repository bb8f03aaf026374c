// What the service knows of a job besides its records: whose it is, where it waits, and why it stands.
#pragma once

#include "spool/job.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace linefeed::spool {

/// The ticket of a job. Names are those of the settings.
struct Ticket {
    JobId job{};
    std::string name{};       ///< shown for the job, usually the file's
    std::string printer{};    ///< empty = none yet
    std::string layout{};     ///< empty = given with the import
    std::string created_by{}; ///< for people
    bool autostart = false;   ///< may start by itself, once
    bool begun = false;       ///< a start was tried, and the job is not over: from then on only people start it
    bool cancelled = false;
    std::optional<std::int64_t> place{}; ///< orders the queue of its printer; absent = in no queue
    std::string message{};               ///< why it stands; one line

    friend bool operator==(const Ticket&, const Ticket&) = default;
};

/// What has happened, for people and programs that watch.
struct Event {
    std::uint64_t id = 0; ///< given by the spool, ascending, never twice
    std::int64_t time_ns = 0;
    std::string kind{};
    std::string printer{};
    std::optional<JobId> job{};
    std::optional<RecordNumber> record{};
    std::string message{};

    friend bool operator==(const Event&, const Event&) = default;
};

/// Who has changed what, or was refused.
struct AuditEntry {
    std::uint64_t id = 0; ///< given by the spool, ascending
    std::int64_t time_ns = 0;
    std::string who{};
    std::string what{};
    std::string object{};
    std::string detail{}; ///< JSON, one line
    bool done = true;

    friend bool operator==(const AuditEntry&, const AuditEntry&) = default;
};

/// The answer to a request that carried a key.
struct Answer {
    std::string request_hash{};
    int status = 0;
    std::string body{};

    friend bool operator==(const Answer&, const Answer&) = default;
};

} // namespace linefeed::spool
