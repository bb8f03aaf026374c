#include "printer/printer_files.hpp"

#include "printer/exchange.hpp"

namespace linefeed::printer {

using protocol::Parameter;

Result<protocol::VersionInfo> ConversationFiles::identity() {
    const auto versions = printer_.ask<protocol::VersionInfo>(Parameter::VS);
    return versions ? Result<protocol::VersionInfo>{*versions} : no_answer(printer_, Parameter::VS);
}

Result<std::string> ConversationFiles::loaded_job() {
    const auto job = printer_.ask<protocol::JobName>(Parameter::JL);
    return job ? job->path : std::string{};
}

Result<std::vector<protocol::DirectoryEntry>> ConversationFiles::list(const std::string& directory) {
    const auto there = list_files(printer_, directory);
    return there && !there->empty() ? list_directory(printer_, directory) : there;
}

Result<std::string> ConversationFiles::read(const std::string& path) {
    return download(printer_, path, options_);
}

Result<bool> ConversationFiles::exists(const std::string& path) {
    const auto there = list_files(printer_, path);
    return there ? Result<bool>{!there->empty()} : there.error();
}

Result<void> ConversationFiles::write(const std::string& path, std::string_view bytes) {
    return put_file(printer_, path, bytes, true, options_);
}

} // namespace linefeed::printer
