#include "service/layouts.hpp"

#include "base/assert.hpp"

namespace linefeed::service {

intake::Layout layout_of(const config::LayoutSettings& settings, const protocol::Profile& profile) {
    intake::Layout layout;
    layout.columns = settings.columns;
    layout.table = settings.table;
    layout.query = settings.query;
    layout.delimiter = settings.delimiter;
    layout.header = settings.header;
    layout.skip_bad = settings.skip_bad;
    if (settings.encoding != protocol::Charset::latin1) { // left out, as by whoever prints from the command line
        layout.encodings.emplace_back(protocol::to_string(settings.encoding));
    }
    for (const auto& [column, charset] : settings.column_encodings) {
        layout.encodings.push_back(column + '=' + std::string{protocol::to_string(charset)});
    }
    layout.graphics = settings.graphics;
    layout.graphics_folder = settings.graphics_folder;
    layout.profile = profile;
    layout.base = settings.base;
    layout.properties = settings.properties();
    return layout;
}

namespace {

intake::SettleBy settle_by(config::Settle settle) {
    switch (settle) {
    case config::Settle::in_place:
        return intake::SettleBy::quiet;
    case config::Settle::rename:
        return intake::SettleBy::renaming;
    case config::Settle::done_companion:
        return intake::SettleBy::done_mark;
    }
    assertion_failed("Settle", __FILE__, __LINE__);
}

intake::WatchMode watch_mode(config::Watch watch) {
    switch (watch) {
    case config::Watch::inotify:
        return intake::WatchMode::inotify;
    case config::Watch::poll:
        return intake::WatchMode::poll;
    }
    assertion_failed("Watch", __FILE__, __LINE__);
}

} // namespace

intake::DropSettings drop_settings(const config::FolderSettings& folder, const config::Settings& settings) {
    const config::LayoutSettings* const layout = settings.layout(folder.layout);
    const config::PrinterSettings* const printer = settings.printer(folder.printer);
    LINEFEED_ASSERT(layout != nullptr && printer != nullptr);
    intake::DropSettings drop;
    drop.folder = folder.path;
    drop.pattern = folder.pattern;
    drop.settle.by = settle_by(folder.settle);
    drop.mode = watch_mode(folder.watch);
    drop.rescan = folder.poll_interval;
    drop.layout = layout_of(*layout, printer->profile);
    drop.refuse_grown = folder.grown_files == config::GrownFiles::refuse;
    if (!drop.layout.graphics_folder) {
        drop.layout.graphics_folder = folder.path; // a file that is being read lies in a folder of its own
    }
    return drop;
}

} // namespace linefeed::service
