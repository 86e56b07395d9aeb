// Draws the shapes of an overlay over a rendered frame.
#pragma once

#include "core/image.h"
#include "overlay/callout_painter.h"
#include "overlay/legend.h"
#include "overlay/overlay_frame.h"
#include "overlay/shape_raster.h"
#include "render/camera/camera.h"
#include "scene/description/description.h"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// A rendered frame.
struct PlainFrame {
    const Image& image;
    const std::vector<Rectangle>& changed;  // since the previous one
    const DepthImage& depths;
    const Camera& camera;
};

class OverlayPainter {
public:
    /// `scene` must outlive it.
    OverlayPainter(const SceneDescription& scene, const PanelOverlay& overlay);

    /// The frame with the shapes. It equals a full drawing, and is valid until the next call.
    const Image& draw(const PlainFrame& frame, const OverlayFrame& shapes);

    /// Regions in which the image may differ from the previous one.
    const std::vector<Rectangle>& changed() const { return changed_; }

private:
    void draw_shapes(const Camera& camera, const OverlayFrame& shapes);
    void draw_line(const Camera& camera, const OverlayLine& line);
    SurfaceCover cover(const Camera& camera, const OverlaySurface& surface);
    void draw_surface(const Camera& camera, const OverlaySurface& surface);
    void draw_label(const Camera& camera, const OverlayLabel& label);
    const Image& text_picture(const OverlayLabel& label);

    /// Triangles of a body's surface in the body's frame: three vertices each.
    struct Vertex {
        Vec3 position, normal;
        Color color;
    };
    using Triangles = std::vector<Vertex>;
    static void add_shape(const Shape& shape, const Vec3& origin, const Quat& rotation, Color color, Triangles& to);
    const Triangles& triangles(std::size_t body);

    const SceneDescription* scene_;
    double unit_;  // pixels of a unit of the shapes' sizes
    ShapeRaster raster_;
    CalloutPainter callouts_;
    std::optional<Image> legend_;
    int legend_top_;  // pixels
    Image image_;
    TouchedTiles previous_;  // drawn to in the previous frame
    bool first_ = true;
    std::vector<Rectangle> changed_;
    std::vector<ScreenPoint> points_;
    std::vector<ScreenCorner> corners_;
    std::map<std::size_t, Triangles> triangles_;  // by body, made on first use
    std::map<std::pair<std::string, float>, Image> texts_;
    std::map<std::array<double, 8>, SurfaceCover> ghosts_;  // by body and pose, for the camera below
    std::size_t ghost_pixels_ = 0;                          // of all of these
    Vec3 ghost_eye_ = Vec3::Zero();
    glm::mat4 ghost_view_{0.0f};
};

}  // namespace tumble
