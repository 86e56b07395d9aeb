#include "render/gl/shader_locator.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <cstdlib>
#include <vector>

namespace tumble {

std::filesystem::path find_shader_folder() {
    namespace fs = std::filesystem;
    std::vector<fs::path> places;
    if (const char* named = std::getenv("TUMBLE_SHADERS"); named != nullptr && *named != '\0') {
        places.emplace_back(named);  // a named folder is used exclusively, without a fallback
    } else {
        std::error_code failed;
        const fs::path program = fs::read_symlink("/proc/self/exe", failed);
        if (!failed) places.push_back(program.parent_path() / ".." / "share" / "tumble" / "shaders");
        places.emplace_back(TUMBLE_SHADER_SOURCE_FOLDER);
    }
    std::string tried;
    for (const fs::path& place : places) {
        std::error_code failed;
        if (fs::is_regular_file(place / "look.glsl", failed)) return place.lexically_normal();
        tried += "\n  " + safe_path(place.lexically_normal());
    }
    throw RunError(fmt::format("no shaders found; set TUMBLE_SHADERS to their folder. Looked in:{}", tried));
}

}  // namespace tumble
