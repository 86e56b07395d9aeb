#include "compare/comparison.h"

#include "core/html_text.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Rectangle& r) { return {{"x", r.x}, {"y", r.y}, {"width", r.width}, {"height", r.height}}; }

/// A number; null for an infinite one.
Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json json_of(const RuleFigure& figure) {
    return {{"metric", figure.metric},
            {"value", json_of(figure.value)},
            {"limit", json_of(figure.limit)},
            {"holds", figure.holds},
            {"x", figure.x},
            {"y", figure.y}};
}

Json json_of(const ImageResult& image) {
    Json json{{"name", image.name}, {"verdict", name_of(image.verdict)}};
    json["reference"] = image.reference.empty() ? Json() : Json(image.reference.string());
    json["image"] = image.image.empty() ? Json() : Json(image.image.string());
    json["width"] = image.width;
    json["height"] = image.height;
    if (image.sizes_differ()) {
        json["image_width"] = image.image_width;
        json["image_height"] = image.image_height;
    }
    json["rule"] = image.rule.empty() ? Json() : Json(image.rule);
    json["reason"] = image.reason;
    json["figures"] = Json::array();
    for (const RuleFigure& figure : image.figures) json["figures"].push_back(json_of(figure));
    json["differing_pixels"] = image.differing_pixels;
    json["max_difference"] = image.max_difference;
    json["changed"] = image.changed.width > 0 ? json_of(image.changed) : Json();
    json["causes"] = image.causes;
    json["accepted"] = image.accepted;
    return json;
}

/// Text for an attribute or an element. XML 1.0 allows no control characters but tab and line breaks, and a reader
/// turns tabs and line breaks in an attribute into spaces.
std::string escaped(std::string_view text) {
    std::string xml;
    for (const char c : html_text(safe_lines(text, text.size() + message_text_bytes))) {
        if (c == '\n' || c == '\t')
            xml += fmt::format("&#{};", int(c));
        else
            xml += c;
    }
    return xml;
}

/// JUnit tells tests that fail from tests that cannot be done.
bool is_error(Verdict verdict) { return verdict == Verdict::missing || verdict == Verdict::broken; }

std::string testcase(const ImageResult& image, const SetResult& result) {
    const std::string head = fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                                         escaped(result.reference), escaped(image.name), image.seconds);
    if (!result.fails(image)) return head + "/>\n";
    std::string text = image.reason;
    for (const std::string& cause : image.causes) text += "\n" + cause;
    const std::string_view element = is_error(image.verdict) ? "error" : "failure";
    return fmt::format("{}>\n    <{} type=\"{}\" message=\"{}\">{}</{}>\n  </testcase>\n", head, element,
                       name_of(image.verdict), escaped(text.substr(0, text.find('\n'))), escaped(text), element);
}

}  // namespace

std::string to_json(const SetResult& result) {
    Json json{{"format", "tumble-comparison"},
              {"version", 1},
              {"reference", result.reference},
              {"image", result.image},
              {"platform", Json()},
              {"added_allowed", result.added_allowed},
              {"exit_code", result.exit_code()},
              {"counts", Json::object()}};
    if (!result.platform.empty()) json["platform"] = result.platform;
    const auto counts = result.counts();
    for (std::size_t i = 0; i < verdict_count; ++i) json["counts"][std::string(name_of(Verdict(i)))] = counts[i];
    json["images"] = Json::array();
    for (const ImageResult& image : result.images) json["images"].push_back(json_of(image));
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_junit(const SetResult& result) {
    std::size_t failures = 0, errors = 0;
    double seconds = 0.0;
    std::string cases;
    for (const ImageResult& image : result.images) {
        if (result.fails(image)) ++(is_error(image.verdict) ? errors : failures);
        seconds += image.seconds;
        cases += testcase(image, result);
    }
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" "
        "errors=\"{}\" skipped=\"0\" time=\"{:.3f}\">\n{}</testsuite>\n",
        escaped(fmt::format("tumble compare {} {}", result.reference, result.image)), result.images.size(), failures,
        errors, seconds, cases);
}

}  // namespace tumble
