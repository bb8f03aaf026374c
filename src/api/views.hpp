// What operations.hpp shows, as the JSON of openapi.yaml.
#pragma once

#include "api/json_text.hpp"
#include "daemon/operations.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::api {

[[nodiscard]] Json to_json(const daemon::Finding& finding);
[[nodiscard]] Json to_json(const daemon::ServiceStatus& status);
[[nodiscard]] Json to_json(const daemon::PrinterView& printer);
[[nodiscard]] Json to_json(const daemon::FrameView& frame);
[[nodiscard]] Json to_json(const daemon::JobView& job);
[[nodiscard]] Json to_json(const daemon::DoubtView::Record& record);
[[nodiscard]] Json to_json(const daemon::DoubtView& doubt);
[[nodiscard]] Json to_json(const daemon::ImportAnswer& answer);
[[nodiscard]] Json to_json(const daemon::FolderView& folder);
[[nodiscard]] Json to_json(const daemon::EventView& event);
[[nodiscard]] Json to_json(const daemon::AuditView& entry);
[[nodiscard]] Json to_json(const spool::HistoryStretch& stretch);
[[nodiscard]] Json to_json(const spool::LedgerRow& row);

template <typename View>
[[nodiscard]] Json items_json(const std::vector<View>& views) {
    Json items = Json::array();
    for (const View& view : views) {
        items.push_back(to_json(view));
    }
    return items;
}

/// {"ok":…,"items":[…]}
[[nodiscard]] Json findings_json(const std::vector<daemon::Finding>& findings);

/// By its name; std::nullopt = there is none of that name.
[[nodiscard]] std::optional<daemon::JobPhase> job_phase(std::string_view name);
/// All names, "importing, ready, …".
[[nodiscard]] std::string job_phase_names();

} // namespace linefeed::api
