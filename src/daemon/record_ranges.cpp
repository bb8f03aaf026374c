#include "daemon/record_ranges.hpp"

#include <algorithm>
#include <charconv>

namespace linefeed::daemon {

namespace {

std::string_view without_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view{}
                                           : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Failure no_range(std::string_view part) {
    return {FailureKind::usage, '"' + std::string{part} +
                                    "\" is neither a record number nor a range: expected N or N-M, separated by "
                                    "commas, or none"};
}

} // namespace

std::optional<RecordRange> parse_record_range(std::string_view text) {
    std::uint32_t first = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, first);
    if (error != std::errc{}) {
        return std::nullopt;
    }
    if (stop == end) {
        return RecordRange{RecordNumber{first}, RecordCount{1}};
    }
    std::uint32_t last = 0;
    if (*stop != '-') {
        return std::nullopt;
    }
    const auto [last_stop, last_error] = std::from_chars(stop + 1, end, last);
    if (last_error != std::errc{} || last_stop != end || last < first) {
        return std::nullopt;
    }
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

Result<std::vector<RecordRange>> parse_record_ranges(std::string_view text) {
    std::vector<RecordRange> ranges;
    if (without_blanks(text) == "none") {
        return ranges;
    }
    for (bool more = true; more;) {
        const std::size_t comma = text.find(',');
        const std::string_view part = without_blanks(text.substr(0, comma));
        const auto range = parse_record_range(part);
        if (!range) {
            return no_range(part);
        }
        ranges.push_back(*range);
        more = comma != std::string_view::npos;
        text.remove_prefix(more ? comma + 1 : text.size());
    }
    std::sort(ranges.begin(), ranges.end(),
              [](const RecordRange& a, const RecordRange& b) { return a.first() < b.first(); });
    for (std::size_t k = 1; k < ranges.size(); ++k) {
        if (ranges[k].first() <= ranges[k - 1].last()) {
            return Failure{FailureKind::usage, "record " + std::to_string(ranges[k].first().value()) +
                                                   " is named twice, in " + to_text(ranges[k - 1]) + " and in " +
                                                   to_text(ranges[k])};
        }
    }
    return ranges;
}

std::string to_text(const RecordRange& range) {
    if (range.empty()) {
        return "none";
    }
    const std::string first = std::to_string(range.first().value());
    return range.count() == RecordCount{1} ? first : first + '-' + std::to_string(range.last().value());
}

std::string to_text(const std::vector<RecordRange>& ranges) {
    constexpr std::size_t most = 20;
    std::string text;
    for (std::size_t k = 0; k < std::min(ranges.size(), most); ++k) {
        text += (k == 0 ? "" : ", ") + to_text(ranges[k]);
    }
    if (ranges.size() > most) {
        text += " and " + std::to_string(ranges.size() - most) + " more ranges";
    }
    return ranges.empty() ? "none" : text;
}

} // namespace linefeed::daemon
