
#include "core/input_file.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <algorithm>
#include <system_error>

namespace tumble {

std::string read_mesh_bytes(const std::filesystem::path& file) {
    try {
        return read_regular_file(file, limits::mesh_bytes);
    } catch (const UnreadableFile& error) {
        throw MeshError(error.what());
    }
}

std::filesystem::path file_below(const std::filesystem::path& folder, const std::string& name) {
    const std::filesystem::path asked(name);
    if (name.empty() || name.find('\0') != name.npos || asked.is_absolute())
        throw MeshError("is not a file of its folder");
    std::error_code error;
    const auto top = std::filesystem::canonical(folder.empty() ? "." : folder, error);
    const auto file = error ? std::filesystem::path() : std::filesystem::canonical(top / asked, error);
    if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
        throw MeshError("does not exist");
    if (error) throw MeshError("cannot be read: " + error.message());
    if (std::mismatch(top.begin(), top.end(), file.begin(), file.end()).first != top.end())
        throw MeshError("lies outside its folder");
    return file;
}

}  // namespace tumble
