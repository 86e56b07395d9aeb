#include "render/antialiasing/analytic_aa.h"

#include "render/antialiasing/surface_ids.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tumble {
namespace {

// The integral of clamp(x, 0, 1), without branches, which would be unpredictable.
double ramp_area(double x) {
    const double c = std::min(std::max(x, 0.0), 1.0);
    return 0.5 * c * c + std::max(x - 1.0, 0.0);
}

// Half width below which the slope of a strip is negligible.
constexpr double least_half = 1e-6;

// share_before(), given 1 / (2 half), or 0 below least_half. Inlined: a call per pixel of an edge would take a tenth of
// the pass.
[[gnu::always_inline]] inline double share_of(double t, double half, double inverse) {
    if (inverse == 0.0) return std::clamp(t, 0.0, 1.0);
    return (ramp_area(t + half) - ramp_area(t - half)) * inverse;
}

double inverse_width(double half) { return half < least_half ? 0.0 : 1.0 / (2.0 * half); }

// A surface that shows this far beyond its own edge, or another one this far within it, hides that edge (the near side
// of a ring hides the far rim). Above the deviation of a ball's mesh (0.15) and of its outline polygon (0.03).
constexpr double hidden = 0.2;  // pixels

// Rows to either side in which a gap beside an edge is looked for: as far as the margin of DirtyTiles.
constexpr int gap_rows = 3;

// The greatest integer not above x; for x >= -2 (avoids a call, because baseline x86-64 lacks the instruction).
int below(double x) { return int(x + 2.0) - 2; }

// An edge in the image along its main direction: m counts along it, n across. For edges with the given `whole_box`.
// `with_coverage`: see blend_analytic_edges().
template <bool whole_box, bool with_coverage>
class Walk {
public:
    Walk(const Image& drawn, const DirtyTiles& dirty, Image& frame) : drawn_(drawn), dirty_(dirty), frame_(frame) {}

    void blend(ScreenEdge e) {
        const double dx = e.x1 - e.x0, dy = e.y1 - e.y0;
        across_ = std::abs(dy) > std::abs(dx);
        inner_ = e.inner;
        outer_ = e.outer;
        face_ = e.face;
        double m0 = across_ ? e.y0 : e.x0, n0 = across_ ? e.x0 : e.y0;
        double m1 = across_ ? e.y1 : e.x1, n1 = across_ ? e.x1 : e.y1;
        side_ = across_ ? -1 : 1;  // direction of n towards the inner surface
        if (m1 < m0) {
            std::swap(m0, m1);
            std::swap(n0, n1);
            side_ = -side_;
        }
        if (!(m1 > m0)) return;
        const std::ptrdiff_t row = std::ptrdiff_t(4) * drawn_.width;
        count_m_ = across_ ? drawn_.height : drawn_.width;
        count_n_ = across_ ? drawn_.width : drawn_.height;
        step_m_ = across_ ? row : 4;
        step_n_ = across_ ? 4 : row;
        slope_ = (n1 - n0) / (m1 - m0);
        first_ = m0;
        last_ = m1;
        const double slope = slope_, steepness = 0.5 * std::abs(slope), inverse = inverse_width(steepness);
        if (!(std::max(m0, 0.0) < count_m_)) return;
        const int first = below(std::max(m0, 0.0)), last = below(std::min(m1, count_m_ - 0.5));
        for (int m = first; m <= last; ++m) {
            const double from = std::max(double(m), m0), to = std::min(m + 1.0, m1), length = to - from;
            if (length <= 0.0) continue;
            const double line = n0 + (0.5 * (from + to) - m0) * slope, half = steepness * length;
            if (!(line + half >= 0.0 && line - half < count_n_)) continue;
            const Crossing here{line, half, length == 1.0 ? inverse : inverse_width(half), length,
                                n0 + (m + 0.5 - m0) * slope};
            const int end = std::min(below(line + half), count_n_ - 1);
            for (int n = std::max(below(std::max(line - half, 0.0)), 0); n <= end; ++n) pixel(m, n, here);
        }
    }

private:
    // Crossing of an edge with a row of pixels across it.
    struct Crossing {
        double line, half;  // its height there, and half of its rise over the width
        double inverse;     // inverse_width() of half
        double length;      // part of the pixel's width that it crosses
        double middle;      // height of its extended line at the middle of that width
    };

