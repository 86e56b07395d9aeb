#include "scene/mesh/mesh_file.h"

#include "scene/mesh/mesh_images.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

namespace tumble {

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

std::string readable(std::string_view text, std::size_t longest) {
    std::string result(text.substr(0, longest));
    for (char& c : result)
        if (c < ' ' || c > '~') c = '?';
    return text.size() > longest ? result + "..." : result;
}

}  // namespace tumble
