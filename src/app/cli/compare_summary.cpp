#include "app/cli/compare_summary.h"

#include "app/cli/say.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace tumble {
namespace {

constexpr std::int64_t listed = 20;  // of each verdict: a screenful or two; files have them all

std::string indented(const std::string& lines) {
    std::string text = "  ";
    for (const char c : safe_lines(lines)) text += c == '\n' ? std::string("\n  ") : std::string(1, c);
    return text + "\n";
}

std::string entry(const ImageResult& image) {
    std::string text = fmt::format("{}: {}\n", name_of(image.verdict), safe_path(image.name));
    if (image.verdict == Verdict::different || image.verdict == Verdict::broken) text += indented(image.reason);
    if (image.verdict == Verdict::different)
        text += fmt::format("  {} pixels differ, by {} levels at most; changed: {} x {} pixels from x {}, y {}\n",
                            image.differing_pixels, image.max_difference, image.changed.width, image.changed.height,
                            image.changed.x, image.changed.y);
    for (const std::string& cause : image.causes) text += indented(cause);
    return text;
}

}  // namespace

void print_summary(const SetResult& result, bool brief) {
    for (const Verdict verdict : worst_first) {
        if (verdict == Verdict::alike || verdict == Verdict::same) continue;
        std::int64_t shown = 0;
        for (const ImageResult& image : result.images)
            if (image.verdict == verdict && shown++ < listed) put_text(entry(image));
        if (shown > listed) put("{} more {} pictures (--json lists all)\n", shown - listed, name_of(verdict));
    }
    if (const auto accepted = std::ranges::count_if(result.images, &ImageResult::accepted); accepted > 0 && !brief)
        put("accepted: {} {} now the reference\n", accepted, accepted == 1 ? "picture is" : "pictures are");
    if (!brief) {
        std::string counts;
        const auto numbers = result.counts();
        for (std::size_t i = 0; i < verdict_count; ++i)
            if (numbers[i] > 0)
                counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", numbers[i], name_of(Verdict(i)));
        put("{} {}: {}\n", result.images.size(), result.images.size() == 1 ? "picture" : "pictures", counts);
        if (!result.platform.empty())
            put("references of the platform {} replace general ones\n", safe_text(result.platform));
    }
    finish_standard_output();
}

}  // namespace tumble
