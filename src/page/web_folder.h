// The folder of the built player: page.html, the template of all pages, and the compiler of lessons.
#pragma once

#include <filesystem>

namespace tumble {

/// $TUMBLE_WEB if set; otherwise share/tumble/web beside the installed program; otherwise the folder web beside the
/// program's own folder, where scripts/build-web puts it. Throws RunError that says how to build it.
std::filesystem::path find_web_folder();

}  // namespace tumble
