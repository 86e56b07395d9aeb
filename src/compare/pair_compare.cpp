#include "compare/pair_compare.h"

#include "compare/comparison.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/ssim.h"
#include "compare/tolerances.h"
#include "core/check.h"
#include "core/error.h"
#include "core/image.h"
#include "core/safe_text.h"
#include "core/start_thread.h"
#include "output/picture_reader.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <exception>
#include <fstream>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace tumble {

namespace {

namespace fs = std::filesystem;

struct PerceptualFigure {
    RuleFigure figure;
    std::string reason;  // a sentence, for a figure beyond its limit
};

PerceptualFigure ssim_figure(const Image& reference, const Image& image, double limit) {
    const SsimResult found = ssim(reference, image);
    const RuleFigure figure{"ssim", found.mean, limit, found.mean >= limit, found.x, found.y};
    return {figure,
            fmt::format("rule ssim: the structural similarity is {:.6g} (at least {:.6g} is needed; key ssim); the "
                        "lowest at x {}, y {}",
                        found.mean, limit, found.x, found.y)};
}

PerceptualFigure flip_figure(const Image& reference, const Image& image, double limit) {
    const FlipResult found = flip(reference, image);
    const RuleFigure figure{"flip", found.mean, limit, found.mean <= limit, found.x, found.y};
    return {figure, fmt::format("rule flip: the mean perceptual error is {:.6g} (at most {:.6g} may be; key flip); the "
                                "largest at x {}, y {}",
                                found.mean, limit, found.x, found.y)};
}

/// ssim and flip, as far as they have a limit. Precondition: the sizes are equal.
std::vector<PerceptualFigure> perceptual_figures(const Image& reference, const Image& image,
                                                 const PairTolerances& tolerances) {
    std::vector<PerceptualFigure> figures;
    if (tolerances.ssim) figures.push_back(ssim_figure(reference, image, *tolerances.ssim));
    if (tolerances.flip) figures.push_back(flip_figure(reference, image, *tolerances.flip));
    return figures;
}

/// A picture from top to bottom.
class ComparedRows {
public:
    explicit ComparedRows(const ComparedPicture& picture) : pixels_(picture.pixels) {
        if (pixels_ == nullptr) file_.emplace(picture.file);
    }

    ImageSize size() const { return file_ ? file_->size() : ImageSize{pixels_->width, pixels_->height}; }

    std::span<const std::uint8_t> next() {
        if (file_) return file_->next();
        return {pixels_->at(0, row_++), 4 * std::size_t(pixels_->width)};
    }

private:
    std::shared_ptr<const Image> pixels_;
    std::optional<PictureRows> file_;
    int row_ = 0;
};

Image whole(const ComparedPicture& picture) {
    return picture.pixels != nullptr ? *picture.pixels : read_picture(picture.file);
}

/// True if both are files with the same bytes.
bool same_bytes(const ComparedPicture& a, const ComparedPicture& b) {
    if (a.pixels != nullptr || b.pixels != nullptr) return false;
    std::error_code error;  // a pipe has no size
    const std::uintmax_t size = fs::file_size(a.file, error);
    if (error || size != fs::file_size(b.file, error) || error) return false;
    std::ifstream stream_a(a.file, std::ios::binary), stream_b(b.file, std::ios::binary);
    std::array<char, 65536> bytes_a{}, bytes_b{};
    for (std::uintmax_t left = size; left > 0;) {
        const auto count = std::min<std::uintmax_t>(left, bytes_a.size());
        if (!stream_a.read(bytes_a.data(), std::streamsize(count)) ||
            !stream_b.read(bytes_b.data(), std::streamsize(count)) ||
            !std::equal(bytes_a.begin(), bytes_a.begin() + std::ptrdiff_t(count), bytes_b.begin()))
            return false;
        left -= count;
    }
    return size > 0;
}

void check_same_size(ImageSize a, ImageSize b, ImageResult& result) {
    if (a == b) return;
    result.image_width = b.width;
    result.image_height = b.height;
    throw InputError(
        fmt::format("the picture has {} x {} pixels, and the reference {} x {}", b.width, b.height, a.width, a.height));
}

/// The pair row by row. With the same bytes, one of them is read: a broken file is not the same as itself.
Comparison compare_rows(const ImagePair& pair, const PairTolerances& tolerances, ImageResult& result) {
    ComparedRows reference(*pair.reference);
    std::optional<ComparedRows> image;
    if (!same_bytes(*pair.reference, *pair.image)) image.emplace(*pair.image);
    const auto [width, height] = reference.size();
    result.width = width;
    result.height = height;
    if (image) check_same_size(reference.size(), image->size(), result);
    const IgnoredPixels ignored(tolerances.masks, width, height);
    ImageComparer comparer(width, height, tolerances.pixels);
    std::vector<std::uint8_t> masked;
    for (int y = 0; y < height; ++y) {
        const std::span<const std::uint8_t> row = reference.next();
        std::span<const std::uint8_t> other = image ? image->next() : row;
        if (image && !ignored.none()) {
            masked.assign(other.begin(), other.end());
            ignored.equalize(y, row, masked);
            other = masked;
        }
        comparer.add_row(row, other);
    }
    return comparer.result(LimitNames::keys);
}

/// The same of whole images, with the perceptual metrics.
Comparison compare_whole(const ImagePair& pair, const PairTolerances& tolerances, ImageResult& result) {
    const Image reference = whole(*pair.reference);
    Image image = whole(*pair.image);
    result.width = reference.width;
    result.height = reference.height;
    check_same_size({reference.width, reference.height}, {image.width, image.height}, result);
    const IgnoredPixels ignored(tolerances.masks, reference.width, reference.height);
    ImageComparer comparer(reference.width, reference.height, tolerances.pixels);
    const std::size_t row_bytes = 4 * std::size_t(reference.width);
    for (int y = 0; y < reference.height; ++y) {
        ignored.equalize(y, {reference.at(0, y), row_bytes}, {image.at(0, y), row_bytes});
        comparer.add_row({reference.at(0, y), row_bytes}, {image.at(0, y), row_bytes});
    }
    Comparison comparison = comparer.result(LimitNames::keys);
    for (const PerceptualFigure& figure : perceptual_figures(reference, image, tolerances)) {
        result.figures.push_back(figure.figure);
        if (figure.figure.holds) continue;
        comparison.alike = false;
        comparison.reason += (comparison.reason.empty() ? "" : "\n") + figure.reason;
    }
    return comparison;
}

void fill(ImageResult& result, const Comparison& comparison) {
    std::vector<RuleFigure> figures;
    for (const CompareRule& rule : comparison.rules)
        figures.push_back({rule.name, rule.figure, rule.limit, rule.holds(), rule.x, rule.y});
    result.figures.insert(result.figures.begin(), figures.begin(), figures.end());
    result.reason = comparison.reason;
    result.differing_pixels = std::int64_t(comparison.differing_pixels);
    result.max_difference = comparison.max_difference;
    result.changed = comparison.changed;
    const bool same = comparison.differing_pixels == 0;
    result.verdict = !comparison.alike ? Verdict::different : same ? Verdict::same : Verdict::alike;
}

/// Reads a picture without a partner, for its size: a broken one is not merely missing or added.
void read_alone(const ComparedPicture& picture, ImageResult& result) {
    ComparedRows rows(picture);
    result.width = rows.size().width;
    result.height = rows.size().height;
}

}  // namespace

