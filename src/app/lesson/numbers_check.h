// Equations with numbers in lessons, checked in the runs of their stages.
#pragma once

#include "app/lesson/lesson_runs.h"

#include <filesystem>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// Mistakes with the indices of their lessons: equations whose sides differ by more than their tolerance. Stages without a
/// clip are left out. Throws RunError if the compiler of lessons fails.
std::vector<std::pair<std::size_t, InputError>> wrong_numbers(const Course& course,
                                                              std::span<const LessonResult> results,
                                                              const std::filesystem::path& web_folder);

}  // namespace tumble
