#include "overlay/shape_raster.h"

#include "core/color.h"
#include "render/damage/dirty_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

using Eigen::Vector2d;

constexpr int tile = 16;  // pixels
// A shape that lies in a surface counts as visible: relative depth, and pixels at the surface's distance.
constexpr double depth_tolerance = 2e-3, depth_tolerance_pixels = 4.0;

/// Thin shapes have a thin outline, which would otherwise be all that is seen of them.
double halo_width(double width) { return std::min(style::most_halo, style::halo_of_width * width); }

float coverage(float distance) { return std::min(std::max(0.5f - distance, 0.0f), 1.0f); }

/// An arrow in its own coordinates: along from the foot, across from the axis, in pixels.
struct ArrowOutline {
    ArrowOutline(double length_, double width, int heads_) : length(length_), half_width(0.5 * width), heads(heads_) {
        const double room = length / (1.0 + style::second_head * (heads - 1));
        const double scale = std::min(1.0, room / (style::head_length * width));
        head = scale * style::head_length * width;
        half_base = std::max(scale * style::head_half_width * width, half_width);
        shaft_end = std::max(0.0, length - (style::head_overlap + style::second_head * (heads - 1)) * head);
        slope = std::hypot(head, half_base);
        halo = halo_width(width);
        heads_start = length - (1.0 + style::second_head * (heads - 1)) * head - halo - 0.5;
    }

    double length, half_width, head, half_base, shaft_end, slope, halo, heads_start;
    int heads;
};

/// The same in the form that a run of pixels is computed with: in single precision, without branches.
struct ArrowDistance {
    explicit ArrowDistance(const ArrowOutline& o)
        : half_width(float(o.half_width)),
          shaft_end(float(o.shaft_end)),
          head(float(o.head)),
          tip(float(o.length)),
          second_tip(float(o.heads > 1 ? o.length - style::second_head * o.head : o.length)),
          along_part(float(o.half_base / o.slope)),
          across_part(float(o.head / o.slope)) {}

    float operator()(float along, float across) const {
        const float before = along - std::min(std::max(along, 0.0f), shaft_end);
        const float shaft = std::sqrt(before * before + across * across) - half_width;
        return std::min(shaft, std::min(head_distance(tip, along, across), head_distance(second_tip, along, across)));
    }
    float head_distance(float at, float along, float across) const {
        return std::max(at - head - along, (along - at) * along_part + across * across_part);
    }

    float half_width, shaft_end, head, tip, second_tip, along_part, across_part;
};

/// Half of the width of a marker, in radii.
double marker_extent(MarkerShape shape) {
    switch (shape) {
        case MarkerShape::diamond:
            return 1.3;
        case MarkerShape::ring:
        case MarkerShape::cross:
            return 1.1;
        default:
            return 1.0;
    }
}

/// Calls use(distance) with the signed distance from the outline of a marker as a function of the place (pixels).
template <class Use>
void with_marker_distance(MarkerShape shape, float radius, const Use& use) {
    constexpr float half_root = 0.70710678f;
    switch (shape) {
        case MarkerShape::ring:
            use([=](float x, float y) { return std::fabs(std::sqrt(x * x + y * y) - 0.8f * radius) - 0.3f * radius; });
            break;
        case MarkerShape::square:
            use([=](float x, float y) { return std::max(std::fabs(x), std::fabs(y)) - 0.85f * radius; });
            break;
        case MarkerShape::diamond:
            use([=](float x, float y) { return (std::fabs(x) + std::fabs(y) - 1.3f * radius) * half_root; });
            break;
        case MarkerShape::cross:
            use([=](float x, float y) {
                const float u = std::fabs(x + y) * half_root, v = std::fabs(x - y) * half_root;
                const float arm = 1.15f * radius, half = 0.32f * radius;
                return std::min(std::max(u - arm, v - half), std::max(v - arm, u - half));
            });
            break;
        case MarkerShape::disc:
        case MarkerShape::center_of_mass:
            use([=](float x, float y) { return std::sqrt(x * x + y * y) - radius; });
            break;
    }
}

/// mix() into a pixel that is transparent itself.
[[gnu::noinline]] void mix_into_transparent(std::uint8_t* p, Color color, int share) {
    const std::uint8_t channels[] = {color.r, color.g, color.b};
    put_over(channels, std::uint32_t(255 * share + 128) >> 8, p);
}

