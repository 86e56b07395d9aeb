#include "compare/report/report_entry.h"

#include "core/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <tuple>

namespace tumble {
namespace {

/// The meaning of a metric.
struct MetricText {
    std::string_view name, meaning, unit;
};

constexpr MetricText metric_texts[] = {
    {"pixels", "pixels beyond the tolerance", "pixels"},
    {"cluster", "most of them in 8 × 8 pixels", "pixels"},
    {"window", "largest mean difference of 8 × 8 pixels", "levels"},
    {"shade", "most pixels of 8 × 8 that are all brighter, or all darker", "pixels"},
    {"ssim", "structural similarity: 1 for equal pictures", ""},
    {"flip", "mean perceived difference, from 0 to 1", ""},
};

MetricText text_of(const std::string& metric) {
    const auto* const found = std::find_if(std::begin(metric_texts), std::end(metric_texts),
                                           [&](const MetricText& text) { return text.name == metric; });
    return found == std::end(metric_texts) ? MetricText{metric, "", ""} : *found;
}

/// "1,234".
std::string grouped(std::int64_t value) {
    if (value < 1000) return std::to_string(value);  // no figure is negative
    return fmt::format("{},{:03}", grouped(value / 1000), value % 1000);
}

std::string number_text(double value) {
    if (value == std::floor(value) && std::fabs(value) < 1e15) return grouped(static_cast<std::int64_t>(value));
    return fmt::format("{:.4g}", value);
}

/// "12 times the limit".
std::string excess_text(const RuleFigure& figure) {
    const double times = excess(figure);
    if (figure.holds) return "within its limit";
    if (times >= 1e6) return "none is allowed";
    return fmt::format("{} times the limit",
                       times < 10.0 ? fmt::format("{:.1f}", times) : number_text(std::round(times)));
}

/// "1,234 pixels differ".
std::string differing_text(const ImageResult& result) {
    return result.differing_pixels == 1 ? "1 pixel differs" : grouped(result.differing_pixels) + " pixels differ";
}

/// The sentence of an image in the list.
std::string image_summary(const ImageResult& result) {
    switch (result.verdict) {
        case Verdict::missing:
            return "there is a reference, but no picture";
        case Verdict::added:
            return "there is a picture, but no reference";
        case Verdict::broken:
            return result.sizes_differ() ? "has another size" : "cannot be compared";
        default:
            break;
    }
    if (!result.causes.empty()) return result.causes.front();
    const RuleFigure* const worst = worst_figure(result);
    if (!worst) return "";
    if (worst->holds) return differing_text(result) + ", within the tolerances";
    return fmt::format("{}: {}", worst->metric, excess_text(*worst));
}

struct PictureText {
    std::string_view role, label;
    std::string alternative;
};

std::string picture_html(const PictureText& text, const PictureBytes& picture, const ImageSize& size) {
    if (picture.empty()) return "";
    return fmt::format(
        "<figure data-role=\"{}\"><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" loading=\"lazy\" "
        "decoding=\"async\"><figcaption>{}</figcaption></figure>\n",
        text.role, data_address(picture_media_type(picture), picture), size.width, size.height,
        html_text(text.alternative), text.label);
}

/// A frame around the changed pixels, over a picture.
std::string mark_html(const ImageResult& result) {
    const Rectangle& r = result.changed;
    if (r.width == 0 || result.width == 0) return "";
    return fmt::format(
        "<svg class=\"mark\" viewBox=\"0 0 {} {}\" aria-hidden=\"true\" focusable=\"false\"><rect x=\"{}\" y=\"{}\" "
        "width=\"{}\" height=\"{}\"/></svg>",
        result.width, result.height, r.x, r.y, r.width, r.height);
}

std::string facts_html(const ReportEntry& entry) {
    const ImageResult& result = *entry.result;
    std::string facts;
    const auto add = [&](std::string_view html) {
        facts += fmt::format("{}<span>{}</span>", facts.empty() ? "" : " ", html);
    };
    if (result.sizes_differ())
        add(fmt::format("{} × {} pixels, the reference {} × {}", result.image_width, result.image_height, result.width,
                        result.height));
    else if (result.width > 0)
        add(fmt::format("{} × {} pixels", result.width, result.height));
    if (result.differing_pixels > 0)
        add(fmt::format(
            "{} ({:.2g} %), by up to {} levels", differing_text(result),
            100.0 * double(result.differing_pixels) / std::max(1.0, double(result.width) * double(result.height)),
            result.max_difference));
    if (result.changed.width > 0)
        add(fmt::format("changed region {} × {} from x {}, y {}", result.changed.width, result.changed.height,
                        result.changed.x, result.changed.y));
    if (!result.rule.empty()) add(fmt::format("tolerances of <code>{}</code>", html_text(result.rule)));
    return facts.empty() ? "" : fmt::format("<p class=\"facts\">{}</p>\n", facts);
}

std::string causes_html(const ImageResult& result) {
    if (result.causes.empty()) return "";
    std::string html = "<div class=\"causes\"><h3>Cause</h3>\n<ul>\n";
    for (const std::string& cause : result.causes) html += fmt::format("<li>{}</li>\n", html_text(cause));
    return html + "</ul></div>\n";
}

std::string reasons_html(const ImageResult& result) {
    if (result.reason.empty()) return "";
    std::string html = fmt::format("<ul class=\"reasons {}\">\n", name_of(result.verdict));
    for (std::string_view rest = result.reason; !rest.empty();) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        html += fmt::format("<li>{}</li>\n", html_text(rest.substr(0, end)));
        rest.remove_prefix(std::min(rest.size(), end + 1));
    }
    return html + "</ul>\n";
}

/// The measured value as a bar, with the limit at its middle.
std::string bar_html(const RuleFigure& figure) {
    const double width = std::min(100.0, 50.0 * excess(figure));
    return fmt::format(
        "<svg class=\"bar\" viewBox=\"0 0 100 8\" preserveAspectRatio=\"none\" aria-hidden=\"true\" "
        "focusable=\"false\">"
        "<rect class=\"track\" width=\"100\" height=\"8\"/><rect class=\"value\" width=\"{:.1f}\" height=\"8\"/>"
        "<rect class=\"limit\" x=\"49.4\" width=\"1.2\" height=\"8\"/></svg>",
        width);
}

std::string figure_row_html(const RuleFigure& figure) {
    const MetricText text = text_of(figure.metric);
    const std::string unit = text.unit.empty() ? "" : fmt::format(" <span class=\"unit\">{}</span>", text.unit);
    return fmt::format(
        "<tr class=\"{}\"><th scope=\"row\">{} <span class=\"meaning\">{}</span></th><td class=\"number\">{}{}</td>"
        "<td class=\"number\">{} {}</td><td class=\"state\">{}<span class=\"times\">{}</span></td>"
        "<td class=\"place\" data-x=\"{}\" data-y=\"{}\">x {}, y {}</td></tr>\n",
        figure.holds ? "holds" : "fails", html_text(text.name), text.meaning, number_text(figure.value), unit,
        figure.metric == "ssim" ? "at least" : "at most", number_text(figure.limit), bar_html(figure),
        excess_text(figure), figure.x, figure.y, figure.x, figure.y);
}

/// Metrics of the report itself, which have no limit.
std::string perception_html(const PairPictures& pictures) {
    if (!pictures.figures || !pictures.ssim) return "";
    const FlipFigures& f = *pictures.figures;
    return fmt::format(
        "<dl class=\"perception\"><div><dt>FLIP, mean</dt><dd>{:.4g}</dd></div><div><dt>FLIP, weighted median</dt>"
        "<dd>{:.3g}</dd></div><div><dt>FLIP, 99 % of pixels below</dt><dd>{:.3g}</dd></div><div><dt>FLIP, largest</dt>"
        "<dd>{:.3g}</dd></div><div><dt>SSIM, mean</dt><dd>{:.6g}</dd></div></dl>\n",
        f.mean, f.weighted_median, f.quantile_99, f.maximum, *pictures.ssim);
}

std::string figures_html(const ReportEntry& entry) {
    const ImageResult& result = *entry.result;
    std::string html;
    if (!result.figures.empty()) {
        html +=
            "<div class=\"table\" role=\"region\" aria-label=\"Rules of image " + std::to_string(entry.number) +
            "\" tabindex=\"0\"><table>\n<thead><tr><th scope=\"col\">Rule</th><th scope=\"col\">Measured</th><th "
            "scope=\"col\">Limit</th><th scope=\"col\">Verdict</th><th scope=\"col\">Worst place</th></tr></thead>\n"
            "<tbody>\n";
        for (const RuleFigure& figure : result.figures) html += figure_row_html(figure);
        html += "</tbody></table></div>\n";
    }
    return html + perception_html(*entry.pictures);
}

std::string pictures_html(const ReportEntry& entry) {
    const ImageResult& result = *entry.result;
    const PairPictures& pictures = *entry.pictures;
    if (pictures.left_out)
        return "<p class=\"note\">The pictures are left out, so that the page stays small. They are the files "
               "themselves, and <code>tumble compare A.png B.png --report R.html</code> shows one pair.</p>\n";
    if (pictures.reference.empty() && pictures.image.empty()) return "";
    const Rectangle& r = result.changed;
    std::string html = fmt::format("<div class=\"pictures\" data-changed=\"{} {} {} {}\" data-hottest=\"{:.3g}\">\n",
                                   r.x, r.y, r.width, r.height, pictures.hottest_window);
    const std::string windows =
        fmt::format("Mean difference of 8 × 8 pixels: black 0, yellow {:.3g} levels", pictures.hottest_window);
    html += picture_html({"reference", "Reference", "Reference of " + result.name}, pictures.reference,
                         pictures.reference_size);
    html += picture_html({"image", "Image", "Image " + result.name}, pictures.image, pictures.image_size);
    html += picture_html(
        {"flip", "Perceived difference (FLIP): black 0, yellow 1", "Perceived difference of " + result.name},
        pictures.flip, pictures.image_size);
    html +=
        picture_html({"windows", windows, "Mean differences of " + result.name}, pictures.windows, pictures.image_size);
    html += picture_html({"difference",
                          "Difference of two sizes: yellow where only the reference has pixels, green where only the "
                          "image has some",
                          "Difference of " + result.name},
                         pictures.difference, pictures.difference_size);
    return html + "</div>\n";
}

}  // namespace

