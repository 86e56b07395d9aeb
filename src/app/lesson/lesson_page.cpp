#include "app/lesson/lesson_page.h"

#include "core/html_text.h"
#include "page/run_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

namespace tumble {
namespace {

/// Replaces "<!--KEY-->" by the text of each key.
std::string fill_places(std::string_view html, const std::map<std::string, std::string, std::less<>>& texts) {
    constexpr std::string_view begin = "<!--", end = "-->";
    std::string filled;
    for (std::size_t at = 0;;) {
        const std::size_t open = html.find(begin, at);
        filled += html.substr(at, open - at);
        if (open == std::string_view::npos) return filled;
        const std::size_t close = html.find(end, open);
        const auto text = texts.find(html.substr(open + begin.size(), close - open - begin.size()));
        if (text != texts.end()) filled += text->second;
        at = close + end.size();
    }
}

/// Enough to tell a number from others beyond the tolerance.
int digits_of(double value, double tolerance) {
    if (value == 0.0 || tolerance == 0.0) return 15;
    return int(std::clamp(std::ceil(std::log10(std::abs(value) / tolerance)) + 2.0, 4.0, 15.0));
}

std::string clip_id(const LessonStage& stage) { return "clip-" + stage.id; }

/// Quantities of joints are recorded where a plot of the scene names them.
std::string live_of(const LessonStage& stage, const std::vector<LiveControl>& controls) {
    LivePage page;
    page.name = stage.scene.text ? stage.id + ".toml" : stage.scene.file.filename().string();
    page.settings = stage.scene.set;
    if (stage.options.plot.find("joint.") != std::string::npos)
        page.settings.push_back("overlay.plot=" + stage.options.plot);
    page.controls = controls;
    page.editor = false;
    return live_json(page);
}

std::string stage_html(const LessonStage& stage, const StagePictures& pictures,
                       const std::vector<LiveControl>& controls) {
    PlayerFigure figure;
    if (!controls.empty()) figure.live = live_of(stage, controls);
    figure.clip = clip_id(stage);
    figure.id = stage.id;
    figure.options = stage.options;
    figure.poster = pictures.poster;
    figure.film = pictures.film;
    figure.width = pictures.width;
    figure.height = pictures.height;
    figure.caption_html = stage.caption_html;
    return figure_html(figure);
}

/// Address of its page, with percent escapes.
std::string address_of(const Lesson& lesson) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.!~*'()";
    std::string address;
    for (const char byte : lesson.name)
        address += plain.find(byte) != std::string_view::npos
                       ? std::string(1, byte)
                       : fmt::format("%{:02X}", static_cast<unsigned char>(byte));
    return address + ".html";
}

}  // namespace

PageShell lesson_page(const Course& course, std::size_t index, const LessonParts& parts, const std::string& generator) {
    const LessonResult& result = parts.result;
    const Lesson& lesson = course.lessons[index];
    std::map<std::string, std::string, std::less<>> texts;
    PageShell shell;
    for (std::size_t i = 0; i < lesson.stages.size(); ++i) {
        texts["stage:" + lesson.stages[i].id] = stage_html(lesson.stages[i], parts.pictures[i], parts.live[i]);
        shell.live = shell.live || !parts.live[i].empty();
        shell.clips.push_back({clip_id(lesson.stages[i]), result.stages[i].clip});
    }
    for (std::size_t i = 0; i < lesson.convergences.size(); ++i)
        texts[fmt::format("convergence:{}", i)] = result.convergences[i];
    for (std::size_t i = 0; i < lesson.measures.size(); ++i)
        for (std::size_t row = 0; row < lesson.measures[i].rows.size(); ++row) {
            const StatedNumber& stated = lesson.measures[i].rows[row];
            const double measured = result.measures[i][row];
            texts[fmt::format("measured:{}:{}", i, row)] = number_html(measured, digits_of(measured, stated.tolerance));
            texts[fmt::format("deviation:{}:{}", i, row)] = number_html(std::abs(measured - stated.value), 2);
        }
    shell.title = lesson.title;
    shell.description = lesson.summary;
    shell.kind = "lesson";
    shell.generator = generator;
    shell.body_html = fill_places(lesson.body_html, texts);
    if (course.lessons.size() > 1) shell.up = {"index.html", ""};
    if (index > 0) shell.previous = {address_of(course.lessons[index - 1]), course.lessons[index - 1].title};
    if (index + 1 < course.lessons.size())
        shell.next = {address_of(course.lessons[index + 1]), course.lessons[index + 1].title};
    return shell;
}

PageShell index_page(const Course& course, const std::string& title, const std::string& generator,
                     const std::vector<std::string>& posters) {
    // The title of the lesson says what the picture shows.
    std::map<std::string, std::string, std::less<>> pictures;
    for (std::size_t i = 0; i < posters.size(); ++i)
        if (!posters[i].empty())
            pictures[fmt::format("picture:{}", i)] = fmt::format("<img src=\"{}\" alt=\"\">", posters[i]);
    PageShell shell;
    shell.title = title;
    shell.description = course.lessons.size() == 1 ? course.lessons.front().summary : "Contents of the lessons";
    shell.kind = "index";
    shell.generator = generator;
    shell.body_html = fmt::format("<header class=\"lesson-header\"><h1>{}</h1></header>\n", html_text(title)) +
                      fill_places(course.index_html, pictures);
    shell.with_player = false;
    return shell;
}

}  // namespace tumble