/// Moves a color toward another by a share of 0 to 256.
inline void mix(std::uint8_t* p, Color color, int share) {
    if (p[3] != 255) return mix_into_transparent(p, color, share);
    const auto channel = [&](std::uint8_t from, int to) {
        return std::uint8_t(from + (((to - from) * share + 128) >> 8));
    };
    p[0] = channel(p[0], color.r);
    p[1] = channel(p[1], color.g);
    p[2] = channel(p[2], color.b);
}

/// A paint, and its shares where the shape covers a whole pixel: 256 is opaque.
struct Brush {
    explicit Brush(const OverlayPaint& paint)
        : color(paint.color), share(float(256.0 * paint.opacity)), halo_share(float(style::halo_opacity) * share) {}
    /// `own`, `halo`: shares of the shape and of its dark outline below it.
    void draw(std::uint8_t* p, int own, int halo) const {
        if (own >= 256) {  // most pixels of a shape
            p[0] = color.r;
            p[1] = color.g;
            p[2] = color.b;
            p[3] = 255;
            return;
        }
        if (halo > 0) mix(p, style::halo_color, halo);
        if (own > 0) mix(p, color, own);
    }
    Color color;
    float share, halo_share;
};

}  // namespace

TouchedTiles::TouchedTiles(int width, int height)
    : width_(width),
      height_(height),
      columns_((width + tile - 1) / tile),
      rows_((height + tile - 1) / tile),
      touched_(std::size_t(columns_) * std::size_t(rows_)) {}

void TouchedTiles::clear() { std::fill(touched_.begin(), touched_.end(), char(0)); }

void TouchedTiles::add(const Rectangle& r) {
    if (r.width <= 0 || r.height <= 0) return;
    for (int row = r.y / tile; row <= (r.y + r.height - 1) / tile; ++row)
        for (int column = r.x / tile; column <= (r.x + r.width - 1) / tile; ++column)
            touched_[std::size_t(row * columns_ + column)] = 1;
}

void TouchedTiles::add(const TouchedTiles& others) {
    for (std::size_t i = 0; i < touched_.size(); ++i) touched_[i] = char(touched_[i] | others.touched_[i]);
}

std::vector<Rectangle> TouchedTiles::rectangles() const {
    return cell_rectangles({columns_, rows_, tile, width_, height_},
                           [&](int column, int row) { return touched_[std::size_t(row * columns_ + column)] != 0; });
}

ShapeRaster::ShapeRaster(int width, int height, double pixel_size)
    : width_(width),
      height_(height),
      surface_factor_(1.0 + depth_tolerance + depth_tolerance_pixels * pixel_size),
      touched_(width, height) {}

void ShapeRaster::begin(Image& image, const DepthImage* depths) {
    image_ = &image;
    depths_ = depths;
    touched_.clear();
}

// Far outside, coordinates may exceed int.
ShapeRaster::Box ShapeRaster::clipped(double left, double top, double right, double bottom) {
    const auto pixel = [](double value, int most) { return int(std::clamp(value, 0.0, double(most))); };
    const Box box{pixel(std::floor(left), width_), pixel(std::floor(top), height_),
                  pixel(std::ceil(right) + 1.0, width_), pixel(std::ceil(bottom) + 1.0, height_)};
    return box;
}

bool ShapeRaster::hidden(int x, int y, double nearness, const OverlayPaint& paint) const {
    if (depths_ == nullptr || !paint.depth_tested) return false;
    return nearness * (*depths_->at(x, y) * surface_factor_ + paint.allowance) < 1.0;
}

// Distances, coverage and visibility are computed for a run of pixels at a time, in loops that become vector
// instructions.
template <class Distance, class Nearness>
void ShapeRaster::draw_run(int y, int left, int right, const OverlayPaint& paint, double halo, const Distance& distance,
                           const Nearness& nearness) {
    constexpr int most = 64;  // pixels: a run fits into the registers and the first cache
    const Brush brush(paint);
    const auto reach = float(halo), surface_factor = float(surface_factor_), allowance = float(paint.allowance);
    const bool tested = depths_ != nullptr && paint.depth_tested;
    std::array<int, most> own, dark;
    for (int first = left; first < right; first += most) {
        const int count = std::min(most, right - first);
        for (int k = 0; k < count; ++k) {
            const float d = distance(first + k);
            own[std::size_t(k)] = int(coverage(d) * brush.share + 0.5f);
            dark[std::size_t(k)] = int(coverage(d - reach) * brush.halo_share + 0.5f);
        }
        if (tested) {
            const float* const surface = depths_->at(first, y);
            for (int k = 0; k < count; ++k) {
                const int hidden = nearness(first + k) * (surface[k] * surface_factor + allowance) < 1.0f ? 1 : 0;
                own[std::size_t(k)] >>= hidden;
                dark[std::size_t(k)] >>= hidden;
            }
        }
        std::uint8_t* pixel = image_->at(first, y);
        for (int k = 0; k < count; ++k, pixel += 4)
            if ((own[std::size_t(k)] | dark[std::size_t(k)]) != 0)
                brush.draw(pixel, own[std::size_t(k)], dark[std::size_t(k)]);
    }
}

