#include "render/gl/shader_locator.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <cstdlib>
#include <vector>

namespace tumble {
namespace {

/// The program, or the shared library, that holds this function.
std::filesystem::path own_binary() {
    static const char anchor = 0;
    Dl_info info{};
    link_map* object = nullptr;  // its name is empty for the program
    const bool known = ::dladdr1(&anchor, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
    std::error_code failed;
    if (known && object != nullptr && *object->l_name != '\0')
        return std::filesystem::canonical(object->l_name, failed);
    return std::filesystem::read_symlink("/proc/self/exe", failed);
}

}  // namespace

std::filesystem::path find_shader_folder() {
    namespace fs = std::filesystem;
    std::vector<fs::path> places;
    if (const char* named = std::getenv("TUMBLE_SHADERS"); named != nullptr && *named != '\0') {
        places.emplace_back(named);  // a named folder is used exclusively, without a fallback
    } else {
        // A library folder may have a folder for the processor's architecture in it.
        if (const fs::path binary = own_binary(); !binary.empty())
            for (const char* up : {"..", "../.."})
                places.push_back(binary.parent_path() / up / "share" / "tumble" / "shaders");
#ifdef TUMBLE_SHADER_SOURCE_FOLDER  // absent in packages
        places.emplace_back(TUMBLE_SHADER_SOURCE_FOLDER);
#endif
    }
    std::string tried;
    for (const fs::path& place : places) {
        std::error_code failed;
        if (fs::is_regular_file(place / "light_constants.glsl", failed)) return place.lexically_normal();
        tried += "\n  " + safe_path(place.lexically_normal());
    }
    throw RunError(fmt::format("no shaders found; set TUMBLE_SHADERS to their folder. Looked in:{}", tried));
}

}  // namespace tumble
