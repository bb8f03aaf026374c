// A spool in a directory of its own, and jobs of numbered records, for tests that print over real sockets.
#pragma once

#include "protocol/mail_record.hpp"
#include "spool/spool.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace linefeed::realtime {

/// Removed with all that is in it at the end.
class SpoolDirectory {
public:
    SpoolDirectory() {
        std::string name = std::filesystem::temp_directory_path() / "linefeed-realtime-XXXXXX";
        if (::mkdtemp(name.data()) == nullptr) {
            throw std::runtime_error{"no directory for the spool"};
        }
        path_ = name;
        spool_.emplace(spool::Spool::open(path_ / "spool.db", {[] { return std::int64_t{1}; }, {}}).value());
    }
    ~SpoolDirectory() {
        spool_.reset();
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    SpoolDirectory(const SpoolDirectory&) = delete;
    SpoolDirectory& operator=(const SpoolDirectory&) = delete;

    [[nodiscard]] spool::Spool& spool() { return *spool_; }

    [[nodiscard]] spool::Job import_job(std::uint32_t records, std::uint32_t records_of_page = 256) {
        const protocol::MailRecordEncoder encoder{{protocol::Charset::latin1}, protocol::EscapeMode::backslash};
        spool::JobSpec spec;
        spec.source.path = "/data/serials.csv";
        auto import = spool_->begin_import(spec).value();
        for (std::uint32_t first = 1; first <= records; first += records_of_page) {
            RecordPage page{RecordNumber{first}, {}, {}};
            for (std::uint32_t number = first; number < std::min(records + 1, first + records_of_page); ++number) {
                const std::string text = "SN-" + std::to_string(number);
                encoder.append(page.frames, RecordNumber{number}, std::array{std::string_view{text}}).value();
                page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
            }
            import.add(page).value();
        }
        return import.commit({}).value();
    }

private:
    std::filesystem::path path_;
    std::optional<spool::Spool> spool_;
};

} // namespace linefeed::realtime
