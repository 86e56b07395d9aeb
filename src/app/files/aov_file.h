// The AOVs of one frame as a file: an .npz archive with an array for each requested AOV, and the camera. The
// description for users is docs/reference/aovs.md.
//
//   depth, normal, segmentation, motion, albedo   rows x columns (x channels), as in AovFrame
//   intrinsics        3 x 3: column = fx x / z + cx, row = fy y / z + cy; pixel centers are integers
//   camera_to_world   4 x 4: from the camera's frame (x right, y down, z forward, m) to the world's
#pragma once

#include "output/npz_archive.h"
#include "render/aov/aov_renderer.h"

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace tumble {

class AovFile {
public:
    /// The scene must outlive it. `mark`: see NpzArchive::finish().
    AovFile(const SceneDescription& scene, const AovSet& aovs, std::string mark = {})
        : maker_(scene, aovs), mark_(std::move(mark)) {}

    /// The whole file, valid until the next call. Throws RunError if it is too large.
    std::span<const std::byte> make(const AovPoses& poses);

private:
    AovRenderer maker_;
    NpzArchive archive_;
    std::string mark_;
};

/// Bytes of the values of a pixel, before compression.
std::size_t bytes_of_pixel(Aov aov);

/// Upper bound of the size of such a file, bytes.
std::size_t aov_file_bound(const AovSet& aovs, int width, int height);

}  // namespace tumble
