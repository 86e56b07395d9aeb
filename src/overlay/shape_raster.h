// Draws antialiased shapes over an image. Where a surface of the scene is nearer than the shape, the shape is faint.
// Coverage comes from the distance to the shape's outline, so a shape costs as much as its pixels.
#pragma once

#include "core/color.h"
#include "core/image.h"
#include "overlay/overlay_frame.h"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// A point on the screen: pixels from the top left corner; distance along the view axis, m.
struct ScreenPoint {
    Eigen::Vector2d pixel;
    double depth = 0.0;
};

struct ScreenArrow {
    ScreenPoint from, to;
    double width = 3.0;  // of the shaft, pixels
    int heads = 1;
};

/// A corner of a surface's triangle, with its brightness (0 to 1). The color is that of the triangle's first corner.
struct ScreenCorner {
    ScreenPoint point;
    double light = 1.0;
    Color color{255, 255, 255};
};

/// The pixels of a surface.
struct SurfaceCover {
    struct Pixel {
        float nearness = 0.0f, share = 0.0f;  // 1 / depth of the nearest part, 1/m; covered part of the pixel
        Color color;                          // mean, lit
    };
    Rectangle box;
    std::vector<Pixel> pixels;  // of the box, row by row
};

/// The pixels that were drawn to, as tiles.
class TouchedTiles {
public:
    TouchedTiles(int width, int height);
    void clear();
    void add(const Rectangle& rectangle);
    void add(const TouchedTiles& others);
    std::vector<Rectangle> rectangles() const;

private:
    int width_, height_, columns_, rows_;
    std::vector<char> touched_;
};

class ShapeRaster {
public:
    /// `pixel_size`: width of a pixel at distance 1 m, m.
    ShapeRaster(int width, int height, double pixel_size);

    /// Draws to this image from now on. The depths may be null: no shape is then hidden.
    void begin(Image& image, const DepthImage* depths);

    void arrow(const ScreenArrow& arrow, const OverlayPaint& paint);
    void line(std::span<const ScreenPoint> points, double width, const OverlayPaint& paint);
    void marker(const ScreenPoint& at, double radius, MarkerShape shape, const OverlayPaint& paint);
    /// The pixels of one surface's triangles: three corners each, in any order and orientation.
    SurfaceCover cover(std::span<const ScreenCorner> corners);
    /// Hidden parts are not drawn.
    void surface(const SurfaceCover& cover, double opacity);
    /// Straight alpha; its top left corner is at the pixel.
    void picture(const Image& picture, int x, int y, double opacity);
    /// The outline of a rectangle.
    void outline(const Rectangle& rectangle, const OverlayPaint& paint);

    /// The tiles that were drawn to since begin().
    const TouchedTiles& touched() const { return touched_; }

private:
    struct Box {
        int left, top, right, bottom;  // pixels, right and bottom excluded
        bool empty() const { return left >= right || top >= bottom; }
    };
    Box clipped(double left, double top, double right, double bottom);
    bool hidden(int x, int y, double nearness, const OverlayPaint& paint) const;  // nearness: 1 / depth, 1/m
    struct CornerValue {
        double nearness, light;  // 1 / depth, 1/m; brightness
    };
    void fill(const std::array<Eigen::Vector2d, 3>& places, const std::array<CornerValue, 3>& values, Color color,
              int columns, int rows);
    /// Draws the pixels left to right - 1 of a row. distance(x): from the outline, pixels, positive outside;
    /// nearness(x): 1 / depth, 1/m.
    template <class Distance, class Nearness>
    void draw_run(int y, int left, int right, const OverlayPaint& paint, double halo, const Distance& distance,
                  const Nearness& nearness);
    /// Calls draw(y, left, right) for runs with at least the pixels whose centers are within `reach` (pixels) of the
    /// line.
    template <class Draw>
    void for_runs_along(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double reach, const Draw& draw);
    void add_cover(const ScreenPoint& from, const ScreenPoint& to, double radius, const OverlayPaint& paint);

    int width_, height_;
    double surface_factor_;  // a shape is hidden beyond this many times the depth of the surface
    Image* image_ = nullptr;
    const DepthImage* depths_ = nullptr;
    TouchedTiles touched_;
    // The line being drawn: coverage of each pixel, and the pixels with any.
    struct Cover {
        float line = 0.0f, halo = 0.0f;
    };
    std::vector<Cover> cover_;
    std::vector<std::size_t> covered_;
    // The surface being drawn, at 2 x 2 samples a pixel: 1 / depth of the nearest triangle (0: none), lit color.
    struct SurfaceSample {
        float nearness = 0.0f;
        Color color;
    };
    std::vector<SurfaceSample> samples_;
};

}  // namespace tumble
