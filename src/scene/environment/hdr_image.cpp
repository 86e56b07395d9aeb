#include "scene/environment/hdr_image.h"

#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>

namespace tumble {
namespace {

constexpr std::size_t most_header_bytes = 64 << 10;
constexpr int least_encoded = 8, most_encoded = 0x7fff;  // widths of rows that may be encoded by channel

using Rgbe = std::array<std::uint8_t, 4>;

class Reader {
public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    EnvironmentImage image() {
        read_header();
        EnvironmentImage image = read_size(line());
        image.texels.reserve(std::size_t(image.width) * std::size_t(image.height));
        std::vector<Rgbe> row(std::size_t(image.width));
        for (int y = 0; y < image.height; ++y) {
            read_row(row);
            for (const Rgbe& texel : row) image.texels.push_back(light(texel));
        }
        return image;
    }

private:
    [[noreturn]] static void cut() { throw MeshError("ends too early"); }

    std::string_view line() {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == bytes_.npos || end > most_header_bytes) throw MeshError("has no image after its header");
        std::string_view text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (text.ends_with('\r')) text.remove_suffix(1);
        return text;
    }

    void read_header() {
        line();
        for (std::string_view text = line(); !text.empty(); text = line()) {
            constexpr std::string_view format = "FORMAT=";
            if (text.starts_with(format) && text.substr(format.size()) != "32-bit_rle_rgbe")
                throw MeshError("has colors that are not red, green and blue");
        }
    }

    static EnvironmentImage read_size(std::string_view text) {
        EnvironmentImage image;
        const auto number = [&](std::string_view before, int& value) {
            if (!text.starts_with(before)) throw MeshError("has rows in another order than \"-Y HEIGHT +X WIDTH\"");
            text.remove_prefix(before.size());
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (error != std::errc() || value < 1) throw MeshError("has no valid size");
            text.remove_prefix(std::size_t(end - text.data()));
        };
        number("-Y ", image.height);
        number(" +X ", image.width);
        if (std::max(image.width, image.height) > limits::environment_side)
            throw MeshError(fmt::format("is too large: {} x {} pixels (at most {} a side)", image.width, image.height,
                                        limits::environment_side));
        return image;
    }

    std::uint8_t byte() {
        if (at_ >= bytes_.size()) cut();
        return std::uint8_t(bytes_[at_++]);
    }

    Rgbe four() { return {byte(), byte(), byte(), byte()}; }

    void read_row(std::vector<Rgbe>& row) {
        const Rgbe first = four();
        const int width = int(row.size());
        const bool by_channel = first[0] == 2 && first[1] == 2 && (first[2] << 8 | first[3]) == width;
        if (by_channel && width >= least_encoded && width <= most_encoded)
            for (std::size_t channel = 0; channel < 4; ++channel) read_channel(row, channel);
        else
            read_texels(row, first);
    }

    /// Runs of one value, and stretches of single ones.
    void read_channel(std::vector<Rgbe>& row, std::size_t channel) {
        for (std::size_t x = 0; x < row.size();) {
            const std::size_t code = byte();
            const bool run = code > 128;
            const std::size_t count = run ? code - 128 : code;
            if (count == 0 || count > row.size() - x) throw MeshError("has a row of another length");
            std::uint8_t value = run ? byte() : std::uint8_t(0);
            for (std::size_t i = 0; i < count; ++i) {
                if (!run) value = byte();
                row[x++][channel] = value;
            }
        }
    }

    /// The older encoding: a texel (1, 1, 1, n) repeats the one before, with further ones n of a higher place.
    void read_texels(std::vector<Rgbe>& row, Rgbe texel) {
        unsigned shift = 0;
        for (std::size_t x = 0;;) {
            if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1) {
                const std::size_t count = shift < 24 ? std::size_t(texel[3]) << shift : row.size() + 1;
                if (x == 0 || count > row.size() - x) throw MeshError("has a row of another length");
                for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
                shift += 8;
            } else {
                row[x++] = texel;
                shift = 0;
            }
            if (x == row.size()) return;
            texel = four();
        }
    }

    static std::array<float, 3> light(const Rgbe& texel) {
        if (texel[3] == 0) return {};
        const float unit = std::ldexp(1.0f, int(texel[3]) - (128 + 8));
        return {unit * (float(texel[0]) + 0.5f), unit * (float(texel[1]) + 0.5f), unit * (float(texel[2]) + 0.5f)};
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
};

}  // namespace

bool is_hdr_image(std::string_view bytes) { return bytes.starts_with("#?"); }

EnvironmentImage read_hdr_image(std::string_view bytes) { return Reader(bytes).image(); }

}  // namespace tumble
