#include "app/lesson/course_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

using CourseJson = nlohmann::json;

template <class T>
void read(const CourseJson& json, const char* key, T& value) {
    if (const auto found = json.find(key); found != json.end()) found->get_to(value);
}

template <class T>
void read(const CourseJson& json, const char* key, std::optional<T>& value) {
    if (const auto found = json.find(key); found != json.end()) value = found->get<T>();
}

SourceLocation read_place(const CourseJson& json, const std::string& file) {
    return {file, json.at("line"), json.at("column")};
}

BlockPlaces read_places(const CourseJson& json, const std::string& file) {
    BlockPlaces places{read_place(json.at("place"), file), {}};
    for (const auto& [key, place] : json.at("places").items()) places.keys.emplace(key, read_place(place, file));
    return places;
}

LessonScene read_scene(const CourseJson& json, const std::string& lesson) {
    LessonScene scene;
    read(json, "text", scene.text);
    read(json, "set", scene.set);
    scene.file = lesson;
    if (const auto file = json.find("scene"); file != json.end())
        scene.file = scene.file.parent_path() / file->get<std::string>();
    return scene;
}

Vec3 read_vector(const CourseJson& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

PlayerOptions read_options(const CourseJson& json) {
    PlayerOptions options;
    read(json, "time", options.time);
    read(json, "run", options.run);
    read(json, "follow", options.follow);
    read(json, "body", options.body);
    read(json, "overlay", options.overlay);
    read(json, "plot", options.plot);
    read(json, "panels", options.panels);
    read(json, "layout", options.layout);
    read(json, "compare", options.compare);
    if (const auto view = json.find("view"); view != json.end())
        options.view = PlayerView{read_vector(view->at("eye")), read_vector(view->at("target"))};
    return options;
}

LessonStage read_stage(const CourseJson& json, const std::string& file) {
    LessonStage stage;
    read(json, "id", stage.id);
    stage.scene = read_scene(json, file);
    read(json, "vary", stage.vary);
    read(json, "labels", stage.labels);
    stage.options = read_options(json.at("options"));
    read(json, "caption", stage.caption_html);
    read(json, "alt", stage.options.alt);
    stage.places = read_places(json, file);
    return stage;
}

LessonCheck read_check(const CourseJson& json) {
    LessonCheck check;
    read(json, "of", check.of);
    read(json, "take", check.take);
    read(json, "at", check.at);
    read(json, "from", check.from);
    read(json, "to", check.to);
    read(json, "impact", check.impact);
    read(json, "column", check.column);
    read(json, "run", check.run);
    return check;
}

StatedNumber read_number(const CourseJson& json, const char* value, const std::string& file) {
    StatedNumber number;
    read(json, value, number.value);
    read(json, "tolerance", number.tolerance);
    read(json, "unit", number.unit);
    read(json, "label", number.label);
    if (const auto check = json.find("check"); check != json.end()) number.check = read_check(*check);
    number.places = read_places(json, file);
    return number;
}

LessonNumbers read_numbers(const CourseJson& json, const std::string& file) {
    LessonNumbers numbers;
    read(json, "stage", numbers.stage);
    read(json, "run", numbers.run);
    read(json, "tolerance", numbers.tolerance);
    numbers.data = json.at("data").dump();
    numbers.places = read_places(json, file);
    return numbers;
}

LessonConvergence read_convergence(const CourseJson& json, const std::string& file) {
    LessonConvergence convergence;
    convergence.scene = read_scene(json, file);
    read(json, "of", convergence.of);
    read(json, "at", convergence.at);
    read(json, "integrators", convergence.integrators);
    read(json, "steps_per_frame", convergence.steps_per_frame);
    read(json, "exact", convergence.exact);
    read(json, "reference", convergence.reference);
    read(json, "slopes", convergence.slopes);
    read(json, "caption", convergence.caption_html);
    read(json, "alt", convergence.alt);
    convergence.places = read_places(json, file);
    return convergence;
}

Lesson read_lesson(const CourseJson& json) {
    Lesson lesson;
    read(json, "file", lesson.file);
    read(json, "name", lesson.name);
    read(json, "title", lesson.title);
    read(json, "summary", lesson.summary);
    read(json, "body", lesson.body_html);
    for (const CourseJson& stage : json.at("stages")) lesson.stages.push_back(read_stage(stage, lesson.file));
    for (const CourseJson& quiz : json.at("quizzes"))
        lesson.quizzes.push_back({quiz.at("stage"), read_number(quiz, "answer", lesson.file)});
    for (const CourseJson& measure : json.at("measures")) {
        LessonMeasure& read_measure = lesson.measures.emplace_back();
        read(measure, "stage", read_measure.stage);
        for (const CourseJson& row : measure.at("rows"))
            read_measure.rows.push_back(read_number(row, "expected", lesson.file));
    }
    for (const CourseJson& numbers : json.at("numbers")) lesson.numbers.push_back(read_numbers(numbers, lesson.file));
    for (const CourseJson& convergence : json.at("convergences"))
        lesson.convergences.push_back(read_convergence(convergence, lesson.file));
    return lesson;
}

}  // namespace

Course read_course(std::string_view json) {
    try {
        const CourseJson root = CourseJson::parse(json);
        Course course;
        for (const CourseJson& error : root.at("errors"))
            course.errors.emplace_back(read_place(error, error.at("file")), error.at("message").get<std::string>());
        // The lessons are whole only without mistakes.
        if (!course.errors.empty()) return course;
        for (const CourseJson& lesson : root.at("lessons")) course.lessons.push_back(read_lesson(lesson));
        read(root, "index", course.index_html);
        return course;
    } catch (const CourseJson::exception& error) {
        throw RunError(
            fmt::format("the output of lesson.cjs is not as expected ({}); run scripts/build-web again", error.what()));
    }
}

}  // namespace tumble
