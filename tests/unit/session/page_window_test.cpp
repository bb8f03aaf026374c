// The pages at hand: slices across pages, and giving back what is not needed any more.
#include "conversation.hpp"
#include "session/page_window.hpp"

namespace linefeed::session {
namespace {

RecordRange records(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

class PageWindowTest : public testing::Test {
protected:
    PageWindowTest() {
        for (const auto& page : pages) {
            window.add(page.get());
        }
    }
    std::vector<std::string> stage(RecordRange range) {
        Outbox outbox;
        window.stage(range, outbox);
        static_cast<void>(outbox.begin_write());
        std::vector<std::string> texts;
        for (const std::string_view piece : outbox.pieces()) {
            texts.emplace_back(piece);
        }
        return texts;
    }

    std::vector<std::unique_ptr<RecordPage>> pages = make_pages(11, 22, 4, plain_text); // 11-14, 15-18, 19-22
    PageWindow window;
};

using Texts = std::vector<std::string>;

TEST_F(PageWindowTest, shouldGiveTheFrameOfOneRecord) {
    EXPECT_EQ(window.frame_of(RecordNumber{12}), "^0=MR12\trecord 12\r");
    EXPECT_EQ(window.frame_of(RecordNumber{22}), "^0=MR22\trecord 22\r");
}

TEST_F(PageWindowTest, shouldStageASliceOfOnePage) {
    EXPECT_EQ(stage(records(12, 13)), (Texts{"^0=MR12\trecord 12\r^0=MR13\trecord 13\r"}));
    EXPECT_EQ(stage(records(19, 19)), (Texts{"^0=MR19\trecord 19\r"}));
}

TEST_F(PageWindowTest, shouldStageASliceAcrossPages) {
    EXPECT_EQ(stage(records(14, 19)), (Texts{"^0=MR14\trecord 14\r", pages[1]->frames, "^0=MR19\trecord 19\r"}));
    EXPECT_EQ(stage(records(11, 22)), (Texts{pages[0]->frames, pages[1]->frames, pages[2]->frames}));
    EXPECT_EQ(stage(records(15, 18)), (Texts{pages[1]->frames}));
}

TEST_F(PageWindowTest, shouldGiveBackThePagesThatAreSentInOrder) {
    EXPECT_EQ(window.last(), RecordNumber{22});
    EXPECT_EQ(window.take_done(RecordNumber{13}), nullptr);
    EXPECT_EQ(window.take_done(RecordNumber{18}), pages[0].get());
    EXPECT_EQ(window.take_done(RecordNumber{18}), pages[1].get());
    EXPECT_EQ(window.take_done(RecordNumber{18}), nullptr);
    EXPECT_FALSE(window.empty());
    EXPECT_EQ(window.take_any(), pages[2].get());
    EXPECT_EQ(window.take_any(), nullptr);
    EXPECT_EQ(window.take_done(RecordNumber{100}), nullptr);
    EXPECT_TRUE(window.empty());
}

TEST_F(PageWindowTest, shouldGoRoundAsPagesComeAndGo) {
    const auto more = make_pages(23, 22 + 4 * 40, 4, plain_text);
    for (const auto& page : more) {
        ASSERT_NE(window.take_any(), nullptr);
        window.add(page.get());
        const std::uint32_t first = page->first.value();
        ASSERT_EQ(stage(records(first - 1, first)).size(), 2U);
    }
    EXPECT_EQ(window.last(), RecordNumber{182});
}

using PageWindowDeathTest = PageWindowTest;

TEST_F(PageWindowDeathTest, shouldRefuseWhatBreaksTheOrder) {
    EXPECT_DEATH(window.add(nullptr), "page");
    EXPECT_DEATH(window.add(pages[0].get()), "next");
    EXPECT_DEATH(static_cast<void>(stage(records(21, 23))), "at hand");
    EXPECT_DEATH(static_cast<void>(stage(records(10, 12))), "contains");
    PageWindow empty;
    EXPECT_DEATH(static_cast<void>(empty.last()), "empty");
    const auto many = make_pages(1, max_pages + 1, 1, plain_text);
    for (std::size_t i = 0; i < max_pages; ++i) {
        empty.add(many[i].get());
    }
    EXPECT_DEATH(empty.add(many[max_pages].get()), "max_pages");
}

} // namespace
} // namespace linefeed::session
