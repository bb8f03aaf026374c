// Printers for people: the table, a single printer, its frames, and findings of a preflight or of the doctor. The JSON
// is that of openapi.yaml.
#pragma once

#include "client/json_fields.hpp"
#include "client/table.hpp"

#include <string>
#include <vector>

namespace linefeed::client {

/// What stands in the tables about a printer.
struct PrinterCells {
    Cell name;
    Cell state; ///< what it does, or why it cannot
    Cell job;
    Cell queue; ///< how many wait
    Cell rate;
    Cell fifo;
    Cell fifo_lasts;
    Cell data_left;
};
[[nodiscard]] PrinterCells printer_cells(const Json& printer);

/// What somebody should know of a printer besides its state, one line each, safe to show.
[[nodiscard]] std::vector<std::string> printer_trouble(const Json& printer);

/// Printer objects as a table, with errors and warnings below it.
[[nodiscard]] std::string printers_text(const std::vector<Json>& printers, const Screen& screen);

/// One Printer object, with all that is known.
[[nodiscard]] std::string printer_text(const Json& printer, const Screen& screen);

/// "line1: printing, job 12, 812/s, FIFO 243 of 256, 1:02:03 left"; one line, safe to show.
[[nodiscard]] std::string printer_line(const Json& printer);

/// Frame objects, a line for each.
[[nodiscard]] std::string frames_text(const std::vector<Json>& frames, const Screen& screen);

/// Finding objects, with the advice below what is not well.
[[nodiscard]] std::string findings_text(const Json& findings, const Screen& screen);

} // namespace linefeed::client
