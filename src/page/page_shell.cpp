#include "page/page_shell.h"

#include "core/check.h"
#include "core/error.h"
#include "core/html_text.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace tumble {
namespace {

/// Parts of the template that some pages have: {{NAME}} ... {{/NAME}}.
std::map<std::string, bool, std::less<>> parts_of(const PageShell& shell) {
    return {{"player", shell.with_player}, {"contents", shell.kind == "index"}};
}

std::string link_html(const ShellLink& link, std::string_view relation, std::string_view label) {
    if (link.address.empty()) return "";
    return fmt::format("<a class=\"{0}\" rel=\"{0}\" href=\"{1}\"><span class=\"label\">{2}</span> {3}</a>\n", relation,
                       html_text(link.address), label, html_text(link.text));
}

std::string navigation_html(const PageShell& shell, std::string_view place) {
    const std::string links = link_html(shell.previous, "prev", "Previous") + link_html(shell.up, "up", "Contents") +
                              link_html(shell.next, "next", "Next");
    return links.empty()
               ? ""
               : fmt::format("<nav class=\"pages {0}\" aria-label=\"Pages, {0}\">\n{1}</nav>\n", place, links);
}

/// Base64 has no character that would end the element.
std::string data_html(const std::vector<ShellClip>& clips) {
    std::string html;
    for (const ShellClip& clip : clips) {
        TUMBLE_CHECK_EQ(clip.id, html_text(clip.id));
        html += fmt::format("<script type=\"text/plain\" class=\"tumble-clip\" id=\"{}\">{}</script>\n", clip.id,
                            base64(clip.data));
    }
    return html;
}

std::map<std::string, std::string, std::less<>> values_of(const PageShell& shell) {
    return {{"language", html_text(shell.language.value_or("en"))},
            {"player-language", html_text(shell.language.value_or(""))},
            {"title", html_text(shell.title)},
            {"description", html_text(shell.description)},
            {"generator", html_text(shell.generator)},
            {"kind", html_text(shell.kind)},
            {"state", shell.with_player ? "loading" : "none"},
            {"head", shell.head_html},
            {"body", shell.body_html},
            {"navigation-top", navigation_html(shell, "top")},
            {"navigation-bottom", navigation_html(shell, "bottom")},
            {"clips", data_html(shell.clips)}};
}

}  // namespace

PageTemplate::PageTemplate(const std::filesystem::path& web_folder, PageKind kind)
    : file_(web_folder / (kind == PageKind::live ? "live-page.html" : "page.html")) {
    if (kind == PageKind::live && !std::filesystem::exists(file_))
        throw RunError(
            fmt::format("live pages need the simulation as WebAssembly, which is not built ({}): run "
                        "scripts/build-web --live in Tumble's source tree",
                        safe_path(file_)));
    std::ifstream file(file_, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw RunError(fmt::format("cannot read {}", safe_path(file_)));
    text_ = text.str();
}

// One pass: the values are not searched for places.
std::string PageTemplate::fill(const PageShell& shell) const {
    const auto values = values_of(shell);
    const auto parts = parts_of(shell);
    const std::string_view text = text_;
    std::string page;
    for (std::size_t at = 0;;) {
        const std::size_t begin = text.find("{{", at);
        page += text.substr(at, begin - at);
        if (begin == std::string_view::npos) return page;
        const std::size_t end = text.find("}}", begin);
        const std::string_view name = text.substr(begin + 2, end == std::string_view::npos ? end : end - begin - 2);
        at = end + 2;
        if (const auto part = parts.find(name); part != parts.end()) {
            if (part->second) continue;
            const std::size_t after = text.find(fmt::format("{{{{/{}}}}}", name), at);
            if (after != std::string_view::npos) at = after;
            continue;
        }
        if (name.starts_with('/') && parts.contains(name.substr(1))) continue;
        const auto value = values.find(name);
        if (value == values.end())
            throw RunError(fmt::format("{}: unknown place '{{{{{}}}}}' in the template; run scripts/build-web again",
                                       safe_path(file_), safe_text(name)));
        page += value->second;
    }
}

}  // namespace tumble