// The rows of a slanted band are cut to the pixels that it can reach; touched tiles are added a row of tiles at a time.
template <class Draw>
void ShapeRaster::for_runs_along(const Vector2d& from, const Vector2d& to, double reach, const Draw& draw) {
    const Vector2d way = to - from;
    const double least = std::min(from.x(), to.x()) - reach, most = std::max(from.x(), to.x()) + reach;
    const Box box = clipped(least, std::min(from.y(), to.y()) - reach, most, std::max(from.y(), to.y()) + reach);
    const bool slanted = std::fabs(way.y()) >= 1e-6;
    const double slope = slanted ? way.x() / way.y() : 0.0;
    const double half = slanted ? reach * std::sqrt(1.0 + slope * slope) : most - least;
    int tile_left = width_, tile_right = 0;
    for (int y = box.top; y < box.bottom; ++y) {
        const double middle = slanted ? from.x() + (y + 0.5 - from.y()) * slope : least;
        const int left = int(std::clamp(middle - half, double(box.left), double(box.right)));
        const int right = int(std::clamp(middle + half + 1.0, double(box.left), double(box.right)));
        if (left < right) draw(y, left, right);
        tile_left = std::min(tile_left, left);
        tile_right = std::max(tile_right, right);
        if (y % tile != tile - 1 && y + 1 < box.bottom) continue;
        touched_.add({tile_left, y, tile_right - tile_left, 1});
        tile_left = width_, tile_right = 0;
    }
}

void ShapeRaster::arrow(const ScreenArrow& a, const OverlayPaint& paint) {
    const Vector2d way = a.to.pixel - a.from.pixel;
    const double length = way.norm();
    if (!(length > 0.0)) return;
    const Vector2d axis = way / length;
    const ArrowOutline outline(length, a.width, a.heads);
    const ArrowDistance distance(outline);
    const auto near_from = float(1.0 / a.from.depth),
               near_change = float((1.0 / a.to.depth - 1.0 / a.from.depth) / length);
    const auto axis_x = float(axis.x()), axis_y = float(axis.y()), end = float(length);
    for_runs_along(a.from.pixel, a.to.pixel, outline.half_base + outline.halo + 0.5, [&](int y, int left, int right) {
        const double dx = left + 0.5 - a.from.pixel.x(), dy = y + 0.5 - a.from.pixel.y();
        const auto along = float(dx * axis.x() + dy * axis.y()), across = float(dx * axis.y() - dy * axis.x());
        draw_run(
            y, left, right, paint, outline.halo,
            [&, left](int x) {
                return distance(along + float(x - left) * axis_x, std::fabs(across + float(x - left) * axis_y));
            },
            [&, left](int x) {
                return near_from + near_change * std::min(std::max(along + float(x - left) * axis_x, 0.0f), end);
            });
    });
}

void ShapeRaster::add_cover(const ScreenPoint& from, const ScreenPoint& to, double radius, const OverlayPaint& paint) {
    const Vector2d way = to.pixel - from.pixel;
    const double squared = way.squaredNorm(), per_square = squared > 0.0 ? 1.0 / squared : 0.0;
    const double near_from = 1.0 / from.depth, nearness = 1.0 / to.depth - near_from;
    const double halo_reach = halo_width(2.0 * radius);
    for_runs_along(from.pixel, to.pixel, radius + halo_reach + 0.5, [&](int y, int left, int right) {
        for (int x = left; x < right; ++x) {
            const Vector2d from_start = Vector2d(x + 0.5, y + 0.5) - from.pixel;
            const double t = std::clamp(from_start.dot(way) * per_square, 0.0, 1.0);
            const double d = (from_start - t * way).norm() - radius;
            const float halo = coverage(float(d - halo_reach));
            if (halo <= 0.0f) continue;
            const float visibility = hidden(x, y, near_from + nearness * t, paint) ? 0.5f : 1.0f;
            const std::size_t index = std::size_t(y) * std::size_t(width_) + std::size_t(x);
            Cover& cover = cover_[index];
            if (cover.halo == 0.0f) covered_.push_back(index);
            cover.line = std::max(cover.line, coverage(float(d)) * visibility);
            cover.halo = std::max(cover.halo, halo * visibility);
        }
    });
}

