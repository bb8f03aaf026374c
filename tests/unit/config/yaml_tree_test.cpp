// YAML as a tree: places, quotes, and what is refused whatever the keys mean.
#include "config/yaml_tree.hpp"
#include "texts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::config {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> problems_of(std::string_view text) {
    Problems problems;
    (void)read_yaml(text, "f.yaml", problems);
    return lines_of(problems);
}

Node tree_of(std::string_view text) {
    Problems problems;
    Node node = read_yaml(text, "f.yaml", problems);
    EXPECT_THAT(lines_of(problems), IsEmpty());
    return node;
}

TEST(YamlTree, shouldKeepPlacesAndQuotes) {
    const Node root = tree_of("a: 010\nb:\n  - \"010\"\n  - {ü: x, c: ~}\n");
    ASSERT_EQ(root.kind, Node::Kind::mapping);
    ASSERT_EQ(root.entries.size(), 2U);
    EXPECT_EQ(root.entries[0].value.text, "010");
    EXPECT_TRUE(root.entries[0].value.plain);
    EXPECT_EQ(root.entries[0].value.place, (Place{1, 4, {}}));
    const Node& list = root.entries[1].value;
    ASSERT_EQ(list.items.size(), 2U);
    EXPECT_FALSE(list.items[0].plain);
    EXPECT_EQ(list.items[0].place, (Place{3, 5, {}}));
    const Node* const nothing = list.items[1].find("c");
    ASSERT_NE(nothing, nullptr);
    EXPECT_EQ(nothing->kind, Node::Kind::nothing);
    EXPECT_EQ(list.items[1].entries[1].place, (Place{4, 12, {}})) << "columns count characters, not bytes";
}

TEST(YamlTree, shouldReadNothingFromAnEmptyText) {
    for (const char* text : {"", "\n\n", "# only words\n", "---\n"}) {
        EXPECT_EQ(tree_of(text).kind, Node::Kind::nothing) << text;
    }
}

TEST(YamlTree, shouldPassOverAByteOrderMark) {
    EXPECT_EQ(tree_of("\xEF\xBB\xBF"
                      "a: 1\n")
                  .entries[0]
                  .place,
              (Place{1, 1, {}}));
}

TEST(YamlTree, shouldTellEveryDoubledKeyWithTheFirstOne) {
    EXPECT_THAT(problems_of("a: 1\nb: {c: 1, \"c\": 2}\na: 3\n"),
                ElementsAre("f.yaml:2:11: b.c: doubled key: it stands in line 2 already",
                            "f.yaml:3:1: a: doubled key: it stands in line 1 already"));
    EXPECT_THAT(problems_of("a:\n  - b: 1\n    b: 2\n"),
                ElementsAre("f.yaml:3:5: a[1].b: doubled key: it stands in line 2 already"));
}

TEST(YamlTree, shouldRefuseAnchorsAliasesAndTags) {
    EXPECT_THAT(problems_of("a: &x {b: 1}\nc: *x\nd: !!int 5\ne: !thing {f: 1}\ng: 1\n"),
                ElementsAre("f.yaml:1:4: a: anchors (&name) are not supported: write each value out",
                            "f.yaml:2:4: c: aliases (*name) are not supported: write the value out",
                            "f.yaml:3:4: d: tags (\"tag:yaml.org,2002:int\") are not supported: leave it out",
                            "f.yaml:4:4: e: tags (\"!thing\") are not supported: leave it out"));
}

TEST(YamlTree, shouldRefuseKeysThatAreNoText) {
    EXPECT_THAT(problems_of("{[a]: 1}\n"), ElementsAre("f.yaml:1:2: a key must be a text"));
    EXPECT_THAT(problems_of("a: {~: 1}\n"), ElementsAre("f.yaml:1:5: a: a key must be a text"));
    EXPECT_THAT(problems_of("? {b: 1}\n: 2\n"), ElementsAre("f.yaml:1:3: a key must be a text"));
}

