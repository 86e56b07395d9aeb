// Tolerances of a comparison by file pattern: the file tolerances.toml, or a table of another file.
//
//   levels = 3                       # of all pictures
//
//   [[rule]]
//   files = ["smoke/*.png"]
//   levels = 8
//   masks = [{pixels = [0, 0, 90, 20]}, {fractions = [0.9, 0.9, 0.1, 0.1]}, {file = "clock.png"}]
//
// A key has the value of the last matching rule that has it, so that later rules refine earlier ones.
#pragma once

#include "compare/ignored_pixels.h"
#include "compare/image_compare.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

class TomlTable;

/// The tolerances of one pair of images.
struct PairTolerances {
    CompareOptions pixels;
    std::optional<double> ssim;  // at least this structural similarity
    std::optional<double> flip;  // at most this mean perceptual error (FLIP)
    std::vector<Mask> masks;
    std::string rule;  // pattern of the last rule that matched; empty: none did
};

/// The values that a rule has; the others stay.
struct ToleranceValues {
    std::optional<bool> exact;
    std::optional<int> levels, cluster, shade;
    std::optional<double> fraction, window, ssim, flip;
    std::optional<std::vector<Mask>> masks;

    void apply(PairTolerances& to) const;
};

class Tolerances {
public:
    /// The same for all images.
    explicit Tolerances(const PairTolerances& all = {});

    /// Throws InputError with file, line and column for any mistake; masks are read. `base` has the values of keys that
    /// the file does not have.
    static Tolerances read(const std::filesystem::path& file, const PairTolerances& base = {});

    /// The same from the text of the file.
    static Tolerances parse(const std::string& text, const std::filesystem::path& file,
                            const PairTolerances& base = {});

    /// The same from a table of another file with the keys of tolerances.toml. `folder` is that of relative names of
    /// masks.
    static Tolerances of_table(const TomlTable& table, const std::filesystem::path& folder,
                               const PairTolerances& base = {});

    PairTolerances of(std::string_view name) const;

    /// Further platforms whose folders hold references (see platform.h).
    const std::vector<std::string>& platforms() const { return platforms_; }

    /// The files that were read: its own, and masks.
    std::vector<std::filesystem::path> files() const;

    /// The rules that stand for none of these names, as "FILE:LINE: PATTERN".
    std::vector<std::string> unused(const std::vector<std::string>& names) const;

private:
    struct Rule;  // values that it has, and its patterns

    static void add_masks(const std::vector<Mask>& masks, std::vector<std::filesystem::path>& files);

    std::filesystem::path file_;  // empty: none
    PairTolerances all_;
    std::vector<Rule> rules_;
    std::vector<std::string> platforms_;
};

struct Tolerances::Rule {
    std::vector<std::string> files;  // patterns
    std::string place;               // FILE:LINE
    ToleranceValues values;
};

inline Tolerances::Tolerances(const PairTolerances& all) : all_(all) {}

}  // namespace tumble