// The largest coverage of all segments counts, so that joints are not drawn twice.
void ShapeRaster::line(std::span<const ScreenPoint> points, double width, const OverlayPaint& paint) {
    cover_.resize(std::size_t(width_) * std::size_t(height_));
    for (std::size_t i = 0; i + 1 < points.size(); ++i) add_cover(points[i], points[i + 1], 0.5 * width, paint);
    const Brush brush(paint);
    for (const std::size_t index : covered_) {
        Cover& cover = cover_[index];
        brush.draw(image_->pixels.data() + 4 * index, int(cover.line * brush.share + 0.5f),
                   int(cover.halo * brush.halo_share + 0.5f));
        cover = {};
    }
    covered_.clear();
}

void ShapeRaster::marker(const ScreenPoint& at, double radius, MarkerShape shape, const OverlayPaint& paint) {
    const double halo = halo_width(radius), reach = marker_extent(shape) * radius + halo + 0.5;
    const Box box = clipped(at.pixel.x() - reach, at.pixel.y() - reach, at.pixel.x() + reach, at.pixel.y() + reach);
    if (box.empty()) return;
    touched_.add({box.left, box.top, box.right - box.left, box.bottom - box.top});
    const auto near = float(1.0 / at.depth);
    const auto nearness = [near](int) { return near; };
    const auto center = float(box.left + 0.5 - at.pixel.x());
    OverlayPaint dark = paint;
    dark.color = style::center_dark_color;
    with_marker_distance(shape, float(radius), [&](const auto& distance) {
        for (int y = box.top; y < box.bottom; ++y) {
            const auto dy = float(y + 0.5 - at.pixel.y());
            draw_run(
                y, box.left, box.right, paint, halo, [&](int x) { return distance(center + float(x - box.left), dy); },
                nearness);
            if (shape != MarkerShape::center_of_mass) continue;
            draw_run(
                y, box.left, box.right, dark, 0.0,
                [&](int x) {
                    const float dx = center + float(x - box.left);
                    const float edge = std::min(std::fabs(dx), std::fabs(dy));
                    return std::max(distance(dx, dy), dx * dy >= 0.0f ? -edge : edge);
                },
                nearness);
        }
    });
}

SurfaceCover ShapeRaster::cover(std::span<const ScreenCorner> corners) {
    SurfaceCover cover;
    double left = width_, top = height_, right = 0.0, bottom = 0.0;
    for (const ScreenCorner& corner : corners) {
        left = std::min(left, corner.point.pixel.x());
        right = std::max(right, corner.point.pixel.x());
        top = std::min(top, corner.point.pixel.y());
        bottom = std::max(bottom, corner.point.pixel.y());
    }
    const Box box = clipped(left, top, right, bottom);
    if (box.empty()) return cover;
    cover.box = {box.left, box.top, box.right - box.left, box.bottom - box.top};
    const int columns = 2 * cover.box.width, rows = 2 * cover.box.height;
    samples_.assign(std::size_t(columns) * std::size_t(rows), {});
    const auto place = [&](const ScreenPoint& p) {  // in samples; their centers are at whole numbers
        return Vector2d(2.0 * (p.pixel.x() - box.left) - 0.5, 2.0 * (p.pixel.y() - box.top) - 0.5);
    };
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const ScreenCorner &a = corners[i], &b = corners[i + 1], &c = corners[i + 2];
        fill({place(a.point), place(b.point), place(c.point)},
             {CornerValue{1.0 / a.point.depth, a.light}, CornerValue{1.0 / b.point.depth, b.light},
              CornerValue{1.0 / c.point.depth, c.light}},
             a.color, columns, rows);
    }
    cover.pixels.reserve(samples_.size() / 4);
    for (int y = 0; y < rows; y += 2)
        for (int x = 0; x < columns; x += 2) {
            const std::size_t at = std::size_t(y) * std::size_t(columns) + std::size_t(x);
            SurfaceCover::Pixel pixel;
            int count = 0, r = 0, g = 0, b = 0;
            for (const std::size_t k : {at, at + 1, at + std::size_t(columns), at + std::size_t(columns) + 1}) {
                const SurfaceSample& sample = samples_[k];
                if (sample.nearness <= 0.0f) continue;
                pixel.nearness = std::max(pixel.nearness, sample.nearness);
                ++count;
                r += sample.color.r, g += sample.color.g, b += sample.color.b;
            }
            pixel.share = 0.25f * float(count);
            if (count > 0) pixel.color = {std::uint8_t(r / count), std::uint8_t(g / count), std::uint8_t(b / count)};
            cover.pixels.push_back(pixel);
        }
    return cover;
}

