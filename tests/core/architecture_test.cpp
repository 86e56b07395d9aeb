// The layers of src/: a folder includes only the folders below it, and no cycle joins two folders at any depth.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <istream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace tumble::architecture_test {
namespace {

namespace fs = std::filesystem;

const fs::path source = fs::path(TUMBLE_SOURCE_DIR) / "src";

/// The allowed includes of a top folder.
struct Layer {
    std::vector<std::string> allowed;              // prefixes of headers: a folder ("core/") or one header
    std::vector<std::string> forbidden_libraries;  // prefixes of system headers
};

const std::map<std::string, Layer> layers = {
    {"core", {{"core/"}, {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"scene",
     {{"core/", "scene/", "sim/geometry/shapes/", "sim/math/mass_properties.h", "output/jpeg_reader.h",
       "output/png_reader.h"},
      {"GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"sim", {{"core/", "scene/", "sim/"}, {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/"}}},
    {"render",
     {{"core/", "scene/description/", "scene/environment/", "sim/geometry/shapes/curved.h", "sim/snapshot/snapshot.h",
       "render/"},
      {"toml++", "assimp", "png.h", "CLI/", "libqhull"}}},
    {"output", {{"core/", "output/"}, {"toml++", "assimp", "GL/", "glm/", "CLI/", "libqhull"}}},
    {"compare",
     {{"core/", "scene/toml/", "output/", "compare/"}, {"toml++", "assimp", "GL/", "glm/", "CLI/", "libqhull"}}},
    {"plot", {{"core/", "plot/"}, {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"overlay",
     {{"core/", "scene/description/", "sim/geometry/shapes/", "sim/snapshot/", "render/", "plot/", "overlay/"},
      {"toml++", "assimp", "png.h", "CLI/", "libqhull"}}},
    {"gltf",
     {{"core/", "scene/description/", "sim/snapshot/", "output/png_writer.h", "gltf/"},
      {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"sound",
     {{"core/", "scene/description/", "sim/geometry/shapes/", "sim/snapshot/", "sound/"},
      {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"presimulation",
     {{"core/", "scene/camera/", "scene/description/", "scene/keys/fracture.h", "sim/", "presimulation/"},
      {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"quantities",
     {{"core/", "scene/description/", "scene/toml/error_text.h", "sim/", "quantities/"},
      {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"page",
     {{"core/", "scene/description/", "scene/environment/", "scene/fields/", "sim/snapshot/", "sim/frames/clip_speed.h",
       "render/camera/camera_animation.h", "overlay/", "quantities/", "page/"},
      {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"live",
     {{"core/", "scene/", "sim/", "presimulation/", "quantities/", "page/", "live/", "tumble/live.h"},
      {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"api",
     {{"core/", "scene/", "sim/", "presimulation/", "live/", "render/", "output/", "compare/", "api/", "tumble/"},
      {"toml++", "assimp", "GL/", "glm/", "png.h", "CLI/", "libqhull"}}},
    {"app",
     {{"core/", "scene/", "sim/", "render/", "output/", "compare/", "plot/", "overlay/", "gltf/", "quantities/",
       "page/", "live/", "sound/", "presimulation/", "api/", "tumble/", "app/"},
      {}}},
};

/// The included folders of each folder below src/.
using FolderGraph = std::map<std::string, std::set<std::string>>;

struct Include {
    std::string header;
    bool ours;
};

// A header of the standard library may have the name of a folder: <compare>.
std::vector<Include> includes_of(std::istream& text) {
    static const std::regex include("^\\s*#\\s*include\\s*([\"<])([^\">]+)[\">].*$");
    std::vector<Include> includes;
    std::smatch match;
    for (std::string line; std::getline(text, line);)
        if (std::regex_match(line, match, include))
            includes.push_back({match[2], match[1] == "\"" || fs::is_regular_file(source / match[2].str())});
    return includes;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](const std::string& b) { return text.rfind(b, 0) == 0; });
}

std::vector<std::string> forbidden_includes(const std::string& top_folder, std::istream& text) {
    const Layer& layer = layers.at(top_folder);
    std::vector<std::string> forbidden;
    for (const Include& include : includes_of(text))
        if (include.ours ? !starts_with_any(include.header, layer.allowed)
                         : starts_with_any(include.header, layer.forbidden_libraries))
            forbidden.push_back(include.header);
    return forbidden;
}

std::vector<fs::path> source_files() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(source))
        if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

FolderGraph folder_graph() {
    FolderGraph graph;
    for (const fs::path& file : source_files()) {
        const std::string folder = file.parent_path().lexically_relative(source).string();
        std::ifstream text(file);
        for (const Include& include : includes_of(text)) {
            const std::string other = fs::path(include.header).parent_path().string();
            if (include.ours && other != folder) graph[folder].insert(other);
        }
    }
    return graph;
}

std::set<std::string> reachable(const FolderGraph& graph, const std::string& from) {
    std::set<std::string> seen;
    std::vector<std::string> open{from};
    while (!open.empty()) {
        const auto next = graph.find(open.back());
        open.pop_back();
        if (next == graph.end()) continue;
        for (const std::string& folder : next->second)
            if (seen.insert(folder).second) open.push_back(folder);
    }
    return seen;
}

/// "a -> b" for each include that is part of a cycle between folders.
std::vector<std::string> cyclic_includes(const FolderGraph& graph) {
    std::vector<std::string> cyclic;
    for (const auto& [folder, others] : graph)
        for (const std::string& other : others)
            if (reachable(graph, other).count(folder) > 0) cyclic.push_back(folder + " -> " + other);
    return cyclic;
}

/// Types outside unnamed namespaces by their names, each with its files.
using TypeFiles = std::map<std::string, std::set<std::string>>;

/// Namespaces are not indented, so definitions in them begin a line.
void add_types(std::istream& text, const std::string& file, TypeFiles& types) {
    static const std::regex opens("^namespace ?([a-z_0-9:]*) ?\\{$"),
        defines("^(?:struct|class|enum class|enum) (\\w+)(?: final)?(?: : .*)? ?\\{.*$");
    std::vector<std::string> spaces;
    std::smatch match;
    for (std::string line; std::getline(text, line);) {
        if (std::regex_match(line, match, opens)) spaces.push_back(match[1]);
        if (line.rfind("}  // namespace", 0) == 0 && !spaces.empty()) spaces.pop_back();
        if (!std::regex_match(line, match, defines) || std::count(spaces.begin(), spaces.end(), "") > 0) continue;
        std::string name;
        for (const std::string& space : spaces) name += space + "::";
        types[name + match[1].str()].insert(file);
    }
}

std::vector<std::string> types_of_several_files(const TypeFiles& types) {
    std::vector<std::string> several;
    for (const auto& [name, files] : types)
        if (files.size() > 1) several.push_back(name + " in " + *files.begin() + " and " + *files.rbegin());
    return several;
}

TEST(Architecture, EveryTopFolderHasALayer) {
    for (const auto& entry : fs::directory_iterator(source)) {
        if (!entry.is_directory()) continue;
        EXPECT_EQ(layers.count(entry.path().filename()), 1u) << entry.path().filename();
    }
}

TEST(Architecture, NoIncludeLeavesItsLayer) {
    const std::vector<fs::path> files = source_files();
    for (const fs::path& file : files) {
        const fs::path name = file.lexically_relative(source);
        std::ifstream text(file);
        for (const std::string& header : forbidden_includes(name.begin()->string(), text))
            ADD_FAILURE() << "src/" << name.string() << " includes " << header;
    }
    EXPECT_GT(files.size(), 100u);
}

TEST(Architecture, NoCycleBetweenFolders) {
    for (const std::string& include : cyclic_includes(folder_graph())) ADD_FAILURE() << "in a cycle: " << include;
}

// The linker keeps one std::vector<T> for both: objects of one size would be taken for objects of the other.
TEST(Architecture, NoTwoTypesHaveOneName) {
    TypeFiles types;
    for (const fs::path& file : source_files()) {
        std::ifstream text(file);
        add_types(text, file.lexically_relative(source).string(), types);
    }
    EXPECT_GT(types.size(), 300u);
    for (const std::string& name : types_of_several_files(types)) ADD_FAILURE() << name;
}

TEST(Architecture, ASecondTypeOfAnExistingNameIsFound) {
    TypeFiles types;
    std::istringstream first(
        "namespace tumble {\nnamespace {\nstruct Own {\n};\n}  // namespace\n\nclass A final : B {\n");
    std::istringstream second("namespace tumble {\nstruct A {};\nstruct Own {};\n}  // namespace tumble\nstruct B {\n");
    add_types(first, "1.h", types);
    add_types(second, "2.h", types);
    EXPECT_EQ(types_of_several_files(types), (std::vector<std::string>{"tumble::A in 1.h and 2.h"}));
}

TEST(Architecture, AForbiddenIncludeIsFound) {
    std::istringstream upwards(
        "#include \"sim/world.h\"\n#include <vector>\n  # include \"core/color.h\"\n#include <GL/gl.h>\n");
    EXPECT_EQ(forbidden_includes("scene", upwards), (std::vector<std::string>{"sim/world.h", "GL/gl.h"}));
    std::istringstream bridge("#include \"sim/snapshot/snapshot.h\"\n#include \"sim/world.h\"\n");
    EXPECT_EQ(forbidden_includes("render", bridge), (std::vector<std::string>{"sim/world.h"}));
}

TEST(Architecture, ACycleIsFound) {
    const FolderGraph straight{{"a", {"b", "c"}}, {"b", {"c"}}};
    EXPECT_TRUE(cyclic_includes(straight).empty());
    const FolderGraph round{{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}};
    EXPECT_EQ(cyclic_includes(round), (std::vector<std::string>{"b -> c", "c -> b"}));
}

}  // namespace
}  // namespace tumble::architecture_test
