#include "render/culling/software_depth_buffer.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Rasterization rounds corners to 1/256 pixel.
constexpr double rounding_margin = 0.02;  // pixels

// Depths that differ by less may compare either way: 24 bits, with the near plane far in front of crowds of small
// bodies.
constexpr float depth_margin = 1e-3f;

struct Span {
    double left = std::numeric_limits<double>::infinity(), right = -left;
};

// The part of a row's center line within a convex polygon.
Span span(const std::array<SoftwareDepthBuffer::Corner, 4>& face, double y) {
    Span s;
    for (std::size_t i = 0; i < 4; ++i) {
        const ScreenPoint &a = face[i].at, &b = face[(i + 1) % 4].at;
        if ((a.y() <= y) == (b.y() <= y)) continue;
        const double x = a.x() + (b.x() - a.x()) * ((y - a.y()) / (b.y() - a.y()));
        s.left = std::min(s.left, x);
        s.right = std::max(s.right, x);
    }
    return s;
}

}  // namespace

SoftwareDepthBuffer::SoftwareDepthBuffer(const Camera& view, const CoarseDepthBuffer& boxes)
    : boxes_(&boxes),
      width_(view.width()),
      height_(view.height()),
      inverse_depths_(std::size_t(view.width()) * std::size_t(view.height()), 0.0f) {}

bool SoftwareDepthBuffer::add(const std::array<Corner, 4>& face) {
    double top = std::numeric_limits<double>::infinity(), bottom = -top;
    for (const Corner& c : face) {
        top = std::min(top, c.at.y());
        bottom = std::max(bottom, c.at.y());
    }
    // The reciprocal of the depth is linear on the screen.
    const ScreenPoint u = face[1].at - face[0].at, v = face[3].at - face[0].at;
    const double area = u.x() * v.y() - u.y() * v.x();
    const double du = face[1].inverse_depth - face[0].inverse_depth, dv = face[3].inverse_depth - face[0].inverse_depth;
    const bool flat = std::abs(area) < 1e-6;  // seen edge-on: its nearest depth is used, and it covers nothing
    const double along_x = flat ? 0.0 : (du * v.y() - dv * u.y()) / area,
                 along_y = flat ? 0.0 : (dv * u.x() - du * v.x()) / area;
    double nearest = 0.0;
    for (const Corner& c : face) nearest = std::max(nearest, c.inverse_depth);
    const auto inverse_depth = [&](int x, int y) {
        if (flat) return float(nearest);
        const double at =
            face[0].inverse_depth + along_x * (x + 0.5 - face[0].at.x()) + along_y * (y + 0.5 - face[0].at.y());
        return float(std::min(at, nearest));
    };
    bool seen = false;
    const int first = std::max(0, int(std::ceil(top - rounding_margin - 0.5))),
              last = std::min(height_ - 1, int(std::floor(bottom + rounding_margin - 0.5)));
    for (int y = first; y <= last; ++y) {
        // Near a corner, the line through the row's center can miss points within the margin.
        const Span middle = span(face, y + 0.5), above = span(face, y + 0.5 - rounding_margin),
                   below = span(face, y + 0.5 + rounding_margin);
        double left = std::min({middle.left, above.left, below.left}) - rounding_margin;
        double right = std::max({middle.right, above.right, below.right}) + rounding_margin;
        for (const Corner& c : face)
            if (std::abs(c.at.y() - (y + 0.5)) <= rounding_margin) {
                left = std::min(left, c.at.x() - rounding_margin);
                right = std::max(right, c.at.x() + rounding_margin);
            }
        if (!(left <= right)) continue;
        // Inside on all three lines, so that an oblique side keeps its margin.
        const double within_left = std::max({middle.left, above.left, below.left}) + rounding_margin;
        const double within_right = std::min({middle.right, above.right, below.right}) - rounding_margin;
        const int x0 = std::max(0, int(std::ceil(left - 0.5))), x1 = std::min(width_ - 1, int(std::floor(right - 0.5)));
        float* row = &inverse_depths_[std::size_t(y) * std::size_t(width_)];
        for (int x = x0; x <= x1; ++x) {
            const float here = inverse_depth(x, y);
            const bool within = !flat && x + 0.5 > within_left && x + 0.5 < within_right;
            if (!seen && here * (1.0f + depth_margin) >= row[x] &&
                !(boxes_->depth(x / CoarseDepthBuffer::cell, y / CoarseDepthBuffer::cell) * double(here) <
                  1.0 - double(depth_margin)))
                seen = true;
            if (within) row[x] = std::max(row[x], here);
        }
    }
    return seen;
}

bool SoftwareDepthBuffer::hides(double x0, double y0, double x1, double y1, double depth) const {
    const float here = float(1.0 / depth) * (1.0f + depth_margin);
    const int left = std::max(0, int(std::ceil(x0 - rounding_margin - 0.5))),
              right = std::min(width_ - 1, int(std::floor(x1 + rounding_margin - 0.5)));
    const int top = std::max(0, int(std::ceil(y0 - rounding_margin - 0.5))),
              bottom = std::min(height_ - 1, int(std::floor(y1 + rounding_margin - 0.5)));
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x)
            if (!(here < inverse_depths_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]) &&
                !(boxes_->depth(x / CoarseDepthBuffer::cell, y / CoarseDepthBuffer::cell) <
                  depth * (1.0 - double(depth_margin))))
                return false;
    return true;
}

}  // namespace tumble