void ShapeRaster::surface(const SurfaceCover& cover, double opacity) {
    touched_.add(cover.box);
    const SurfaceCover::Pixel* pixel = cover.pixels.data();
    for (int y = cover.box.y; y < cover.box.y + cover.box.height; ++y)
        for (int x = cover.box.x; x < cover.box.x + cover.box.width; ++x, ++pixel)
            if (pixel->share > 0.0f && !hidden(x, y, pixel->nearness, {}))
                mix(image_->at(x, y), pixel->color, int(256.0 * opacity * pixel->share + 0.5));
}

// Edge functions are linear: each row adds the same to them from sample to sample.
void ShapeRaster::fill(const std::array<Vector2d, 3>& p, const std::array<CornerValue, 3>& values, Color color,
                       int columns, int rows) {
    const double area = (p[1] - p[0]).x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x();
    if (area == 0.0) return;
    const auto bound = [](double value, int most) { return int(std::clamp(value, 0.0, double(most))); };
    const int first_row = bound(std::ceil(std::min({p[0].y(), p[1].y(), p[2].y()})), rows);
    const int last_row = bound(std::floor(std::max({p[0].y(), p[1].y(), p[2].y()})) + 1.0, rows) - 1;
    const int first = bound(std::ceil(std::min({p[0].x(), p[1].x(), p[2].x()})), columns);
    const int last = bound(std::floor(std::max({p[0].x(), p[1].x(), p[2].x()})) + 1.0, columns) - 1;
    const auto lit = [](std::uint8_t channel, double light) { return std::uint8_t(channel * light + 0.5); };
    const double wa_step = -(p[2] - p[1]).y() / area, wb_step = -(p[0] - p[2]).y() / area;
    for (int y = first_row; y <= last_row; ++y) {
        const double wa_first = ((p[2] - p[1]).x() * (y - p[1].y()) - (p[2] - p[1]).y() * (first - p[1].x())) / area;
        const double wb_first = ((p[0] - p[2]).x() * (y - p[2].y()) - (p[0] - p[2]).y() * (first - p[2].x())) / area;
        SurfaceSample* sample = samples_.data() + std::size_t(y) * std::size_t(columns) + std::size_t(first);
        for (int k = 0; k <= last - first; ++k, ++sample) {
            const double wa = wa_first + k * wa_step, wb = wb_first + k * wb_step, wc = 1.0 - wa - wb;
            if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
            const auto nearness = float(wa * values[0].nearness + wb * values[1].nearness + wc * values[2].nearness);
            if (nearness <= sample->nearness) continue;
            const double light = wa * values[0].light + wb * values[1].light + wc * values[2].light;
            *sample = {nearness, {lit(color.r, light), lit(color.g, light), lit(color.b, light)}};
        }
    }
}

void ShapeRaster::picture(const Image& picture, int left, int top, double opacity) {
    const Box box = clipped(left, top, left + picture.width - 1, top + picture.height - 1);
    if (box.empty()) return;
    touched_.add({box.left, box.top, box.right - box.left, box.bottom - box.top});
    for (int y = box.top; y < box.bottom; ++y)
        for (int x = box.left; x < box.right; ++x) {
            const std::uint8_t* from = picture.at(x - left, y - top);
            if (from[3] == 0) continue;
            mix(image_->at(x, y), {from[0], from[1], from[2]}, int(from[3] * opacity * (256.0 / 255.0) + 0.5));
        }
}

void ShapeRaster::outline(const Rectangle& r, const OverlayPaint& paint) {
    touched_.add(r);
    const Brush brush(paint);
    const auto draw = [&](int x, int y) { brush.draw(image_->at(x, y), int(brush.share + 0.5f), 0); };
    const auto row = [&](int y) {
        for (int x = r.x; x < r.x + r.width; ++x) draw(x, y);
    };
    row(r.y);
    if (r.height > 1) row(r.y + r.height - 1);
    for (int y = r.y + 1; y + 1 < r.y + r.height; ++y) {
        draw(r.x, y);
        if (r.width > 1) draw(r.x + r.width - 1, y);
    }
}

}  // namespace tumble
