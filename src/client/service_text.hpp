// What the service tells of itself, for people: status, events, audit log, folders. The JSON is that of openapi.yaml.
#pragma once

#include "client/json_fields.hpp"
#include "client/terminal.hpp"

#include <string>
#include <vector>

namespace linefeed::client {

/// A Status object without its checks; those that are not well are added.
[[nodiscard]] std::string status_text(const Json& status, const Screen& screen);

/// An Event object, with its line end.
[[nodiscard]] std::string event_text(const Json& event, const Screen& screen);

/// AuditEntry objects.
[[nodiscard]] std::string audit_text(const std::vector<Json>& entries, const Screen& screen);

/// Folder objects, with the files that stay below.
[[nodiscard]] std::string folders_text(const std::vector<Json>& folders, const Screen& screen);

} // namespace linefeed::client
