// A job to print, in a spool of its own in memory, and the same records as pages: what the programs here feed from.
#pragma once

#include "base/record_page.hpp"
#include "protocol/mail_record.hpp"
#include "spool/spool.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace linefeed::benchmarks {

/// As many as intake puts into a page.
inline constexpr std::uint32_t records_of_page = 512;

/// Records of one field of about 30 bytes.
inline std::vector<RecordPage> make_pages(std::uint32_t records) {
    const protocol::MailRecordEncoder encoder{{protocol::Charset::latin1}, protocol::EscapeMode::backslash};
    std::vector<RecordPage> pages;
    for (std::uint32_t first = 1; first <= records; first += records_of_page) {
        RecordPage page{RecordNumber{first}, {}, {}};
        for (std::uint32_t number = first; number <= std::min(records, first + records_of_page - 1); ++number) {
            const std::string text = "SN-" + std::to_string(1000000000 + number) + "-ABCDEFGHIJKLMNOP";
            encoder.append(page.frames, RecordNumber{number}, std::array{std::string_view{text}}).value();
            page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
        }
        pages.push_back(std::move(page));
    }
    return pages;
}

/// The pages as the only job of a spool in /dev/shm: syncs to a disk would only add noise.
class PrintJob {
public:
    explicit PrintJob(const std::vector<RecordPage>& pages)
        : directory_(make_directory())
        , spool_(spool::Spool::open(directory_ / "spool.db", {[] { return std::int64_t{1}; }, {}}).value())
        , job_(import(pages)) {}
    ~PrintJob() { std::filesystem::remove_all(directory_); }
    PrintJob(const PrintJob&) = delete;
    PrintJob& operator=(const PrintJob&) = delete;

    [[nodiscard]] spool::Spool& spool() { return spool_; }
    [[nodiscard]] const spool::Job& job() const { return job_; }

private:
    static std::filesystem::path make_directory() {
        const std::filesystem::path memory = "/dev/shm";
        const auto base = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
        std::string name = base / "linefeed-feed-XXXXXX";
        LINEFEED_ASSERT(::mkdtemp(name.data()) != nullptr);
        return name;
    }
    spool::Job import(const std::vector<RecordPage>& pages) {
        spool::JobSpec spec;
        spec.source.path = "/data/records.csv";
        auto import = spool_.begin_import(spec).value();
        for (const RecordPage& page : pages) {
            import.add(page).value();
        }
        return import.commit({}).value();
    }

    std::filesystem::path directory_;
    spool::Spool spool_;
    spool::Job job_;
};

} // namespace linefeed::benchmarks
