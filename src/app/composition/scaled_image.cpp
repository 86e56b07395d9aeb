#include "app/composition/stamp.h"

#include "core/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tumble {
namespace {

/// A pixel of one side, and its part of a new pixel.
struct Part {
    int at;
    double weight;
};

/// For each new pixel of a side.
std::vector<std::vector<Part>> parts_of(int from, int to) {
    const double scale = double(from) / to;
    std::vector<std::vector<Part>> all;
    for (int i = 0; i < to; ++i) {
        std::vector<Part>& parts = all.emplace_back();
        if (scale <= 1.0) {
            const double middle = std::clamp((i + 0.5) * scale - 0.5, 0.0, from - 1.0);
            const int first = int(middle), second = std::min(first + 1, from - 1);
            parts = {{first, 1.0 - (middle - first)}, {second, middle - first}};
            continue;
        }
        const double begin = i * scale, end = (i + 1) * scale;
        for (int at = int(begin); at < from && at < end; ++at)
            parts.push_back({at, (std::min(end, at + 1.0) - std::max(begin, double(at))) / scale});
    }
    return all;
}

}  // namespace

Image scaled_image(const Texture::Level& image, int width, int height, double opacity) {
    std::array<double, 256> light;
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = srgb_to_linear(double(i) / 255.0);
    const auto byte_of = [](double share) { return std::uint8_t(std::lround(255.0 * std::clamp(share, 0.0, 1.0))); };
    const auto columns = parts_of(image.width, width), rows = parts_of(image.height, height);
    Image scaled(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::array<double, 4> sum{};
            for (const Part& row : rows[std::size_t(y)])
                for (const Part& column : columns[std::size_t(x)]) {
                    const auto& texel =
                        image.texels[std::size_t(row.at) * std::size_t(image.width) + std::size_t(column.at)];
                    const double alpha = row.weight * column.weight * (texel[3] / 255.0);
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += alpha * light[texel[c]];
                    sum[3] += alpha;
                }
            std::uint8_t* const to = scaled.at(x, y);
            for (std::size_t c = 0; c < 3; ++c) to[c] = sum[3] > 0.0 ? byte_of(linear_to_srgb(sum[c] / sum[3])) : 0;
            to[3] = byte_of(opacity * sum[3]);
        }
    return scaled;
}

}  // namespace tumble
