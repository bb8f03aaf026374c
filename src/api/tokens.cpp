#include "api/tokens.hpp"

#include "api/random.hpp"
#include "config/problem.hpp"
#include "spool/checksum.hpp"

#include <openssl/crypto.h>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace linefeed::api {

namespace {

constexpr std::size_t max_name = 64;
constexpr std::string_view algorithm = "sha256:";
constexpr std::string_view prefix = "linefeed_"; ///< so that a token is known for one wherever it turns up

bool is_name(std::string_view name) {
    constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
    return !name.empty() && name.size() <= max_name && name.find_first_not_of(allowed) == std::string_view::npos;
}

spool::Sha256Digest digest_of(std::string_view token) {
    spool::Sha256 sha256;
    sha256.update(token);
    return sha256.finish();
}

std::optional<unsigned> hex_digit(char c) {
    constexpr std::string_view digits = "0123456789abcdef";
    const std::size_t at = digits.find(c);
    return at == std::string_view::npos ? std::nullopt : std::optional{static_cast<unsigned>(at)};
}

bool read_hash(std::string_view word, spool::Sha256Digest& digest) {
    if (!word.starts_with(algorithm) || word.size() != algorithm.size() + 2 * digest.size()) {
        return false;
    }
    word.remove_prefix(algorithm.size());
    for (std::size_t k = 0; k < digest.size(); ++k) {
        const auto high = hex_digit(word[2 * k]);
        const auto low = hex_digit(word[2 * k + 1]);
        if (!high || !low) {
            return false;
        }
        digest[k] = static_cast<unsigned char>(*high << 4U | *low);
    }
    return true;
}

/// The next word of a line, without the blanks around it.
std::string_view take_word(std::string_view& line) {
    constexpr std::string_view blanks = " \t\r";
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

/// What is wrong with the line; empty = nothing.
std::string read_line(std::string_view line, Token& token) {
    const std::string_view name = take_word(line);
    const std::string_view role = take_word(line);
    const std::string_view hash = take_word(line);
    if (!is_name(name)) {
        return "the name " + config::in_quotes(name) + " may have letters, digits and ._- only, at most 64";
    }
    if (role != "viewer" && role != "operator") {
        return "the role " + config::in_quotes(role) + " is neither viewer nor operator";
    }
    if (!read_hash(hash, token.sha256) || !take_word(line).empty()) {
        return "behind the role, sha256: and 64 hex digits are expected, and nothing else";
    }
    token.name = name;
    token.role = role == "viewer" ? Role::viewer : Role::operator_;
    return {};
}

struct Descriptor {
    int fd;
    ~Descriptor() {
        if (fd >= 0) {
            ::close(fd);
        }
    }
};

} // namespace

Result<Tokens> Tokens::parse(std::string_view text, const std::filesystem::path& file) {
    Tokens tokens;
    for (std::size_t number = 1; !text.empty(); ++number) {
        std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        std::string_view rest = line;
        const std::string_view first = take_word(rest);
        if (first.empty() || first.front() == '#') {
            continue;
        }
        Token token;
        std::string wrong = read_line(line, token);
        if (std::any_of(tokens.tokens_.begin(), tokens.tokens_.end(),
                        [&](const Token& other) { return other.name == token.name; })) {
            wrong = "the name " + config::in_quotes(token.name) + " comes twice";
        }
        if (tokens.tokens_.size() == max_tokens) {
            wrong = "there are more than " + std::to_string(max_tokens) + " tokens";
        }
        if (!wrong.empty()) {
            return Failure{FailureKind::usage, file.string() + ':' + std::to_string(number) + ": " + wrong +
                                                   " (linefeed token new NAME --role viewer makes a line)"};
        }
        tokens.tokens_.push_back(std::move(token));
    }
    return tokens;
}

Result<Tokens> Tokens::load(const std::filesystem::path& file) {
    const auto failed = [&](const std::string& why) {
        return Failure{FailureKind::usage, "the tokens in " + file.string() + " are not used: " + why};
    };
    const auto system_error = [&] { return failed(std::generic_category().message(errno)); };
    const Descriptor descriptor{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    struct stat status {};
    if (descriptor.fd < 0 || ::fstat(descriptor.fd, &status) != 0) {
        return system_error();
    }
    if (!S_ISREG(status.st_mode)) {
        return failed("it is not a file");
    }
    constexpr mode_t too_open = S_IRWXO | S_IWGRP | S_IXGRP;
    if ((status.st_mode & too_open) != 0) {
        return failed("others may read it, or the group may write it: chmod 640 " + file.string());
    }
    std::string text;
    std::array<char, 16384> piece{};
    for (;;) {
        const ssize_t got = ::read(descriptor.fd, piece.data(), piece.size());
        if (got < 0) {
            return system_error();
        }
        if (got == 0) {
            return parse(text, file);
        }
        text.append(piece.data(), static_cast<std::size_t>(got));
        if (text.size() > max_bytes) {
            return failed("it is larger than 1 MiB");
        }
    }
}

const Token* Tokens::find(std::string_view token) const {
    const spool::Sha256Digest digest = digest_of(token);
    const Token* found = nullptr;
    for (const Token& candidate : tokens_) {
        if (CRYPTO_memcmp(candidate.sha256.data(), digest.data(), digest.size()) == 0) {
            found = &candidate;
        }
    }
    return found;
}

Result<NewToken> make_token(std::string_view name, Role role) {
    if (!is_name(name)) {
        return Failure{FailureKind::usage, "a token's name may have letters, digits and ._- only, at most 64: not " +
                                               config::in_quotes(name)};
    }
    constexpr std::size_t token_bytes = 32;
    NewToken made;
    made.token = std::string{prefix} + random_hex(token_bytes);
    const spool::Sha256Digest digest = digest_of(made.token);
    const std::string_view bytes{reinterpret_cast<const char*>(digest.data()), digest.size()};
    made.line =
        std::string{name} + ' ' + std::string{to_string(role)} + ' ' + std::string{algorithm} + spool::to_hex(bytes);
    return made;
}

} // namespace linefeed::api
