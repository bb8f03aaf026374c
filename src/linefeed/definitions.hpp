// The subcommands of linefeed with their options and help texts. CLI11 stays in this folder, and each file defines the
// commands of one kind.
#pragma once

#include "cli/exit_code.hpp"
#include "client/command.hpp"
#include "client/printer_commands.hpp"
#include "daemon/operator_word.hpp"
#include "intake/layout.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace linefeed {

/// A subcommand, and what it does once its options are read.
struct Command {
    CLI::App* app = nullptr;
    std::function<cli::ExitCode()> run;
};
using Commands = std::vector<Command>;

// Each adds its subcommands to `app` and to `commands`.
void define_print(CLI::App& app, Commands& commands);
void define_drop(CLI::App& app, Commands& commands);
/// jobs, ledger, distrust
void define_jobs(CLI::App& app, Commands& commands);
/// import, job, queue, cancel, reprint
void define_job_changes(CLI::App& app, Commands& commands);
/// start, resume, settle
void define_starts(CLI::App& app, Commands& commands);
/// What `linefeed printer P` has: every task, monitor, record, replay.
void define_tasks(CLI::App& printer, Commands& commands, const std::shared_ptr<client::PrinterOptions>& options);
/// files get and put, backup, restore, script, preview
void define_files(CLI::App& printer, Commands& commands, const std::shared_ptr<client::PrinterOptions>& options);
/// printers, printer, stop
void define_printers(CLI::App& app, Commands& commands);
/// status, watch, events, folders, audit, reload
void define_service(CLI::App& app, Commands& commands);
/// doctor, check-config, token
void define_checks(CLI::App& app, Commands& commands);

// What several commands have: common_options.cpp

/// Says what is wrong with the options.
[[nodiscard]] cli::ExitCode usage_error(const std::string& problem);

/// `-o,--output`.
void add_output(CLI::App& command, bool& json);

/// Where `linefeed print` keeps its jobs unless it is told otherwise.
[[nodiscard]] std::filesystem::path default_spool();

/// `--socket`, `--url` and `--token-file`.
void add_service(CLI::App& command, client::ServiceOptions& options);
/// The same with `-o`.
void add_common(CLI::App& command, client::CommonOptions& options);

/// A positional JOB.
CLI::Option* add_job(CLI::App& command, std::int64_t& job);

/// Texts of layout options that need more than CLI11's conversion.
struct RawLayout {
    std::string delimiter;
    std::string profile{protocol::profiles.front().name};
    bool no_header = false;
    std::optional<int> orientation;
    std::string graphics_folder;
};
/// The options that decide which records a file gives: the same for every command that reads files.
void add_layout(CLI::App& command, intake::Layout& layout, RawLayout& raw);
/// What is wrong with them, or nothing.
[[nodiscard]] std::string finish_layout(intake::Layout& layout, const RawLayout& raw);

/// `--in-doubt`, `--last-printed` and `--printed`.
struct RawWord {
    std::string in_doubt{"ask"};
};
void add_word(CLI::App& command, daemon::OperatorWord& word, RawWord& raw);
[[nodiscard]] std::string finish_word(daemon::OperatorWord& word, const RawWord& raw);

} // namespace linefeed