std::string list_item_html(const ReportEntry& entry) {
    const ImageResult& result = *entry.result;
    const std::string verdict(name_of(result.verdict));
    const std::string picture =
        entry.pictures->thumbnail.empty()
            ? std::string("<span class=\"blank\"></span>")
            : fmt::format("<img src=\"{}\" alt=\"\" decoding=\"async\">{}",
                          data_address("image/png", entry.pictures->thumbnail), mark_html(result));
    return fmt::format(
        "<li data-verdict=\"{}\"><a href=\"#image-{}\"><span class=\"thumb\"><span>{}</span></span><span "
        "class=\"text\"><span class=\"name\">{}</span><span class=\"summary\">{}</span></span><span class=\"verdict "
        "{}\">{}</span></a></li>\n",
        verdict, entry.number, picture, html_text(result.name), html_text(image_summary(result)), verdict, verdict);
}

std::string details_html(const ReportEntry& entry) {
    const ImageResult& result = *entry.result;
    const std::string_view verdict = name_of(result.verdict);
    const std::string reasons = reasons_html(result);
    const bool compared = !result.figures.empty();  // otherwise the reason is all that there is to say
    return fmt::format(
        "<article id=\"image-{0}\" data-verdict=\"{1}\" aria-labelledby=\"title-{0}\" tabindex=\"-1\">\n<header><h2 "
        "id=\"title-{0}\"><span class=\"name\">{2}</span> <span class=\"verdict {1}\">{1}</span></h2>\n{3}</header>\n"
        "{4}{5}{6}{7}{8}</article>\n",
        entry.number, verdict, html_text(result.name), facts_html(entry), causes_html(result), compared ? "" : reasons,
        pictures_html(entry), figures_html(entry), compared ? reasons : "");
}

