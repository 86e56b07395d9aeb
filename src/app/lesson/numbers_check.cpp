#include "app/lesson/numbers_check.h"

#include "app/lesson/lesson_compiler.h"
#include "core/html_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>

namespace tumble {
namespace {

using NumbersJson = nlohmann::json;

/// An equation of the task for the compiler.
struct Asked {
    std::size_t lesson;
    const LessonNumbers* numbers;
};

std::string sides_text(const NumbersJson& side) {
    std::vector<std::string> components;
    for (const NumbersJson& component : side) components.push_back(fmt::format("{:.10g}", component.get<double>()));
    return components.size() == 1 ? components.front() : fmt::format("({})", fmt::join(components, ", "));
}

std::optional<InputError> mistake(const LessonNumbers& numbers, const NumbersJson& result) {
    if (const auto problem = result.find("problem"); problem != result.end()) {
        const std::string text = problem->get<std::string>();
        return InputError(numbers.places.of(text.substr(0, text.find(':'))), text);
    }
    const double residual = result.at("residual").get<double>();
    if (residual <= numbers.tolerance) return std::nullopt;
    return InputError(
        numbers.places.of("value"),
        fmt::format(
            "value: the left side is {} and the right side {} at {:.4g} s in the run (residual {:.2g}, allowed {:g})",
            sides_text(result.at("left")), sides_text(result.at("right")), result.at("time").get<double>(), residual,
            numbers.tolerance));
}

/// Adds the equations of a lesson, and the clips of their stages.
void ask(const Lesson& lesson, std::size_t index, const LessonResult& result, NumbersJson& task,
         std::vector<Asked>& asked) {
    for (std::size_t i = 0; i < lesson.stages.size(); ++i) {
        const LessonStage& stage = lesson.stages[i];
        const std::size_t first = asked.size();
        for (const LessonNumbers& numbers : lesson.numbers) {
            if (numbers.stage != stage.id || result.stages[i].clip.empty()) continue;
            asked.push_back({index, &numbers});
            task["blocks"].push_back({{"clip", task["clips"].size()},
                                      {"run", numbers.run},
                                      {"data", NumbersJson::parse(numbers.data)},
                                      {"body", stage.options.body}});
        }
        if (asked.size() > first) task["clips"].push_back(base64(result.stages[i].clip));
    }
}

}  // namespace

std::vector<std::pair<std::size_t, InputError>> wrong_numbers(const Course& course,
                                                              std::span<const LessonResult> results,
                                                              const std::filesystem::path& web_folder) {
    NumbersJson task = {{"clips", NumbersJson::array()}, {"blocks", NumbersJson::array()}};
    std::vector<Asked> asked;
    for (std::size_t i = 0; i < course.lessons.size(); ++i) ask(course.lessons[i], i, results[i], task, asked);
    std::vector<std::pair<std::size_t, InputError>> mistakes;
    if (asked.empty()) return mistakes;
    try {
        const NumbersJson answers = NumbersJson::parse(run_lesson_compiler(web_folder, {"--numbers"}, task.dump()));
        for (std::size_t i = 0; i < asked.size(); ++i)
            if (const auto error = mistake(*asked[i].numbers, answers.at(i)))
                mistakes.emplace_back(asked[i].lesson, *error);
    } catch (const NumbersJson::exception& error) {
        throw RunError(
            fmt::format("the output of lesson.cjs is not as expected ({}); run scripts/build-web again", error.what()));
    }
    return mistakes;
}

}  // namespace tumble
