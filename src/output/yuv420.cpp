#include "output/yuv420.h"

#include "core/check.h"

#include <emmintrin.h>

#include <algorithm>

#ifdef __SSE2__
#endif

namespace tumble {
namespace {

constexpr int fraction_bits = 15;

/// Weights of R, G and B in one plane, times 2^15.
struct Weights {
    int r, g, b;
};
// Rounded so that white is 235 (the first adds up to 219/255) and gray has no color (the others add up to 0).
constexpr Weights to_y{5983, 20127, 2032}, to_cb{-3298, -11094, 14392}, to_cr{14392, -13072, -1320};
static_assert(to_cb.r + to_cb.g + to_cb.b == 0 && to_cr.r + to_cr.g + to_cr.b == 0);

constexpr int y_offset = 16, chroma_offset = 128;
constexpr int y_shift = fraction_bits,
              chroma_shift = fraction_bits + 2;  // color is computed from the sum of four pixels

/// The offset, and a half for rounding.
constexpr int bias(int offset, int shift) { return (offset << shift) + (1 << (shift - 1)); }

std::uint8_t weigh(const Weights& w, int r, int g, int b, int offset, int shift) {
    return static_cast<std::uint8_t>((w.r * r + w.g * g + w.b * b + bias(offset, shift)) >> shift);
}

/// Two rows of pixels and the destination of their values.
struct RowPair {
    const std::uint8_t* top;  // R, G, B and an unused byte
    const std::uint8_t* bottom;
    std::uint8_t* y_top;
    std::uint8_t* y_bottom;
    std::uint8_t* cb;
    std::uint8_t* cr;
};

void convert_square(const RowPair& rows, int x) {
    int sum[3] = {};
    for (int i = 0; i < 2; ++i) {
        const std::uint8_t* top = rows.top + 4 * (x + i);
        const std::uint8_t* bottom = rows.bottom + 4 * (x + i);
        rows.y_top[x + i] = weigh(to_y, top[0], top[1], top[2], y_offset, y_shift);
        rows.y_bottom[x + i] = weigh(to_y, bottom[0], bottom[1], bottom[2], y_offset, y_shift);
        for (int c = 0; c < 3; ++c) sum[c] += top[c] + bottom[c];
    }
    rows.cb[x / 2] = weigh(to_cb, sum[0], sum[1], sum[2], chroma_offset, chroma_shift);
    rows.cr[x / 2] = weigh(to_cr, sum[0], sum[1], sum[2], chroma_offset, chroma_shift);
}

#ifdef __SSE2__  // part of every x86-64

/// Four pixels of 16 bits a channel (two in each half) to four values of one plane, 32 bits each.
__m128i weigh(__m128i first, __m128i second, __m128i weights, __m128i added, int shift) {
    const __m128 a = _mm_castsi128_ps(_mm_madd_epi16(first, weights));  // (r + g, b) of two pixels
    const __m128 b = _mm_castsi128_ps(_mm_madd_epi16(second, weights));
    const __m128i red_green = _mm_castps_si128(_mm_shuffle_ps(a, b, _MM_SHUFFLE(2, 0, 2, 0)));
    const __m128i blue = _mm_castps_si128(_mm_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 3, 1)));
    return _mm_srai_epi32(_mm_add_epi32(_mm_add_epi32(red_green, blue), added), shift);
}

__m128i repeated(const Weights& w) {
    const auto r = static_cast<short>(w.r), g = static_cast<short>(w.g), b = static_cast<short>(w.b);
    return _mm_setr_epi16(r, g, b, 0, r, g, b, 0);
}

/// Sums of adjacent pixels: of (p0, p1) and (p2, p3), (p0 + p1, p2 + p3).
__m128i add_neighbors(__m128i first, __m128i second) {
    return _mm_add_epi16(_mm_unpacklo_epi64(first, second), _mm_unpackhi_epi64(first, second));
}

/// Eight pixels of both rows.
void convert_eight(const RowPair& rows, int x) {
    const __m128i zero = _mm_setzero_si128(), y_weights = repeated(to_y);
    const __m128i y_bias = _mm_set1_epi32(bias(y_offset, y_shift));
    const __m128i chroma_bias = _mm_set1_epi32(bias(chroma_offset, chroma_shift));
    __m128i column_sums[4];
    for (const bool top : {true, false}) {
        const auto* from = reinterpret_cast<const __m128i*>((top ? rows.top : rows.bottom) + 4 * x);
        __m128i y[2];
        for (int i = 0; i < 2; ++i) {
            const __m128i four = _mm_loadu_si128(from + i);
            const __m128i first = _mm_unpacklo_epi8(four, zero), second = _mm_unpackhi_epi8(four, zero);
            y[i] = weigh(first, second, y_weights, y_bias, y_shift);
            column_sums[2 * i] = top ? first : _mm_add_epi16(column_sums[2 * i], first);
            column_sums[2 * i + 1] = top ? second : _mm_add_epi16(column_sums[2 * i + 1], second);
        }
        const __m128i words = _mm_packs_epi32(y[0], y[1]);
        _mm_storel_epi64(reinterpret_cast<__m128i*>((top ? rows.y_top : rows.y_bottom) + x),
                         _mm_packus_epi16(words, words));
    }
    const __m128i first = add_neighbors(column_sums[0], column_sums[1]);
    const __m128i second = add_neighbors(column_sums[2], column_sums[3]);
    const auto store_four = [](std::uint8_t* to, __m128i values) {
        const __m128i words = _mm_packs_epi32(values, values);
        const int bytes = _mm_cvtsi128_si32(_mm_packus_epi16(words, words));
        std::copy_n(reinterpret_cast<const std::uint8_t*>(&bytes), 4, to);
    };
    store_four(rows.cb + x / 2, weigh(first, second, repeated(to_cb), chroma_bias, chroma_shift));
    store_four(rows.cr + x / 2, weigh(first, second, repeated(to_cr), chroma_bias, chroma_shift));
}

