// Includes go down the street only: each folder of src/ knows what this table says and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// What the files of a folder may include: a folder ("core/") or a single header.
struct Street {
    std::vector<std::string> ours;
    std::vector<std::string> outside_forbidden;   // beginnings of system headers
};

const std::map<std::string, Street> streets = {
    {"core", {{"core/"}, {"toml++", "nlohmann", "assimp", "assimp", "assimp", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"scene", {{"core/", "scene/"}, {"GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"sim", {{"core/", "scene/", "sim/"}, {"toml++", "nlohmann", "GL/", "glm/", "png.h", "CLI/"}}},
    {"render",
     {{"core/", "scene/description.h", "sim/snapshot.h", "render/"},
      {"toml++", "nlohmann", "png.h", "CLI/", "libqhull"}}},
    {"output", {{"core/", "output/"}, {"toml++", "nlohmann", "GL/", "glm/", "CLI/", "libqhull"}}},
    {"app", {{"core/", "scene/", "sim/", "render/", "output/", "app/"}, {}}},
};

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](const std::string& b) { return text.rfind(b, 0) == 0; });
}

/// The includes of a text that its folder does not know.
std::vector<std::string> wrong_includes(const std::string& folder, std::istream& text) {
    static const std::regex include("^\\s*#\\s*include\\s*([\"<])([^\">]+)[\">].*$");
    std::vector<std::string> wrong;
    std::smatch match;
    for (std::string line; std::getline(text, line);) {
        if (!std::regex_match(line, match, include)) continue;
        const std::string header = match[2];
        const bool ours = match[1] == "\"" || fs::exists(fs::path(TUMBLE_SOURCE_DIR) / "src" / header);
        const Street& street = streets.at(folder);
        if (ours ? !starts_with_any(header, street.ours) : starts_with_any(header, street.outside_forbidden)) {
            wrong.push_back(header);
        }
    }
    return wrong;
}

TEST(Street, EveryFolderOfTheSourceIsOnIt) {
    for (const auto& entry : fs::directory_iterator(fs::path(TUMBLE_SOURCE_DIR) / "src")) {
        if (!entry.is_directory()) continue;
        EXPECT_EQ(streets.count(entry.path().filename()), 1u) << entry.path().filename();
    }
}

TEST(Street, NoIncludeGoesUpTheStreet) {
    std::size_t files = 0;
    for (const auto& [folder, street] : streets) {
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(TUMBLE_SOURCE_DIR) / "src" / folder)) {
            const std::string kind = entry.path().extension();
            if (kind != ".h" && kind != ".cpp") continue;
            ++files;
            std::ifstream text(entry.path());
            for (const std::string& header : wrong_includes(folder, text)) {
                ADD_FAILURE() << "src/" << folder << "/" << entry.path().filename().string() << " includes " << header;
            }
        }
    }
    EXPECT_GT(files, 20u);
}

TEST(Street, TheTestItselfSeesAWrongInclude) {
    std::istringstream upwards(
        "#include \"sim/world.h\"\n#include <vector>\n  # include \"core/color.h\"\n#include <GL/gl.h>\n");
    EXPECT_EQ(wrong_includes("scene", upwards), (std::vector<std::string>{"sim/world.h", "GL/gl.h"}));
    std::istringstream bridge("#include \"sim/snapshot.h\"\n#include \"sim/world.h\"\n");
    EXPECT_EQ(wrong_includes("render", bridge), (std::vector<std::string>{"sim/world.h"}));
}

}  // namespace
}  // namespace tumble
