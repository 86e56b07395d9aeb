// Masks: the parts of an image that a comparison leaves out.
#pragma once

#include "core/image.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

/// Parts of the width and the height, from the top left corner.
struct FractionRectangle {
    double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

/// A picture whose white pixels (opaque, brightness of at least a half) are left out.
struct MaskPicture {
    std::filesystem::path file;
    int width = 0, height = 0;
    std::vector<std::uint8_t> ignored;  // 1 for each pixel that is left out

    /// Throws InputError if it cannot be read, or leaves out nothing.
    static std::shared_ptr<const MaskPicture> read(const std::filesystem::path& file);
};

struct Mask {
    std::variant<Rectangle, FractionRectangle, std::shared_ptr<const MaskPicture>> area;
};

/// The pixels of an image of some size that are left out.
class IgnoredPixels {
public:
    /// Throws InputError if a mask does not fit an image of that size: a picture of another size, or a rectangle of
    /// pixels that is not within the image.
    IgnoredPixels(std::span<const Mask> masks, int width, int height);

    bool none() const { return ignored_.empty(); }
    std::int64_t count() const;
    bool at(int x, int y) const;

    /// Gives these pixels of a row of the one image the values of the other.
    void equalize(int row, std::span<const std::uint8_t> from, std::span<std::uint8_t> to) const;

private:
    int width_;
    std::vector<std::uint8_t> ignored_;  // 1 for each pixel that is left out; empty if none is
};

}  // namespace tumble
