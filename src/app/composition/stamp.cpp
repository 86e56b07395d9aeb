#include "app/composition/stamp.h"

#include "core/color.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr double least_size = 4.0, shrinking = 0.92;                        // pixels; factor
constexpr double line_height = 1.3, ascent = 0.95;                          // em
constexpr double padding_across = 0.55, padding_down = 0.22, corner = 0.4;  // em, of the ground
constexpr int balancing_rounds = 6;
constexpr Paint ground{{18, 22, 30}, 0.66};

struct SetLines {
    std::vector<std::string> lines;
    double width = 0.0;   // of the longest
    bool broken = false;  // a word is longer than a line
};

std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    for (std::size_t first = 0; first < line.size();) {
        const std::size_t end = std::min(line.find(' ', first), line.size());
        if (end > first) words.emplace_back(line.substr(first, end - first));
        first = end + 1;
    }
    return words;
}

/// No line ends between a number and its unit, or at an equals sign: "F = 2 N" is one word.
std::vector<std::string> joined(const std::vector<std::string>& words) {
    const auto is_number = [](const std::string& word) {
        return !word.empty() && word.find_first_not_of("0123456789.,-") == std::string::npos;
    };
    std::vector<std::string> all;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool joins =
            i > 0 && (words[i] == "=" || words[i - 1] == "=" || (is_number(words[i - 1]) && !is_number(words[i])));
        if (joins)
            all.back() += ' ' + words[i];
        else
            all.push_back(words[i]);
    }
    return all;
}

SetLines break_lines(std::string_view text, const TextStyle& style, double width, const Canvas& canvas) {
    SetLines set;
    const auto put = [&](const std::string& line) {
        const double used = canvas.text_width(line, style);
        set.width = std::max(set.width, used);
        set.broken = set.broken || used > width;
        set.lines.push_back(line);
    };
    for (std::size_t first = 0; first <= text.size();) {
        const std::size_t end = std::min(text.find('\n', first), text.size());
        std::string line;
        for (const std::string& word : joined(words_of(text.substr(first, end - first)))) {
            std::string longer = line;
            if (!line.empty()) longer += ' ';
            longer += word;
            if (!line.empty() && canvas.text_width(longer, style) > width) {
                put(line);
                line = word;
            } else {
                line = longer;
            }
        }
        put(line);
        first = end + 1;
    }
    return set;
}

/// The same number of lines, as equally long as possible.
SetLines balanced(SetLines set, std::string_view text, const TextStyle& style, double width, const Canvas& canvas) {
    if (set.lines.size() < 2 || set.broken) return set;
    double narrow = 0.5 * width, wide = width;
    for (int i = 0; i < balancing_rounds; ++i) {
        const double middle = 0.5 * (narrow + wide);
        SetLines tried = break_lines(text, style, middle, canvas);
        const bool fits = tried.lines.size() == set.lines.size() && !tried.broken;
        (fits ? wide : narrow) = middle;
        if (fits) set = std::move(tried);
    }
    return set;
}

}  // namespace

Rectangle intersection(const Rectangle& a, const Rectangle& b) {
    const int left = std::max(a.x, b.x), right = std::min(a.x + a.width, b.x + b.width);
    const int top = std::max(a.y, b.y), bottom = std::min(a.y + a.height, b.y + b.height);
    if (right <= left || bottom <= top) return {};
    return {left, top, right - left, bottom - top};
}

void Stamp::blend(Image& frame, const Rectangle& region) const {
    const Rectangle part = intersection(box, region);
    for (int y = part.y; y < part.y + part.height; ++y) {
        const std::uint8_t* from = pixels.at(part.x - box.x, y - box.y);
        std::uint8_t* to = frame.at(part.x, y);
        for (int x = 0; x < part.width; ++x, from += 4, to += 4) put_over(from, from[3], to);
    }
}

Stamp set_text(std::string_view text, const TextBox& box) {
    const Canvas measure(1, 1, 1.0);
    TextStyle style{box.size, {box.color}, box.bold, box.across};
    SetLines set;
    double width = 0.0, height = 0.0;
    while (true) {
        const double across = box.ground ? 2.0 * padding_across * style.size : 0.0;
        const double down = box.ground ? 2.0 * padding_down * style.size : 0.0;
        const double most = box.area.width - across;
        set = balanced(break_lines(text, style, most, measure), text, style, most, measure);
        if (!box.widest.empty()) set.width = std::max(set.width, measure.text_width(box.widest, style));
        width = set.width + across;
        height = line_height * style.size * double(set.lines.size()) + down;
        if ((!set.broken && width <= box.area.width && height <= box.area.height) || style.size <= least_size) break;
        style.size *= shrinking;
    }
    Stamp stamp;
    stamp.box.width = std::min(int(std::ceil(width)), box.area.width);
    stamp.box.height = std::min(int(std::ceil(height)), box.area.height);
    stamp.box.x = box.area.x + int(std::lround(box.across * (box.area.width - stamp.box.width)));
    stamp.box.y = box.area.y + int(std::lround(box.down * (box.area.height - stamp.box.height)));
    Canvas canvas(stamp.box.width, stamp.box.height, 1.0);
    const double full_width = stamp.box.width, full_height = stamp.box.height;
    if (box.ground) canvas.fill({0.0, 0.0, full_width, full_height}, ground, corner * style.size);
    const double left = box.ground ? padding_across * style.size : 0.0;
    const double top = box.ground ? padding_down * style.size : 0.0;
    for (std::size_t i = 0; i < set.lines.size(); ++i)
        canvas.text(
            {left + box.across * (full_width - 2.0 * left), top + (line_height * double(i) + ascent) * style.size},
            set.lines[i], style);
    stamp.pixels = canvas.image();
    return stamp;
}

}  // namespace tumble