ImageResult compare_pair(const ImagePair& pair, const PairTolerances& tolerances) {
    TUMBLE_CHECK_EQ(pair.reference || pair.image, true);
    ImageResult result;
    result.name = pair.name;
    result.rule = tolerances.rule;
    if (pair.reference) result.reference = pair.reference->file;
    if (pair.image) result.image = pair.image->file;
    try {
        if (!pair.image || !pair.reference) {
            result.verdict = pair.image ? Verdict::added : Verdict::missing;
            result.reason = pair.image ? "there is no reference" : "there is no picture";
            read_alone(pair.image ? *pair.image : *pair.reference, result);
        } else {
            const bool perceptual = tolerances.ssim || tolerances.flip;
            fill(result, perceptual ? compare_whole(pair, tolerances, result) : compare_rows(pair, tolerances, result));
        }
    } catch (const InputError& error) {
        result.verdict = Verdict::broken;
        result.figures.clear();
        result.reason = error.where().file.empty()
                            ? error.message()
                            : fmt::format("{}: {}", safe_path(error.where().file), error.message());
    }
    return result;
}

namespace {

class SetComparison {
public:
    SetComparison(const PairSource& next, const Tolerances& tolerances, const PairSink& found)
        : next_(next), tolerances_(tolerances), found_(found) {}

    /// Takes and compares pairs until there are none, or a thread has failed.
    void work() {
        try {
            while (const auto task = take()) {
                const auto start = std::chrono::steady_clock::now();
                ImageResult result = compare_pair(task->pair, tolerances_.of(task->pair.name));
                result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
                put(task->index, task->pair, std::move(result));
            }
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!error_) error_ = std::current_exception();
        }
    }

    std::vector<ImageResult> results() {
        if (error_) std::rethrow_exception(error_);
        return std::move(results_);
    }

private:
    struct Task {
        std::size_t index;
        ImagePair pair;
    };

    std::optional<Task> take() {
        const std::lock_guard lock(mutex_);
        if (error_) return std::nullopt;
        std::optional<ImagePair> pair = next_();
        if (!pair) return std::nullopt;
        results_.emplace_back();
        return Task{results_.size() - 1, std::move(*pair)};
    }

    void put(std::size_t index, const ImagePair& pair, ImageResult result) {
        if (found_) found_(pair, result);
        const std::lock_guard lock(mutex_);
        results_[index] = std::move(result);
    }

    const PairSource& next_;
    const Tolerances& tolerances_;
    const PairSink& found_;
    std::mutex mutex_;
    std::vector<ImageResult> results_;
    std::exception_ptr error_;
};

}  // namespace

std::vector<ImageResult> compare_pairs(const PairSource& next, const Tolerances& tolerances, int workers,
                                       const PairSink& found) {
    SetComparison comparison(next, tolerances, found);
    {
        std::vector<std::jthread> threads;
        for (int i = 1; i < workers; ++i) threads.push_back(start_thread<std::jthread>([&] { comparison.work(); }));
        comparison.work();
    }
    return comparison.results();
}

}  // namespace tumble
