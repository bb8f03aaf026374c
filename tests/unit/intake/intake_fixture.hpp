// Source files in a directory of their own, and rows in a form that can be compared and printed.
#pragma once

#include "intake/row_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace linefeed::intake {

/// A row as one line: "3: a|b", or "3: ! column: problem".
inline std::string to_text(const Row& row) {
    std::string text = std::to_string(row.line) + ": ";
    if (!row.problem.empty()) {
        return text + "! " + (row.problem_column.empty() ? "" : row.problem_column + ": ") + row.problem;
    }
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
        text.append(i == 0 ? "" : "|").append(row.fields[i]);
    }
    return text;
}

class IntakeTest : public testing::Test {
protected:
    void SetUp() override {
        std::string name = std::filesystem::temp_directory_path() / "linefeed-intake-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        directory = name;
    }
    void TearDown() override { std::filesystem::remove_all(directory); }

    std::filesystem::path write(const std::string& content, const std::string& name = "source.csv") const {
        const auto file = directory / name;
        std::ofstream{file, std::ios::binary} << content;
        return file;
    }
    /// Runs SQL on the database db.sqlite and returns its path.
    std::filesystem::path database(const std::string& sql) const {
        const auto file = directory / "db.sqlite";
        sqlite3* connection = nullptr;
        EXPECT_EQ(sqlite3_open(file.c_str(), &connection), SQLITE_OK);
        EXPECT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
            << sqlite3_errmsg(connection);
        EXPECT_EQ(sqlite3_close(connection), SQLITE_OK);
        return file;
    }
    /// All rows as text; a failure comes last, as "failed: …".
    static std::vector<std::string> rows_of(RowSource& source) {
        std::vector<std::string> rows;
        Row row;
        while (true) {
            const auto more = source.next(row);
            if (!more) {
                rows.push_back("failed: " + more.error().message);
                return rows;
            }
            if (!*more) {
                return rows;
            }
            rows.push_back(to_text(row));
        }
    }
    static std::vector<std::string> rows_of(const std::filesystem::path& file, const SourceOptions& options = {}) {
        auto source = open_source(file, options);
        return source ? rows_of(**source) : std::vector{"refused: " + source.error().message};
    }
    static Failure refusal_of(const std::filesystem::path& file, const SourceOptions& options = {}) {
        const auto source = open_source(file, options);
        EXPECT_FALSE(source.has_value());
        const Failure failure = source ? Failure{} : source.error();
        EXPECT_EQ(failure.message.find('\n'), std::string::npos) << failure.message;
        return failure;
    }

    std::filesystem::path directory;
};

} // namespace linefeed::intake
