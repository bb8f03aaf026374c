// Names of the service, origins of pages, and what each role may on each route.
#include "api/access.hpp"
#include "api/admission.hpp"
#include "api/route.hpp"

#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

const Peer ipv6{false, "::1", "::1", 8631};
const Peer http_port{false, "10.0.0.9", "10.0.0.5", 80};

TEST(Access, TheHostMayBeAnIpv6AddressAndLeaveThePortOfHttpOut) {
    EXPECT_TRUE(check_host("[::1]:8631", ipv6, {}));
    EXPECT_FALSE(check_host("::1:8631", ipv6, {}));
    EXPECT_FALSE(check_host("[::1]", ipv6, {}));
    EXPECT_TRUE(check_host("10.0.0.5", http_port, {}));
    EXPECT_TRUE(check_host("10.0.0.5:80", http_port, {}));
    EXPECT_FALSE(check_host("10.0.0.9", http_port, {}));
    const auto refused = check_host("evil.example", ipv6, {});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().advice.find("[::1]:8631"), std::string::npos);
}

TEST(Access, AConfiguredHostMayHaveItsOwnPort) {
    AccessRules rules;
    rules.hosts = {"Print.Plant.Example:8443"};
    EXPECT_TRUE(check_host("print.plant.example:8443", ipv6, rules));
    EXPECT_FALSE(check_host("print.plant.example", ipv6, rules));
    EXPECT_FALSE(check_host("print.plant.example:8631", ipv6, rules));
}

TEST(Access, BeyondTheLoopbackTokensAreNeeded) {
    config::HttpSettings settings;
    EXPECT_TRUE(AccessRules::load(settings));
    settings.listen = "0.0.0.0";
    const auto rules = AccessRules::load(settings);
    ASSERT_FALSE(rules);
    EXPECT_EQ(rules.error().kind, FailureKind::usage);
    settings.listen = "::";
    EXPECT_FALSE(AccessRules::load(settings));
    settings.tokens_file = "/nowhere/tokens";
    EXPECT_FALSE(AccessRules::load(settings));
}

/// The token of either role, and what `authorization` says to show it.
struct Shown {
    Role role;
    std::string authorization;
};

struct RulesWithTokens {
    AccessRules rules;
    std::vector<Shown> shown{{Role::anyone, ""}};
};

RulesWithTokens rules_with_tokens() {
    RulesWithTokens made;
    std::string file;
    for (const Role role : {Role::viewer, Role::operator_}) {
        const auto token = make_token(to_string(role), role);
        file += token->line + '\n';
        made.shown.push_back({role, "Bearer " + token->token});
    }
    made.rules.tokens = Tokens::parse(file, "tokens").value();
    return made;
}

Header header_for(const Route& route) {
    std::string path{route.path};
    if (const std::size_t open = path.find('{'); open != std::string::npos) {
        path.replace(open, path.find('}') - open + 1, "12");
    }
    Header header{std::string{to_string(route.method)}, path, false, {{"host", "[::1]:8631"}}, std::nullopt, false};
    if (route.method == Method::post) {
        header.fields.emplace_back("idempotency-key", "k");
        header.fields.emplace_back("content-type", route.body == Body::file ? media::bytes : media::json);
        header.content_length = 2;
    }
    return header;
}

TEST(Access, EachRouteIsOpenToItsRoleAndThoseAbove) {
    const RulesWithTokens with = rules_with_tokens();
    for (const Route& route : routes()) {
        for (const Shown& shown : with.shown) {
            Header header = header_for(route);
            if (!shown.authorization.empty()) {
                header.fields.emplace_back("authorization", shown.authorization);
            }
            const auto admitted = admit(header, ipv6, with.rules, {65536, 65536}).admitted;
            EXPECT_EQ(admitted.has_value(), shown.role >= route.role) << route.path << " as " << to_string(shown.role);
            if (!admitted) {
                EXPECT_EQ(admitted.error().type,
                          shown.role == Role::anyone ? ProblemType::token_missing : ProblemType::not_permitted);
            }
        }
    }
}

TEST(Access, WithoutTokensTheLoopbackLooksAndTheSocketDoesAll) {
    const Peer socket{true, "anna (uid 1000)", "", 0};
    for (const Route& route : routes()) {
        const Header header = header_for(route);
        EXPECT_EQ(admit(header, ipv6, {}, {65536, 65536}).admitted.has_value(), route.role != Role::operator_)
            << route.path;
        const auto local = admit(header, socket, {}, {65536, 65536}).admitted;
        ASSERT_TRUE(local) << route.path << local.error().detail;
        EXPECT_EQ(local->request.caller.name, "anna (uid 1000)");
        EXPECT_TRUE(local->request.over_unix_socket);
    }
}

TEST(Access, WhatChangesSomethingIsForOperatorsAndTakesAKey) {
    for (const Route& route : routes()) {
        EXPECT_EQ(route.method == Method::post, route.role == Role::operator_) << route.path;
        EXPECT_EQ(route.method == Method::post, route.key != Key::none) << route.path;
    }
}

} // namespace
} // namespace linefeed::api
