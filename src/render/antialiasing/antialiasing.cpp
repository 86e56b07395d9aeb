#include "render/antialiasing/antialiasing.h"

#include "render/antialiasing/analytic_aa.h"
#include "render/antialiasing/surface_ids.h"
#include "render/antialiasing/thin_geometry_aa.h"

#include <algorithm>

namespace tumble {

void Antialiasing::apply(const FrameContext& frame, const Damage& damage, const Visibility& visible, Image& result) {
    if (!options_.transparent)
        copy_opaque(drawn_, damage.changed, result);
    else
        copy_coverage(drawn_, damage.changed, options_.analytic, result);
    if (options_.analytic) {
        blend_analytic_edges(drawn_, edges_.find(frame, damage.drawn.bodies, visible), damage.tiles, result,
                             options_.transparent);
        blend_rods(drawn_, edges_.rods(), damage.tiles, result, options_.transparent);
    }
    if (options_.transparent) make_alpha_straight(damage.changed, result);
}

namespace {

template <class Work>
void for_each_pixel(const std::vector<Rectangle>& rectangles, Image& frame, const Work& work) {
    for (const Rectangle& r : rectangles)
        for (int y = r.y; y < r.y + r.height; ++y)
            for (int x = r.x; x < r.x + r.width; ++x) work(x, y, frame.at(x, y));
}

}  // namespace

void copy_coverage(const Image& drawn, const std::vector<Rectangle>& rectangles, bool ids, Image& frame) {
    for_each_pixel(rectangles, frame, [&](int x, int y, std::uint8_t* to) {
        const std::uint8_t* const from = drawn.at(x, y);
        if (ids)
            std::ranges::copy(covered_color(from), to);
        else
            std::copy_n(from, 4, to);
    });
}

void make_alpha_straight(const std::vector<Rectangle>& rectangles, Image& frame) {
    for_each_pixel(rectangles, frame, [](int, int, std::uint8_t* pixel) {
        const int coverage = pixel[3];
        if (coverage == 255) return;
        // Rounding can leave a color a level above its coverage.
        for (int c = 0; c < 3; ++c)
            pixel[c] = coverage == 0 ? std::uint8_t(0)
                                     : std::uint8_t(std::min((255 * pixel[c] + coverage / 2) / coverage, 255));
    });
}

}  // namespace tumble