    // A share of the pixel's color comes from the neighbor across the edge, or from the next one if the edge is
    // oblique. At a hidden edge the pixels have other surfaces.
    void pixel(int m, int n, const Crossing& here) {
        const auto inside = [this](std::uint8_t id) {
            return whole_box ? of_same_box(id, inner_, face_) : id == inner_;
        };
        const std::ptrdiff_t at = m * step_m_ + n * step_n_;
        const std::uint8_t* const drawn = drawn_.pixels.data() + at;
        bool is_inner = inside(drawn[3]);
        if (is_inner && inner_ == outer_)
            is_inner = (n + 0.5 - here.line) * side_ > 0.0;  // the ids do not tell them apart
        if (!is_inner && outer_ != 0 && drawn[3] != outer_) return;
        const int step = is_inner ? -side_ : side_;
        const std::uint8_t* from = drawn;
        if (outer_ == 0 && (n + 0.5 - here.middle) * step > hidden) return;
        for (int other = n + step;; other += step) {
            if (other == n + 3 * step || other < 0 || other >= count_n_) return;
            from += step * step_n_;
            if (is_inner && outer_ == 0 && inside(from[3]) && (other + 0.5 - here.middle) * step > hidden) return;
            if (is_inner ? (outer_ == 0 ? !inside(from[3]) : from[3] == outer_) : inside(from[3])) break;
            if (!is_inner && outer_ == 0 && (other + 0.5 - here.middle) * step > hidden) return;
        }
        if (whole_box && !is_inner && from[3] != inner_) from = of_face_beside(m, n, step, from);
        if (is_inner && outer_ == 0) from = of_gap_beside(m, step, here, from);
        const int x = across_ ? n : m, y = across_ ? m : n;
        if (!dirty_.at(int(unsigned(x) / DirtyTiles::tile), int(unsigned(y) / DirtyTiles::tile))) return;
        const double after =
            share_of(n + 1.0 - here.line, here.half, here.inverse);  // of the strip on the side of greater n
        // A line that passes the center on the wrong side belongs to a partly hidden edge: half at most.
        const double share = std::min(here.length * (step > 0 ? after : 1.0 - after), 0.5);
        const int weight = int(256.0 * share + 0.5);
        std::uint8_t* const to = frame_.pixels.data() + at;
        const auto blended = [&](int own, int other) {
            return std::uint8_t(own + (((other - own) * weight + 128) >> 8));
        };
        if (with_coverage) {
            const auto other = covered_color(from);
            for (std::size_t c = 0; c < 4; ++c) to[c] = blended(to[c], other[c]);
        } else {
            for (int c = 0; c < 3; ++c) to[c] = blended(to[c], from[c]);
        }
    }

    // Color of the edge's own face, from a pixel beside these two; a narrow face does not show in every pixel.
    const std::uint8_t* of_face_beside(int m, int n, int step, const std::uint8_t* otherwise) const {
        for (const int beside : {m - 1, m + 1, m - 2, m + 2})
            for (const int at : {n, n + step}) {
                if (beside < 0 || beside >= count_m_ || at < 0 || at >= count_n_) continue;
                const std::uint8_t* const pixel = drawn_.pixels.data() + beside * step_m_ + at * step_n_;
                if (pixel[3] == inner_) return pixel;
            }
        return otherwise;
    }

    // Color of a gap along the outline, narrower than a pixel, that the centers of this row miss: rows on both sides of
    // it show the same surface, one pixel wide, beside the edge.
    const std::uint8_t* of_gap_beside(int m, int step, const Crossing& here, const std::uint8_t* otherwise) const {
        const std::uint8_t* found = nullptr;
        for (const int way : {-1, 1}) {
            const std::uint8_t* seen = nullptr;
            for (int rows = 1; rows <= gap_rows && seen == nullptr; ++rows) {
                const int row = m + way * rows;
                const double shift = way * rows * slope_, line = here.middle + shift;
                if (std::abs(shift) > 1.0 || row + 0.5 < first_ || row + 0.5 > last_) break;
                const int n = below(line + 0.5 * step);
                if (row < 0 || row >= count_m_ || n < 1 || n >= count_n_ - 1) break;
                const std::uint8_t* const pixel = drawn_.pixels.data() + row * step_m_ + n * step_n_;
                const std::uint8_t id = pixel[3];
                if (id != otherwise[3] && id != inner_ && pixel[step * step_n_ + 3] != id) seen = pixel;
            }
            if (seen == nullptr || (found != nullptr && found[3] != seen[3])) return otherwise;
            found = seen;
        }
        return found;
    }

    const Image& drawn_;
    const DirtyTiles& dirty_;
    Image& frame_;
    double slope_ = 0.0, first_ = 0.0, last_ = 0.0;  // of the edge: rise, and its ends along m
    bool across_ = false;                            // the edge is steep: m is y
    int side_ = 1, count_m_ = 0, count_n_ = 0;
    std::ptrdiff_t step_m_ = 0, step_n_ = 0;  // strides, bytes
    std::uint8_t inner_ = 0, outer_ = 0, face_ = 0;
};

template <bool with_coverage>
void blend_edges(const Image& drawn, const std::vector<ScreenEdge>& edges, const DirtyTiles& dirty, Image& frame) {
    Walk<false, with_coverage> one_face(drawn, dirty, frame);
    Walk<true, with_coverage> whole_box(drawn, dirty, frame);
    for (const ScreenEdge& edge : edges) edge.whole_box ? whole_box.blend(edge) : one_face.blend(edge);
}

}  // namespace

double share_before(double t, double half) { return share_of(t, half, inverse_width(half)); }

void copy_opaque(const Image& drawn, const std::vector<Rectangle>& rectangles, Image& frame) {
    for (const Rectangle& r : rectangles) {
        const std::size_t bytes =
            4 * std::size_t(r.width);  // a local copy, which the compiler need not reload for each pixel
        for (int y = r.y; y < r.y + r.height; ++y) {
            const std::uint8_t* from = drawn.at(r.x, y);
            std::uint8_t* to = frame.at(r.x, y);
            for (std::size_t at = 0; at < bytes; at += 4) {
                std::uint32_t pixel;
                std::memcpy(&pixel, from + at, 4);
                pixel |= 0xff000000u;  // red first in memory, alpha last: little-endian, as all supported processors
                std::memcpy(to + at, &pixel, 4);
            }
        }
    }
}

void blend_analytic_edges(const Image& drawn, const std::vector<ScreenEdge>& edges, const DirtyTiles& dirty,
                          Image& frame, bool with_coverage) {
    if (with_coverage)
        blend_edges<true>(drawn, edges, dirty, frame);
    else
        blend_edges<false>(drawn, edges, dirty, frame);
}

}  // namespace tumble
