#include "app/golden/check.h"

#include "app/causes/explain.h"
#include "app/causes/motion_record.h"
#include "compare/image_folder.h"
#include "compare/pair_compare.h"
#include "compare/platform.h"
#include "core/error.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The place of a result: its case and frame.
struct ImagePlace {
    const DrawnCase* drawn;
    std::int64_t frame;
};

References references_in(const GoldenSuite& suite, const std::string& platform) {
    std::error_code error;
    if (!fs::exists(suite.references, error)) return {};
    return references_of(pictures_in(suite.references).files, {}, platform,
                         platform_folders(suite.tolerances.platforms()));
}

ImagePair pair_of(const ImagePlace& place, const NamedFiles& references) {
    ImagePair pair;
    pair.name = place.drawn->golden->image_name(place.frame);
    if (const auto reference = references.find(pair.name); reference != references.end())
        pair.reference = ComparedPicture{reference->second, nullptr};
    if (place.drawn->error.empty()) pair.image = ComparedPicture{place.drawn->folder / pair.name, nullptr};
    return pair;
}

/// The result of an image that cannot be compared.
ImageResult lone_result(const ImagePair& pair, const DrawnCase& drawn) {
    ImageResult result;
    result.name = pair.name;
    if (pair.reference) result.reference = pair.reference->file;
    if (pair.image) result.image = pair.image->file;
    if (!drawn.error.empty()) {
        result.verdict = Verdict::broken;
        result.reason = "cannot be drawn: " + drawn.error;
    } else {
        result.verdict = Verdict::missing;
        result.reason = "there is no reference; look at the new image, and accept the case " + drawn.golden->name;
    }
    return result;
}

void explain(const ImagePlace& place, ImageResult& result) {
    if (result.verdict != Verdict::different) return;
    const std::string name = place.drawn->golden->record_name();
    const fs::path before = result.reference.parent_path() / name;
    std::error_code error;
    if (!fs::exists(before, error)) return;
    try {
        explain_image(read_motion_record(before), read_motion_record(place.drawn->folder / name), place.frame, result);
    } catch (const InputError&) {
        // Causes are an addition: the verdict stands without them.
    }
}

std::vector<ImagePlace> places_of(std::span<const DrawnCase> drawn) {
    std::vector<ImagePlace> places;
    for (const DrawnCase& one : drawn)
        for (const std::int64_t frame : one.golden->frames) places.push_back({&one, frame});
    return places;
}

}  // namespace

SetResult check_cases(const GoldenSuite& suite, std::span<const DrawnCase> drawn, const CheckOptions& options,
                      Interrupt& interrupt) {
    SetResult result;
    result.reference = suite.references.string();
    result.image = suite.file.string();
    const References references = references_in(suite, platform_of_option(options.platform));
    result.platform = references.platform;
    const std::vector<ImagePlace> places = places_of(drawn);
    result.images.resize(places.size());
    // Pairs with the same tolerances together: pairs of the suite, and of each case with tolerances of its own.
    std::map<const Tolerances*, std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const ImagePair pair = pair_of(places[i], references.files);
        if (pair.reference && pair.image) {
            groups[&suite.tolerances_of(*places[i].drawn->golden)].push_back(i);
        } else {
            result.images[i] = lone_result(pair, *places[i].drawn);
        }
    }
    for (const auto& group : groups) {
        const std::vector<std::size_t>& indices = group.second;
        std::size_t next = 0;
        const auto source = [&]() -> std::optional<ImagePair> {
            if (interrupt.pending()) throw Interrupted();
            if (next == indices.size()) return std::nullopt;
            return pair_of(places[indices[next++]], references.files);
        };
        std::vector<ImageResult> compared = compare_pairs(source, *group.first, options.workers);
        for (std::size_t k = 0; k < indices.size(); ++k) result.images[indices[k]] = std::move(compared[k]);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        explain(places[i], result.images[i]);
        // Each image of a case has its share.
        result.images[i].seconds += places[i].drawn->seconds / double(places[i].drawn->golden->frames.size());
    }
    return result;
}

std::vector<std::string> references_of_no_case(const GoldenSuite& suite) {
    std::set<std::string> known;
    for (const GoldenCase& golden : suite.cases) {
        for (const std::int64_t frame : golden.frames) known.insert(golden.image_name(frame));
        known.insert(golden.record_name());
    }
    std::vector<std::string> others;
    std::error_code error;
    std::vector<fs::path> folders{suite.references};
    for (const std::string& platform : platform_folders(suite.tolerances.platforms()))
        folders.push_back(suite.references / platform);
    for (const fs::path& folder : folders)
        for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
            const std::string name = it->path().filename().string();
            const bool ours = name.ends_with(".png") || name.ends_with(".motion.json");
            if (ours && !name.starts_with('.') && known.count(name) == 0)
                others.push_back(it->path().lexically_relative(suite.references).string());
        }
    std::ranges::sort(others);
    return others;
}

}  // namespace tumble
