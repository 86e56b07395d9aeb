#include "compare/report/report_pictures.h"

#include "compare/difference_image.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/metric_map.h"
#include "compare/metrics/pixel_windows.h"
#include "compare/metrics/ssim.h"
#include "core/check.h"
#include "core/error.h"
#include "core/image.h"
#include "core/start_thread.h"
#include "output/file_bytes.h"
#include "output/picture_reader.h"
#include "output/png_writer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace tumble {
namespace {

/// The largest mean difference, levels, of the 8 x 8 windows that a pixel is in. Windows start at every fourth row and
/// column. Precondition: the sizes are equal.
MetricMap window_map(const Image& a, const Image& b) {
    TUMBLE_CHECK_EQ(a.width, b.width);
    TUMBLE_CHECK_EQ(a.height, b.height);
    MetricMap map(a.width, a.height);
    if (a.width == 0 || a.height == 0) return map;
    std::vector<int> sums(std::size_t(a.width));  // of the columns of a row of windows
    for (const int top : window_starts(a.height)) {
        const int bottom = std::min(a.height, top + window_side);
        std::fill(sums.begin(), sums.end(), 0);
        for (int y = top; y < bottom; ++y)
            for (int x = 0; x < a.width; ++x) sums[std::size_t(x)] += pixel_difference(a.at(x, y), b.at(x, y));
        for (const int left : window_starts(a.width)) {
            const int right = std::min(a.width, left + window_side);
            int sum = 0;
            for (int x = left; x < right; ++x) sum += sums[std::size_t(x)];
            if (sum == 0) continue;
            const float mean = float(sum) / float(window_side * window_side);
            for (int y = top; y < bottom; ++y) {
                float* const row = map.row(y);
                for (int x = left; x < right; ++x) row[x] = std::max(row[x], mean);
            }
        }
    }
    return map;
}

namespace fs = std::filesystem;

constexpr int thumbnail_width = 192, thumbnail_height = 144;  // pixels: twice their size on the page, for sharp screens
constexpr float least_hot_window = 8.0f;                      // levels of the lightest color: noise stays dark

PictureBytes png_of(const Image& image, PngAlpha alpha) {
    PngEncoder encoder(alpha);
    const auto bytes = encoder.encode(image);
    return {bytes.begin(), bytes.end()};
}

PictureBytes bytes_of(const fs::path& file) {
    const std::string content = bytes_of_file(file).value_or("");
    const auto bytes = std::as_bytes(std::span(content));
    return {bytes.begin(), bytes.end()};
}

/// Empty where there is no image, or none that can be read.
std::optional<Image> image_of(const fs::path& file) {
    if (file.empty()) return std::nullopt;
    try {
        return read_picture(file);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

/// Bytes of both files, 0 for a missing one.
std::int64_t bytes_of_files(const ImageResult& result) {
    std::int64_t bytes = 0;
    for (const fs::path& file : {result.reference, result.image}) {
        std::error_code error;
        const std::uintmax_t size = file.empty() ? 0 : fs::file_size(file, error);
        if (!error && size != static_cast<std::uintmax_t>(-1)) bytes += static_cast<std::int64_t>(size);
    }
    return bytes;
}

void add_differences(const Image& reference, const Image& image, PairPictures& to) {
    const FlipResult perceived = flip(reference, image);
    to.figures = {perceived.mean, perceived.weighted_median, perceived.quantile_99, perceived.maximum};
    to.ssim = ssim(reference, image).mean;
    to.flip = png_of(heat_map(perceived.map), PngAlpha::dropped);
    const MetricMap windows = window_map(reference, image);
    to.hottest_window = std::max(least_hot_window, *std::max_element(windows.values.begin(), windows.values.end()));
    to.windows = png_of(heat_map(windows, to.hottest_window), PngAlpha::dropped);
}

PairPictures pictures_of(const ImageResult& result) {
    PairPictures pictures;
    const std::optional<Image> reference = image_of(result.reference), image = image_of(result.image);
    if (reference) {
        pictures.reference = bytes_of(result.reference);
        pictures.reference_size = {reference->width, reference->height};
    }
    if (image) {
        pictures.image = bytes_of(result.image);
        pictures.image_size = {image->width, image->height};
    }
    if (reference || image) {
        const Image small = thumbnail(image ? *image : *reference, thumbnail_width, thumbnail_height);
        pictures.thumbnail = png_of(small, PngAlpha::kept);
    }
    if (!reference || !image) return pictures;
    if (pictures.reference_size == pictures.image_size) {
        add_differences(*reference, *image, pictures);
    } else {
        const Image difference = difference_image(*reference, *image);
        pictures.difference = png_of(difference, PngAlpha::dropped);
        pictures.difference_size = {difference.width, difference.height};
    }
    return pictures;
}

/// The pictures of the results [first, last), several at a time.
void draw(const std::vector<const ImageResult*>& results, std::size_t first, std::size_t last, int workers,
          std::vector<PairPictures>& to) {
    std::atomic<std::size_t> next = first;
    std::vector<std::exception_ptr> errors(last - first);
    const auto work = [&] {
        for (std::size_t i; (i = next++) < last;) {
            if (to[i].left_out) continue;
            try {
                to[i] = pictures_of(*results[i]);
            } catch (...) {
                errors[i - first] = std::current_exception();
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        for (int i = 1; i < workers; ++i) threads.push_back(start_thread<std::jthread>(work));
        work();
    }
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
}

}  // namespace

std::vector<PairPictures> report_pictures(const std::vector<const ImageResult*>& results, std::int64_t most_bytes,
                                          int workers) {
    // In groups of a fixed size, so that the same pictures are left out with any number of workers.
    constexpr std::size_t group = 16;
    constexpr std::int64_t alike_part = 8;  // pairs within the tolerances get an eighth of the bytes
    std::vector<PairPictures> all(results.size());
    std::int64_t used = 0;
    const auto room = [&](std::size_t i) {
        return (results[i]->verdict == Verdict::alike ? most_bytes / alike_part : most_bytes) - used;
    };
    for (std::size_t first = 0; first < results.size(); first += group) {
        const std::size_t last = std::min(results.size(), first + group);
        for (std::size_t i = first; i < last; ++i) all[i].left_out = bytes_of_files(*results[i]) > room(i);
        draw(results, first, last, workers, all);
        for (std::size_t i = first; i < last; ++i) {
            const auto bytes = static_cast<std::int64_t>(all[i].bytes());
            if (bytes > room(i)) {
                PairPictures left_out;
                left_out.left_out = true;
                if (static_cast<std::int64_t>(all[i].thumbnail.size()) <= room(i))
                    left_out.thumbnail = std::move(all[i].thumbnail);
                all[i] = std::move(left_out);
            }
            used += static_cast<std::int64_t>(all[i].bytes());
        }
    }
    return all;
}

namespace {

/// Pixels [first, last) of the image, for a pixel of the small one.
struct PixelSpan {
    int first, last;
};

PixelSpan covered_pixels(int i, int small, int large) {
    const auto at = [&](int k) { return static_cast<int>(std::int64_t(k) * large / small); };
    return {at(i), std::max(at(i + 1), at(i) + 1)};
}

}  // namespace

Image thumbnail(const Image& image, int width, int height) {
    if (image.width <= width && image.height <= height) return image;
    const std::int64_t w = image.width, h = image.height;
    const bool wide = w * height > h * width;
    const int small_w = wide ? width : std::max(1, static_cast<int>(w * height / h));
    const int small_h = wide ? std::max(1, static_cast<int>(h * width / w)) : height;
    Image small(small_w, small_h);
    for (int y = 0; y < small_h; ++y)
        for (int x = 0; x < small_w; ++x) {
            const PixelSpan columns = covered_pixels(x, small_w, image.width),
                            rows = covered_pixels(y, small_h, image.height);
            std::array<std::int64_t, 4> sums{};
            for (int row = rows.first; row < rows.last; ++row)
                for (int column = columns.first; column < columns.last; ++column)
                    for (std::size_t c = 0; c < 4; ++c) sums[c] += image.at(column, row)[c];
            const std::int64_t count =
                std::int64_t(rows.last - rows.first) * std::int64_t(columns.last - columns.first);
            for (std::size_t c = 0; c < 4; ++c)
                small.at(x, y)[c] = static_cast<std::uint8_t>((sums[c] + count / 2) / count);
        }
    return small;
}

}  // namespace tumble
