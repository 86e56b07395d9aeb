// Two PNG files and the options of `compare`: a verdict consistent with its rules, or an InputError. The first four
// bytes are the tolerance, the fraction in parts of 255, and the cluster's and the window's limit (0: not given); the
// next two are the first file's length, low byte first.
#include "png_bytes.h"

#include "compare/difference_image.h"
#include "core/check.h"
#include "core/error.h"

#include <vector>

namespace {

constexpr std::size_t head = 6;

std::size_t first_length(std::span<const std::uint8_t> bytes) {
    return std::min(std::size_t(bytes[4]) | std::size_t(bytes[5]) << 8, bytes.size() - head);
}

void compare(std::span<const std::uint8_t> first, std::span<const std::uint8_t> second,
             const tumble::CompareOptions& options) {
    tumble::PngRows a(tumble::as_file(first), "a.png"), b(tumble::as_file(second), "b.png");
    const auto [width, height] = a.size();
    tumble::check_sizes(width, height, b.size().width, b.size().height);
    if (std::int64_t(width) * height > tumble::fuzzed_pixels) return;
    tumble::ImageComparer comparer(width, height, options), same(width, height, options);
    std::vector<std::uint8_t> difference(4 * std::size_t(width));
    std::size_t differing = 0;
    for (int y = 0; y < height; ++y) {
        const auto row_a = a.next(), row_b = b.next();
        comparer.add_row(row_a, row_b);
        same.add_row(row_a, row_a);
        tumble::difference_row(row_a, row_b, options.tolerance, difference);
        for (std::size_t i = 0; i < row_a.size(); i += 4)
            differing += std::equal(&row_a[i], &row_a[i] + 4, &row_b[i]) ? 0 : 1;
    }
    TUMBLE_CHECK_EQ(same.result().alike, true);
    const tumble::Comparison result = comparer.result();
    TUMBLE_CHECK_EQ(result.differing_pixels, differing);
    TUMBLE_CHECK_EQ(result.alike, result.rules[0].holds() && result.rules[1].holds() && result.rules[2].holds() &&
                                      result.rules[3].holds());
    TUMBLE_CHECK_EQ(result.alike, result.reason.empty());
    if (differing == 0) TUMBLE_CHECK_EQ(result.alike, true);
    for (const tumble::CompareRule& rule : result.rules)
        TUMBLE_CHECK_EQ(rule.x >= 0 && rule.x < width && rule.y >= 0 && rule.y < height, true);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < head) return 0;
    const std::span<const std::uint8_t> bytes(data, size);
    tumble::CompareOptions options;
    options.tolerance = data[0];
    options.fraction = data[1] / 255.0;
    if (data[2] > 0) options.cluster = data[2] - 1;
    if (data[3] > 0) options.window = data[3] - 1;
    const std::size_t length = first_length(bytes);
    try {
        compare(bytes.subspan(head, length), bytes.subspan(head + length), options);
    } catch (const tumble::InputError&) {
    }
    return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room) __attribute__((weak));

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    size = LLVMFuzzerMutate(data, size, room);
    if (size < head || seed % 8 == 0) return size;
    const std::span<std::uint8_t> bytes(data, size);
    const std::size_t length = first_length(bytes);
    tumble::mend_checksums(bytes.subspan(head, length));
    tumble::mend_checksums(bytes.subspan(head + length));
    return size;
}
