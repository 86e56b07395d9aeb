#include "scene/mesh/mesh_file.h"
#include "scene/mesh/mesh_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace tumble {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
    std::string text = file.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

MeshFile import(std::string_view bytes, const std::filesystem::path& folder, const std::string& extension,
                MeshImports imports) {
    if (imports == MeshImports::in_child_process) return import_with_assimp(bytes, folder, extension);
    throw MeshError("needs an import in a child process, which has to be allowed first");
}

/// assimp may read a file that the own reader does not support; buffers in other files are then missing.
MeshFile read_any_gltf(const std::string& bytes, const std::filesystem::path& folder, const std::string& extension,
                       MeshImports imports) {
    try {
        return read_gltf(bytes, folder);
    } catch (const UnsupportedGltf& unsupported) {
        try {
            return import(bytes, folder, extension, imports);
        } catch (const MeshError& error) {
            throw MeshError(fmt::format("{} (assimp: {})", unsupported.what(), error.what()));
        }
    }
}

/// Text without a byte-order mark, from UTF-16 too. Letters beyond ASCII stand in names only.
std::string plain_text(std::string bytes) {
    if (bytes.starts_with("\xef\xbb\xbf")) return bytes.substr(3);
    const bool little = bytes.starts_with("\xff\xfe");
    if (!little && !bytes.starts_with("\xfe\xff")) return bytes;
    std::string text;
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        const auto low = static_cast<unsigned char>(bytes[i + (little ? 0 : 1)]),
                   high = static_cast<unsigned char>(bytes[i + (little ? 1 : 0)]);
        text += high == 0 && low < 0x80 ? char(low) : '?';
    }
    return text;
}

MeshFile read_bytes(const std::filesystem::path& file, const std::string& extension, MeshImports imports) {
    const bool gltf = extension == ".gltf" || extension == ".glb";
    const bool own = gltf || extension == ".obj" || extension == ".stl" || extension == ".ply";
    if (!own && !assimp_reads(extension))
        throw MeshError(
            "is of an unknown kind: .obj, .stl, .ply, .gltf, .glb and the kinds that assimp reads can be used");
    const std::string bytes = read_mesh_bytes(file);
    if (bytes.empty()) throw MeshError("is empty");
    if (!own) return import(bytes, file.parent_path(), extension, imports);
    if (gltf) return read_any_gltf(bytes, file.parent_path(), extension, imports);
    if (extension == ".obj") return read_obj(plain_text(bytes), file.parent_path());
    return extension == ".stl" ? read_stl(bytes) : read_ply(plain_text(bytes), file.parent_path());
}

}  // namespace

MeshFile read_mesh_file(const std::filesystem::path& file, MeshImports imports) {
    MeshFile mesh = read_bytes(file, lower_extension(file), imports);
    if (mesh.triangles.empty()) throw MeshError("holds no triangles");
    if (mesh.objects.empty() || mesh.objects.front() != 0) mesh.objects.insert(mesh.objects.begin(), 0);
    if (mesh.objects.back() == mesh.triangles.size()) mesh.objects.pop_back();  // an object of points and lines
    return mesh;
}

}  // namespace tumble
