#include "scene/mesh/input_file.h"

#include "core/input_file.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

namespace tumble {

std::string read_mesh_bytes(const std::filesystem::path& file) {
    try {
        return read_regular_file(file, limits::mesh_bytes);
    } catch (const UnreadableFile& error) {
        throw MeshError(error.what());
    }
}

}  // namespace tumble
