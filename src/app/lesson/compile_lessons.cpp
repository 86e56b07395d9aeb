#include "app/lesson/course.h"
#include "app/lesson/lesson_compiler.h"
#include "core/safe_text.h"
#include "output/process.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <string_view>

namespace tumble {

const SourceLocation& BlockPlaces::of(const std::string& key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? block : found->second;
}

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

LiveControl read_live_control(const CourseJson& json) {
    LiveControl control;
    read(json, "key", control.key);
    read(json, "label", control.label);
    read(json, "unit", control.unit);
    read(json, "min", control.min);
    read(json, "max", control.max);
    read(json, "step", control.step);
    read(json, "choices", control.choices);
    return control;
}

LessonStage read_stage(const CourseJson& json, const std::string& file) {
    LessonStage stage;
    read(json, "id", stage.id);
    stage.scene = read_scene(json, file);
    read(json, "vary", stage.vary);
    read(json, "labels", stage.labels);
    for (const CourseJson& control : json.at("live")) stage.live.push_back(read_live_control(control));
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

/// Throws RunError if the text is not what the compiler writes.
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

/// A file without a name, for the output of a program of any length.
class OutputInMemory {
public:
    OutputInMemory() : file_(::memfd_create("lessons", MFD_CLOEXEC)) {
        if (file_ < 0) throw RunError(fmt::format("cannot make a file in memory: {}", std::strerror(errno)));
    }
    ~OutputInMemory() { ::close(file_); }
    OutputInMemory(const OutputInMemory&) = delete;
    OutputInMemory& operator=(const OutputInMemory&) = delete;

    int descriptor() const { return file_; }

    std::string text() const {
        struct stat status {};
        ::fstat(file_, &status);
        std::string text(std::size_t(status.st_size), '\0');
        for (std::size_t at = 0; at < text.size();) {
            const ssize_t count = ::pread(file_, text.data() + at, text.size() - at, off_t(at));
            if (count <= 0) throw RunError("cannot read the output of node");
            at += std::size_t(count);
        }
        return text;
    }

private:
    int file_;
};

}  // namespace

std::string run_lesson_compiler(const std::filesystem::path& web_folder, const std::vector<std::string>& arguments,
                                const std::string& input) {
    const std::filesystem::path compiler = web_folder / "lesson.cjs";
    if (!std::filesystem::exists(compiler))
        throw RunError(fmt::format("{} is missing: run scripts/build-web again", safe_path(compiler)));
    const auto node = find_program("node");
    if (!node)
        throw RunError(
            "lessons need Node.js 18.13 or later, and there is no program 'node' on the PATH (Debian: apt-get "
            "install nodejs)");
    std::vector<std::string> command{compiler.string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    // It ends with this process, which may be killed.
    command.insert(command.end(), {"--for", std::to_string(::getpid())});
    const OutputInMemory output;
    Process process(*node, command, output.descriptor());
    process.write(std::as_bytes(std::span(input)));
    const ProcessEnd end = process.finish();
    if (!end.ok())
        throw RunError(fmt::format("node {}: {}\n{}", safe_path(compiler), end.describe(), safe_lines(end.error_text)));
    return output.text();
}

Course compile_lessons(const std::vector<std::filesystem::path>& files, const std::filesystem::path& web_folder) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& file : files) list.push_back(file.string());
    return read_course(
        run_lesson_compiler(web_folder, {}, list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

}  // namespace tumble
