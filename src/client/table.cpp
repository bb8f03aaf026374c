#include "client/table.hpp"

#include "base/assert.hpp"
#include "cli/progress_view.hpp"

#include <algorithm>
#include <utility>

namespace linefeed::client {

namespace {

constexpr std::size_t gap = 2;

/// The column that takes the most room of those that can still be cut; absent = none.
std::optional<std::size_t> widest(const std::vector<Column>& columns, const std::vector<std::size_t>& widths) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].may_be_cut && widths[i] > Table::shortest_cut && (!found || widths[i] > widths[*found])) {
            found = i;
        }
    }
    return found;
}

} // namespace

Table::Table(std::vector<Column> columns)
    : columns_(std::move(columns)) {}

void Table::add(std::vector<Cell> row) {
    LINEFEED_ASSERT(row.size() == columns_.size());
    for (Cell& cell : row) {
        cell.text = cli::printable(cell.text);
    }
    rows_.push_back(std::move(row));
}

std::vector<std::size_t> Table::widths(const Screen& screen) const {
    std::vector<std::size_t> widths;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        std::size_t width = display_width(columns_[i].title);
        for (const auto& row : rows_) {
            width = std::max(width, display_width(row[i].text));
        }
        widths.push_back(width);
    }
    if (!screen.columns) {
        return widths;
    }
    std::size_t all = gap * (widths.size() - 1);
    for (const std::size_t width : widths) {
        all += width;
    }
    while (all > *screen.columns) {
        const auto column = widest(columns_, widths);
        if (!column) {
            break;
        }
        --widths[*column];
        --all;
    }
    return widths;
}

void Table::append_line(std::string& out, const std::vector<Cell>& row, const std::vector<std::size_t>& widths,
                        const Screen& screen) const {
    std::string blanks;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const std::string text =
            columns_[i].may_be_cut ? cut(row[i].text, std::max<std::size_t>(1, widths[i])) : row[i].text;
        const std::string space(widths[i] - std::min(widths[i], display_width(text)), ' ');
        blanks += columns_[i].right ? space : "";
        if (!text.empty()) { // no blanks at the end of a line
            out += blanks + coloured(text, row[i].colour, screen);
            blanks.clear();
        }
        blanks += columns_[i].right ? "" : space;
        blanks.append(gap, ' ');
    }
    out += '\n';
}

std::string Table::text(const Screen& screen) const {
    const std::vector<std::size_t> all = widths(screen);
    std::string out;
    std::vector<Cell> head;
    for (const Column& column : columns_) {
        head.push_back({column.title, Colour::faint});
    }
    if (std::any_of(columns_.begin(), columns_.end(), [](const Column& column) { return !column.title.empty(); })) {
        append_line(out, head, all, screen);
    }
    for (const auto& row : rows_) {
        append_line(out, row, all, screen);
    }
    return out;
}

Facts::Facts()
    : table_({{"", false, false}, {"", false, false}}) {}

void Facts::add(std::string name, Cell value) {
    if (!value.text.empty()) {
        table_.add({{std::move(name), Colour::faint}, std::move(value)});
    }
}

} // namespace linefeed::client
