// Pages of lessons: results put into the places that the compiler left.
#pragma once

#include "app/lesson/lesson_runs.h"
#include "page/page_shell.h"

#include <string>
#include <vector>

namespace tumble {

/// Pictures of a stage for readers without WebGL, and for print. Data addresses; empty: there is none.
struct StagePictures {
    std::string poster, film;
    int width = 0, height = 0;  // pixels
};

/// The contents of a lesson's page, by stage.
struct LessonParts {
    const LessonResult& result;
    const std::vector<StagePictures>& pictures;
    const std::vector<std::vector<LiveControl>>& live;  // empty: of stages that are recorded
};

/// The page of a lesson of the course.
PageShell lesson_page(const Course& course, std::size_t index, const LessonParts& parts, const std::string& generator);

/// The page of contents. `posters`: data addresses of the lessons' pictures; empty: there is none.
PageShell index_page(const Course& course, const std::string& title, const std::string& generator,
                     const std::vector<std::string>& posters);

}  // namespace tumble
