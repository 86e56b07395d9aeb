#include "page/web_folder.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace tumble {

std::filesystem::path find_web_folder() {
    namespace fs = std::filesystem;
    std::vector<fs::path> places;
    std::error_code failed;
    if (const char* named = std::getenv("TUMBLE_WEB"); named != nullptr && *named != '\0') {
        places.emplace_back(named);  // a named folder is used exclusively, without a fallback
    } else if (const fs::path program = fs::read_symlink("/proc/self/exe", failed); !program.empty()) {
        const fs::path above = program.parent_path().parent_path();
        places = {above / "share" / "tumble" / "web", above / "web"};
    }
    std::string tried;
    for (const fs::path& place : places) {
        if (fs::is_regular_file(place / "page.html", failed)) return place;
        tried += "\n  " + safe_path(place.lexically_normal());
    }
    throw RunError(
        fmt::format("the player of pages is not built: run scripts/build-web in Tumble's source tree (it needs Node "
                    "18 or later), or set TUMBLE_WEB to its folder. Looked in:{}",
                    tried));
}

}  // namespace tumble
