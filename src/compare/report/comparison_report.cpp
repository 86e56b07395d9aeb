#include "compare/report/comparison_report.h"

#include "compare/report/report_assets.h"
#include "compare/report/report_entry.h"
#include "compare/report/report_pictures.h"
#include "core/html_text.h"
#include "output/temporary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace tumble {
namespace {

/// All that the parts of the page are made of.
struct Report {
    const SetResult& set;
    const ReportOptions& options;
    std::vector<const ImageResult*> images;
    std::vector<PairPictures> pictures;

    ReportEntry entry(std::size_t i) const { return {images[i], &pictures[i], static_cast<int>(i) + 1}; }
};

/// "sha256-..." of a content security policy.
std::string policy_hash(std::string_view hexadecimal) {
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i + 1 < hexadecimal.size(); i += 2)
        bytes.push_back(std::byte(std::stoi(std::string(hexadecimal.substr(i, 2)), nullptr, 16)));
    return "sha256-" + base64(bytes);
}

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// "3 of 42 pictures fail".
std::string headline(const SetResult& set) {
    const auto all = static_cast<std::int64_t>(set.images.size());
    const auto bad =
        std::count_if(set.images.begin(), set.images.end(), [&](const ImageResult& image) { return set.fails(image); });
    const auto accepted =
        std::count_if(set.images.begin(), set.images.end(), [](const ImageResult& image) { return image.accepted; });
    if (all == 0) return "No pictures were compared";
    if (bad > 0)
        return fmt::format("{} of {} {}", bad, counted(all, "picture", "pictures"), bad == 1 ? "fails" : "fail");
    if (accepted > 0)
        return fmt::format("{} of {} {} accepted", accepted, counted(all, "picture", "pictures"),
                           accepted == 1 ? "is" : "are");
    if (set.count(Verdict::same) == all)
        return all == 1 ? "The picture is the same" : fmt::format("All {} pictures are the same", all);
    return all == 1 ? "The picture is alike" : fmt::format("All {} pictures are alike", all);
}

std::string title_of(const Report& report) {
    if (!report.options.title.empty()) return report.options.title;
    return fmt::format("{} — {}", headline(report.set), report.set.image);
}

std::string counts_html(const SetResult& set) {
    std::string items, segments;
    double x = 0.0;
    for (const Verdict verdict : worst_first) {
        const std::int64_t count = set.count(verdict);
        if (count == 0) continue;
        const std::string_view name = name_of(verdict);
        const double width = 100.0 * double(count) / double(set.images.size());
        items += fmt::format("<li class=\"{0}\"><strong>{1}</strong> {0}</li>\n", name, count);
        segments += fmt::format("<rect class=\"{}\" x=\"{:.3f}\" width=\"{:.3f}\" height=\"4\"/>", name, x, width);
        x += width;
    }
    return fmt::format(
        "<svg class=\"shares\" viewBox=\"0 0 100 4\" preserveAspectRatio=\"none\" aria-hidden=\"true\" "
        "focusable=\"false\">{}</svg>\n<ul class=\"counts\" aria-label=\"Pictures by verdict\">\n{}</ul>\n",
        segments, items);
}

std::string masthead_html(const Report& report) {
    const SetResult& set = report.set;
    return fmt::format(
        "<header class=\"masthead {}\">\n<p class=\"eyebrow\">Comparison of pictures</p>\n<h1>{}</h1>\n<p "
        "class=\"lead\"><code>{}</code> against the references <code>{}</code></p>\n{}</header>\n",
        set.exit_code() == 0 ? "good" : "bad", headline(set), html_text(set.image), html_text(set.reference),
        counts_html(set));
}

std::string browser_html(const Report& report) {
    if (report.images.empty()) return "";
    std::string list, details;
    for (std::size_t i = 0; i < report.images.size(); ++i) {
        list += list_item_html(report.entry(i));
        details += details_html(report.entry(i));
    }
    const auto left_out = std::count_if(report.pictures.begin(), report.pictures.end(),
                                        [](const PairPictures& pictures) { return pictures.left_out; });
    const std::string note = left_out == 0
                                 ? ""
                                 : fmt::format(
                                       "<p class=\"note\">The page is limited to {} MiB of pictures: those of {} are "
                                       "left out, the least differences first.</p>\n",
                                       report.options.most_picture_bytes >> 20, counted(left_out, "pair", "pairs"));
    return fmt::format(
        "{}<div class=\"browser\">\n<nav class=\"list\" aria-label=\"Pictures, worst first\">\n<ol>\n{}</ol>\n</nav>\n"
        "<div class=\"details\">\n{}</div>\n</div>\n",
        note, list, details);
}

std::string same_html(const SetResult& set) {
    if (set.count(Verdict::same) == 0) return "";
    std::string names;
    for (const ImageResult& image : set.images)
        if (image.verdict == Verdict::same) names += fmt::format("<li>{}</li>\n", html_text(image.name));
    return fmt::format(
        "<details class=\"same\"><summary>{} the same, pixel for pixel</summary>\n<ul>\n{}</ul></details>\n",
        set.count(Verdict::same) == 1 ? "1 picture is" : fmt::format("{} pictures are", set.count(Verdict::same)),
        names);
}

std::string facts_html(const Report& report) {
    std::string facts;
    const auto add = [&](std::string_view name, const std::string& value) {
        if (!value.empty()) facts += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, html_text(value));
    };
    add("References", report.set.reference);
    add("Pictures", report.set.image);
    add("Tolerances", report.options.tolerances.empty() ? "the defaults" : report.options.tolerances);
    add("Processor", report.options.platform);
    add("Program", report.options.generator);
    add("Exit code", std::to_string(report.set.exit_code()));
    return fmt::format("<section class=\"about\"><h2>About this comparison</h2>\n<dl>\n{}</dl></section>\n", facts);
}

std::string page_html(const Report& report) {
    const ReportAsset style = report_style(), script = report_script();
    const std::string generator = html_text(report.options.generator);
    return fmt::format(
               "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
               "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src '{}'; style-src '{}'; "
               "img-src data:; base-uri 'none'; form-action 'none'\">\n<meta name=\"viewport\" "
               "content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light "
               "dark\">\n<meta name=\"generator\" content=\"{}\">\n<title>{}</title>\n<style>{}</style>\n</head>\n",
               policy_hash(script.sha256), policy_hash(style.sha256), generator, html_text(title_of(report)),
               style.text) +
           "<body>\n<a class=\"skip\" href=\"#content\">Skip to the pictures</a>\n<main id=\"content\" "
           "tabindex=\"-1\">\n" +
           masthead_html(report) + browser_html(report) + same_html(report.set) + facts_html(report) + "</main>\n" +
           fmt::format(
               "<footer class=\"colophon\"><p>Made with {}. The page needs no network.</p></footer>\n"
               "<script>{}</script>\n</body>\n</html>\n",
               generator, script.text);
}

}  // namespace

void write_comparison_report(const SetResult& set, const ReportOptions& options, const std::filesystem::path& path) {
    Report report{set, options, by_severity(set), {}};
    report.pictures = report_pictures(report.images, options.most_picture_bytes, options.workers);
    write_file(path, page_html(report));
}

}  // namespace tumble
