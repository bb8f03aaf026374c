// openapi.yaml against the table of routes: neither knows anything that the other does not.
#include "api/openapi.hpp"
#include "api/route.hpp"
#include "api/views.hpp"

#include <gmock/gmock.h>

#include <set>
#include <yaml-cpp/yaml.h>

namespace linefeed::api {
namespace {

const YAML::Node& document() {
    static const YAML::Node node = YAML::Load(std::string{openapi_text});
    return node;
}

std::string lower_case(std::string_view method) {
    return method == "GET" ? "get" : "post";
}

/// Parameters of an operation and of its path, references followed.
std::vector<YAML::Node> parameters(const YAML::Node& path, const YAML::Node& operation) {
    std::vector<YAML::Node> all;
    for (const YAML::Node& list : {path["parameters"], operation["parameters"]}) {
        if (!list.IsDefined()) {
            continue;
        }
        for (const YAML::Node& parameter : list) {
            const auto reference = parameter["$ref"].IsDefined() ? parameter["$ref"].as<std::string>() : "";
            all.push_back(reference.empty()
                              ? parameter
                              : document()["components"]["parameters"][reference.substr(reference.rfind('/') + 1)]);
        }
    }
    return all;
}

std::set<std::string> strings(const YAML::Node& list) {
    std::set<std::string> all;
    for (const YAML::Node& text : list) {
        all.insert(text.as<std::string>());
    }
    return all;
}

TEST(OpenApi, KnowsEveryRouteAndNoOther) {
    std::set<std::string> in_table;
    for (const Route& route : routes()) {
        EXPECT_TRUE(in_table.insert(lower_case(to_string(route.method)) + ' ' + std::string{route.path}).second)
            << route.path << " comes twice";
    }
    std::set<std::string> in_document;
    for (const auto& path : document()["paths"]) {
        for (const auto& operation : path.second) {
            if (operation.first.as<std::string>() != "parameters") {
                in_document.insert(operation.first.as<std::string>() + ' ' + path.first.as<std::string>());
            }
        }
    }
    EXPECT_EQ(in_table, in_document);
}

TEST(OpenApi, SaysOfEachRouteWhatTheTableSays) {
    for (const Route& route : routes()) {
        SCOPED_TRACE(route.path);
        const YAML::Node path = document()["paths"][std::string{route.path}];
        const YAML::Node operation = path[lower_case(to_string(route.method))];
        EXPECT_EQ(operation["x-linefeed-role"].as<std::string>(), to_string(route.role));
        std::set<std::string> query;
        std::optional<bool> key_required;
        bool in_path = false;
        for (const YAML::Node& parameter : parameters(path, operation)) {
            const auto place = parameter["in"].as<std::string>();
            const auto name = parameter["name"].as<std::string>();
            if (place == "query") {
                query.insert(name);
            } else if (name == "Idempotency-Key") {
                key_required = parameter["required"].as<bool>();
            }
            in_path = in_path || (place == "path" && route.path.find('{' + name + '}') != std::string_view::npos);
        }
        EXPECT_EQ(in_path, route.path.find('{') != std::string_view::npos);
        std::set<std::string> taken;
        for (const std::string_view name : route.query) {
            if (!name.empty()) {
                taken.emplace(name);
            }
        }
        EXPECT_EQ(query, taken);
        EXPECT_EQ(key_required, route.key == Key::none ? std::nullopt : std::optional{route.key == Key::required});
        EXPECT_EQ(operation["requestBody"].IsDefined(), route.body != Body::none);
        const bool required = operation["requestBody"].IsDefined() && operation["requestBody"]["required"].as<bool>();
        EXPECT_EQ(required, route.body == Body::json || route.body == Body::import || route.body == Body::file);
        for (const auto& response : operation["responses"]) {
            if (response.first.as<std::string>() != "default") {
                const std::string_view produces = route.produces.substr(0, route.produces.find(';'));
                EXPECT_TRUE(response.second["content"][std::string{produces}].IsDefined());
            }
        }
    }
}

TEST(OpenApi, NamesEveryProblem) {
    const auto text = document()["components"]["responses"]["Problem"]["description"].as<std::string>();
    for (int type = 0; type <= static_cast<int>(ProblemType::disk_full); ++type) {
        const std::string name =
            urn(static_cast<ProblemType>(type)).substr(std::string{"urn:linefeed:problem:"}.size());
        EXPECT_NE(text.find(name), std::string::npos) << name;
        EXPECT_NE(text.find(std::to_string(status_of(static_cast<ProblemType>(type)))), std::string::npos) << name;
    }
}

TEST(OpenApi, NamesEveryPhaseAndState) {
    const YAML::Node schemas = document()["components"]["schemas"];
    std::string phases;
    for (const YAML::Node& phase : schemas["JobPhase"]["enum"]) {
        phases += (phases.empty() ? "" : ", ") + phase.as<std::string>();
        EXPECT_TRUE(job_phase(phase.as<std::string>()));
    }
    EXPECT_EQ(phases, job_phase_names());
    const auto states = strings(schemas["HistoryStretch"]["properties"]["state"]["enum"]);
    for (int state = 0; state <= static_cast<int>(spool::RecordState::released); ++state) {
        EXPECT_TRUE(states.contains(std::string{to_string(static_cast<spool::RecordState>(state))})) << state;
    }
    const auto kinds = strings(schemas["LedgerRow"]["properties"]["kind"]["enum"]);
    for (int kind = 0; kind <= static_cast<int>(spool::LedgerKind::run_ended); ++kind) {
        EXPECT_TRUE(kinds.contains(std::string{to_string(static_cast<spool::LedgerKind>(kind))})) << kind;
    }
}

TEST(Routes, AreFoundByMethodAndPath) {
    EXPECT_EQ(find_route(Method::get, "/api/v1/jobs/12").parameter, "12");
    EXPECT_EQ(find_route(Method::get, "/api/v1/printers/a%20b/frames").parameter, "a b");
    EXPECT_EQ(find_route(Method::post, "/api/v1/jobs/12").route, nullptr);
    EXPECT_EQ(find_route(Method::post, "/api/v1/jobs/12").allow, "GET, HEAD");
    EXPECT_EQ(find_route(std::nullopt, "/api/v1/jobs").allow, "GET, HEAD, POST");
    for (const std::string path : {"", "/", "/api/v1", "/api/v1/jobs/", "/api/v1/jobs//start", "/api/v1/jobs/1/start/",
                                   "/LIVEZ", "/api/v1/printers/%zz", "/api/v1/jobs/1/2/start"}) {
        EXPECT_EQ(find_route(Method::get, path).allow, "") << path;
    }
}

} // namespace
} // namespace linefeed::api
