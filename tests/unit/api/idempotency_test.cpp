// A key is carried out once, also when the service ends at the worst moment.
#include "api/idempotency.hpp"
#include "fake_operations.hpp"

#include <gtest/gtest.h>

namespace linefeed::api {
namespace {

class KeyedAnswersTest : public testing::Test {
protected:
    Outcome ask(const std::string& hash, bool harmless = false) {
        return keyed_.answer({{"anna"}, "key", hash, harmless}, [&]() -> Outcome {
            ++carried_out_;
            if (throws_) {
                throw std::runtime_error("out of memory");
            }
            Answer answer;
            answer.status = 201;
            answer.body = R"({"job":12})";
            answer.location = "/api/v1/jobs/12";
            return answer;
        });
    }

    FakeOperations operations_;
    KeyedAnswers keyed_{operations_};
    int carried_out_ = 0;
    bool throws_ = false;
};

TEST_F(KeyedAnswersTest, GivesTheSameAnswerAgain) {
    const Outcome first = ask("h");
    const Outcome again = ask("h");
    ASSERT_TRUE(first && again);
    EXPECT_EQ(again->status, 201);
    EXPECT_EQ(again->body, first->body);
    EXPECT_EQ(again->location, first->location);
    EXPECT_TRUE(again->replayed && !first->replayed);
    EXPECT_EQ(carried_out_, 1);
    EXPECT_EQ(ask("other").error().type, ProblemType::key_reused);
}

TEST_F(KeyedAnswersTest, DoesNotCarryOutBlindlyWhatWasInterrupted) {
    throws_ = true; // as if the service had ended: nothing is remembered but that it was begun
    EXPECT_THROW(static_cast<void>(ask("h")), std::runtime_error);
    throws_ = false;
    KeyedAnswers after_restart{operations_};
    const auto again = after_restart.answer({{"anna"}, "key", "h"}, []() -> Outcome { std::abort(); });
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().type, ProblemType::key_interrupted);
    EXPECT_EQ(ask("h").error().type, ProblemType::key_interrupted);
    EXPECT_EQ(ask("other").error().type, ProblemType::key_reused);
    EXPECT_TRUE(ask("h", true)) << "a stop does no harm twice";
}

TEST_F(KeyedAnswersTest, ARequestWithinItselfIsInUse) {
    const auto outer = keyed_.answer({{"anna"}, "key", "h"}, [&]() -> Outcome {
        EXPECT_EQ(ask("h").error().type, ProblemType::key_in_use);
        EXPECT_EQ(ask("other").error().type, ProblemType::key_reused);
        const auto somebody_else = keyed_.answer({{"bob"}, "key", "h"}, [] { return Outcome{Answer{}}; });
        EXPECT_TRUE(somebody_else);
        return Answer{};
    });
    EXPECT_TRUE(outer);
    EXPECT_EQ(carried_out_, 0);
}

TEST_F(KeyedAnswersTest, WithoutAStoreNothingIsBegunButWhatDoesNoHarmTwice) {
    operations_.fail_remembering(Failure{FailureKind::storage, "the disk is gone"});
    EXPECT_EQ(ask("h").error().type, ProblemType::storage);
    EXPECT_EQ(carried_out_, 0);
    EXPECT_TRUE(ask("h", true));
    EXPECT_EQ(carried_out_, 1);
}

} // namespace
} // namespace linefeed::api
