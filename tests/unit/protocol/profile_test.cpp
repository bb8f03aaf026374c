// What differs between firmwares.
#include "protocol/profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace linefeed::protocol {
namespace {

TEST(Profile, shouldBeFoundByName) {
    const auto jet3up = profile_by_name("jet3up");
    ASSERT_TRUE(jet3up);
    EXPECT_EQ(jet3up->escapes, EscapeMode::backslash);
    EXPECT_EQ(profile_by_name("jet2neo").value().escapes, EscapeMode::backslash);
}

TEST(Profile, shouldKnowTheFirmwareWithoutEscapes) {
    EXPECT_EQ(profile_by_name("jet3").value().escapes, EscapeMode::none);
    EXPECT_EQ(profile_by_name("jet2neo-v71").value().escapes, EscapeMode::none);
}

TEST(Profile, shouldNotGuess) {
    EXPECT_FALSE(profile_by_name("JET3"));
    EXPECT_FALSE(profile_by_name(""));
}

TEST(Profile, shouldKnowWhatTheFamiliesHave) {
    const Profile jet3 = profile_by_name("jet3").value();
    const Profile jet3up = profile_by_name("jet3up").value();
    const Profile jet2neo = profile_by_name("jet2neo").value();
    EXPECT_EQ(jet3up.configured_inputs(), 6U);
    EXPECT_EQ(jet2neo.configured_inputs(), 3U);
    EXPECT_EQ(jet3.outputs(), 8U);
    EXPECT_EQ(jet2neo.outputs(), 4U);
    EXPECT_EQ(jet3up.job_select_inputs(), 10U);
    EXPECT_EQ(jet2neo.job_select_inputs(), 8U);
    EXPECT_EQ(jet3.graphic_height, 32U);
    EXPECT_EQ(jet2neo.graphic_height, 24U);
    EXPECT_TRUE(jet3.has_sd_card());
    EXPECT_FALSE(jet3up.has_sd_card() || jet2neo.has_sd_card());
    EXPECT_EQ(jet3up.usb_root(), "USB-Stick\\LJ3");
    EXPECT_EQ(jet2neo.usb_root(), "USB-Stick\\LJet2neo");
}

TEST(Profile, shouldRiskNothingBeforeThePrinterHasTold) {
    const Profile automatic = profile_by_name("auto").value();
    EXPECT_TRUE(is_automatic(automatic));
    EXPECT_EQ(automatic.escapes, EscapeMode::none) << "what needs escapes is refused";
    EXPECT_FALSE(is_automatic(profile_by_name("jet3").value()));
}

TEST(Profile, shouldBeWhatItsOwnerSaysOfIt) {
    const Profile profile = parse_profile("jet3,escapes=on,speed=m/min,record-properties=off,output-control=off,"
                                          "counter-limits=on,graphic-height=16")
                                .value();
    EXPECT_EQ(profile.name, "jet3");
    EXPECT_EQ(profile.escapes, EscapeMode::backslash);
    EXPECT_TRUE(profile.speed_in_metres);
    EXPECT_FALSE(profile.record_properties);
    EXPECT_FALSE(profile.output_control);
    EXPECT_TRUE(profile.counter_parameters);
    EXPECT_EQ(profile.graphic_height, 16U);
    EXPECT_TRUE(profile.has_sd_card()) << "the rest is as the name says";
    EXPECT_EQ(to_string(profile), "jet3,escapes=on,speed=m/min,record-properties=off,output-control=off,"
                                  "counter-limits=on,graphic-height=16");
}

TEST(Profile, shouldBeWrittenAsItIsRead) {
    for (const std::string_view text : {"jet3up", "auto", "auto,escapes=off", "jet2neo,speed=dm/min,graphic-height=1",
                                        "jet2neo-v71,record-properties=on,counter-limits=off"}) {
        EXPECT_EQ(to_string(parse_profile(text).value()), text);
    }
    EXPECT_EQ(to_string(parse_profile("jet3,output-control=on,escapes=on").value()),
              "jet3,escapes=on,output-control=on");
}

TEST(Profile, shouldSayWhatIsWrongWithIt) {
    const auto problem = [](std::string_view text) { return parse_profile(text).error().message; };
    EXPECT_EQ(problem("jet4"),
              "there is no firmware profile \"jet4\"; there are: jet3up, jet3, jet2neo, jet2neo-v71, auto");
    EXPECT_EQ(problem("jet3,echo=on"), "\"echo\" is no property of a firmware profile; there are: escapes, speed, "
                                       "record-properties, output-control, counter-limits, graphic-height");
    EXPECT_THAT(problem("jet3,"), testing::StartsWith("\"\" is no property"));
    EXPECT_EQ(problem("jet3,escapes=1"), "escapes is on or off, not \"1\"");
    EXPECT_EQ(problem("jet3,speed"), "speed is dm/min or m/min, not \"\"");
    EXPECT_EQ(problem("jet3,graphic-height=33"), "graphic-height is 1 to 32, not \"33\"");
    EXPECT_EQ(problem("jet3,graphic-height=0"), "graphic-height is 1 to 32, not \"0\"");
    EXPECT_EQ(problem("jet3,escapes=on,escapes=on"), "escapes is set twice");
    EXPECT_EQ(parse_profile("jet4").error().kind, FailureKind::usage);
}

TEST(Profile, shouldKeepItsOwnersWordWhateverThePrinterTells) {
    const Profile told = with_own_properties(profile_for("JET3", "V60.0.1.17").value(),
                                             parse_profile("auto,escapes=on,speed=dm/min").value().own);
    EXPECT_EQ(to_string(told), "jet3,escapes=on,speed=dm/min");
    EXPECT_EQ(told.escapes, EscapeMode::backslash);
    EXPECT_FALSE(told.speed_in_metres);
    EXPECT_FALSE(told.record_properties) << "as the version says";
}

Profile of(std::string_view type, std::string_view firmware) {
    const auto profile = profile_for(type, firmware);
    EXPECT_TRUE(profile) << type << ' ' << firmware;
    return profile.value_or(Profile{});
}

TEST(Profile, shouldFollowFromTypeAndVersion) {
    EXPECT_EQ(of("JET3", "V60.0.25.0").name, "jet3");
    EXPECT_EQ(of("JET3up", "V62.0.9.0").name, "jet3up");
    EXPECT_EQ(of("Leibinger Jet3Up Pro", "v62.0.9.0").name, "jet3up");
    EXPECT_EQ(of("JET2neo", "V71.0.27.00").name, "jet2neo-v71");
    EXPECT_EQ(of("JET2neo", "V71.0.27.01").name, "jet2neo");
    EXPECT_EQ(of("JET2neo", "V75.0.11.2").name, "jet2neo");
    for (const auto& [type, firmware] :
         {std::pair{"JET4", "V1.0"}, std::pair{"", "V60.0.1"}, std::pair{"JET3", ""}, std::pair{"JET3", "V"},
          std::pair{"JET3", "new"}, std::pair{"JET3", "V60.x"}}) {
        EXPECT_FALSE(profile_for(type, firmware)) << type << ' ' << firmware;
    }
}

TEST(Profile, shouldTakeEachThingFromTheVersionThatTheManualNames) {
    EXPECT_TRUE(of("JET3", "V60.0.1.17").speed_in_metres);
    EXPECT_FALSE(of("JET3", "V60.0.1.18").speed_in_metres);
    EXPECT_TRUE(of("JET2neo", "V71.0.00.11").speed_in_metres);
    EXPECT_FALSE(of("JET2neo", "V71.0.00.12").speed_in_metres);
    EXPECT_FALSE(of("JET3", "V60.0.1.21").record_properties);
    EXPECT_TRUE(of("JET3", "V60.0.1.22").record_properties);
    EXPECT_FALSE(of("JET2neo", "V71.0.21.9").record_properties);
    EXPECT_TRUE(of("JET2neo", "V71.0.22.00").record_properties);
    EXPECT_FALSE(of("JET3", "V60.0.01.04D").output_control);
    EXPECT_TRUE(of("JET3", "V60.0.25.0").output_control);
    EXPECT_FALSE(of("JET2neo", "V75.0.11.2").output_control);
    EXPECT_FALSE(of("JET3up", "V62.0.6.9").counter_parameters);
    EXPECT_TRUE(of("JET3up", "V62.0.7.0").counter_parameters);
    EXPECT_FALSE(of("JET3", "V62.0.7.0").counter_parameters);
}

} // namespace
} // namespace linefeed::protocol
