#include "app/lesson/lesson_runs.h"

#include "app/lesson/convergence_figure.h"
#include "app/lesson/lesson_compiler.h"
#include "app/lesson/run_numbers.h"
#include "app/page/record_run.h"
#include "app/threads/task_group.h"
#include "core/html_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tumble {
namespace {

/// A stated number of a stage, and where its measured value is kept.
struct StatedPlace {
    const StatedNumber* number;
    double* measured;  // null: of a quiz
};

std::string amount(double value, const std::string& unit) {
    return unit.empty() ? fmt::format("{:.10g}", value) : fmt::format("{:.10g} {}", value, unit);
}

void compare_with_run(const StatedNumber& number, double measured, bool of_quiz) {
    if (std::abs(measured - number.value) <= number.tolerance) return;
    const std::string name = of_quiz ? std::string("answer") : fmt::format("expected, of '{}'", number.label);
    throw InputError(number.places.of(of_quiz ? "answer" : "expected"),
                     fmt::format("{}: the lesson has {}, the run {} (deviation {:.2g}, allowed {:g})", name,
                                 amount(number.value, number.unit), amount(measured, number.unit),
                                 std::abs(measured - number.value), number.tolerance));
}

bool comes_before(const InputError& a, const InputError& b) {
    return std::pair(a.where().line, a.where().column) < std::pair(b.where().line, b.where().column);
}

std::vector<StatedPlace> numbers_of_stage(const Lesson& lesson, const std::string& stage, LessonResult& result) {
    std::vector<StatedPlace> numbers;
    for (const LessonQuiz& quiz : lesson.quizzes)
        if (quiz.stage == stage && quiz.answer.check) numbers.push_back({&quiz.answer, nullptr});
    for (std::size_t m = 0; m < lesson.measures.size(); ++m)
        for (std::size_t row = 0; lesson.measures[m].stage == stage && row < lesson.measures[m].rows.size(); ++row)
            numbers.push_back({&lesson.measures[m].rows[row], &result.measures[m][row]});
    return numbers;
}

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

/// Mistakes with the indices of their lessons: equations whose sides differ by more than their tolerance. Stages
/// without a clip are left out. Throws RunError if the compiler of lessons fails.
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

}  // namespace

struct LessonRuns::Job {
    std::size_t lesson;
    std::function<void()> work;
};

LessonRuns::LessonRuns(const Course& course, std::string generator)
    : course_(course), generator_(std::move(generator)), errors_(course.lessons.size()) {
    for (const Lesson& lesson : course_.lessons) load(lesson);
}

void LessonRuns::load(const Lesson& lesson) {
    LessonScenes& scenes = scenes_.emplace_back();
    LessonResult& result = results_.emplace_back();
    const std::size_t index = scenes_.size() - 1;
    scenes.stages.resize(lesson.stages.size());
    scenes.live.resize(lesson.stages.size());
    scenes.convergences.resize(lesson.convergences.size());
    result.stages.resize(lesson.stages.size());
    result.convergences.resize(lesson.convergences.size());
    for (const LessonMeasure& measure : lesson.measures) result.measures.emplace_back(measure.rows.size());
    for (std::size_t i = 0; i < lesson.stages.size(); ++i)
        collect(index, [&] {
            scenes.stages[i] = load_stage(lesson.stages[i], inputs_);
            scenes.live[i] = load_live_controls(lesson.stages[i]);
        });
    for (std::size_t i = 0; i < lesson.convergences.size(); ++i)
        collect(index, [&] { scenes.convergences[i] = load_convergence(lesson.convergences[i], inputs_); });
}

void LessonRuns::collect(std::size_t lesson, const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        const std::lock_guard lock(errors_mutex_);
        errors_[lesson].push_back(error);
    }
}

std::size_t LessonRuns::blocks() const {
    std::size_t count = 0;
    for (const Lesson& lesson : course_.lessons) count += lesson.stages.size() + lesson.convergences.size();
    return count;
}

