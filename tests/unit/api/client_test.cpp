// The client of the command line against the server: answers, failures as kinds, repetition, events across a restart.
#include "api/client.hpp"
#include "running_server.hpp"

#include <fstream>
#include <thread>

namespace linefeed::api {
namespace {

class ClientTest : public RunningServer {
protected:
    Client client() {
        ClientSettings settings;
        settings.address.socket = settings_.control.socket;
        return Client{settings};
    }
};

TEST_F(ClientTest, AsksAndIsAnswered) {
    start();
    Client client = this->client();
    const auto printers = client.get("/api/v1/printers");
    ASSERT_TRUE(printers) << printers.error().message;
    EXPECT_EQ(printers->body["items"][0]["name"], "line1");
    std::vector<std::int64_t> ids;
    ASSERT_TRUE(client.each("/api/v1/jobs?limit=1", [&](const Json& job) {
        ids.push_back(job["id"]);
        return true;
    }));
    EXPECT_EQ(ids, (std::vector<std::int64_t>{13, 12, 11}));
    EXPECT_NE(client.get("/metrics")->text.find("linefeed_build_info"), std::string::npos);
}

TEST_F(ClientTest, ARepeatedKeyIsOneRequest) {
    start();
    Client client = this->client();
    const std::string key = new_key();
    const auto first = client.post("/api/v1/jobs/12/start", nullptr, key);
    const auto again = client.post("/api/v1/jobs/12/start", nullptr, key);
    ASSERT_TRUE(first && again);
    EXPECT_EQ(first->status, 202);
    EXPECT_TRUE(!first->replayed && again->replayed);
    EXPECT_EQ(operations_.changes(), 1U);
    EXPECT_TRUE(client.post("/api/v1/printers/line1/stop", nullptr, ""));
    EXPECT_TRUE(client.post("/api/v1/jobs/12/queue", {{"printer", "line1"}}, ""));
}

TEST_F(ClientTest, FailuresKeepTheirKind) {
    start();
    Client client = this->client();
    using enum FailureKind;
    for (const FailureKind kind : {usage, unreachable, stopped, input, in_doubt, storage, internal}) {
        operations_.fail(Failure{kind, "it is so"});
        const auto reply = client.post("/api/v1/printers/line1/stop", nullptr, "");
        ASSERT_FALSE(reply);
        EXPECT_EQ(reply.error(), (Failure{kind, "it is so"}));
    }
    const auto missing = client.get("/api/v1/jobs/99");
    EXPECT_EQ(missing.error().kind, usage);
    EXPECT_NE(missing.error().message.find("there is no job \"99\""), std::string::npos);
}

TEST_F(ClientTest, WithoutAServiceItSaysSo) {
    const auto reply = client().get("/livez");
    ASSERT_FALSE(reply);
    EXPECT_EQ(reply.error().kind, FailureKind::unreachable);
    EXPECT_NE(reply.error().message.find("is linefeedd running"), std::string::npos) << reply.error().message;
}

TEST_F(ClientTest, OverTcpItShowsItsToken) {
    start();
    ClientSettings settings;
    settings.address = {"", "127.0.0.1", server_->port()};
    EXPECT_TRUE(Client{settings}.get("/api/v1/status"));
    settings.token = "linefeed_nonsense";
    EXPECT_EQ(Client{settings}.get("/api/v1/status").error().kind, FailureKind::usage);
}

TEST_F(ClientTest, SendsAFileThatIsLargerThanAnyBuffer) {
    start();
    const auto file = directory_ / "big.csv";
    std::ofstream{file} << std::string(3'000'000, 'x');
    Client client = this->client();
    const auto reply = client.upload("/api/v1/jobs?name=big.csv", file, "text/csv", new_key());
    ASSERT_TRUE(reply) << reply.error().message;
    EXPECT_EQ(reply->status, 201);
    EXPECT_EQ(operations_.last_import_bytes(), 3'000'000U);
    EXPECT_EQ(operations_.last_import()->name, "big.csv");
    EXPECT_EQ(client.upload("/api/v1/jobs", directory_ / "no.csv", "text/csv", new_key()).error().kind,
              FailureKind::input);
    std::ofstream{file} << std::string(17 << 20, 'x'); // more than http.max_body
    const auto refused = client.upload("/api/v1/jobs", file, "text/csv", new_key());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, FailureKind::usage) << refused.error().message;
}

TEST_F(ClientTest, FollowsEventsOverARestartOfTheService) {
    start();
    std::vector<std::uint64_t> seen;
    std::atomic<std::size_t> count = 0;
    std::thread follower{[&] {
        Client client = this->client();
        const auto followed = client.follow(
            0,
            [&](const Json& event) {
                seen.push_back(event["id"]);
                ++count;
                return seen.size() < 6;
            },
            [](const Failure&) { return true; });
        EXPECT_TRUE(followed);
    }};
    const auto wait_for = [&](std::size_t wanted) {
        for (int k = 0; k < 2000 && count < wanted; ++k) {
            std::this_thread::sleep_for(std::chrono::milliseconds{10});
        }
        EXPECT_GE(count, wanted);
    };
    wait_for(2);
    operations_.add_event("job.started", "three");
    wait_for(3);
    server_.reset();
    operations_.add_event("job.stopped", "four");
    operations_.add_event("job.queued", "five");
    start();
    wait_for(5);
    operations_.add_event("job.finished", "six");
    follower.join();
    EXPECT_EQ(seen, (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6}));
}

} // namespace
} // namespace linefeed::api
