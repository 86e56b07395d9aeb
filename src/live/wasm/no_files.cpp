// A page has no files and no limits of memory that it can ask for: the functions of the layers below that need them.
#include "core/available_memory.h"
#include "core/input_file.h"
#include "scene/environment/exr_image.h"
#include "scene/environment/hdr_image.h"
#include "scene/mesh/height_grid.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_files.h"
#include "scene/mesh/texture_image.h"

namespace tumble {
namespace {

[[noreturn]] void refuse() { throw MeshError("cannot be read: a live page has no files"); }

}  // namespace

void require_memory(std::uint64_t, std::string_view, std::string_view) {}
std::string memory_limit_note() { return ""; }

MeshFile read_mesh_file(const std::filesystem::path&, MeshImports) { refuse(); }
std::shared_ptr<const MeshPaint> make_paint(const MeshFile&, const TriangleMesh&,
                                            const std::vector<std::array<MeshFile::Corner, 3>>&) {
    return nullptr;  // made meshes have no colors of a file
}

std::shared_ptr<const Texture> TextureFiles::load(const std::filesystem::path&) { refuse(); }
std::shared_ptr<const Texture> TextureFiles::load_normals(const std::filesystem::path&) { refuse(); }
std::shared_ptr<const Texture> TextureFiles::load_roughness(const std::filesystem::path&) { refuse(); }
bool is_texture_image(std::string_view) { return false; }
std::shared_ptr<const Texture> make_texture(std::string_view, const std::string&, std::int64_t&) { refuse(); }

std::string read_mesh_bytes(const std::filesystem::path&) { refuse(); }
bool is_exr_image(std::string_view) { return false; }
EnvironmentImage import_exr_image(std::string_view) { refuse(); }
bool is_hdr_image(std::string_view) { return false; }
EnvironmentImage read_hdr_image(std::string_view) { refuse(); }
HeightGrid read_height_grid(const std::filesystem::path&) { refuse(); }
MeshFile height_field_mesh(const HeightGrid&, double, double, double) { refuse(); }
std::string read_input_file(const std::filesystem::path&, const std::string&, std::int64_t) { refuse(); }

}  // namespace tumble