// A stage's runs are recorded one after the other: a job is long enough as it is.
void LessonRuns::run_stage(std::size_t lesson, std::size_t stage) {
    const LessonStage& block = course_.lessons[lesson].stages[stage];
    const std::vector<LoadedScene>& scenes = scenes_[lesson].stages[stage];
    const std::vector<StatedPlace> stated = numbers_of_stage(course_.lessons[lesson], block.id, results_[lesson]);
    for (const StatedPlace& place : stated)
        if (place.number->check->run >= scenes.size())
            throw InputError(place.number->places.of("check"),
                             fmt::format("check: the stage has {} runs, numbered from 0 (run = {})", scenes.size(),
                                         place.number->check->run));
    PageClip clip;
    clip.title = scenes.front().scene.title;
    clip.generator = generator_;
    clip.sources.push_back(
        {block.scene.text ? block.id + ".toml" : block.scene.file.filename().string(), scene_source(block.scene)});
    Interrupt interrupt;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        std::vector<StatedPlace> of_run;
        std::ranges::copy_if(stated, std::back_inserter(of_run),
                             [&](const StatedPlace& place) { return place.number->check->run == i; });
        std::vector<const StatedNumber*> numbers;
        for (const StatedPlace& place : of_run) numbers.push_back(place.number);
        CheckedRun checked(numbers, scenes[i].scene);
        RecordSettings settings;
        settings.label = scenes[i].label;
        settings.plot = block.options.plot.empty() ? scenes[i].scene.overlay.plot : block.options.plot;
        settings.observers = {&checked.observer()};
        clip.runs.push_back(record_run(scenes[i].scene, settings, interrupt));
        for (std::size_t k = 0; k < of_run.size(); ++k)
            collect(lesson, [&] {
                const double measured = checked.measured(k, clip.runs.back());
                compare_with_run(*numbers[k], measured, of_run[k].measured == nullptr);
                if (of_run[k].measured != nullptr) *of_run[k].measured = measured;
            });
    }
    results_[lesson].stages[stage].clip = make_clip_data(clip).bytes;
}

void LessonRuns::run_convergence_block(std::size_t lesson, std::size_t block) {
    Interrupt interrupt;
    const LessonConvergence& convergence = course_.lessons[lesson].convergences[block];
    const auto lines = run_convergence(convergence, scenes_[lesson].convergences[block], interrupt);
    results_[lesson].convergences[block] = convergence_figure(convergence, lines);
}

std::vector<LessonRuns::Job> LessonRuns::jobs() {
    std::vector<Job> list;
    for (std::size_t lesson = 0; lesson < course_.lessons.size(); ++lesson) {
        // The longest come first: a convergence block has dozens of runs.
        for (std::size_t i = 0; i < course_.lessons[lesson].convergences.size(); ++i)
            list.push_back({lesson, [=, this] { run_convergence_block(lesson, i); }});
    }
    for (std::size_t lesson = 0; lesson < course_.lessons.size(); ++lesson)
        for (std::size_t i = 0; i < course_.lessons[lesson].stages.size(); ++i)
            list.push_back({lesson, [=, this] { run_stage(lesson, i); }});
    return list;
}

void LessonRuns::run(int threads, const std::function<void(std::size_t)>& progress) {
    const std::vector<Job> list = jobs();
    std::atomic<std::size_t> next = 0, done = 0;
    std::atomic<bool> stopped = false;
    const auto work = [&] {
        for (std::size_t i; !stopped && (i = next++) < list.size();) {
            collect(list[i].lesson, list[i].work);
            ++done;
        }
    };
    Interrupt interrupt;  // blocks the signals in the threads too
    TaskGroup group;
    group.on_stop([&] { stopped = true; });
    for (int i = 0; i < std::min<int>(threads, int(list.size())); ++i) group.start(work);
    while (!group.wait(std::chrono::milliseconds(50))) {
        progress(done);
        if (interrupt.pending()) group.stop(std::make_exception_ptr(Interrupted()));
    }
    group.finish();
    progress(done);
}

void LessonRuns::check_numbers(const std::filesystem::path& web_folder) {
    for (auto& [lesson, error] : wrong_numbers(course_, results_, web_folder))
        errors_[lesson].push_back(std::move(error));
}

std::vector<InputError> LessonRuns::errors() const {
    std::vector<InputError> all;
    for (std::vector<InputError> of_lesson : errors_) {
        std::ranges::stable_sort(of_lesson, comes_before);
        all.insert(all.end(), of_lesson.begin(), of_lesson.end());
    }
    return all;
}

}  // namespace tumble
