// Look-ups in the one table of commands, see commands.hpp and command_table.hpp.
#include "protocol/commands.hpp"

#include "protocol/command_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace linefeed::protocol {

namespace {

constexpr std::size_t code_bytes = 2;
constexpr std::size_t letters = 26;
constexpr std::size_t letters_and_digits = 36;
constexpr std::size_t no_place = SIZE_MAX;
constexpr std::uint8_t no_command = UINT8_MAX;

/// Where a code stands among all that have a letter in front and a letter or digit behind it.
constexpr std::size_t place_of(std::string_view code) {
    const auto letter = [](char c) { return c >= 'A' && c <= 'Z'; };
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    if (code.size() != code_bytes || !letter(code[0]) || !(letter(code[1]) || digit(code[1]))) {
        return no_place;
    }
    const auto back =
        letter(code[1]) ? static_cast<std::size_t>(code[1] - 'A') : static_cast<std::size_t>(code[1] - '0') + letters;
    return static_cast<std::size_t>(code[0] - 'A') * letters_and_digits + back;
}

/// What is known of the names of one enumeration.
template <std::size_t Size>
struct Names {
    std::array<std::uint8_t, Size> rows{};                          ///< of the table, by enumerator
    std::array<std::uint8_t, letters * letters_and_digits> index{}; ///< by the place of the code: every answer is
                                                                    ///< looked up on its way to the refill
};

/// From the rows of a group and, where that has none for a name, of another.
template <std::size_t Size>
constexpr Names<Size> names_of(Group group, Group other) {
    Names<Size> names;
    names.rows.fill(no_command);
    names.index.fill(no_command);
    for (std::size_t place = 0; place < command_table.size(); ++place) {
        const Command& row = command_table[place];
        if (row.group == group || (row.group == other && names.rows[row.index] == no_command)) {
            names.rows[row.index] = static_cast<std::uint8_t>(place);
            names.index[place_of(row.code)] = row.index;
        }
    }
    return names;
}

constexpr auto actions = names_of<static_cast<std::size_t>(Action::end_of_data) + 1>(Group::action, Group::action);
constexpr auto parameters = names_of<static_cast<std::size_t>(Parameter::VS) + 1>(Group::parameter, Group::inquiry);
constexpr auto files = names_of<static_cast<std::size_t>(FileCommand::FA) + 1>(Group::file, Group::file);

/// Each enumerator has its row, and each code leads to one.
template <std::size_t Size>
constexpr bool complete(const Names<Size>& names) {
    return std::ranges::count(names.rows, no_command) == 0 &&
           std::ranges::count_if(names.index, [](std::uint8_t index) { return index != no_command; }) ==
               static_cast<std::ptrdiff_t>(Size);
}
static_assert(complete(actions) && complete(parameters) && complete(files));

template <typename Name, std::size_t Size>
const Command& row_of(const Names<Size>& names, Name name) {
    return command_table[names.rows[static_cast<std::size_t>(name)]];
}

template <typename Name, std::size_t Size>
std::optional<Name> find(const Names<Size>& names, std::string_view code) {
    const std::size_t place = place_of(code);
    const std::uint8_t index = place == no_place ? no_command : names.index[place];
    return index == no_command ? std::nullopt : std::optional{static_cast<Name>(index)};
}

} // namespace

std::string_view code(Action action) {
    return row_of(actions, action).code;
}

std::string_view code(Parameter parameter) {
    return row_of(parameters, parameter).code;
}

std::string_view code(FileCommand command) {
    return row_of(files, command).code;
}

std::string_view description(Action action) {
    return row_of(actions, action).description;
}

std::string_view description(Parameter parameter) {
    return row_of(parameters, parameter).description;
}

std::string_view description(FileCommand command) {
    return row_of(files, command).description;
}

std::optional<Action> action_from_code(std::string_view code) {
    return find<Action>(actions, code);
}

std::optional<Parameter> parameter_from_code(std::string_view code) {
    return find<Parameter>(parameters, code);
}

std::optional<FileCommand> file_command_from_code(std::string_view code) {
    return find<FileCommand>(files, code);
}

} // namespace linefeed::protocol
