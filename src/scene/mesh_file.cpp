#include "scene/mesh_file.h"

#include "scene/assimp_file.h"
#include "scene/limits.h"
#include "scene/ply_file.h"
#include "scene/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <system_error>

namespace tumble {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
    std::string text = file.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

void check_file(const std::filesystem::path& file, const std::string& extension) {
    if (extension != ".obj" && extension != ".stl" && extension != ".ply" && extension != ".gltf" &&
        extension != ".glb") {
        throw MeshError("is of an unknown kind: .obj, .stl, .ply, .gltf and .glb can be read");
    }
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) throw MeshError("does not exist");
    if (error) throw MeshError("cannot be read: " + error.message());
    if (!std::filesystem::is_regular_file(status)) throw MeshError("is not a file");
    if (!std::ifstream(file)) throw MeshError("cannot be read: " + std::generic_category().message(errno));
    const auto size = std::filesystem::file_size(file, error);
    if (error) throw MeshError("cannot be read: " + error.message());
    if (size == 0) throw MeshError("is empty");
    if (size > static_cast<std::uintmax_t>(limits::mesh_bytes)) {
        throw MeshError(fmt::format("is larger than {} MiB", limits::mesh_bytes >> 20));
    }
}

}  // namespace

void MeshFile::add_position(const Vec3& position) {
    constexpr double farthest = 1e30;
    if (!(position.cwiseAbs().maxCoeff() <= farthest)) {   // false for NaN
        throw MeshError("holds a coordinate that is not a finite number, or beyond 1e30");
    }
    positions.push_back(position);
}

void MeshFile::begin_object() {
    if (objects.empty() || objects.back() != triangles.size()) objects.push_back(triangles.size());
}

void MeshFile::add_polygon(const std::vector<Corner>& corners) {
    if (corners.size() < 3) return;   // points and lines
    if (corners.size() > static_cast<std::size_t>(limits::polygon_corners)) {
        throw MeshError(fmt::format("holds a polygon of {} corners (at most {} can be cut)", corners.size(),
                                    limits::polygon_corners));
    }
    if (triangles.size() + corners.size() - 2 > static_cast<std::size_t>(limits::mesh_triangles)) {
        throw MeshError(fmt::format("has more than {} triangles", limits::mesh_triangles));
    }
    if (corners.size() == 3) {
        triangles.push_back({corners[0], corners[1], corners[2]});
        return;
    }
    std::vector<Vec3> points;
    for (const Corner& corner : corners) points.push_back(positions[corner.position]);
    for (const auto& t : cut_polygon(points)) triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
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

MeshFile read_mesh_file(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    check_file(file, extension);
    MeshFile mesh = extension == ".ply" ? read_ply(file) : read_with_assimp(file, extension != ".stl");
    if (mesh.triangles.empty()) throw MeshError("holds no triangles");
    if (mesh.objects.empty()) mesh.objects.push_back(0);
    if (mesh.objects.back() == mesh.triangles.size()) mesh.objects.pop_back();   // an object of points and lines
    return mesh;
}

}  // namespace tumble
