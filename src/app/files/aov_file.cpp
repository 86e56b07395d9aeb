#include "app/files/aov_file.h"

#include <array>

namespace tumble {
namespace {

constexpr std::size_t camera_numbers = 9 + 16;

void add_camera(NpzArchive& archive, const PinholeCamera& c) {
    const std::array<double, 9> intrinsics = {c.focal, 0.0, c.center_x, 0.0, c.focal, c.center_y, 0.0, 0.0, 1.0};
    archive.add("intrinsics", {3, 3}, intrinsics);
    std::array<double, 16> to_world{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
            to_world[4 * row + column] = c.axes(Eigen::Index(row), Eigen::Index(column));
        to_world[4 * row + 3] = c.eye[Eigen::Index(row)];
    }
    to_world[15] = 1.0;
    archive.add("camera_to_world", {4, 4}, to_world);
}

}  // namespace

std::span<const std::byte> AovFile::make(const AovPoses& poses) {
    const AovFrame& frame = maker_.make(poses);
    const auto rows = std::size_t(frame.camera.height), columns = std::size_t(frame.camera.width);
    const auto add = [&](Aov aov, const ArrayShape& shape, const auto& values) {
        if (!values.empty()) archive_.add(name_of(aov), shape, std::span(values));
    };
    add(Aov::depth, {rows, columns}, frame.depth);
    add(Aov::normal, {rows, columns, 3}, frame.normal);
    add(Aov::segmentation, {rows, columns}, frame.segmentation);
    add(Aov::motion, {rows, columns, 2}, frame.motion);
    add(Aov::albedo, {rows, columns, 3}, frame.albedo);
    add_camera(archive_, frame.camera);
    return archive_.finish(mark_);
}

std::size_t bytes_of_pixel(Aov aov) {
    switch (aov) {
        case Aov::normal:
            return 3 * sizeof(float);
        case Aov::motion:
            return 2 * sizeof(float);
        case Aov::albedo:
            return 3;
        default:
            return 4;  // depth, segmentation
    }
}

std::size_t aov_file_bound(const AovSet& aovs, int width, int height) {
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    std::size_t bytes = 2 * NpzArchive::bytes_bound(camera_numbers * sizeof(double));
    for (const Aov aov : all_aovs)
        if (aovs.has(aov)) bytes += NpzArchive::bytes_bound(bytes_of_pixel(aov) * pixels);
    return bytes;
}

}  // namespace tumble
