// Lessons as their compiler (web/lesson, run by Node.js) hands them over: HTML with places to fill in, and the blocks
// that need a run.
#pragma once

#include "app/page/live_controls.h"
#include "core/error.h"
#include "page/player_figure.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Places of a block and of its keys in the lesson's file.
struct BlockPlaces {
    SourceLocation block;
    std::map<std::string, SourceLocation> keys;

    /// Place of the key; of the block if the key is not there.
    const SourceLocation& of(const std::string& key) const;
};

/// A scene in a file, or its text in the lesson.
struct LessonScene {
    std::filesystem::path file;       // of the scene; of the lesson, if `text` is there
    std::optional<std::string> text;  // on the lines where it stands in the lesson's file
    std::vector<std::string> set;     // as --set
};

struct LessonStage {
    std::string id;
    LessonScene scene;
    std::vector<std::string> vary;    // as --vary
    std::vector<std::string> labels;  // of the runs; empty: made from `vary`
    std::vector<LiveControl> live;    // values that the reader may change; empty: a recorded stage
    PlayerOptions options;
    std::string caption_html;
    BlockPlaces places;
};

/// The number of a run that a quiz or a measure is compared with: an impact's column, the count of impacts, or a
/// quantity over time.
struct LessonCheck {
    std::string of;                     // a quantity of `tumble plot --of`; empty: of impacts
    std::string take;                   // max, min, first, last, mean, range, at
    double at = 0.0;                    // s, for `take = "at"`
    std::optional<double> from, to;     // s
    std::optional<std::size_t> impact;  // from 1; without it, the count
    std::string column;                 // of the impact
    std::size_t run = 0;
};

/// A number that a lesson states.
struct StatedNumber {
    double value = 0.0, tolerance = 0.0;
    std::string unit, label;
    std::optional<LessonCheck> check;
    BlockPlaces places;
};

struct LessonMeasure {
    std::string stage;
    std::vector<StatedNumber> rows;
};

struct LessonQuiz {
    std::string stage;
    StatedNumber answer;
};

/// An equation whose sides must agree in a run.
struct LessonNumbers {
    std::string stage;
    std::string data;  // JSON, for the compiler of lessons: the sides, and the moment
    std::size_t run = 0;
    double tolerance = 0.0;  // largest residual
    BlockPlaces places;
};

struct LessonConvergence {
    LessonScene scene;
    std::string of;   // a quantity, or body.NAME.position
    double at = 0.0;  // s
    std::vector<std::string> integrators;
    std::vector<int> steps_per_frame;
    std::optional<double> exact;           // value of the quantity
    std::string reference;                 // integrator whose run is exact, without `exact`
    std::map<std::string, double> slopes;  // by integrator
    std::string caption_html, alt;
    BlockPlaces places;
};

struct Lesson {
    std::string file;  // of the Markdown, as given
    std::string name;  // of its page
    std::string title, summary;
    std::string body_html;
    std::vector<LessonStage> stages;
    std::vector<LessonQuiz> quizzes;
    std::vector<LessonMeasure> measures;
    std::vector<LessonNumbers> numbers;
    std::vector<LessonConvergence> convergences;
};

struct Course {
    std::vector<Lesson> lessons;     // in their order
    std::string index_html;          // below its title
    std::vector<InputError> errors;  // mistakes in the lessons
};

/// Reads the lessons with lesson.cjs of the web folder. Throws RunError if Node.js is missing or fails.
Course compile_lessons(const std::vector<std::filesystem::path>& files, const std::filesystem::path& web_folder);

}  // namespace tumble
