// Tables of commands, see command_help.hpp.
#include "protocol/command_help.hpp"

#include "base/assert.hpp"

namespace linefeed::protocol {

namespace {

std::string_view title_of(Group group) {
    switch (group) {
    case Group::action:
        return "Actions";
    case Group::inquiry:
        return "Inquiries";
    case Group::parameter:
        return "Parameter transfers";
    case Group::script:
        return "Scripts";
    case Group::file:
        return "Files and directories";
    }
    assertion_failed("Group", __FILE__, __LINE__);
}

void append_row(std::string& out, const Command& row, std::span<const CommandColumn> columns) {
    out.append("| `^0").push_back(static_cast<char>(row.group));
    out.append(row.code.empty() ? "…" : row.code).append("` | ").append(to_string(row.direction)).append(" | ");
    out.append(row.description).append(" | ").append(row.parameters).append(" | ");
    out.append(to_string(row.risk)).append(" |");
    for (const CommandColumn& column : columns) {
        out.append(" ").append(column.cell(row)).append(" |");
    }
    out.push_back('\n');
}

} // namespace

std::string_view to_string(Direction direction) {
    switch (direction) {
    case Direction::to_printer:
        return "host to printer";
    case Direction::to_host:
        return "printer to host";
    case Direction::both:
        return "both ways";
    }
    assertion_failed("Direction", __FILE__, __LINE__);
}

std::string_view to_string(Risk risk) {
    switch (risk) {
    case Risk::none:
        return "";
    case Risk::line:
        return "disturbs the line";
    case Risk::destructive:
        return "loses what is in the printer";
    }
    assertion_failed("Risk", __FILE__, __LINE__);
}

std::string commands_as_markdown(std::span<const CommandColumn> columns) {
    std::string out = "# Every command of the interface protocol\n\n"
                      "linefeed knows each of these commands as a type, and its simulator answers each.\n";
    std::string head = "| command | direction | what | parameters | risk |";
    std::string line = "|---|---|---|---|---|";
    for (const CommandColumn& column : columns) {
        head.append(" ").append(column.title).append(" |");
        line.append("---|");
    }
    Group group = Group::file;
    for (const Command& row : command_table) {
        if (row.group != group) {
            group = row.group;
            out.append("\n## ").append(title_of(group)).append("\n\n");
            out.append(head).append("\n").append(line).append("\n");
        }
        append_row(out, row, columns);
    }
    return out;
}

} // namespace linefeed::protocol
