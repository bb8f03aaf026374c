// Who may what over TCP: a file of lines `name role hash`. The token itself is nowhere on this machine: 256 random
// bits, shown once when it is made. It cannot be guessed, whatever the hash costs, so a fast hash is right: a slow one
// would only let strangers keep the service busy with wrong tokens.
#pragma once

#include "api/exchange.hpp"
#include "base/failure.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::api {

struct Token {
    std::string name; ///< letters, digits and `._-`
    Role role = Role::viewer;
    std::array<unsigned char, 32> sha256{}; ///< of the token as it is shown
};

/// What a token file says.
class Tokens {
public:
    static constexpr std::size_t max_tokens = 1000;
    static constexpr std::size_t max_bytes = std::size_t{1} << 20U;

    /// Blank lines and lines that begin with # are passed over. FailureKind::usage with file and line if a line is not
    /// `name viewer|operator sha256:HEX`, or a name comes twice.
    [[nodiscard]] static Result<Tokens> parse(std::string_view text, const std::filesystem::path& file);
    /// FailureKind::usage besides if the file cannot be read, or others may read it or the group write it.
    [[nodiscard]] static Result<Tokens> load(const std::filesystem::path& file);

    /// Takes equally long whichever token it is. nullptr = it is none.
    [[nodiscard]] const Token* find(std::string_view token) const;
    [[nodiscard]] std::size_t size() const { return tokens_.size(); }

private:
    std::vector<Token> tokens_;
};

/// A token that nobody has yet.
struct NewToken {
    std::string token; ///< to be shown once
    std::string line;  ///< for the file, without newline
};

/// FailureKind::usage if the name has other characters or is longer than 64.
[[nodiscard]] Result<NewToken> make_token(std::string_view name, Role role);

} // namespace linefeed::api
