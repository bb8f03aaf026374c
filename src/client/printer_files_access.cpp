#include "client/printer_files_access.hpp"

#include "api/exchange.hpp"
#include "printer/local_file.hpp"
#include "printer/printer_path.hpp"
#include "printer/tasks.hpp"

#include <cstdlib>
#include <unistd.h>

namespace linefeed::client {

Result<ServiceFiles> service_files(const PrinterOptions& options) {
    const auto place = find_service(options.common.service);
    return place ? Result<ServiceFiles>{ServiceFiles{Service{*place}, options}} : place.error();
}

Result<Json> ServiceFiles::ask(std::string_view task, std::string_view path) const {
    TaskOptions options{options_, printer::find_task(task), {}, true};
    if (!path.empty()) {
        options.arguments.emplace_back("path", std::string{path});
    }
    return task_answer(options);
}

std::string ServiceFiles::target(const std::string& path) const {
    return printer_path(options_.printer, "/files?path=" + api::url_encoded(printer::path_text(path)));
}

Result<protocol::VersionInfo> ServiceFiles::identity() {
    const auto answer = ask("info");
    if (!answer) {
        return answer.error();
    }
    protocol::VersionInfo info;
    info.type = text(*answer, "type");
    info.serial_number = text(*answer, "serial_number");
    info.firmware = text(*answer, "firmware");
    return info;
}

Result<std::string> ServiceFiles::loaded_job() {
    const auto answer = ask("jobs");
    return answer ? Result<std::string>{printer::path_bytes(text(*answer, "loaded")).value_or("")} : answer.error();
}

Result<std::vector<protocol::DirectoryEntry>> ServiceFiles::list(const std::string& directory) {
    const auto there = exists(directory);
    if (!there || !*there) {
        return there ? Result<std::vector<protocol::DirectoryEntry>>{boost::system::in_place_value} : there.error();
    }
    const auto answer = ask("files ls", printer::path_text(directory));
    if (!answer) {
        return answer.error();
    }
    std::vector<protocol::DirectoryEntry> entries;
    for (const Json& entry : member(*answer, "entries")) {
        entries.push_back({printer::path_bytes(text(entry, "name")).value_or(""), member(entry, "directory") == true});
    }
    return entries;
}

Result<std::string> ServiceFiles::read(const std::string& path) {
    return service_.get_bytes(target(path));
}

Result<bool> ServiceFiles::exists(const std::string& path) {
    const auto answer = ask("files ls", printer::path_text(path));
    if (!answer) {
        return answer.error().kind == FailureKind::input ? Result<bool>{false} : answer.error();
    }
    return true;
}

Result<void> ServiceFiles::write(const std::string& path, std::string_view bytes) {
    std::string name = (std::filesystem::temp_directory_path() / "linefeed-XXXXXX").string();
    const int descriptor = ::mkstemp(name.data());
    if (descriptor < 0) {
        return Failure{FailureKind::storage, name + ": cannot be made"};
    }
    ::close(descriptor);
    auto file = printer::NewFile::create(name, printer::NewFile::Existing::replace);
    auto written = file ? file->write(bytes) : file.error();
    written = written ? file->commit() : written;
    written = written ? send(path, name, true) : written;
    ::unlink(name.c_str());
    return written;
}

Result<void> ServiceFiles::send(const std::string& path, const std::filesystem::path& local, bool replace) {
    const auto done = service_.upload(target(path) + (replace ? "&replace=true" : ""), local, api::media::bytes);
    return done ? Result<void>{} : done.error();
}

} // namespace linefeed::client
