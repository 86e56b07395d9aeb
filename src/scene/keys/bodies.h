// [[body]]: the bodies of the scene, with grids, scatters and files of poses expanded.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/materials.h"
#include "scene/keys/shapes.h"
#include "scene/mesh/mesh_loader.h"
#include "scene/toml/toml_reader.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_set>
#include <vector>

namespace tumble {

/// Sources of bodies, beside their tables.
struct BodySources {
    const Materials& materials;
    const std::filesystem::path& folder;  // of relative paths
    const SimulationSettings& settings;
    MeshCache& meshes;
    TextureFiles& textures;
    std::vector<std::filesystem::path>& files;  // receives the files that are read, except meshes and textures
};

/// The text of the file that the value names, at most limits::scene_bytes. `file`: gets its path. `what`: "template".
std::string read_named_file(const TomlValue& value, const std::string& what, const BodySources& sources,
                            std::filesystem::path& file);

/// Names of the bodies of a scene: given ones are unique.
class BodyNames {
public:
    /// Bodies whose name is their index have none.
    explicit BodyNames(const std::vector<BodyDescription>& bodies);
    /// Fails at the origin if another body has the name.
    void take(const std::string& name, const SourcePosition& origin);

private:
    std::unordered_set<std::string> taken_;  // only for lookups
};

/// Reads all body tables in file order.
std::vector<BodyDescription> read_bodies(const TomlTable& root, const BodySources& sources);

/// The body described by its table, but for its type and its shape; the model of all copies of a grid, a scatter or a
/// chain. If the table has a color, the shape loses the colors of its file.
BodyDescription read_body_model(const TomlTable& table, BodyType type, ShapeRequest& shape, const BodySources& sources);

/// Fails at the origin if a scene with so many bodies has too many.
void check_number_of_bodies(std::int64_t number, const SourcePosition& origin);

}  // namespace tumble
