#include "compare/difference_image.h"

#include "compare/metrics/pixel_windows.h"
#include "output/png_writer.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tumble {
namespace {

using Channels = std::array<bool, 3>;  // true: the channel is raised
constexpr Channels only_first{true, true, false}, only_second{false, true, false};
constexpr int raised = 96;  // levels: visible on black

/// A third of the brightness.
int gray_of(const std::uint8_t* pixel) {
    return (2 * seen_on_black(pixel, 0) + 5 * seen_on_black(pixel, 1) + seen_on_black(pixel, 2)) / 24;
}

void put_lone_pixel(const std::uint8_t* pixel, const Channels& color, std::uint8_t* to) {
    const int gray = gray_of(pixel);
    for (std::size_t c = 0; c < color.size(); ++c) to[c] = static_cast<std::uint8_t>(gray + (color[c] ? raised : 0));
    to[3] = 255;
}

std::span<const std::uint8_t> row_of(const Image& image, int y) {
    if (y >= image.height) return {};
    return {image.at(0, y), 4 * std::size_t(image.width)};
}

std::span<const std::uint8_t> next_row(PictureRows& rows, int y) {
    return y < rows.size().height ? rows.next() : std::span<const std::uint8_t>();
}

}  // namespace

void difference_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int tolerance,
                    std::span<std::uint8_t> to) {
    const std::size_t both = std::min(a.size(), b.size());
    for (std::size_t i = 0; i < both; i += 4) {
        const int d = pixel_difference(&a[i], &b[i]);
        const int gray = gray_of(&a[i]);
        const int marked = d == 0 ? gray : std::min(255, 96 + 8 * d);  // the smallest difference is visible
        to[i] = static_cast<std::uint8_t>(d > tolerance ? marked : gray);
        to[i + 1] = static_cast<std::uint8_t>(gray);
        to[i + 2] = static_cast<std::uint8_t>(d > 0 && d <= tolerance ? marked : gray);
        to[i + 3] = 255;
    }
    for (std::size_t i = both; i < a.size(); i += 4) put_lone_pixel(&a[i], only_first, &to[i]);
    for (std::size_t i = both; i < b.size(); i += 4) put_lone_pixel(&b[i], only_second, &to[i]);
    for (std::size_t i = std::max(a.size(), b.size()); i < to.size(); i += 4) {
        std::fill_n(&to[i], 3, std::uint8_t(0));
        to[i + 3] = 255;
    }
}

ImageSize difference_size(ImageSize a, ImageSize b) {
    return {std::max(a.width, b.width), std::max(a.height, b.height)};
}

Image difference_image(const Image& a, const Image& b, const CompareOptions& options) {
    const ImageSize size = difference_size({a.width, a.height}, {b.width, b.height});
    Image image(size.width, size.height);
    for (int y = 0; y < image.height; ++y)
        difference_row(row_of(a, y), row_of(b, y), options.tolerance, {image.at(0, y), 4 * std::size_t(image.width)});
    return image;
}

void write_difference_image(const std::filesystem::path& a, const std::filesystem::path& b,
                            const CompareOptions& options, const std::filesystem::path& file) {
    PictureRows rows_a(a), rows_b(b);
    const ImageSize size = difference_size(rows_a.size(), rows_b.size());
    PngRowWriter difference(file, size.width, size.height);
    std::vector<std::uint8_t> row(4 * std::size_t(size.width));
    for (int y = 0; y < size.height; ++y) {
        difference_row(next_row(rows_a, y), next_row(rows_b, y), options.tolerance, row);
        difference.add_row(row);
    }
    difference.finish();
}

}  // namespace tumble
