#include "page/player_figure.h"

#include "core/html_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// The film if there is one, otherwise the poster.
std::string fallback_html(const PlayerFigure& figure) {
    const std::string size =
        figure.width > 0 ? fmt::format(" width=\"{}\" height=\"{}\"", figure.width, figure.height) : "";
    if (!figure.film.empty())
        return fmt::format(
            "<video class=\"player-fallback\" controls loop muted playsinline preload=\"metadata\"{}{} src=\"{}\" "
            "aria-label=\"{}\"></video>\n",
            size, figure.poster.empty() ? "" : fmt::format(" poster=\"{}\"", figure.poster), figure.film,
            html_text(figure.options.alt));
    if (!figure.poster.empty())
        return fmt::format("<img class=\"player-fallback\"{} src=\"{}\" alt=\"{}\">\n", size, figure.poster,
                           html_text(figure.options.alt));
    return fmt::format("<p class=\"player-fallback\">{}</p>\n", html_text(figure.options.alt));
}

}  // namespace

std::string options_json(const PlayerOptions& options) {
    const PlayerOptions standard;
    OrderedJson json = OrderedJson::object();
    if (options.time != standard.time) json["time"] = options.time;
    if (options.run != standard.run) json["run"] = options.run;
    if (!options.follow.empty()) json["follow"] = options.follow;
    if (!options.body.empty()) json["body"] = options.body;
    if (options.overlay) json["overlay"] = *options.overlay;
    if (!options.plot.empty()) json["plot"] = options.plot;
    if (options.view) json["view"] = {{"eye", triple(options.view->eye)}, {"target", triple(options.view->target)}};
    if (options.panels) json["panels"] = *options.panels;
    if (!options.layout.empty()) json["layout"] = options.layout;
    if (!options.compare.empty()) json["compare"] = options.compare;
    if (!options.alt.empty()) json["alt"] = options.alt;
    return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

std::string figure_html(const PlayerFigure& figure) {
    std::string html = "<figure class=\"tumble-player\"";
    if (!figure.id.empty()) html += fmt::format(" id=\"{}\"", html_text(figure.id));
    html += fmt::format(" data-clip=\"{}\" data-options=\"{}\"", html_text(figure.clip),
                        html_text(options_json(figure.options)));
    if (!figure.live.empty()) html += fmt::format(" data-live=\"{}\"", html_text(figure.live));
    html += ">\n";
    html += fallback_html(figure);
    html += "<noscript><p class=\"player-note\">Turning, scrubbing and plots need JavaScript.</p></noscript>\n";
    if (!figure.caption_html.empty()) html += fmt::format("<figcaption>{}</figcaption>\n", figure.caption_html);
    return html + "</figure>\n";
}

}  // namespace tumble
