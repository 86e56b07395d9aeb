#include "scene/mesh/texture_image.h"

#include "core/color.h"
#include "core/error.h"
#include "output/jpeg_reader.h"
#include "output/png_reader.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <vector>

namespace tumble {
namespace {

using Linear = std::array<float, 4>;  // red, green and blue times alpha; alpha

/// The predicate of an error: of the file, or of an image of that name in it.
std::string about_image(const std::string& name, const std::string& fault) {
    return name.empty() ? "is " + fault : fmt::format("has the image \"{}\", which is {}", name, fault);
}

bool is_jpeg(std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }

/// The rows of an image in memory.
class ImageRows {
public:
    explicit ImageRows(std::string_view bytes, const std::string& name) {
        OpenFile file(::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb"));  // opened for reading
        if (!file) throw MeshError(about_image(name, "empty"));
        if (is_jpeg(bytes))
            jpeg_.emplace(std::move(file), name);
        else
            png_.emplace(std::move(file), name);
        const ImageSize size = this->size();
        if (std::max(size.width, size.height) > limits::texture_side)
            throw MeshError(about_image(name, fmt::format("too large: {} x {} pixels (at most {} a side)", size.width,
                                                          size.height, limits::texture_side)));
    }

    ImageSize size() const { return jpeg_ ? jpeg_->size() : png_->size(); }
    std::span<const std::uint8_t> next() { return jpeg_ ? jpeg_->next() : png_->next(); }

private:
    std::optional<PngRows> png_;
    std::optional<JpegRows> jpeg_;
};

/// Calls visit(rows); a broken image is a MeshError.
template <class Visit>
void with_rows(std::string_view bytes, const std::string& name, const Visit& visit) {
    try {
        ImageRows rows(bytes, name);
        visit(rows);
    } catch (const InputError& error) {
        throw MeshError(about_image(name, error.message()));
    }
}

std::uint8_t code(float share) { return std::uint8_t(std::lround(255.0f * std::clamp(share, 0.0f, 1.0f))); }

std::array<std::uint8_t, 4> coded(const Linear& texel) {
    const float per_alpha = texel[3] > 0.0f ? 1.0f / texel[3] : 0.0f;
    return {code(std::sqrt(texel[0] * per_alpha)), code(std::sqrt(texel[1] * per_alpha)),
            code(std::sqrt(texel[2] * per_alpha)), code(texel[3])};
}

/// The source texels under each target texel along a side, whose shares are those of the box of its width.
struct Shares {
    int first, count;
    std::array<float, 3> share;
};

std::vector<Shares> shares_along(int from, int to) {
    std::vector<Shares> all;
    for (int i = 0; i < to; ++i) {
        const double begin = double(i) * from / to, end = double(i + 1) * from / to;
        Shares shares{int(begin), 0, {}};
        for (int k = shares.first; k < from && double(k) < end && shares.count < 3; ++k)
            shares.share[std::size_t(shares.count++)] =
                float((std::min(double(k + 1), end) - std::max(double(k), begin)) / (end - begin));
        all.push_back(shares);
    }
    return all;
}

/// `source`(x, y): a texel of the larger level.
template <class Source>
std::vector<Linear> halved(int width, int height, int half_width, int half_height, const Source& source) {
    const std::vector<Shares> columns = shares_along(width, half_width), rows = shares_along(height, half_height);
    std::vector<Linear> result;
    result.reserve(std::size_t(half_width) * std::size_t(half_height));
    for (const Shares& row : rows)
        for (const Shares& column : columns) {
            Linear sum{};
            for (int j = 0; j < row.count; ++j)
                for (int i = 0; i < column.count; ++i) {
                    const Linear texel = source(column.first + i, row.first + j);
                    const float share = row.share[std::size_t(j)] * column.share[std::size_t(i)];
                    for (std::size_t c = 0; c < 4; ++c) sum[c] += share * texel[c];
                }
            result.push_back(sum);
        }
    return result;
}

void add_mip_maps(Texture& texture, const std::array<float, 256>& light) {
    std::vector<Linear> texels;
    while (texture.levels.back().width > 1 || texture.levels.back().height > 1) {
        const Texture::Level& larger = texture.levels.back();
        const int width = std::max(1, larger.width / 2), height = std::max(1, larger.height / 2);
        if (texture.levels.size() == 1)
            texels = halved(larger.width, larger.height, width, height, [&](int x, int y) {
                const auto& bytes = larger.texels[std::size_t(y) * std::size_t(larger.width) + std::size_t(x)];
                const float alpha = float(bytes[3]) / 255.0f;
                return Linear{alpha * light[bytes[0]], alpha * light[bytes[1]], alpha * light[bytes[2]], alpha};
            });
        else
            texels = halved(larger.width, larger.height, width, height, [&](int x, int y) {
                return texels[std::size_t(y) * std::size_t(larger.width) + std::size_t(x)];
            });
        Texture::Level level{width, height, {}};
        for (const Linear& texel : texels) level.texels.push_back(coded(texel));
        texture.levels.push_back(std::move(level));
    }
}

/// Mip maps of numbers.
void add_number_maps(Texture& map) {
    std::vector<Linear> texels;
    while (map.levels.back().width > 1 || map.levels.back().height > 1) {
        const Texture::Level& larger = map.levels.back();
        const int width = std::max(1, larger.width / 2), height = std::max(1, larger.height / 2);
        const bool first = map.levels.size() == 1;
        texels = halved(larger.width, larger.height, width, height, [&](int x, int y) -> Linear {
            const std::size_t at = std::size_t(y) * std::size_t(larger.width) + std::size_t(x);
            if (!first) return texels[at];
            const auto& bytes = larger.texels[at];
            return {float(bytes[0]), float(bytes[1]), float(bytes[2]), 255.0f};
        });
        Texture::Level level{width, height, {}};
        for (const Linear& t : texels)
            level.texels.push_back({code(t[0] / 255.0f), code(t[1] / 255.0f), code(t[2] / 255.0f), 255});
        map.levels.push_back(std::move(level));
    }
}

/// The image with its bytes as they are, without mip maps.
Texture whole_image(std::string_view bytes, const std::string& name, std::int64_t& texels) {
    Texture texture;
    with_rows(bytes, name, [&](ImageRows& rows) {
        Texture::Level image{rows.size().width, rows.size().height, {}};
        texels += std::int64_t(image.width) * image.height;
        if (texels > limits::texture_texels)
            throw MeshError(about_image(name, fmt::format("too much: the limit of all images together is {} megapixels",
                                                          limits::texture_texels >> 20)));
        for (int y = 0; y < image.height; ++y) {
            const std::span<const std::uint8_t> row = rows.next();
            for (std::size_t at = 0; at + 3 < row.size(); at += 4) {
                image.texels.push_back({row[at], row[at + 1], row[at + 2], row[at + 3]});
                texture.least_alpha = std::min(texture.least_alpha, row[at + 3]);
            }
        }
        texture.levels.push_back(std::move(image));
    });
    return texture;
}

}  // namespace

bool is_texture_image(std::string_view bytes) { return is_jpeg(bytes) || bytes.starts_with("\x89PNG\r\n\x1a\n"); }

std::shared_ptr<const Texture> make_texture(std::string_view bytes, const std::string& name, std::int64_t& texels) {
    std::array<float, 256> light{};
    std::array<std::uint8_t, 256> root{};
    for (std::size_t i = 0; i < light.size(); ++i) {
        light[i] = float(srgb_to_linear(double(i) / 255.0));
        root[i] = code(std::sqrt(light[i]));
    }
    auto texture = std::make_shared<Texture>(whole_image(bytes, name, texels));
    add_mip_maps(*texture, light);
    for (auto& texel : texture->levels.front().texels)
        texel = {root[texel[0]], root[texel[1]], root[texel[2]], texel[3]};
    return texture;
}

std::shared_ptr<const Texture> make_map(std::string_view bytes, const std::string& name, std::int64_t& texels) {
    return changed_map(whole_image(bytes, name, texels), [](int, int, auto&) {});
}

std::shared_ptr<const Texture> changed_map(const Texture& map,
                                           const std::function<void(int, int, std::array<std::uint8_t, 4>&)>& change) {
    auto made = std::make_shared<Texture>();
    Texture::Level image = map.levels.front();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            auto& texel = image.texels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
            texel[3] = 255;
            change(x, y, texel);
        }
    made->levels.push_back(std::move(image));
    add_number_maps(*made);
    return made;
}

std::shared_ptr<const Texture> normals_of_heights(const Texture& heights, float strength) {
    const Texture::Level& image = heights.levels.front();
    const auto at = [&](int x, int y) {
        const int column = (x + image.width) % image.width, row = (y + image.height) % image.height;
        return float(image.texels[std::size_t(row) * std::size_t(image.width) + std::size_t(column)][0]) / 255.0f;
    };
    return changed_map(heights, [&](int x, int y, std::array<std::uint8_t, 4>& texel) {
        const float across = 0.5f * strength * (at(x - 1, y) - at(x + 1, y));
        const float up = 0.5f * strength * (at(x, y + 1) - at(x, y - 1));
        const float length = std::sqrt(across * across + up * up + 1.0f);
        const auto channel = [&](float v) { return std::uint8_t(std::lround(128.0f + 127.0f * v / length)); };
        texel = {channel(across), channel(up), channel(1.0f), 255};
    });
}

bool is_gray(const Texture& map) {
    constexpr int rounding = 3;  // of JPEG
    const auto gray = [](const auto& texel) {
        return std::max({texel[0], texel[1], texel[2]}) - std::min({texel[0], texel[1], texel[2]}) <= rounding;
    };
    return std::ranges::all_of(map.levels.front().texels, gray);
}

}  // namespace tumble
