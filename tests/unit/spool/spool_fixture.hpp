// A spool in a directory of its own, jobs with simple content, and a second connection for looking at and damaging the
// file.
#pragma once

#include "spool/spool.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace linefeed::spool {

inline RecordRange range(std::uint32_t first, std::uint32_t last) {
    return RecordRange::closed(RecordNumber{first}, RecordNumber{last});
}

/// A page whose records are `^0=MR<number>\tname <number>\r`.
inline RecordPage page_of(std::uint32_t first, std::uint32_t count) {
    RecordPage page{RecordNumber{first}, {}, {}};
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t number = first + i;
        page.frames += "^0=MR" + std::to_string(number) + "\tname " + std::to_string(number) + "\r";
        page.ends.push_back(static_cast<std::uint32_t>(page.frames.size()));
    }
    return page;
}

class SpoolTest : public testing::Test {
protected:
    void SetUp() override {
        std::string name = base_directory() / "linefeed-spool-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        directory = name;
        path = directory / "spool.db";
    }
    void TearDown() override { std::filesystem::remove_all(directory); }

    [[nodiscard]] virtual std::filesystem::path base_directory() const {
        return std::filesystem::temp_directory_path();
    }
    Result<Spool> try_open() {
        return Spool::open(path, {[this] { return now_ns; }, {}});
    }
    Spool open() {
        auto spool = try_open();
        EXPECT_TRUE(spool.has_value()) << spool.error().message;
        return std::move(spool).value();
    }
    static JobSpec spec(std::uint32_t base = 0) {
        return {{"/data/names.csv", 1000, 77, 5, ""}, R"({"columns":["name"]})", RecordNumber{base}};
    }
    /// A ready job with records base + 1 … base + count in pages of 10.
    static Job make_job(Spool& spool, std::uint32_t count = 100, std::uint32_t base = 0) {
        auto import = spool.begin_import(spec(base));
        EXPECT_TRUE(import.has_value());
        for (std::uint32_t done = 0; done < count; done += 10) {
            EXPECT_TRUE(import->add(page_of(base + done + 1, std::min(10U, count - done))).has_value());
        }
        auto job = import->commit("{}");
        EXPECT_TRUE(job.has_value());
        return job.value();
    }
    static Result<void> append(Spool& spool, JobId job, std::initializer_list<LedgerEntry> entries) {
        return spool.append(job, {entries.begin(), entries.size()});
    }
    /// Runs SQL over another connection and returns the first value as text.
    std::string sql(const std::string& text) const {
        sqlite3* connection = nullptr;
        EXPECT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
        std::string result;
        const auto take = [](void* out, int, char** values, char**) {
            *static_cast<std::string*>(out) = values[0] == nullptr ? "" : values[0];
            return 0;
        };
        char* error = nullptr;
        if (sqlite3_exec(connection, text.c_str(), take, &result, &error) != SQLITE_OK) {
            result = std::string{"error: "} + error;
            sqlite3_free(error);
        }
        sqlite3_close(connection);
        return result;
    }

    std::filesystem::path directory;
    std::filesystem::path path;
    std::int64_t now_ns = 1'000;
};

} // namespace linefeed::spool
