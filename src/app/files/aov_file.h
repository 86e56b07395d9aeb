// The AOVs of one frame as a file: an .npz archive with an array for each that is asked for, and the camera's place. What
// users are told of it stands in docs/reference/aovs.md.
//
//   depth, normal, segmentation, motion, albedo   rows x columns (x channels), as AovFrame has them
//   intrinsics        3 x 3: column = fx x / z + cx, row = fy y / z + cy; pixels' centers are whole numbers
//   camera_to_world   4 x 4: from the camera's frame (x right, y down, z forward, m) to the world's
#pragma once

#include "output/npz_archive.h"
#include "render/aov/aov_renderer.h"

#include <cstddef>
#include <span>

namespace tumble {

class AovFile {
public:
    /// The scene must outlive it.
    AovFile(const SceneDescription& scene, const AovSet& aovs) : maker_(scene, aovs) {}

    /// The whole file, valid until the next call. Throws RunError where it is too large.
    std::span<const std::byte> make(const AovPoses& poses);

private:
    AovRenderer maker_;
    NpzArchive archive_;
};

/// Of its values, before they are compressed.
std::size_t bytes_of_pixel(Aov aov);

/// The most bytes that such a file takes.
std::size_t aov_file_bound(const AovSet& aovs, int width, int height);

}  // namespace tumble
