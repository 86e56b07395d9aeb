#include "render/antialiasing/thin_geometry_aa.h"

#include "render/antialiasing/analytic_aa.h"
#include "render/antialiasing/surface_ids.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

// Range of the search for a pixel without a rod: an oblique rod drawn one pixel wide covers at most two pixels of a
// column.
constexpr int search = 3;

// Pixels to both sides along a rod over which its color is averaged, because its sides alternate at pixel centers.
constexpr int averaged = 2;

struct Mean {
    std::array<double, 4> sum{};  // sRGB values and coverage, 0 to 255
    int count = 0;
    void add(const std::uint8_t* pixel, std::size_t channels) {
        const auto color = covered_color(pixel);
        for (std::size_t c = 0; c < 4; ++c) sum[c] += channels == 4 ? color[c] : pixel[c];
        ++count;
    }
};

/// True for each pixel that shows a rod; row length as in the image.
using RodPixels = std::vector<char>;

// A rod in the image along its main direction: m counts along it, n across.
class RodWalk {
public:
    /// `channels`: 3 for the color, 4 with coverage.
    RodWalk(const Image& drawn, const ScreenRod& rod, std::size_t channels)
        : drawn_(drawn), first_face_(rod.first_face), channels_(channels) {
        steep_ = std::abs(rod.y1 - rod.y0) > std::abs(rod.x1 - rod.x0);
        m0_ = steep_ ? rod.y0 : rod.x0, n0_ = steep_ ? rod.x0 : rod.y0;
        m1_ = steep_ ? rod.y1 : rod.x1, n1_ = steep_ ? rod.x1 : rod.y1;
        half0_ = rod.half0, half1_ = rod.half1;
        if (m1_ < m0_) {
            std::swap(m0_, m1_);
            std::swap(n0_, n1_);
            std::swap(half0_, half1_);
        }
        count_m_ = steep_ ? drawn.height : drawn.width;
        count_n_ = steep_ ? drawn.width : drawn.height;
        length_ = std::max(m1_ - m0_, 1e-6);
        slope_ = (n1_ - n0_) / length_;
        widening_ = std::sqrt(1.0 + slope_ * slope_);  // of a perpendicular extent, along n
    }

    /// Marks the pixels that show this rod.
    void mark(RodPixels& rods) const {
        for_each([&](int m, int n, double, double) {
            if (of_rod(m, n)) rods[index(m, n)] = 1;
        });
    }

    /// Fills these pixels from beside the rods.
    void clear(const RodPixels& rods, const DirtyTiles& dirty, Image& frame) const {
        for_each([&](int m, int n, double, double) {
            if (!of_rod(m, n) || !is_dirty(m, n, dirty)) return;
            Mean beside;
            for (const int side : {-1, 1})
                for (int step = 1; step <= search; ++step) {
                    const int across = n + side * step;
                    if (!in_picture(m, across) || rods[index(m, across)] != 0) continue;
                    beside.add(at(m, across), channels_);
                    break;
                }
            std::uint8_t* const to = &frame.pixels[4 * index(m, n)];
            for (std::size_t c = 0; c < channels_ && beside.count > 0; ++c)
                to[c] = std::uint8_t(std::lround(beside.sum[c] / beside.count));
        });
    }