double excess(const RuleFigure& figure) {
    constexpr double most = 1e6;
    // Similarity counts from 1 downwards. A limit of 0 allows nothing: any value exceeds it.
    const bool similarity = figure.metric == "ssim";
    const double value = similarity ? 1.0 - figure.value : figure.value;
    const double limit = similarity ? 1.0 - figure.limit : figure.limit;
    if (value <= 0.0) return 0.0;
    return limit > 0.0 ? std::min(value / limit, most) : most;
}

const RuleFigure* worst_figure(const ImageResult& result) {
    const auto worst = std::max_element(result.figures.begin(), result.figures.end(), [](const auto& a, const auto& b) {
        return std::pair(!a.holds, excess(a)) < std::pair(!b.holds, excess(b));
    });
    return worst == result.figures.end() ? nullptr : &*worst;
}

std::vector<const ImageResult*> by_severity(const SetResult& set) {
    std::vector<const ImageResult*> images;
    for (const ImageResult& image : set.images)
        if (image.verdict != Verdict::same) images.push_back(&image);
    const auto key = [](const ImageResult* image) {
        const RuleFigure* const worst = worst_figure(*image);
        return std::tuple(std::ranges::find(worst_first, image->verdict), worst ? -excess(*worst) : 0.0,
                          -image->differing_pixels);
    };
    std::stable_sort(images.begin(), images.end(), [&](const auto* a, const auto* b) { return key(a) < key(b); });
    return images;
}

}  // namespace tumble