TEST(YamlTree, shouldPlaceSyntaxErrors) {
    EXPECT_THAT(problems_of("a: 1\nb: [1, 2\nc: 3\n"),
                ElementsAre(testing::StartsWith("f.yaml:3:2: not valid YAML: ")));
    EXPECT_THAT(problems_of("a: \"open"), ElementsAre(testing::HasSubstr("not valid YAML: ")));
    EXPECT_THAT(problems_of("a: 1\n\tb: 2\n"), ElementsAre(testing::StartsWith("f.yaml:2:")));
}

TEST(YamlTree, shouldRefuseAQuoteThatSwallowsTheRestOfTheFile) {
    for (const char* text :
         {"a: \"open\n", "a: \"open\nb: 1\n", "a: 'open\nb: 1\n", "a: \"open \\\"\n", "a: 'open ''\n"}) {
        EXPECT_THAT(problems_of(text), ElementsAre("f.yaml:1:4: a: not valid YAML: the quote is not closed")) << text;
    }
    EXPECT_THAT(problems_of("'a: 1\n"), ElementsAre("f.yaml:1:1: not valid YAML: the quote is not closed"));
    EXPECT_EQ(tree_of("a: 'it''s'\nb: \"\\\"\"\nc: \"two\n  lines\"\nd: it's\n").entries[2].value.text, "two lines");
}

TEST(YamlTree, shouldRefuseASecondDocument) {
    EXPECT_THAT(problems_of("a: 1\n---\nb: 2\n"),
                ElementsAre("f.yaml: more than one document: leave the second \"---\" out"));
}

TEST(YamlTree, shouldRefuseWhatIsNoTextInUtf8) {
    EXPECT_THAT(problems_of("a: 1\nb: \xFC\n"), ElementsAre("f.yaml:2:4: not UTF-8: save the file as UTF-8"));
    EXPECT_THAT(problems_of(std::string_view{"a: \0", 4}), ElementsAre("f.yaml:1:4: a control character: \"\\x00\""));
    EXPECT_THAT(problems_of("ü: \x1B[2J\n"), ElementsAre("f.yaml:1:4: a control character: \"\\x1B\""));
}

TEST(YamlTree, shouldRefuseDepthAndSizeBeyondItsBounds) {
    EXPECT_THAT(problems_of(std::string(max_depth, '[') + std::string(max_depth, ']')), IsEmpty());
    EXPECT_THAT(problems_of(std::string(100'000, '[')),
                ElementsAre(testing::HasSubstr("more than 16 lists and mappings in each other")));
    EXPECT_THAT(problems_of(std::string(max_file_bytes + 1, '#')), ElementsAre("f.yaml: larger than 1024 KiB"));
}

TEST(Problems, shouldShowNothingThatActsOnATerminal) {
    EXPECT_EQ(in_quotes("a\x1B[2J\xFF\xE2\x80\xAEü"), "\"a\\x1B[2J\\xFF\\xE2\\x80\\xAEü\"");
    EXPECT_EQ(in_quotes(std::string(61, 'a')), '"' + std::string(60, 'a') + "...\"");
    EXPECT_EQ(to_string(Problem{"a\nb", {1, 2, {}}, "k\n", "m"}), "a\\x0Ab:1:2: k\\x0A: m");
}

TEST(Problems, shouldKeepAHundredAndCountTheRest) {
    Problems problems;
    for (std::uint32_t i = 0; i < 103; ++i) {
        problems.add({"f", {103 - i, 1, {}}, {}, "m"});
    }
    Problems all;
    all.append(problems);
    EXPECT_EQ(all.kept().size(), Problems::max_kept);
    EXPECT_EQ(all.more(), 3U);
    all.sort();
    EXPECT_EQ(all.kept().front().place.line, 4U);
}

} // namespace
} // namespace linefeed::config
