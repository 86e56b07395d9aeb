#include "compare/ignored_pixels.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/picture_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool is_white(const std::uint8_t* pixel) {
    return pixel[3] >= 128 && 2 * pixel[0] + 5 * pixel[1] + pixel[2] >= 8 * 128;
}

/// The pixels that a rectangle of fractions touches. The margin keeps 0.1 of 50 pixels at 5.
Rectangle touched(const FractionRectangle& part, int width, int height) {
    constexpr double rounding = 1e-6;  // pixels
    const auto first = [&](double at, int size) { return int(std::floor(at * size + rounding)); };
    const auto last = [&](double at, int size) { return std::min(size, int(std::ceil(at * size - rounding))); };
    const int x = first(part.x, width), y = first(part.y, height);
    return {x, y, last(part.x + part.width, width) - x, last(part.y + part.height, height) - y};
}

}  // namespace

std::shared_ptr<const MaskPicture> MaskPicture::read(const std::filesystem::path& file) {
    const Image image = read_picture(file);
    auto mask = std::make_shared<MaskPicture>();
    mask->file = file;
    mask->width = image.width;
    mask->height = image.height;
    mask->ignored.resize(image.pixels.size() / 4);
    for (std::size_t i = 0; i < mask->ignored.size(); ++i) mask->ignored[i] = is_white(&image.pixels[4 * i]) ? 1 : 0;
    if (std::find(mask->ignored.begin(), mask->ignored.end(), 1) == mask->ignored.end())
        throw InputError({file.string(), 0, 0}, "the mask has no white pixels, so it leaves out nothing");
    return mask;
}

IgnoredPixels::IgnoredPixels(std::span<const Mask> masks, int width, int height) : width_(width) {
    if (masks.empty()) return;
    ignored_.assign(std::size_t(width) * std::size_t(height), 0);
    const auto fill = [&](const Rectangle& r) {
        for (int y = r.y; y < r.y + r.height; ++y)
            std::fill_n(ignored_.begin() + std::ptrdiff_t(y) * width + r.x, r.width, std::uint8_t(1));
    };
    for (const Mask& mask : masks) {
        if (const auto* r = std::get_if<Rectangle>(&mask.area)) {
            if (r->width > width - r->x || r->height > height - r->y)
                throw InputError(
                    fmt::format("the mask from x {}, y {} of {} x {} pixels is not within the picture of {} x {}", r->x,
                                r->y, r->width, r->height, width, height));
            fill(*r);
        } else if (const auto* part = std::get_if<FractionRectangle>(&mask.area)) {
            fill(touched(*part, width, height));
        } else {
            const MaskPicture& picture = *std::get<std::shared_ptr<const MaskPicture>>(mask.area);
            if (picture.width != width || picture.height != height)
                throw InputError(fmt::format("the mask {} has {} x {} pixels, and the picture {} x {}",
                                             safe_path(picture.file), picture.width, picture.height, width, height));
            for (std::size_t i = 0; i < ignored_.size(); ++i) ignored_[i] |= picture.ignored[i];
        }
    }
}

std::int64_t IgnoredPixels::count() const { return std::count(ignored_.begin(), ignored_.end(), 1); }

bool IgnoredPixels::at(int x, int y) const {
    return !none() && ignored_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] != 0;
}

void IgnoredPixels::equalize(int row, std::span<const std::uint8_t> from, std::span<std::uint8_t> to) const {
    if (none()) return;
    for (int x = 0; x < width_; ++x)
        if (at(x, row)) std::copy_n(&from[4 * std::size_t(x)], 4, &to[4 * std::size_t(x)]);
}

}  // namespace tumble
