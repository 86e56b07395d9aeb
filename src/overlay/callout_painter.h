// Draws texts beside points of the scene: each in the picture, with a line to its point, and off those before it.
#pragma once

#include "core/image.h"
#include "overlay/overlay_frame.h"
#include "overlay/shape_raster.h"
#include "render/camera/camera.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace tumble {

/// A callout on the screen, in pixels.
struct PlacedCallout {
    const OverlayCallout* callout = nullptr;
    ScreenPoint of;
    Rectangle box;         // of the text
    double opacity = 1.0;  // lower where its point is about to leave the picture
};

class CalloutPainter {
public:
    /// `unit`: pixels of a unit of the sizes.
    CalloutPainter(int width, int height, double unit) : width_(width), height_(height), unit_(unit) {}

    void draw(const Camera& camera, const std::vector<OverlayCallout>& callouts, ShapeRaster& raster);
    /// Those that are shown: a function of the frame alone.
    std::vector<PlacedCallout> place(const Camera& camera, const std::vector<OverlayCallout>& callouts);

private:
    std::optional<PlacedCallout> placed(const Camera& camera, const OverlayCallout& callout);
    void move_off(const std::vector<PlacedCallout>& before, Rectangle& box) const;
    const Image& picture(const OverlayCallout& callout);

    int width_, height_;
    double unit_;
    std::map<std::tuple<std::string, float, std::array<std::uint8_t, 3>>, Image> pictures_;
};

}  // namespace tumble
