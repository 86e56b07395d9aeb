#include "scene/mesh/mesh_file.h"

#include "scene/mesh/assimp_import.h"
#include "scene/mesh/gltf_file.h"
#include "scene/mesh/input_file.h"
#include "scene/mesh/mesh_images.h"
#include "scene/mesh/obj_file.h"
#include "scene/mesh/ply_file.h"
#include "scene/mesh/polygon.h"
#include "scene/mesh/stl_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
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

void MeshFile::add_position(const Vec3& position) {
    constexpr double farthest = 1e30;
    if (!(position.array().abs() <= farthest).all()) {  // false for NaN, which maxCoeff() may pass over
        throw MeshError("holds a coordinate that is not a finite number, or beyond 1e30");
    }
    check_more_positions(1);
    positions.push_back(position);
}

void MeshFile::begin_object() {
    if (objects.empty() || objects.back() != triangles.size()) objects.push_back(triangles.size());
}

void MeshFile::take(const MeshImages& images) {
    other_files.insert(other_files.end(), images.files().begin(), images.files().end());
    missing_images.insert(missing_images.end(), images.missing().begin(), images.missing().end());
}

void MeshFile::add_polygon(const std::vector<Corner>& corners) {
    if (corners.size() < 3) return;  // points and lines
    check_corners(corners.size());
    check_more_triangles(corners.size() - 2);
    if (corners.size() == 3) return add_triangle({corners[0], corners[1], corners[2]});
    std::vector<Vec3> points;
    for (const Corner& corner : corners) points.push_back(positions[corner.position]);
    for (const auto& t : cut_polygon(points)) triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
}

void MeshFile::add_triangle(const std::array<Corner, 3>& corners) {
    check_more_triangles(1);
    triangles.push_back(corners);
}

void MeshFile::check_corners(std::size_t corners) {
    if (corners > static_cast<std::size_t>(limits::polygon_corners))
        throw MeshError(fmt::format("holds a polygon of more than {} corners", limits::polygon_corners));
}

void MeshFile::check_more_triangles(std::uint64_t more) const {
    constexpr std::uint64_t most = limits::mesh_triangles;
    if (more > most || triangles.size() + more > most) throw MeshError(fmt::format("has more than {} triangles", most));
}

void MeshFile::check_more_positions(std::uint64_t more) const {
    constexpr std::uint64_t most = 3 * limits::mesh_triangles;  // a corner each
    if (more > most || positions.size() + more > most) throw MeshError(fmt::format("has more than {} vertices", most));
}

double as_written(float value) {
    if (!std::isfinite(value)) return value;
    char text[32];
    const auto written = std::to_chars(text, text + sizeof text, value);
    double result = 0.0;
    std::from_chars(text, written.ptr, result);
    return result;
}

Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.norm();
    return length > 0.0 && std::isfinite(length) ? Vec3(v / length) : Vec3(Vec3::Zero());
}

MeshFile read_mesh_file(const std::filesystem::path& file, MeshImports imports) {
    MeshFile mesh = read_bytes(file, lower_extension(file), imports);
    if (mesh.triangles.empty()) throw MeshError("holds no triangles");
    if (mesh.objects.empty() || mesh.objects.front() != 0) mesh.objects.insert(mesh.objects.begin(), 0);
    if (mesh.objects.back() == mesh.triangles.size()) mesh.objects.pop_back();  // an object of points and lines
    return mesh;
}

std::string readable(std::string_view text, std::size_t longest) {
    std::string result(text.substr(0, longest));
    for (char& c : result)
        if (c < ' ' || c > '~') c = '?';
    return text.size() > longest ? result + "..." : result;
}

}  // namespace tumble
