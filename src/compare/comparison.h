// Results of a comparison of two sets of images: the material of reports, tables and exit codes.
#pragma once

#include "core/image.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

enum class Verdict {
    same,       // every pixel
    alike,      // within the tolerances
    different,  // beyond them
    missing,    // a reference without an image
    added,      // an image without a reference
    broken,     // cannot be compared: no picture, another size
};
inline constexpr std::size_t verdict_count = 6;
/// The order of reports.
inline constexpr std::array<Verdict, verdict_count> worst_first{Verdict::broken, Verdict::missing, Verdict::different,
                                                                Verdict::added,  Verdict::alike,   Verdict::same};

/// "same", "alike", ...
std::string_view name_of(Verdict verdict);

/// A measured value of a pair and the limit that the tolerances set.
struct RuleFigure {
    std::string metric;  // pixels, cluster, window, shade, ssim or flip
    double value = 0.0, limit = 0.0;
    bool holds = true;
    int x = 0, y = 0;  // pixel, or top left pixel of the window, of the worst place
};

/// Result of a pair of images, or of one without a partner.
struct ImageResult {
    std::string name;                        // path in the folder, with '/', or frame_000041.png of a clip
    std::filesystem::path reference, image;  // files; empty where there is none
    Verdict verdict = Verdict::same;
    std::string rule;                       // pattern of the last rule of the tolerances that applied; empty: none
    std::vector<RuleFigure> figures;        // of a compared pair
    std::string reason;                     // a sentence for each failed rule, one per line; empty for same and alike
    int width = 0, height = 0;              // pixels, of the reference, or of an added image; 0: unknown
    int image_width = 0, image_height = 0;  // of an image of another size than the reference; otherwise 0
    bool accepted = false;                  // the image becomes the reference
    double seconds = 0.0;                   // of the comparison, and of the drawing where there is one
    std::int64_t differing_pixels = 0;      // with any difference
    int max_difference = 0;                 // levels, largest over pixels and channels
    Rectangle changed;                // bounds of the pixels beyond the tolerance, or of all that differ if none is
    std::vector<std::string> causes;  // changes of the scene, a sentence each

    bool sizes_differ() const { return image_width > 0; }
};

struct SetResult {
    std::string reference, image;     // as the caller named them
    std::vector<ImageResult> images;  // by name
    std::string platform;             // whose references replace general ones; empty: none
    bool added_allowed = false;       // an image without a reference is no difference

    /// The number of images of each verdict, in the order of the enumeration.
    std::array<std::int64_t, verdict_count> counts() const;
    std::int64_t count(Verdict verdict) const { return counts()[std::size_t(verdict)]; }

    /// True for a verdict that makes the comparison fail, and for an image with such a verdict that is not accepted.
    bool fails(Verdict verdict) const;
    bool fails(const ImageResult& result) const { return !result.accepted && fails(result.verdict); }

    /// 2 if an image is broken, otherwise 3 if one is missing, otherwise 1 if one differs or an added one is not
    /// allowed, otherwise 0. Accepted images do not count.
    int exit_code() const;
};

/// Leaves out the names of files in a folder that is about to go.
void forget_files_in(const std::filesystem::path& folder, SetResult& result);

// -- Results of a comparison for other programs: JSON and JUnit XML (docs/reference/comparison.md).

/// One object, with a line break at its end.
std::string to_json(const SetResult& result);

/// A <testsuite> with a <testcase> for each image: <failure> for different and added ones, <error> for missing and
/// broken ones.
std::string to_junit(const SetResult& result);

}  // namespace tumble