    /// Blends the rod into each pixel by its coverage, where only other rods hide it.
    void cover(const RodPixels& rods, const DirtyTiles& dirty, Image& frame) const {
        for_each([&](int m, int n, double middle, double half) {
            const double share = std::min(covered(m, n, middle, half), 1.0);
            if (share <= 0.0 || !is_dirty(m, n, dirty)) return;
            if (rods[index(m, n)] == 0 && !of_rod(m, n - 1) && !of_rod(m, n + 1) && !of_rod(m - 1, n) &&
                !of_rod(m + 1, n))
                return;
            Mean own;
            for (int other = m - averaged; other <= m + averaged; ++other)
                for (int across = n - 1; across <= n + 1; ++across)
                    if (of_rod(other, across)) own.add(at(other, across), channels_);
            std::uint8_t* const to = &frame.pixels[4 * index(m, n)];
            for (std::size_t c = 0; c < channels_ && own.count > 0; ++c)
                to[c] = std::uint8_t(std::lround(to[c] + (own.sum[c] / own.count - to[c]) * share));
        });
    }

private:
    /// Visits all pixels that it covers or shows in, with the center and half width of its cross section in their
    /// column.
    template <class See>
    void for_each(See see) const {
        const int first = int(std::clamp(std::floor(m0_) - 1.0, 0.0, double(count_m_)));
        const int last = int(std::clamp(std::floor(m1_) + 1.0, -1.0, count_m_ - 1.0));
        for (int m = first; m <= last; ++m) {
            const double t = std::clamp((m + 0.5 - m0_) / length_, 0.0, 1.0);
            const double middle = n0_ + (n1_ - n0_) * t, half = (half0_ + (half1_ - half0_) * t) * widening_;
            const double extent = std::max(half, 1.5 * thinnest_rod_pixels * widening_) + 0.5;
            const int low = int(std::clamp(std::floor(middle - extent), 0.0, double(count_n_)));
            const int high = int(std::clamp(std::floor(middle + extent), -1.0, count_n_ - 1.0));
            for (int n = low; n <= high; ++n) see(m, n, middle, half);
        }
    }

    std::size_t index(int m, int n) const {
        return steep_ ? std::size_t(m) * std::size_t(drawn_.width) + std::size_t(n)
                      : std::size_t(n) * std::size_t(drawn_.width) + std::size_t(m);
    }
    const std::uint8_t* at(int m, int n) const { return &drawn_.pixels[4 * index(m, n)]; }
    bool in_picture(int m, int n) const { return m >= 0 && n >= 0 && m < count_m_ && n < count_n_; }
    bool of_rod(int m, int n) const { return in_picture(m, n) && of_same_box(at(m, n)[3], first_face_, 0); }
    bool is_dirty(int m, int n, const DirtyTiles& dirty) const {
        return dirty.at((steep_ ? n : m) / DirtyTiles::tile, (steep_ ? m : n) / DirtyTiles::tile);
    }

    /// Coverage of the pixel by the rod: the share before its far side less the share before its near side.
    double covered(int m, int n, double middle, double half) const {
        const double from = std::max(double(m), m0_), to = std::min(m + 1.0, m1_);
        if (!(to > from)) return 0.0;
        const double line = middle + slope_ * (std::clamp(0.5 * (from + to), m0_, m1_) - std::clamp(m + 0.5, m0_, m1_));
        const double rise = 0.5 * std::abs(slope_) * (to - from);
        return (to - from) *
               (share_before(n + 1.0 - (line - half), rise) - share_before(n + 1.0 - (line + half), rise));
    }

    const Image& drawn_;
    std::uint8_t first_face_;
    std::size_t channels_;
    bool steep_;
    double m0_, n0_, m1_, n1_, half0_, half1_, length_, slope_, widening_;
    int count_m_, count_n_;
};

}  // namespace

bool is_rod(const Vec3& half_pixels) {
    const double least = half_pixels.minCoeff(), most = half_pixels.maxCoeff();
    return half_pixels.sum() - least - most < widest_rod_pixels && most > shortest_rod_pixels;
}

void blend_rods(const Image& drawn, const std::vector<ScreenRod>& rods, const DirtyTiles& dirty, Image& frame,
                bool with_coverage) {
    if (rods.empty()) return;
    const std::size_t channels = with_coverage ? 4 : 3;
    RodPixels pixels(drawn.pixels.size() / 4, 0);
    for (const ScreenRod& rod : rods) RodWalk(drawn, rod, channels).mark(pixels);
    for (const ScreenRod& rod : rods) RodWalk(drawn, rod, channels).clear(pixels, dirty, frame);
    for (const ScreenRod& rod : rods) RodWalk(drawn, rod, channels).cover(pixels, dirty, frame);
}

}  // namespace tumble
