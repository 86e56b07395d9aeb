#include "scene/environment/exr_image.h"

#include "scene/mesh/import_process.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#ifdef TUMBLE_OPENEXR
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfRgbaFile.h>
#endif

namespace tumble {

bool is_exr_image(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

#ifdef TUMBLE_OPENEXR
namespace {

class ExrBytes : public OPENEXR_IMF_NAMESPACE::IStream {
public:
    explicit ExrBytes(std::string_view bytes) : IStream("the image"), bytes_(bytes) {}

    bool read(char to[], int count) override {
        if (count < 0 || std::size_t(count) > bytes_.size() - at_) throw MeshError("ends too early");
        std::memcpy(to, bytes_.data() + at_, std::size_t(count));
        at_ += std::size_t(count);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t to) override {
        if (to > bytes_.size()) throw MeshError("ends too early");
        at_ = std::size_t(to);
    }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

float exr_light(float value) { return std::isfinite(value) ? std::max(value, 0.0f) : 0.0f; }

EnvironmentImage read_exr(std::string_view bytes) {
    using namespace OPENEXR_IMF_NAMESPACE;
    ExrBytes stream(bytes);
    RgbaInputFile file(stream, 0);
    if ((file.channels() & (WRITE_RGB | WRITE_Y)) == 0) throw MeshError("has no red, green and blue");
    const auto window = file.dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1) throw MeshError("has no valid size");
    if (std::max(width, height) > limits::environment_side)
        throw MeshError(
            fmt::format("is too large: {} x {} pixels (at most {} a side)", width, height, limits::environment_side));
    EnvironmentImage image{int(width), int(height), {}};
    image.texels.reserve(std::size_t(width * height));
    std::vector<Rgba> row(static_cast<std::size_t>(width));
    for (int y = window.min.y; y <= window.max.y; ++y) {
        file.setFrameBuffer(row.data() - window.min.x, 1, 0);  // the same row again and again
        file.readPixels(y);
        for (const Rgba& texel : row)
            image.texels.push_back({exr_light(texel.r), exr_light(texel.g), exr_light(texel.b)});
    }
    return image;
}

}  // namespace

EnvironmentImage read_exr_image(std::string_view bytes) {
    try {
        return read_exr(bytes);
    } catch (const MeshError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw MeshError(fmt::format("cannot be read: {}", readable(error.what(), 120)));
    }
}
#else
EnvironmentImage read_exr_image(std::string_view) {
    throw MeshError(
        "is an OpenEXR file, which this build of the program does not read: build it with libopenexr-dev, or save the "
        "image as .hdr");
}
#endif

EnvironmentImage import_exr_image(std::string_view bytes) {
    const ImportLimits limits{"OpenEXR", (std::uint64_t(512) << 20) + 16 * std::uint64_t(bytes.size()), 60, ".hdr"};
    const std::string answer = run_import(limits, [&](ImportOutput& output) {
        const EnvironmentImage image = read_exr_image(bytes);
        output.write(&image.width, sizeof image.width);
        output.write(&image.height, sizeof image.height);
        output.write(image.texels.data(), image.texels.size() * sizeof image.texels[0]);
    });
    EnvironmentImage image;
    constexpr std::size_t head = sizeof image.width + sizeof image.height;
    if (answer.size() >= head) {
        std::memcpy(&image.width, answer.data(), sizeof image.width);
        std::memcpy(&image.height, answer.data() + sizeof image.width, sizeof image.height);
    }
    const bool sized = image.width >= 1 && image.width <= limits::environment_side && image.height >= 1 &&
                       image.height <= limits::environment_side;
    const std::size_t texels = sized ? std::size_t(image.width) * std::size_t(image.height) : 0;
    if (!sized || answer.size() != head + texels * sizeof image.texels[0])
        throw MeshError("was not imported as a whole");
    image.texels.resize(texels);
    std::memcpy(static_cast<void*>(image.texels.data()), answer.data() + head, answer.size() - head);
    for (auto& texel : image.texels)
        for (float& channel : texel) channel = std::isfinite(channel) ? std::max(channel, 0.0f) : 0.0f;
    return image;
}

}  // namespace tumble
