#include "render/camera/convex_hull_2d.h"

#include <algorithm>
#include <iterator>

namespace tumble {

// Andrew 1979, Another Efficient Algorithm for Convex Hulls in Two Dimensions.
FewPoints convex_hull(FewPoints points) {
    std::sort(points.begin(), points.end(), [](const ScreenPoint& a, const ScreenPoint& b) {
        return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
    });
    FewPoints hull;
    const auto half = [&](auto begin, auto end) {
        const std::size_t base = hull.size();
        for (auto at = begin; at != end; ++at) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *at) <= 0.0) hull.pop_back();
            hull.push_back(*at);
        }
        hull.pop_back();  // the next half begins with this point
    };
    if (points.size() == 0) return hull;
    half(points.begin(), points.end());
    half(std::reverse_iterator(points.end()), std::reverse_iterator(points.begin()));
    return hull;
}

}  // namespace tumble
