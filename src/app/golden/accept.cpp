#include "app/golden/accept.h"

#include "app/golden/suite.h"
#include "compare/pair_compare.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "output/file_transaction.h"
#include "output/png_reader.h"
#include "output/temporary_folder.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr DrawingWork first_work{1, 1, false}, second_work{3, 2, true};

std::string content(const fs::path& file) {
    std::optional<std::string> bytes = bytes_of_file(file);
    if (!bytes) throw RunError(fmt::format("cannot read '{}'", safe_path(file)));
    return std::move(*bytes);
}

/// Why the image is no reference; empty if both drawings are the same.
std::string difference_between(const DrawnCase& first, const DrawnCase& second, const std::string& name) {
    const fs::path a = first.folder / name, b = second.folder / name;
    if (content(a) == content(b) || read_png(a) == read_png(b)) return "";
    const ImageResult compared =
        compare_pair({name, ComparedPicture{a, nullptr}, ComparedPicture{b, nullptr}}, PairTolerances());
    return fmt::format(
        "does not render twice alike: {} pixels differ, by {} levels at most, between drawings with {} and {} "
        "processes",
        compared.differing_pixels, compared.max_difference, first_work.workers, second_work.workers);
}

/// The fate of an image that renders twice alike.
AcceptedImage::What place_of(const fs::path& image, const fs::path& reference, const Tolerances& tolerances) {
    using What = AcceptedImage::What;
    std::error_code error;
    if (!fs::exists(reference, error)) return What::made;
    const std::string name = reference.filename().string();
    const ImageResult result =
        compare_pair({name, ComparedPicture{reference, nullptr}, ComparedPicture{image, nullptr}}, tolerances.of(name));
    if (result.verdict == Verdict::same) return What::kept_same;
    return result.verdict == Verdict::alike ? What::kept_alike : What::replaced;
}

/// Accepts the images of all cases; their references get their names together.
class Acceptance {
public:
    Acceptance(const GoldenSuite& suite, const AcceptOptions& options)
        : suite_(suite), options_(options), files_(suite.references) {}

    void accept(const DrawnCase& first, const DrawnCase& second, std::vector<AcceptedImage>& accepted) {
        const GoldenCase& golden = *first.golden;
        const std::string& error = first.error.empty() ? second.error : first.error;
        if (!error.empty()) {
            for (const std::int64_t frame : golden.frames)
                accepted.push_back({golden.image_name(frame), What::broken, "cannot be drawn: " + error});
            return;
        }
        std::vector<AcceptedImage> images;
        bool refused = false;
        for (const std::int64_t frame : golden.frames) {
            AcceptedImage& image = images.emplace_back();
            image.name = golden.image_name(frame);
            image.reason = difference_between(first, second, image.name);
            refused = refused || !image.reason.empty();
        }
        for (AcceptedImage& image : images) {
            if (refused) {
                if (image.reason.empty()) image.reason = "another image of its case does not render twice alike";
                image.what = AcceptedImage::What::refused;
            }
            accepted.push_back(image);
        }
        if (!refused) add(first, std::span(accepted).last(images.size()));
    }

    void commit() { files_.commit(); }

private:
    using What = AcceptedImage::What;

    void add(const DrawnCase& drawn, std::span<AcceptedImage> images) {
        const GoldenCase& golden = *drawn.golden;
        const auto add = [&](const fs::path& from, const fs::path& name) { files_.add(name, content(from)); };
        bool all_new = true;  // the record tells of the references: it is kept with an older one
        for (AcceptedImage& image : images) {
            const fs::path from = drawn.folder / image.name, name = reference_name(image.name, options_.platform);
            image.what = place_of(from, suite_.references / name, suite_.tolerances_of(golden));
            if (image.what == What::kept_alike && options_.even_alike) image.what = What::replaced;
            if (image.what == What::made || image.what == What::replaced) add(from, name);
            all_new = all_new && image.what != What::kept_alike;
        }
        const fs::path record = drawn.folder / golden.record_name();
        const fs::path record_name = reference_name(golden.record_name(), options_.platform);
        const fs::path old_record = suite_.references / record_name;
        std::error_code error;
        const bool none = !fs::exists(old_record, error);
        const bool changed = none || content(old_record) != content(record);
        const bool any_new = std::ranges::any_of(
            images, [](const AcceptedImage& i) { return i.what == What::made || i.what == What::replaced; });
        if (changed && (none || all_new || any_new)) add(record, record_name);
    }

    const GoldenSuite& suite_;
    const AcceptOptions& options_;
    FileTransaction files_;
};

}  // namespace

std::vector<AcceptedImage> accept_cases(const GoldenSuite& suite, std::span<const GoldenCase* const> cases,
                                        const CaseDrawer& drawer, const AcceptOptions& options, Interrupt& interrupt) {
    const TemporaryFolder work("accept");
    const auto draw = [&](const char* name, const DrawingWork& by) {
        DrawCasesOptions how;
        how.jobs = options.jobs;
        how.work = by;
        return draw_cases(cases, drawer, ImageCache(work.path() / name), how, interrupt);
    };
    const std::vector<DrawnCase> first = draw("first", first_work), second = draw("second", second_work);
    std::vector<AcceptedImage> accepted;
    finish_left_transactions(suite.references);
    Acceptance acceptance(suite, options);
    for (std::size_t i = 0; i < cases.size(); ++i) acceptance.accept(first[i], second[i], accepted);
    acceptance.commit();
    return accepted;
}

}  // namespace tumble
