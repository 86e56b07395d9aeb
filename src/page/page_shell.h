// The HTML shell of a page: all pages of `tumble page`, `tumble lesson` and `render --report` are filled into one
// template, page.html of the web folder, which holds the style sheet, the player and the content security policy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The data of a player. Figures name it by its id.
struct ShellClip {
    std::string id;                   // "clip-1": letters, digits and hyphens
    std::span<const std::byte> data;  // compressed (make_clip_data())
};

/// A link of the navigation; empty: none.
struct ShellLink {
    std::string address;  // relative: "resting-contact.html"
    std::string text;
};

/// Members are plain text, except names that end in _html.
struct PageShell {
    std::string title;
    std::optional<std::string> language;  // of all texts; without it "en", and the player has the reader's
    std::string description;              // a sentence, for search engines and the summary of links
    std::string kind = "page";            // class of the body element: page, lesson, index, report
    std::string generator;                // "Tumble 0.1.0"
    std::string head_html;                // more of the head: <style>, <meta>
    std::string body_html;                // content of <main>
    std::vector<ShellClip> clips;
    ShellLink previous, next, up;
    bool live = false;        // for the template of live pages
    bool with_player = true;  // false for a page without anything to run: the script is left out
};

/// Live pages have the simulation too.
enum class PageKind : std::uint8_t { recorded, live };

/// The template, read once for many pages.
class PageTemplate {
public:
    /// Throws RunError if it cannot be read, or is not built.
    explicit PageTemplate(const std::filesystem::path& web_folder, PageKind kind = PageKind::recorded);
    /// The whole page. Throws RunError if the template has an unknown place.
    std::string fill(const PageShell& shell) const;

    const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
    std::string text_;
};

}  // namespace tumble
