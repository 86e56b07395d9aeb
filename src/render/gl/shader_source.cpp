#include "render/gl/shader_source.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

class Reader {
public:
    Reader(const fs::path& folder, const std::vector<std::string>& defines) : folder_(folder), defines_(defines) {}

    void read(const std::string& name, const std::string& wanted_by) {
        const fs::path path = folder_ / name;
        if (std::find(source_.files.begin(), source_.files.end(), path) != source_.files.end()) return;
        std::ifstream file(path);
        if (!file) throw RunError(fmt::format("cannot read shader {}{}", path.string(), wanted_by));
        const std::size_t number = source_.files.size();
        source_.files.push_back(path);

        int line_number = 0;
        for (std::string line; std::getline(file, line);) {
            ++line_number;
            if (const std::string included = included_name(line); !included.empty()) {
                read(included, fmt::format(" (included by {}:{})", path.string(), line_number));
            } else {
                add(line, number, line_number);
                if (number == 0 && line_number == 1)
                    for (const std::string& define : defines_) add("#define " + define, number, line_number);
            }
        }
    }

    ShaderSource take() { return std::move(source_); }

private:
    void add(const std::string& line, std::size_t file, int number) {
        source_.text += line + '\n';
        source_.lines.push_back({file, number});
    }

    static std::string included_name(const std::string& line) {
        constexpr std::string_view opening = "#include \"";
        if (line.compare(0, opening.size(), opening) != 0) return {};
        const std::size_t end = line.find('"', opening.size());
        return end == std::string::npos ? std::string() : line.substr(opening.size(), end - opening.size());
    }

    const fs::path& folder_;
    const std::vector<std::string>& defines_;
    ShaderSource source_;
};

}  // namespace

std::string ShaderSource::with_file_names(const std::string& log) const {
    const std::regex place(R"(^\d+[:(](\d+)\)?)");  // Mesa writes 0:12(5), others 0(12)
    std::istringstream words(log);
    std::string result;
    for (std::string line; std::getline(words, line);) {
        std::smatch match;
        if (std::regex_search(line, match, place) && match[1].length() < 9) {
            const std::size_t number = std::stoul(match[1]);
            if (number >= 1 && number <= lines.size()) {
                const Origin& origin = lines[number - 1];
                line = fmt::format("{}:{}{}", files[origin.file].string(), origin.line, match.suffix().str());
            }
        }
        result += line + '\n';
    }
    return result;
}

ShaderSource read_shader(const fs::path& folder, const std::string& name, const std::vector<std::string>& defines) {
    Reader reader(folder, defines);
    reader.read(name, "");
    return reader.take();
}

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