#endif

void convert_rows(const RowPair& rows, int first, int last) {
    int x = first;
#ifdef __SSE2__
    for (; x + 8 <= last; x += 8) convert_eight(rows, x);
#endif
    for (; x < last; x += 2) convert_square(rows, x);
}

}  // namespace

std::size_t yuv420_bytes(int width, int height) {
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    return pixels + pixels / 2;
}

void convert_to_yuv420(const Image& image, const Rectangle& region, std::span<std::uint8_t> planes) {
    TUMBLE_CHECK_EQ(image.width % 2 + image.height % 2, 0);
    TUMBLE_CHECK_EQ(planes.size(), yuv420_bytes(image.width, image.height));
    const int left = std::max(region.x, 0) & ~1, right = std::min(region.x + region.width + 1, image.width) & ~1;
    const int top = std::max(region.y, 0) & ~1, bottom = std::min(region.y + region.height + 1, image.height) & ~1;
    const auto row = static_cast<std::size_t>(image.width);
    std::uint8_t* const cb = planes.data() + row * std::size_t(image.height);
    std::uint8_t* const cr = cb + row / 2 * std::size_t(image.height / 2);
    for (int y = top; y < bottom; y += 2) {
        std::uint8_t* const y_top = planes.data() + row * std::size_t(y);
        const std::size_t chroma = row / 2 * std::size_t(y / 2);
        convert_rows({image.at(0, y), image.at(0, y + 1), y_top, y_top + row, cb + chroma, cr + chroma}, left, right);
    }
}

namespace {

constexpr int block = 16;  // pixels: the codec's blocks are of this size or a multiple

Rectangle enlarged_to_blocks(const Rectangle& region, int width, int height) {
    const int left = std::max(region.x, 0) / block * block, top = std::max(region.y, 0) / block * block;
    const int right = std::min((region.x + region.width + block - 1) / block * block, width);
    const int bottom = std::min((region.y + region.height + block - 1) / block * block, height);
    return {left, top, right - left, bottom - top};
}

/// Copies a block; its pixels without coverage get the mean color of the others.
void fill_block(const Image& image, const Rectangle& r, Image& filled) {
    int weight = 0, sums[3] = {};
    for (int y = r.y; y < r.y + r.height; ++y)
        for (int x = r.x; x < r.x + r.width; ++x) {
            const std::uint8_t* const from = image.at(x, y);
            weight += from[3];
            for (int c = 0; c < 3; ++c) sums[c] += from[3] * from[c];
        }
    std::uint8_t mean[3] = {};
    for (int c = 0; c < 3 && weight > 0; ++c) mean[c] = static_cast<std::uint8_t>((sums[c] + weight / 2) / weight);
    for (int y = r.y; y < r.y + r.height; ++y)
        for (int x = r.x; x < r.x + r.width; ++x) {
            const std::uint8_t* const from = image.at(x, y);
            std::copy_n(from[3] == 0 ? mean : from, 3, filled.at(x, y));
        }
}

}  // namespace

std::size_t yuva420_bytes(int width, int height) {
    return yuv420_bytes(width, height) + std::size_t(width) * std::size_t(height);
}

void convert_to_yuva420(const Image& image, const Rectangle& region, Image& filled, std::span<std::uint8_t> planes) {
    TUMBLE_CHECK_EQ(planes.size(), yuva420_bytes(image.width, image.height));
    if (filled.width != image.width || filled.height != image.height) filled = Image(image.width, image.height);
    const Rectangle blocks = enlarged_to_blocks(region, image.width, image.height);
    const int right = blocks.x + blocks.width, bottom = blocks.y + blocks.height;
    for (int y = blocks.y; y < bottom; y += block)
        for (int x = blocks.x; x < right; x += block)
            fill_block(image, {x, y, std::min(block, right - x), std::min(block, bottom - y)}, filled);
    const std::size_t color = yuv420_bytes(image.width, image.height);
    convert_to_yuv420(filled, blocks, planes.first(color));
    for (int y = blocks.y; y < bottom; ++y) {
        std::uint8_t* const to = planes.data() + color + std::size_t(y) * std::size_t(image.width);
        for (int x = blocks.x; x < right; ++x) to[x] = image.at(x, y)[3];
    }
}

}  // namespace tumble
