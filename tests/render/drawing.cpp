#include "drawing.h"

#include "example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble {
Image drawn(const SceneDescription& scene, const Snapshot& snapshot, const RenderSwitches& switches) {
    return Renderer(scene, switches).render(snapshot);
}

Image drawn(const SceneDescription& scene, const RenderSwitches& switches) {
    return drawn(scene, first_snapshot(scene), switches);
}

Pixel pixel_of(const SceneDescription& scene, const Vec3& point) {
    const Camera view(scene.camera, scene.output.width, scene.output.height);
    const Eigen::Vector2d at = view.pixel(view.relative(point));
    return {int(std::floor(at.x())), int(std::floor(at.y()))};
}

double brightness(const Image& image, Pixel at) {
    EXPECT_TRUE(at.x >= 0 && at.y >= 0 && at.x < image.width && at.y < image.height) << at.x << ", " << at.y;
    const std::uint8_t* p = image.at(at.x, at.y);
    return (p[0] + p[1] + p[2]) / 3.0;
}

double brightness_at(const Image& image, const SceneDescription& scene, const Vec3& point) {
    return brightness(image, pixel_of(scene, point));
}

ShaderCopy::ShaderCopy() {
    std::filesystem::copy(std::filesystem::path(TUMBLE_SOURCE_DIR) / "shaders", folder(),
                          std::filesystem::copy_options::recursive);
}

int ShaderCopy::replace(const std::string& file, const std::string& text, const std::string& by) {
    std::string content = read_text(folder_ / file);
    const std::size_t at = content.find(text);
    EXPECT_NE(at, std::string::npos) << file << " has no '" << text << "'";
    if (at == std::string::npos) return 0;
    content.replace(at, text.size(), by);
    write_text(folder_ / file, content);
    return 1 + int(std::count(content.begin(), content.begin() + std::ptrdiff_t(at), '\n'));
}

void ShaderCopy::remove(const std::string& file) { std::filesystem::remove(folder_ / file); }

}  // namespace tumble
