#include "render/antialiasing/coverage.h"

#include "render/antialiasing/surface_ids.h"

#include <algorithm>

namespace tumble {
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
        std::copy_n(from, 3, to);
        to[3] = ids ? coverage_of(from[3]) : from[3];
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
