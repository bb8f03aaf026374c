// From the settings' words to those of the intake: one layout, one way of a folder to say that a file is whole.
#pragma once

#include "config/settings.hpp"
#include "intake/drop_folder.hpp"
#include "intake/layout.hpp"

namespace linefeed::service {

/// `profile` = of the printer that is to print the records.
[[nodiscard]] intake::Layout layout_of(const config::LayoutSettings& settings, const protocol::Profile& profile);

/// Precondition: the settings have the folder's layout and printer.
[[nodiscard]] intake::DropSettings drop_settings(const config::FolderSettings& folder,
                                                 const config::Settings& settings);

} // namespace linefeed::service
