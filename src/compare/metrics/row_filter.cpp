#include "compare/metrics/row_filter.h"

#include "core/check.h"
#include "core/cpu_dispatch.h"

#include <algorithm>
#include <cstddef>

namespace tumble {
namespace {

/// Rows at both sides of the middle, and their weight.
struct Pair {
    const float *before, *after;
    float weight;
};

TUMBLE_WIDE void set_scaled(const float* from, float weight, std::size_t count, float* __restrict to) {
    for (std::size_t x = 0; x < count; ++x) to[x] = weight * from[x];
}

TUMBLE_WIDE void add_sums(const Pair& a, const Pair& b, std::size_t count, float* __restrict to) {
    const float *a0 = a.before, *a1 = a.after, *b0 = b.before, *b1 = b.after;
    const float wa = a.weight, wb = b.weight;
    for (std::size_t x = 0; x < count; ++x) to[x] += wa * (a0[x] + a1[x]) + wb * (b0[x] + b1[x]);
}

TUMBLE_WIDE void add_differences(const Pair& a, const Pair& b, std::size_t count, float* __restrict to) {
    const float *a0 = a.before, *a1 = a.after, *b0 = b.before, *b1 = b.after;
    const float wa = a.weight, wb = b.weight;
    for (std::size_t x = 0; x < count; ++x) to[x] += wa * (a1[x] - a0[x]) + wb * (b1[x] - b0[x]);
}

/// Values relative to the middle, which then needs no weight.
TUMBLE_WIDE void add_relative_sums(const Pair& a, const Pair& b, const float* middle, std::size_t count,
                                   float* __restrict to) {
    const float *a0 = a.before, *a1 = a.after, *b0 = b.before, *b1 = b.after;
    const float wa = a.weight, wb = b.weight;
    for (std::size_t x = 0; x < count; ++x) {
        const float c = middle[x];
        to[x] += wa * ((a0[x] - c) + (a1[x] - c)) + wb * ((b0[x] - c) + (b1[x] - c));
    }
}

/// The sum over all pairs, two at a time; an odd number ends with a pair of weight 0.
template <typename RowAt>
void convolve(const RowFilter& filter, std::size_t count, const RowAt& row_at, float* to) {
    const int radius = filter.radius();
    const bool with_middle = filter.kind == FilterKind::symmetric;
    set_scaled(row_at(0), with_middle ? filter.weights[0] : 0.0f, count, to);
    for (int k = 1; k <= radius; k += 2) {
        const int next = std::min(k + 1, radius);
        const Pair a{row_at(-k), row_at(k), filter.weights[std::size_t(k)]};
        const Pair b{row_at(-next), row_at(next), next > k ? filter.weights[std::size_t(next)] : 0.0f};
        switch (filter.kind) {
            case FilterKind::symmetric:
                add_sums(a, b, count, to);
                break;
            case FilterKind::antisymmetric:
                add_differences(a, b, count, to);
                break;
            case FilterKind::zero_sum:
                add_relative_sums(a, b, row_at(0), count, to);
                break;
        }
    }
}

}  // namespace

void filter_row(const float* row, int width, const RowFilter& filter, float* to) {
    convolve(
        filter, std::size_t(width), [&](int offset) { return row + offset; }, to);
}

void filter_columns(std::span<const float* const> rows, int width, const RowFilter& filter, float* to) {
    const int middle = static_cast<int>(rows.size() / 2);
    TUMBLE_CHECK_GE(middle, filter.radius());
    convolve(
        filter, std::size_t(width), [&](int offset) { return rows[std::size_t(middle + offset)]; }, to);
}

}  // namespace tumble
