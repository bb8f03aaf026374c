#include "cli/operator_name.hpp"

#include <pwd.h>
#include <unistd.h>

namespace linefeed::cli {

std::string operator_name() {
    const passwd* user = ::getpwuid(::getuid());
    return user != nullptr ? user->pw_name : "uid " + std::to_string(::getuid());
}

} // namespace linefeed::cli
