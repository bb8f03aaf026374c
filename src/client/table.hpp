// Tables for people: aligned columns, and on a terminal no line longer than it is wide where a column may be cut. Every
// text is made safe to show here, so that no caller can forget it: texts come from files and printers.
#pragma once

#include "client/terminal.hpp"

#include <string>
#include <vector>

namespace linefeed::client {

struct Column {
    std::string title;
    bool right = false;      ///< numbers
    bool may_be_cut = false; ///< down to shortest_cut columns, where the terminal is too narrow
};

struct Cell {
    std::string text; ///< any bytes
    Colour colour = Colour::none;
};

/// Flow: construct, add() each row, text().
class Table {
public:
    static constexpr std::size_t shortest_cut = 8;

    /// Without titles in any column there is no head.
    explicit Table(std::vector<Column> columns);

    /// Precondition: as many cells as columns.
    void add(std::vector<Cell> row);
    [[nodiscard]] bool empty() const { return rows_.empty(); }
    /// Every line with its line end; nothing but the head if there is no row.
    [[nodiscard]] std::string text(const Screen& screen) const;

private:
    [[nodiscard]] std::vector<std::size_t> widths(const Screen& screen) const;
    void append_line(std::string& out, const std::vector<Cell>& row, const std::vector<std::size_t>& widths,
                     const Screen& screen) const;

    std::vector<Column> columns_;
    std::vector<std::vector<Cell>> rows_; ///< printable
};

/// Name and value, one below the other, never cut.
class Facts {
public:
    Facts();
    /// An empty value is left out.
    void add(std::string name, Cell value);
    [[nodiscard]] std::string text(const Screen& screen) const { return table_.text(screen); }

private:
    Table table_;
};

} // namespace linefeed::client
