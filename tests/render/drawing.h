// Helpers for tests that look at pixels.
#pragma once

#include "support/folder.h"

#include "core/image.h"
#include "render/camera/camera.h"
#include "render/render_switches.h"

#include <filesystem>
#include <string>

namespace tumble {

Image drawn(const SceneDescription& scene, const RenderSwitches& switches = {});
Image drawn(const SceneDescription& scene, const Snapshot& snapshot, const RenderSwitches& switches = {});

/// The pixel of a point of the world.
struct Pixel {
    int x, y;
};
Pixel pixel_of(const SceneDescription& scene, const Vec3& point);

/// Mean of the three channels, 0 .. 255.
double brightness(const Image& image, Pixel at);
double brightness_at(const Image& image, const SceneDescription& scene, const Vec3& point);

/// A copy of the shaders with changes, deleted at the end of the test.
class ShaderCopy {
public:
    ShaderCopy();

    /// Replaces a text that must exist; returns the number of its line.
    int replace(const std::string& file, const std::string& text, const std::string& by);
    void remove(const std::string& file);
    const std::filesystem::path& folder() const { return folder_.path(); }
    RenderSwitches options() const { return {{GlBackend::osmesa, folder()}}; }

private:
    TestFolder folder_;
};

}  // namespace tumble
